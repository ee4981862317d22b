"""Shapes in half blocks: each block is empty, full, or its lower or upper half.

A design is an array ``halves`` uint8 [X, Y, Z]: bit 1 for the lower half of the block, bit 2 for
the upper. They are what is left where no finer shape exists in an object's colours: each becomes a
full block.
"""

import numpy as np

LOWER, UPPER, FULL = 1, 2, 3


def of_half_layers(layers: np.ndarray) -> np.ndarray:
    """Return halves, uint8 [X, Y, Z], of a bool array [X, Y, 2 Z] with two layers a block."""
    return (layers[:, :, 0::2] * LOWER + layers[:, :, 1::2] * UPPER).astype(np.uint8)

"""Shapes in half blocks: each block is empty, full, or its lower or upper half.

A design is an array ``halves`` uint8 [X, Y, Z]: bit 1 for the lower half of the block, bit 2 for
the upper. Halves become slabs where a slab of the right colour exists, else full blocks.
"""

from collections.abc import Mapping

import numpy as np

from world2minecraft.geometry.colour import oklab_of_srgb
from world2minecraft.minecraft.colours import colours_of, nearest_oklab

LOWER, UPPER, FULL = 1, 2, 3


def of_half_layers(layers: np.ndarray) -> np.ndarray:
    """Return halves, uint8 [X, Y, Z], of a bool array [X, Y, 2 Z] with two layers a block."""
    return (layers[:, :, 0::2] * LOWER + layers[:, :, 1::2] * UPPER).astype(np.uint8)


def slab_states(
    states: np.ndarray, halves: np.ndarray, slabs: Mapping[str, str], margin: float
) -> np.ndarray:
    """Return the states, object [N], with slabs where a block is half and its colour allows it.

    Args:
        states: object [N], the full blocks that the colours chose.
        halves: uint8 [N], LOWER, UPPER or FULL.
        slabs: the slab of each full block that has one.
        margin: the Oklab distance that may be lost by becoming a slab.
    """
    result = states.copy()
    cut = halves != FULL
    for block in sorted(set(states[cut].tolist())):
        slab = _nearest_slab(block, slabs, margin)
        if slab is None:
            continue
        for half, kind in ((LOWER, "bottom"), (UPPER, "top")):
            result[(states == block) & (halves == half)] = f"{slab}[type={kind}]"
    return result


def _nearest_slab(block: str, slabs: Mapping[str, str], margin: float) -> str | None:
    if block in slabs:
        return slabs[block]
    names = sorted(slabs)
    offered = oklab_of_srgb(colours_of(names))
    wanted = oklab_of_srgb(colours_of([block]))
    best = int(nearest_oklab(wanted, offered)[0])
    if np.linalg.norm(offered[best] - wanted[0]) > margin:
        return None
    return slabs[names[best]]

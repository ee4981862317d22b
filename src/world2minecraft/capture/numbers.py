"""Numbers that a capture's JSON states, which may be anything."""

import numpy as np


def as_floats(values: object) -> np.ndarray:
    """Return stated numbers as float64 in the shape of their lists; empty where they are none.

    NaN and infinity stay; a whole number too long for a float makes the whole empty.

    Example:
        >>> as_floats([[1, 2], [3, 4]]).shape, as_floats([[1, 2], [3]]).shape, as_floats("x").shape
        ((2, 2), (0,), (0,))
    """
    try:
        return np.array(values, np.float64)
    except (TypeError, ValueError, OverflowError):
        return np.zeros(0)

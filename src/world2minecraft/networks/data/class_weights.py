"""Class frequencies, and the class weights of the loss.

- ``frequency``: ``1 / ln(1.02 + share)`` (Paszke et al. 2016, ENet), scaled to a mean of 1 over the
  11 occupied classes. Rare classes have larger weights, limited by the constant.
- ``monoscene``: 0.05 for empty cells, 1 for all other classes.
- ``even``: 1 for all classes.
"""

from collections.abc import Iterable

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.errors import UnknownNameError
from world2minecraft.networks.config import CLASS_WEIGHTS

BOUND = 1.02  # As in ENet, which limits weights to about 50.
EMPTY_WEIGHT = 0.05  # MonoScene's.


def class_counts(grids: Iterable[np.ndarray]) -> np.ndarray:
    """Return the number of cells of each class, int64 [12], ignoring 255."""
    total = np.zeros(256, np.int64)
    for labels in grids:
        total += np.bincount(labels.reshape(-1), minlength=256)
    return total[:CLASS_COUNT]


def class_weights(counts: np.ndarray, kind: str) -> np.ndarray:
    """Return the weight of each class, float32 [12].

    Args:
        counts: Number of cells of each class, int64 [12].
        kind: ``frequency``, ``monoscene`` or ``even``.

    Raises:
        UnknownNameError: If the kind is unknown.

    Example:
        >>> class_weights(np.array([90, 5, 5] + [0] * 9), "monoscene")[:2].tolist()
        [0.05000000074505806, 1.0]
    """
    weights = np.ones(CLASS_COUNT)
    if kind == "frequency":
        weights = 1 / np.log(BOUND + counts / max(counts.sum(), 1))
        weights /= weights[1:].mean()
    elif kind == "monoscene":
        weights[0] = EMPTY_WEIGHT
    elif kind != "even":
        raise UnknownNameError("kind of class weights", kind, CLASS_WEIGHTS)
    return weights.astype(np.float32)

"""Other classes for what is labelled already: a map over fine classes.

A stored sample keeps which block and which design each cell is of, so that its 12 classes can be
made anew by another map. Where a fine class alone does not tell (planks are floor, wall or
ceiling), what is known stays.
"""

from collections.abc import Sequence

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, UNKNOWN
from world2minecraft.core.errors import UsageError
from world2minecraft.minecraftocc.block_map.rules import BlockMap, matches
from world2minecraft.minecraftocc.values import FineClass


def class_of_fine(fine: FineClass, rules: BlockMap) -> int | None:
    """Return the class that a map gives a fine class wherever it is; None where it depends.

    A design counts for more than the blocks that it is made of.

    Example:
        >>> from world2minecraft.minecraftocc.block_map import load_block_map
        >>> class_of_fine(FineClass("minecraft:white_wool", "curtain"), load_block_map("paper"))
        0
    """
    if fine.design:
        for pattern, name in rules.designs:
            if matches(pattern, fine.design, fine.design, frozenset()):
                return CLASS_NAMES.index(name)
        return None
    meaning = rules.meaning(fine.block)
    told = rules.rules_of(meaning)
    if meaning in rules.unless_known or not told[0].always:
        return None
    return CLASS_NAMES.index(told[0].class_name)


def remapped(
    labels: np.ndarray, fine: np.ndarray, classes: Sequence[FineClass], rules: BlockMap
) -> np.ndarray:
    """Return labels by another map.

    Args:
        labels: uint8, any shape: 0 to 11 or 255. Cells that are empty or unknown stay so.
        fine: uint16 of the same shape, indices of ``classes``.
        classes: the fine classes; the first stands for empty cells.
        rules: the map.

    Raises:
        UsageError: the shapes differ, or a number is beyond the classes.
    """
    if labels.shape != fine.shape:
        raise UsageError(f"labels {labels.shape} and fine {fine.shape} must be of one shape")
    if fine.size and int(fine.max()) >= len(classes):
        raise UsageError(f"fine goes to {fine.max()}, there are {len(classes)} classes")
    told = [None if n == 0 else class_of_fine(one, rules) for n, one in enumerate(classes)]
    is_told = np.array([one is not None for one in told])
    values = np.array([one or 0 for one in told], np.uint8)
    changed = is_told[fine] & (labels != 0) & (labels != UNKNOWN)
    return np.where(changed, values[fine], labels).astype(np.uint8)

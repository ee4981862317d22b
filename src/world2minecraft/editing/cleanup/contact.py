"""What touches what in a volume: blocks are joined where their shapes meet, not where cells do.

A lantern over a lower slab has half a block of air under it though their cells are neighbours.
"""

from functools import lru_cache
from itertools import product

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from world2minecraft.minecraft.visual_shapes import visual_boxes_of

GAP = 1 / 8  # Blocks: shapes nearer than this touch for the eye. A fence's bar is 1/8 thick.
# Half of the 26 neighbours: the others are these, seen from the other side.
SIDES = (-1, 0, 1)
STEPS = tuple(step for step in product(SIDES, SIDES, SIDES) if step > (0, 0, 0))


def touching_parts(states: np.ndarray, palette: tuple[str, ...], mask: np.ndarray) -> np.ndarray:
    """Number the parts of a mask whose blocks hold together.

    Args:
        states: uint16 [X, Y, Z] in block axes.
        palette: their texts.
        mask: bool [X, Y, Z], the cells that count.

    Returns:
        int32 [X, Y, Z]: 0 outside, and 1 to n for the parts, in the order of their first cells.
    """
    number = np.full(states.shape, -1, np.int64)
    cells = np.flatnonzero(mask)
    number.ravel()[cells] = np.arange(len(cells))
    pairs = [_joined(states, palette, number, step) for step in STEPS]
    first, second = (np.concatenate([pair[side] for pair in pairs]) for side in (0, 1))
    graph = coo_array((np.ones(len(first), bool), (first, second)), (len(cells), len(cells)))
    _, labels = connected_components(graph, directed=False)
    _, starts = np.unique(labels, return_index=True)
    order = np.empty(len(starts), np.int32)
    order[np.argsort(starts)] = np.arange(1, len(starts) + 1)
    parts = np.zeros(states.shape, np.int32)
    parts.ravel()[cells] = order[labels] if len(cells) else 0
    return parts


def _joined(
    states: np.ndarray, palette: tuple[str, ...], number: np.ndarray, step: tuple[int, int, int]
) -> tuple[np.ndarray, np.ndarray]:
    """The pairs of counted cells that touch across a step, by their numbers."""
    here = tuple(slice(max(0, -s), min(n, n - s)) for s, n in zip(step, states.shape, strict=True))
    there = tuple(slice(max(0, s), min(n, n + s)) for s, n in zip(step, states.shape, strict=True))
    both = (number[here] >= 0) & (number[there] >= 0)
    first, second = states[here][both].astype(np.int64), states[there][both].astype(np.int64)
    keys, places = np.unique(first * len(palette) + second, return_inverse=True)
    touch = np.array(
        [touches(palette[key // len(palette)], palette[key % len(palette)], step) for key in keys],
        bool,
    )
    chosen = touch[places] if len(keys) else np.zeros(0, bool)
    return number[here][both][chosen], number[there][both][chosen]


@lru_cache(maxsize=1 << 16)
def touches(state: str, other: str, step: tuple[int, int, int]) -> bool:
    """Whether the shapes of two block states touch, the other one lying ``step`` blocks away.

    Example:
        >>> touches("minecraft:stone", "minecraft:stone", (0, 1, 0))
        True
        >>> touches("minecraft:oak_slab[type=bottom]", "minecraft:stone", (0, 1, 0))
        False
    """
    mine, its = visual_boxes_of(state), visual_boxes_of(other)
    if not len(mine) or not len(its):
        return False
    away = np.array(step, np.float64)
    low = np.maximum(mine[:, None, :3], its[None, :, :3] + away)
    high = np.minimum(mine[:, None, 3:], its[None, :, 3:] + away)
    return bool((high - low > -GAP + 1e-6).all(axis=2).any())

"""The things inside rooms, with their measures in metres and what they are made of."""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from world2minecraft.minecraftocc.block_map.conditions import MEASURES


@dataclass(frozen=True, eq=False)
class Things:
    """``parts`` int32 [X, Y, Z], 0 for none; each measure float64 [things + 1]."""

    parts: np.ndarray
    measures: dict[str, np.ndarray]


def measured(parts: np.ndarray, count: int, ground: np.ndarray, scale: float) -> Things:
    """Return things with their measures.

    Args:
        parts: int32 [X, Y, Z], the number of the thing that each block is part of, 0 for none.
        count: how many things there are.
        ground: int16 [X, Y, Z], the layer of the floor under each block.
        scale: blocks per metre.
    """
    found = {name: np.zeros(count + 1) for name in MEASURES if name != "at_m"}
    for number, box in enumerate(ndimage.find_objects(parts), 1):
        if box is None:
            continue
        own = parts[box] == number
        floor = int(ground[box][own].min()) + 1
        low, high = box[1].start, box[1].stop
        sides = sorted(s.stop - s.start for s in (box[0], box[2]))
        held_columns = own.any(axis=1)
        at_floor = own[:, max(0, floor - low) :][:, :1].any(axis=1) & (low <= floor)
        found["height_m"][number] = (high - low) / scale
        found["bottom_m"][number] = (low - floor) / scale
        found["top_m"][number] = (high - floor) / scale
        found["wide_m"][number], found["long_m"][number] = sides[0] / scale, sides[1] / scale
        found["area_m2"][number] = held_columns.sum() / scale**2
        found["filled"][number] = own.mean()
        found["open"][number] = (held_columns & ~at_floor).sum() / held_columns.sum()
    return Things(parts, found)


def shares_of(parts: np.ndarray, kinds: np.ndarray, count: int) -> np.ndarray:
    """Return the share of each thing's blocks that each kind has, float64 [things + 1, count]."""
    things = int(parts.max(initial=0)) + 1
    held = parts > 0
    pairs = parts[held].astype(np.int64) * count + kinds[held]
    counts = np.bincount(pairs, minlength=things * count).reshape(things, count)
    return counts / np.maximum(counts.sum(1, keepdims=True), 1)

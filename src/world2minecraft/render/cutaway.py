"""What to leave out of a room so that one can look into it.

The ceiling goes; of the walls on the near sides only a low rim stays, with whatever hangs on them
gone too. Nothing is decided by names of blocks, only by the classes and places in the volume.
"""

from dataclasses import replace

import numpy as np

from world2minecraft.classes import SemanticClass
from world2minecraft.types import BlockVolume

RIM_M = 0.25  # So much of a near wall stays, to show where it is.
HUNG_M = 0.12  # What hangs on a near wall reaches this far into the room,
HIGH_M = 1.0  # and hangs above this height; lower things stand on the floor.
_WALLS = (int(SemanticClass.WALL), int(SemanticClass.WINDOW))


def without_ceiling(volume: BlockVolume) -> BlockVolume:
    """Return the volume without its ceiling and all above it."""
    semantic = volume.semantic
    drop = semantic == SemanticClass.CEILING
    level = ceiling_level(semantic)
    if level is not None:
        drop = drop.copy()
        drop[:, level:, :] = True
    return _without(volume, drop)


def ceiling_level(semantic: np.ndarray) -> int | None:
    """Return the lowest layer (y) of the flat ceiling, or None where there is none."""
    counts = (semantic == SemanticClass.CEILING).sum(axis=(0, 2))
    if not counts.any():
        return None
    # Drops and beams lie under the flat part; half of the fullest layer tells them apart.
    return int(np.flatnonzero(counts >= counts.max() / 2)[0])


def without_near_walls(volume: BlockVolume, near_x: int, near_z: int) -> BlockVolume:
    """Return the volume with the walls on two sides cut down to a rim.

    Args:
        volume: the blocks.
        near_x: which end of block x is near: +1 for its far end, -1 for its start.
        near_z: the same for block z.
    """
    semantic = volume.semantic
    floor = floor_columns(semantic)
    outside = _beyond(floor, 0, near_x) | _beyond(floor, 1, near_z)
    level = floor_level(semantic) + 1 + round(RIM_M * volume.blocks_per_metre)
    drop = np.zeros(semantic.shape, bool)
    drop[:, level:, :] = outside[:, None, :]
    far = _beyond(floor, 0, -near_x) | _beyond(floor, 1, -near_z)
    flush = ~far & _dilate(outside, max(1, round(HUNG_M * volume.blocks_per_metre)))
    # What reaches into the room stands there: a floor lamp keeps its shade.
    inside = np.unique(volume.instance[np.broadcast_to(~flush[:, None, :], semantic.shape)])
    stands = np.isin(volume.instance, inside[inside > 0])
    hangs = np.isin(semantic, (*_WALLS, int(SemanticClass.OBJS))) & flush[:, None, :] & ~stands
    high = floor_level(semantic) + 1 + round(HIGH_M * volume.blocks_per_metre)
    hangs[:, :high, :] &= np.isin(semantic[:, :high, :], _WALLS)
    hangs[:, :level, :] = False
    return _without(volume, drop | hangs)


def floor_level(semantic: np.ndarray) -> int:
    """Return the fullest floor layer (y), or 0 where there is no floor."""
    counts = (semantic == SemanticClass.FLOOR).sum(axis=(0, 2))
    return int(counts.argmax())


def floor_columns(semantic: np.ndarray) -> np.ndarray:
    """Return bool [X, Z]: columns with floor in them and no wall at a man's height."""
    is_floor = (semantic == SemanticClass.FLOOR).any(axis=1)
    is_wall = np.isin(semantic, _WALLS).mean(axis=1) > 0.4
    return is_floor & ~is_wall


def _beyond(floor: np.ndarray, axis: int, side: int) -> np.ndarray:
    """Tell which columns [X, Z] lie past the last floor of their row, towards ``side``."""
    rows = np.moveaxis(floor, axis, 0)
    rows = rows[::-1] if side > 0 else rows
    beyond = ~np.logical_or.accumulate(rows, axis=0)
    beyond = beyond[::-1] if side > 0 else beyond
    # A row without any floor runs along a wall: it is cut where its neighbours are.
    empty = ~rows.any(axis=0)
    if empty.any() and not empty.all():
        last = np.flatnonzero(~empty)
        nearest = last[np.abs(last[None] - np.flatnonzero(empty)[:, None]).argmin(axis=1)]
        beyond[:, empty] = beyond[:, nearest]
    return np.moveaxis(beyond, 0, axis)


def _dilate(mask: np.ndarray, steps: int) -> np.ndarray:
    grown = mask.copy()
    for _ in range(steps):
        grown[1:] |= mask[:-1]
        grown[:-1] |= mask[1:]
        grown[:, 1:] |= mask[:, :-1]
        grown[:, :-1] |= mask[:, 1:]
        mask = grown.copy()
    return grown


def _without(volume: BlockVolume, drop: np.ndarray) -> BlockVolume:
    return replace(
        volume,
        states=np.where(drop, np.uint16(0), volume.states),
        semantic=np.where(drop, np.uint8(0), volume.semantic),
        instance=np.where(drop, np.uint16(0), volume.instance),
    )

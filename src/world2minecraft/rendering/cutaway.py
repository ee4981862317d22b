"""Cutaways of a volume, which open its rooms to view.

The ceiling is removed. The near walls are cut down to a low rim without their attachments, and
walls between rooms are cut to chest height. The storeys of a house are placed side by side.
Entities are removed or moved with their blocks. Cutaways only depend on the classes and positions
of blocks, never on block names.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.types import BlockVolume, Entity
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.minecraft.entities import display_cubes, owner_of

MAX_CUT_SHARE = 0.5  # Objects that would lose more than this share of their blocks are removed.
WALL_RIM_M = 0.25  # Remaining height of a near wall.
WALL_MOUNT_DEPTH_M = 0.12  # Maximum depth of objects that hang on a near wall,
WALL_MOUNT_HEIGHT_M = 1.0  # and minimum height of their bottom; lower objects stand on the floor.
PARTITION_HEIGHT_M = 1.1  # Remaining height of a wall between two rooms.
MIN_ROOM_M2 = 1.0
MIN_PASSAGE_M = 0.75  # Between two walls; a bent outer wall had 0.5 m of floor behind it.
MIN_ROOM_WIDTH_M = 0.4  # Narrower strips of floor are not rooms.
MIN_STOREY_M = 1.9  # Minimum vertical distance of two floors,
MIN_STOREY_SHARE = 0.15  # and minimum share of the area of the largest floor.
STOREY_GAP_M = 1.5  # Between storeys that stand side by side.
_WALLS = (int(SemanticClass.WALL), int(SemanticClass.WINDOW))


def remaining_entities(volume: BlockVolume, drop: np.ndarray) -> tuple[Entity, ...]:
    """Return the entities that remain when some blocks of their volume are removed.

    The entities of an object are removed with its blocks. Entities without blocks are removed if
    their centre is in a removed cell.

    Args:
        volume: The whole volume.
        drop: Mask of the removed blocks, bool [X, Y, Z].
    """
    if not volume.entities:
        return ()
    counts = np.bincount(volume.instance.ravel(), minlength=1)
    lost = np.bincount(volume.instance[drop], minlength=len(counts))
    kept = []
    for entity in volume.entities:
        number = owner_of(entity)[1]
        if 0 < number < len(counts) and counts[number]:
            gone = lost[number] > MAX_CUT_SHARE * counts[number]
        else:
            gone = drop[tuple(_cell_of(entity, volume))]
        if not gone:
            kept.append(entity)
    return tuple(kept)


def entities_within(volume: BlockVolume, low: int, high: int) -> tuple[Entity, ...]:
    """Return the entities whose centre is in the layers [low, high) of a volume.

    Entities above the volume belong to its top layer, entities below to its bottom layer.
    """
    top = volume.states.shape[1]
    return tuple(
        entity
        for entity in volume.entities
        if low <= min(max(int(_cell_of(entity, volume)[1]), 0), top - 1) < high
    )


def translate_entities(volume: BlockVolume, shift: np.ndarray) -> tuple[Entity, ...]:
    """Return the entities of a volume translated by a vector in blocks, float64 [3]."""
    return tuple(
        replace(one, position=tuple((np.array(one.position) + shift).tolist()))
        for one in volume.entities
    )


def _cell_of(entity: Entity, volume: BlockVolume) -> np.ndarray:
    """Return the cell, int64 [3], that holds an entity's middle, or the nearest of the volume."""
    drawn = display_cubes((entity,))
    middle = np.array(entity.position)
    if drawn:
        middle = (drawn[0].cube_to_world @ [0.5, 0.5, 0.5, 1.0])[:3]
    cell = np.floor(middle - volume.corner).astype(np.int64)
    return np.clip(cell, 0, np.array(volume.states.shape) - 1)


def without_ceiling(volume: BlockVolume) -> BlockVolume:
    """Return the volume without its ceiling and everything above it."""
    semantic = volume.semantic
    drop = semantic == SemanticClass.CEILING
    level = ceiling_level(semantic)
    if level is not None:
        drop = drop.copy()
        drop[:, level:, :] = True
    return _remove_blocks(volume, drop)


def ceiling_level(semantic: np.ndarray) -> int | None:
    """Return the lowest layer (y) of the flat ceiling, or None without a ceiling."""
    counts = (semantic == SemanticClass.CEILING).sum(axis=(0, 2))
    if not counts.any():
        return None
    # Drops and beams lie under the flat part; half of the fullest layer separates them.
    return int(np.flatnonzero(counts >= counts.max() / 2)[0])


def split_storeys(volume: BlockVolume) -> list[BlockVolume]:
    """Return the storeys of a house from the ground up, each from its floor to the next floor.

    A single room is its own only storey.
    """
    counts = (volume.semantic == SemanticClass.FLOOR).sum(axis=(0, 2))
    least = max(MIN_STOREY_SHARE * counts.max(initial=0), 1)
    spacing = MIN_STOREY_M * volume.blocks_per_metre
    floors: list[int] = []
    for level in np.flatnonzero(counts >= least).tolist():
        if floors and level - floors[-1] < spacing:
            continue
        floors.append(level)
    if len(floors) < 2:
        return [volume]
    edges = [0, *floors[1:], volume.states.shape[1]]
    return [_layers(volume, low, high) for low, high in pairwise(edges)]


def arrange_side_by_side(volumes: Sequence[BlockVolume]) -> BlockVolume:
    """Return volumes of the same floor plan in a row, on one level, in the given order.

    They are placed along the shorter side of the plan, so that the row is roughly square.
    """
    if len(volumes) == 1:
        return volumes[0]
    first = volumes[0]
    axis = 0 if first.states.shape[0] <= first.states.shape[2] else 2
    height = max(one.states.shape[1] for one in volumes)
    gap = round(STOREY_GAP_M * first.blocks_per_metre)
    entities, moved = [], np.zeros(3)
    for one in volumes:
        entities += translate_entities(one, moved + np.subtract(first.corner, one.corner))
        moved[axis] += one.states.shape[axis] + gap
    return replace(
        first,
        entities=tuple(entities),
        states=_concatenate([one.states for one in volumes], axis, height, gap),
        semantic=_concatenate([one.semantic for one in volumes], axis, height, gap),
        instance=_concatenate([one.instance for one in volumes], axis, height, gap),
    )


def without_partitions(volume: BlockVolume) -> BlockVolume:
    """Return the volume with the walls between rooms, and their attachments, cut down.

    Such walls have floor of a room on both sides within half a metre. A strip of floor that was
    seen behind an outer wall does not count as a room.
    """
    semantic = volume.semantic
    bpm = volume.blocks_per_metre
    side = max(round(MIN_PASSAGE_M * bpm), 1)
    floor = ndimage.binary_opening(_room_columns_without_doors(volume), np.ones((side, side)))
    reach = max(2, round(0.5 * bpm))
    walls = np.isin(semantic, _WALLS).any(axis=1)  # A lintel too, over the floor of its doorway.
    between = walls & (
        _floor_on_both_sides(floor, 0, reach) | _floor_on_both_sides(floor, 1, reach)
    )
    if not between.any():
        return volume
    level = floor_level(semantic) + 1 + round(PARTITION_HEIGHT_M * bpm)
    drop = np.zeros(semantic.shape, bool)
    drop[:, level:, :] = between[:, None, :]
    low = np.unique(volume.instance[:, :level, :])
    near = _dilate(between, max(1, round(WALL_MOUNT_DEPTH_M * bpm)))[:, None, :]
    hangs = (volume.instance > 0) & ~np.isin(volume.instance, low) & near
    drop |= np.isin(volume.instance, np.unique(volume.instance[hangs])) & (volume.instance > 0)
    return _remove_blocks(volume, drop)


def without_near_walls(volume: BlockVolume, near_x: int, near_z: int) -> BlockVolume:
    """Return the volume with the walls on two sides cut down to a rim.

    Args:
        volume: The blocks.
        near_x: Near side along block x: +1 for its end, -1 for its start.
        near_z: Near side along block z: +1 for its end, -1 for its start.
    """
    semantic = volume.semantic
    floor = _room_columns_without_doors(volume)
    outside = _beyond_floor(floor, 0, near_x) | _beyond_floor(floor, 1, near_z)
    level = floor_level(semantic) + 1 + round(WALL_RIM_M * volume.blocks_per_metre)
    drop = np.zeros(semantic.shape, bool)
    drop[:, level:, :] = outside[:, None, :]
    far = _beyond_floor(floor, 0, -near_x) | _beyond_floor(floor, 1, -near_z)
    flush = ~far & _dilate(outside, max(1, round(WALL_MOUNT_DEPTH_M * volume.blocks_per_metre)))
    # What reaches into the room stands there: a floor lamp keeps its shade.
    inside = np.unique(volume.instance[np.broadcast_to(~flush[:, None, :], semantic.shape)])
    stands = np.isin(volume.instance, inside[inside > 0])
    hangs = np.isin(semantic, (*_WALLS, int(SemanticClass.OBJS))) & flush[:, None, :] & ~stands
    high = floor_level(semantic) + 1 + round(WALL_MOUNT_HEIGHT_M * volume.blocks_per_metre)
    # What reaches so high hangs or leans there as a whole, such as a curtain or a door.
    above = np.unique(volume.instance[:, high:, :][hangs[:, high:, :]])
    tall = np.isin(volume.instance[:, :high, :], above[above > 0])
    hangs[:, :high, :] &= np.isin(semantic[:, :high, :], _WALLS) | tall
    hangs[:, :level, :] &= volume.instance[:, :level, :] > 0
    return _remove_blocks(volume, drop | hangs)


def _room_columns_without_doors(volume: BlockVolume) -> np.ndarray:
    """Return a mask of the columns that are rooms, bool [X, Z], to which doors do not belong.

    A door is part of its wall, and so the step before it is no room.
    """
    doors = [n for n, state in enumerate(volume.palette) if "_door[" in state]
    blocks = np.isin(volume.states, doors)
    objects = np.unique(volume.instance[blocks])
    columns = np.any(blocks | np.isin(volume.instance, objects[objects > 0]), axis=1)
    semantic = np.where(np.asarray(columns)[:, None, :], np.uint8(0), volume.semantic)
    return room_columns(semantic, volume.blocks_per_metre)


def floor_level(semantic: np.ndarray) -> int:
    """Return the floor layer (y) with the most blocks, or 0 without a floor."""
    counts = (semantic == SemanticClass.FLOOR).sum(axis=(0, 2))
    return int(counts.argmax())


def floor_columns(semantic: np.ndarray) -> np.ndarray:
    """Return a mask of the columns with floor and without a wall at head height, bool [X, Z]."""
    return (semantic == SemanticClass.FLOOR).any(axis=1) & ~_wall_columns(semantic)


def _wall_columns(semantic: np.ndarray) -> np.ndarray:
    """Return bool [X, Z]: columns that are wall or window for most of a man's height."""
    return np.isin(semantic, _WALLS).mean(axis=1) > 0.4


def room_columns(semantic: np.ndarray, blocks_per_metre: float) -> np.ndarray:
    """Return a mask of the columns that are rooms, bool [X, Z].

    Rooms are floor, and objects below which no floor was observed. Isolated floor that a scan saw
    through a door or below a wall, sills and hedges are excluded. If nothing as large as a room
    remains, all floor columns are returned.
    """
    floor = floor_columns(semantic)
    named = (semantic >= SemanticClass.CHAIR) & (semantic != UNKNOWN)
    objects = named.any(axis=1) & ~_wall_columns(semantic)
    side = 2 * int(MIN_ROOM_WIDTH_M / 2 * blocks_per_metre) + 1
    wide = np.asarray(ndimage.binary_opening(floor | objects, np.ones((side, side))), bool)
    parts, count = label_components(wide, corners=False)
    floors = np.bincount(parts[floor], minlength=count + 1)
    rooms = wide & (floors[parts] >= MIN_ROOM_M2 * blocks_per_metre**2)
    return rooms if rooms.any() else floor


def _beyond_floor(floor: np.ndarray, axis: int, side: int) -> np.ndarray:
    """Return the columns, bool [X, Z], past the last floor of their row, towards ``side``."""
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


def _floor_on_both_sides(floor: np.ndarray, axis: int, reach: int) -> np.ndarray:
    """Return the columns, bool [X, Z], with floor within reach on either side along an axis."""
    sides = []
    for step in (-1, 1):
        near = np.zeros_like(floor)
        for distance in range(1, reach + 1):
            moved = np.roll(floor, step * distance, axis=axis)
            edge = [slice(None), slice(None)]
            edge[axis] = slice(0, distance) if step > 0 else slice(-distance, None)
            moved[tuple(edge)] = False
            near |= moved
        sides.append(near)
    return sides[0] & sides[1]


def _layers(volume: BlockVolume, low: int, high: int) -> BlockVolume:
    """Return the layers [low, high) of a volume, at their place."""
    x, y, z = volume.corner
    return replace(
        volume,
        states=volume.states[:, low:high],
        semantic=volume.semantic[:, low:high],
        instance=volume.instance[:, low:high],
        corner=(x, y + low, z),
        entities=entities_within(volume, low, high),
    )


def _concatenate(arrays: list[np.ndarray], axis: int, height: int, gap: int) -> np.ndarray:
    pieces: list[np.ndarray] = []
    for values in arrays:
        tall = np.pad(values, ((0, 0), (0, height - values.shape[1]), (0, 0)))
        if pieces:
            shape = list(tall.shape)
            shape[axis] = gap
            pieces.append(np.zeros(shape, values.dtype))
        pieces.append(tall)
    return np.concatenate(pieces, axis=axis)


def _dilate(mask: np.ndarray, steps: int) -> np.ndarray:
    grown = mask.copy()
    for _ in range(steps):
        grown[1:] |= mask[:-1]
        grown[:-1] |= mask[1:]
        grown[:, 1:] |= mask[:, :-1]
        grown[:, :-1] |= mask[:, 1:]
        mask = grown.copy()
    return grown


def _remove_blocks(volume: BlockVolume, drop: np.ndarray) -> BlockVolume:
    return replace(
        volume,
        states=np.where(drop, np.uint16(0), volume.states),
        semantic=np.where(drop, np.uint8(0), volume.semantic),
        instance=np.where(drop, np.uint16(0), volume.instance),
        entities=remaining_entities(volume, drop),
    )

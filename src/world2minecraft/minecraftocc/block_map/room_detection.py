"""Room detection in a volume of blocks: floors, ceilings, walls and the space inside.

The input is the scale and the set of blocks that can be part of the structure; the output is a zone
for each block. A floor is a wide flat surface below a roof with enough headroom for a person. Walls
are the columns from the floor to the ceiling. Labels and block names are not used.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from world2minecraft.geometry.connected_components import label_components

OUTSIDE, FLOOR, CEILING, WALL, INSIDE = range(5)
HEADROOM_M = 1.8  # Minimum height of a room; doors are 2 m high.
ROOF_M = 8.0  # Maximum height of a room; halls are 6 m high.
FLOOR_M2 = 1.0  # Minimum area of a floor, such as that of a toilet.
FURNITURE_M, FURNITURE_M2 = 1.3, 6.0  # Maximum height and area of a flat top of furniture.
PLATEAU_M2 = 0.75  # Minimum area of a flat ceiling part; the lintel of a door has 0.3.
# Minimum filled share of a wall's column, and of one with an open window below its top.
CLOSED_SHARE, HALF_CLOSED_SHARE = 0.95, 0.5
NO_BLOCK = np.int16(0x7FFF)


@dataclass(frozen=True, eq=False)
class Zones:
    """The zone of each block in a volume.

    Attributes:
        zone: ``OUTSIDE``, ``FLOOR``, ``CEILING``, ``WALL`` or ``INSIDE`` for each block, uint8 [X,
            Y, Z].
        ground: Layer of the floor below each block inside a room, int16 [X, Y, Z]; -1 elsewhere.
    """

    zone: np.ndarray
    ground: np.ndarray


def detect_zones(building: np.ndarray, blocks_per_metre: float) -> Zones:
    """Detect the zone of each block.

    Args:
        building: Whether each block can be part of a floor, wall or ceiling, bool [X, Y, Z]. This
            includes glass and closed doors.
        blocks_per_metre: Scale of the volume.
    """
    zone = np.zeros(building.shape, np.uint8)
    ground = np.full(building.shape, -1, np.int16)
    over = next_above(building)
    roofed = _is_roofed(building, over, blocks_per_metre)
    for level, patch in _floors(building, over, blocks_per_metre, roofed):
        _add_storey(zone, ground, building, over, level, patch, blocks_per_metre, roofed)
    return Zones(zone, ground)


def next_above(filled: np.ndarray) -> np.ndarray:
    """Return the layer of the next filled block above each block, or ``NO_BLOCK`` if none."""
    layers = np.arange(filled.shape[1], dtype=np.int16)[None, :, None]
    at = np.where(filled, layers, NO_BLOCK)[:, ::-1]
    upward = np.minimum.accumulate(at, axis=1)[:, ::-1]
    result = np.full(filled.shape, NO_BLOCK)
    result[:, :-1] = upward[:, 1:]
    return result


def _standable(building: np.ndarray, over: np.ndarray, scale: float, roofed: bool) -> np.ndarray:
    """Return the blocks on which a person can stand, indoors if the build has a roof."""
    head = max(2, int(np.ceil(HEADROOM_M * scale - 1e-6)))
    layers = np.arange(building.shape[1], dtype=np.int32)[None, :, None]
    room = over.astype(np.int32) - layers - 1
    stands = building & (room >= head)
    return stands & (room <= ROOF_M * scale) if roofed else stands & _enclosed(building, scale)


def _is_roofed(building: np.ndarray, over: np.ndarray, scale: float) -> bool:
    """Return whether the build has a roof, instead of being open at the top."""
    return int(_standable(building, over, scale, True).sum()) >= FLOOR_M2 * scale**2


def _enclosed(building: np.ndarray, scale: float) -> np.ndarray:
    """Return the blocks that are enclosed on all four sides one metre above them."""
    up = max(1, round(scale))
    result = np.ones(building.shape, bool)
    for axis in (0, 2):
        for flip in (slice(None), slice(None, None, -1)):
            turned = np.swapaxes(building, 0, axis)[flip]
            seen = np.swapaxes(np.logical_or.accumulate(turned, axis=0)[flip], 0, axis)
            result[:, :-up] &= seen[:, up:]
    result[:, -up:] = False
    return result


def _floors(building: np.ndarray, over: np.ndarray, scale: float, roofed: bool):
    """Yield the floor layers from bottom to top, with the columns in which a person can stand."""
    stands = _standable(building, over, scale, roofed)
    min_size = max(2, FLOOR_M2 * scale**2)
    below: list[tuple[int, np.ndarray]] = []
    for level in range(building.shape[1]):
        parts, count = label_components(stands[:, level], corners=False)
        sizes = np.bincount(parts.ravel(), minlength=count + 1)
        patch = np.zeros(parts.shape, bool)
        for number in np.flatnonzero(sizes >= min_size).tolist():
            if number and not _is_furniture(parts == number, level, below, scale):
                patch |= parts == number
        if patch.any():
            below.append((level, patch))
            yield level, patch


def _is_furniture(
    part: np.ndarray, level: int, below: list[tuple[int, np.ndarray]], scale: float
) -> bool:
    """Return whether a flat surface belongs to furniture or a landing beside a larger floor."""
    if part.sum() > FURNITURE_M2 * scale**2:
        return False
    rim = ndimage.binary_dilation(part, iterations=max(1, round(scale / 2)))
    return any(
        level - floor <= FURNITURE_M * scale and (floor_patch & rim).any()
        for floor, floor_patch in below
    )


def _add_storey(
    zone: np.ndarray,
    ground: np.ndarray,
    building: np.ndarray,
    over: np.ndarray,
    level: int,
    patch: np.ndarray,
    scale: float,
    roofed: bool,
) -> None:
    """Set the zones of the rooms above a floor."""
    tops = _ceilings(patch, over[:, level], level, scale, building.shape[1])
    walls, hung = _walls(building, level, tops)
    ground_layer = building[:, level] & ~walls
    region = _region(patch, ground_layer, building, level, scale) if roofed else patch
    walls &= ndimage.binary_dilation(region, np.ones((3, 3)), iterations=max(2, round(scale)))
    layers = np.arange(building.shape[1])[None, :, None]
    between = (layers > level) & (layers < tops[:, None, :])
    lintel = between & (hung & region)[:, None, :] & (layers >= _lowest_hanging(building, tops))
    within = between & region[:, None, :] & ~lintel
    fresh = zone == OUTSIDE
    zone[fresh & (lintel | between & walls[:, None, :])] = WALL
    zone[fresh & within] = INSIDE
    ground[fresh & within] = level
    zone[(layers == tops[:, None, :]) & (region & ~hung)[:, None, :] & fresh] = CEILING
    zone[:, level][region] = FLOOR


def _ceilings(
    patch: np.ndarray, over: np.ndarray, level: int, scale: float, max_layer: int
) -> np.ndarray:
    """Return the ceiling layer of each column, taken from the nearest flat ceiling part, int."""
    plateaus = np.zeros(patch.shape, bool)
    min_size = max(3, PLATEAU_M2 * scale**2)
    for layer in np.unique(over[patch]).tolist():
        parts, count = label_components(patch & (over == layer))
        sizes = np.bincount(parts.ravel(), minlength=count + 1)
        plateaus |= (sizes >= min_size)[parts] & (parts > 0)
    if not plateaus.any():
        plateaus = patch
    nearest = ndimage.distance_transform_edt(~plateaus, return_distances=False, return_indices=True)
    x, z = np.asarray(nearest)
    tops = over[x, z].astype(np.int64)
    return np.where(tops < NO_BLOCK, tops, min(max_layer, level + 1 + round(2 * scale)))


def _walls(building: np.ndarray, level: int, tops: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the columns of walls, and those of lintels between two walls, bool [X, Z] each."""
    layers = np.arange(building.shape[1])[None, :, None]
    between = (layers > level) & (layers < tops[:, None, :])
    share = (building & between).sum(1) / np.maximum(between.sum(1), 1)
    x, z = np.indices(tops.shape)
    at_top = building[x, np.clip(tops - 1, 0, building.shape[1] - 1), z] & (tops - 1 > level)
    walls = (share >= CLOSED_SHARE) | (at_top & (share >= HALF_CLOSED_SHARE))
    hung = at_top & ~walls
    return walls, hung & (_between(hung, walls, 0) | _between(hung, walls, 1))


def _between(hung: np.ndarray, walls: np.ndarray, axis: int) -> np.ndarray:
    """Return whether each run of hanging columns along an axis ends at walls on both sides."""
    result = np.ones(hung.shape, bool)
    for flip in (slice(None), slice(None, None, -1)):
        h, w = (np.swapaxes(one, 0, axis)[flip] for one in (hung, walls))
        index = np.arange(h.shape[0])[:, None]
        last = np.maximum.accumulate(np.where(h, -1, index), axis=0)
        ended = np.take_along_axis(w, np.maximum(last, 0), 0) & (last >= 0)
        result &= np.swapaxes(ended[flip], 0, axis)
    return result


def _lowest_hanging(building: np.ndarray, tops: np.ndarray) -> np.ndarray:
    """Return the lowest layer that hangs from the ceiling without gaps, int [X, 1, Z]."""
    layers = np.arange(building.shape[1])[None, :, None]
    gaps = np.where(~building & (layers < tops[:, None, :]), layers, -1)
    return gaps.max(1, keepdims=True) + 1


def _region(
    patch: np.ndarray, mask: np.ndarray, building: np.ndarray, level: int, scale: float
) -> np.ndarray:
    """Return the columns of rooms: the walkable ones, and those below furniture."""
    head = level + max(2, int(np.ceil(HEADROOM_M * scale - 1e-6)))
    roof = building[:, head : level + 2 + round(ROOF_M * scale)].any(1)
    return np.asarray(ndimage.binary_propagation(patch & mask & roof, mask=mask & roof)) | patch

"""Relabel noise: specks in the surface of an object, and lumps on walls.

A speck is a few cells of another class within the surface of one object. A lump is an uncertain
object, or one that looks like the wall, close to a wall.
"""

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.reconstruction.instances.object_voxels import colour_distance

MAX_SPECK_CELLS = 6  # At 0.08 m less than a sheet of paper, and less than any object has.
MIN_SURROUNDING_SHARE = 0.8  # Of the occupied cells around a speck, those of the class around it.
MIN_ENCLOSING_AXES = 2  # A surface goes on along two axes; past what stands on it, along none.
NEIGHBOURHOOD = np.ones((3, 3, 3), np.bool_)

# Lumps on walls. Within 25 cm of a wall, 60 % of the objects of confidence below 0.3 in 81 NYUv2
# frames were wall, window, floor or ceiling and 19 % were right (n 283), and so were 62 % and 17 %
# of those of higher confidence that have the wall's colour (n 39). Of 13 generated rooms without
# label images these are 19 objects, all wrong, and 4 objects, 1 of them right.
MAX_WALL_DISTANCE_M = 0.25
NEAR_SHARE = 0.9  # Minimum share of a lump's cells; the rest is noise.
UNCERTAIN = 0.3
SAME_COLOUR = 0.03  # Oklab distance of medians, with reduced weight of lightness.
COLOUR_REACH_M = 0.25  # Wall cells so close to a lump are compared with it.
MIN_WALL_M2 = 0.5  # A smaller part of a wall may itself be a lump.


def relabel_specks(labels: np.ndarray) -> np.ndarray:
    """Return labels, uint8 [X, Y, Z], in which specks take the class of the surrounding object.

    A speck is a connected part of an object class with at most ``MAX_SPECK_CELLS`` cells. It is
    relabelled if nearly all touching cells belong to another object class that is on both sides of
    each of its cells along the same two axes. Objects that protrude, such as items on a table, are
    kept.
    """
    result = labels.copy()
    for class_id in OBJECT_CLASSES:
        mask = labels == class_id
        if not mask.any():
            continue
        parts, _ = label_components(mask)
        sizes = np.bincount(parts[mask])
        boxes = ndimage.find_objects(parts)
        for number in np.flatnonzero((sizes > 0) & (sizes <= MAX_SPECK_CELLS)):
            box = tuple(slice(max(side.start - 1, 0), side.stop + 1) for side in boxes[number - 1])
            own = parts[box] == number
            surrounding = _surrounding_class(own, labels[box])
            if surrounding:
                result[box][own] = surrounding
    return result


def _surrounding_class(own: np.ndarray, labels: np.ndarray) -> int:
    """Return the class that surrounds a speck, bool [A, B, C], or 0."""
    adjacent = labels[ndimage.binary_dilation(own, NEIGHBOURHOOD) & ~own]
    occupied = adjacent[(adjacent > 0) & (adjacent <= OBJECT_CLASSES[-1])]
    counts = np.bincount(occupied, minlength=1)
    surrounding = int(counts.argmax())
    if surrounding not in OBJECT_CLASSES:
        return 0
    if counts[surrounding] < MIN_SURROUNDING_SHARE * len(occupied):
        return 0
    is_enclosed = _count_enclosing_axes(own, labels == surrounding) >= MIN_ENCLOSING_AXES
    return surrounding if is_enclosed else 0


def _count_enclosing_axes(own: np.ndarray, surrounding: np.ndarray) -> int:
    """Count the axes along which the surrounding class is on both sides of each cell's row."""
    own, surrounding = np.pad(own, 1), np.pad(surrounding, 1)
    return sum(
        _all_rows_end(own, surrounding, axis, 1) and _all_rows_end(own, surrounding, axis, -1)
        for axis in range(3)
    )


def _all_rows_end(own: np.ndarray, surrounding: np.ndarray, axis: int, step: int) -> bool:
    """Return whether all rows of the speck end at the surrounding class in one direction."""
    return bool(surrounding[np.roll(own, step, axis) & ~own].all())


def find_wall_lumps(owners: np.ndarray, grid: OccupancyGrid) -> np.ndarray:
    """Return the mask of the cells, bool [X, Y, Z], of objects that are lumps on walls.

    Args:
        owners: Number of the object of each cell, int32 [X, Y, Z], 0 for none.
        grid: Grid with labels, colours and confidences.
    """
    result = np.zeros(grid.shape, np.bool_)
    walls = _large_walls(grid)
    if not walls.any() or not owners.any():
        return result
    distances = np.asarray(ndimage.distance_transform_edt(~walls))
    reach = MAX_WALL_DISTANCE_M / grid.voxel_m + 1e-6
    for number, box in enumerate(ndimage.find_objects(owners), start=1):
        if box is None:
            continue
        own = owners[box] == number
        if (distances[box][own] <= reach).mean() < NEAR_SHARE:
            continue
        confidence = float(grid.confidence[box][own].astype(np.float64).mean())
        if confidence < UNCERTAIN or _looks_like_wall(own, box, grid, walls):
            result[box] |= own
    return result


def _large_walls(grid: OccupancyGrid) -> np.ndarray:
    walls = np.isin(grid.labels, (SemanticClass.WALL, SemanticClass.WINDOW))
    parts, _ = label_components(walls)
    areas_m2 = np.bincount(parts.reshape(-1)) * grid.voxel_m**2
    areas_m2[0] = 0
    return walls & (areas_m2[parts] >= MIN_WALL_M2)


def _looks_like_wall(
    own: np.ndarray, box: tuple[slice, ...], grid: OccupancyGrid, walls: np.ndarray
) -> bool:
    """Return whether an object, bool [A, B, C] in a box, has the colour of the wall beside it."""
    margin = round((COLOUR_REACH_M + MAX_WALL_DISTANCE_M) / grid.voxel_m)
    wide = tuple(slice(max(side.start - margin, 0), side.stop + margin) for side in box)
    return colour_distance(grid.colour[box][own], grid.colour[wide][walls[wide]]) < SAME_COLOUR

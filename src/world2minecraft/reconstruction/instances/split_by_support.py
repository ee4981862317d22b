"""Split small touching objects by their support: the floor, a table, a cupboard or a wall.

A lamp on a sideboard and a plant on the floor next to it are one cluster of ``objs``, but have
different supports.
"""

from typing import NamedTuple

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.reconstruction.instances.density_clustering import assign_voxels
from world2minecraft.reconstruction.instances.object_voxels import floor_layer_below, split_owners
from world2minecraft.reconstruction.instances.parameters import InstanceParameters

# What hangs on a wall: the columns of a curtain or a picture among those of small objects.
WALL_CELLS = 2  # A curtain hangs this near its wall.
MIN_SHEET_CELLS = 12  # At 0.08 m, a picture of 0.3 m side.
MIN_HANGING_TOP_M = 1.8  # Objects this high beside a wall count as hanging.
MIN_CLEARANCE_M = 0.24  # So do objects with this much free air below.
AROUND_CELLS = 4  # What stands this near is compared:
MIN_COLOUR_DIFFERENCE = 0.08  # in Oklab; one object in light and shade differs by less;
MIN_RISE_M = 0.16  # and a sheet rises above it,
MIN_CLEAR_RISE_M = 0.5  # or so far that it may have its colour.
PLAN_BOX = np.ones((3, 3), np.bool_)
MIN_COLUMNS = 3  # What stands with fewer cells leans over, or is noise: a vase has four.
MIN_CELLS = 8  # Of a part, as of any object.
MIN_SHADE_CELLS = 20  # Cells of a shade that floats.
UNDER_CELLS = 2  # Maximum gap between an object and what it stands on.


class LocalScene(NamedTuple):
    """The colours and the floor layer of a box of cells."""

    colour: np.ndarray  # float [X, Y, Z, 3], in Oklab
    floor: int  # the layer on the floor
    voxel_m: float


def hanging_plans(
    own: np.ndarray, labels: np.ndarray, stood: np.ndarray, scene: LocalScene
) -> list[np.ndarray]:
    """Return the plans, bool [X, Y], of the objects that hang on a wall.

    Args:
        own: Mask of the cells of one cluster of small objects, bool [X, Y, Z].
        labels: Class of each cell, uint8 [X, Y, Z].
        stood: Mask of the columns with a support, bool [X, Y].
        scene: Colours and floor layer of the box.
    """
    near = _columns_at_wall(own, labels, scene.floor, scene.voxel_m)
    sheets, count = label_components(near)
    plans = [sheets == sheet for sheet in range(1, count + 1)]
    return [plan for plan in plans if _is_sheet(plan, stood & ~near, own, scene)]


def join_plans_in_air(
    plans: list[np.ndarray], own: np.ndarray, stood: np.ndarray
) -> list[np.ndarray]:
    """Join plans if the cells between them have no support, as in a cooker hood."""
    pieces, count = label_components(own & ~stood[:, :, None])
    joined: dict[int, np.ndarray] = {}
    for plan in plans:
        inside = np.bincount(pieces[own & plan[:, :, None]], minlength=count + 1)
        inside[0] = 0
        piece = int(inside.argmax())
        joined[piece] = joined[piece] | plan if piece in joined else plan
    return list(joined.values())


def _columns_at_wall(own: np.ndarray, labels: np.ndarray, floor: int, voxel_m: float) -> np.ndarray:
    """Return the columns of ``own`` that hang next to a wall, bool [X, Y]."""
    wall = ((labels == SemanticClass.WALL) | (labels == SemanticClass.WINDOW)).any(axis=2)
    if not wall.any():
        return wall
    near = np.asarray(ndimage.distance_transform_cdt(~wall)) <= WALL_CELLS
    near &= own.any(axis=2)
    top = own.shape[2] - own[:, :, ::-1].argmax(axis=2)
    bottom = own.argmax(axis=2)
    layer = np.arange(own.shape[2])
    under = (layer < bottom[..., None]) & (
        layer >= bottom[..., None] - int(MIN_CLEARANCE_M / voxel_m)
    )
    clear = (bottom > 0) & ~(under & (labels != 0)).any(axis=2)
    return near & (((top - floor) >= MIN_HANGING_TOP_M / voxel_m) | clear)


def _is_sheet(plan: np.ndarray, stood: np.ndarray, own: np.ndarray, scene: LocalScene) -> bool:
    """Return whether the cells that hang in some columns are separate from objects beside them.

    Leaves of a plant that touch a wall are not a separate object.
    """
    sheet = own & plan[:, :, None]
    around = ndimage.binary_dilation(plan, PLAN_BOX, iterations=AROUND_CELLS)
    adjacent = own & (around & stood)[:, :, None]
    if np.count_nonzero(sheet) < MIN_SHEET_CELLS:
        return False
    if not adjacent.any():
        return True
    tops = [np.flatnonzero(cells.any(axis=(0, 1)))[-1] for cells in (sheet, adjacent)]
    above_m = float(tops[0] - tops[1]) * scene.voxel_m
    difference = np.median(scene.colour[sheet], axis=0) - np.median(scene.colour[adjacent], axis=0)
    unlike = float(np.linalg.norm(difference)) >= MIN_COLOUR_DIFFERENCE
    return above_m >= MIN_CLEAR_RISE_M or (unlike and above_m >= MIN_RISE_M)


def split_by_support(
    owners: np.ndarray, grid: OccupancyGrid, _parameters: InstanceParameters
) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], with separate numbers for objects with different supports."""

    def parts_of(cells: np.ndarray) -> np.ndarray | None:
        return None if len(cells) < 2 * MIN_CELLS else _part_of_cells(cells, owners, grid)

    return split_owners(owners, grid.labels, SemanticClass.OBJS, parts_of)


def _part_of_cells(cells: np.ndarray, owners: np.ndarray, grid: OccupancyGrid) -> np.ndarray:
    """Return the part of each cell, int32 [N] from 1; all 1 if they are connected."""
    floor = floor_layer_below(cells, grid)
    low = np.maximum(cells.min(axis=0) - WALL_CELLS, 0)
    low[2] = max(int(cells[:, 2].min()) - UNDER_CELLS, 0)
    high = cells.max(axis=0) + 1 + WALL_CELLS
    box = tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
    labels, own = grid.labels[box], np.zeros(grid.labels[box].shape, np.bool_)
    own[tuple((cells - low).T)] = True
    scene = LocalScene(srgb_to_oklab(grid.colour[box]), floor - int(low[2]), grid.voxel_m)
    seeds = _seed_parts(own, labels, owners[box], scene)
    count = int(seeds.max(initial=0))
    if count < 2:
        return np.ones(len(cells), np.int32)
    at = np.argwhere(seeds).astype(np.int32)
    grown = _split_disconnected(own, assign_voxels(labels, own, at, seeds[tuple(at.T)] - 1))
    return _merge_small_parts(grown[tuple((cells - low).T)])


def _seed_parts(
    own: np.ndarray, labels: np.ndarray, owners: np.ndarray, scene: LocalScene
) -> np.ndarray:
    """Return the number of the support in the columns above it, int32 [X, Y, Z]."""
    support = _supports(own, labels, owners, scene.floor)
    sheets = hanging_plans(own, labels, support >= 0, scene)
    hung = np.logical_or.reduce([np.zeros(support.shape, np.bool_), *sheets])
    support = np.where(hung, -1, support)
    stood = support >= 0
    groups = [own & plan[:, :, None] for plan in join_plans_in_air(sheets, own, stood)]
    for number in np.unique(support[stood]):
        plan = support == number
        if plan.sum() >= MIN_COLUMNS:
            groups.append(own & plan[:, :, None])
    if sheets:
        groups += _floating_shades(
            own & ~(hung | stood)[:, :, None], stood, own & hung[:, :, None], scene
        )
    seeds = np.zeros(own.shape, np.int32)
    for number, cells in enumerate(groups, start=1):
        seeds[cells] = number
    return seeds


def _floating_shades(
    rest: np.ndarray, stood: np.ndarray, hung: np.ndarray, scene: LocalScene
) -> list[np.ndarray]:
    """Return the masks of floating parts in front of a curtain: lamps with an unseen post."""
    pieces, count = label_components(rest)
    adjacent = ndimage.binary_dilation(stood, np.ones((3, 3), np.bool_))[:, :, None]
    curtain = np.median(scene.colour[hung], axis=0)
    found = [pieces == piece for piece in range(1, count + 1)]
    return [
        piece
        for piece in found
        if np.count_nonzero(piece) >= MIN_SHADE_CELLS
        and not (piece & adjacent).any()
        and np.linalg.norm(np.median(scene.colour[piece], axis=0) - curtain)
        >= MIN_COLOUR_DIFFERENCE
    ]


def _supports(own: np.ndarray, labels: np.ndarray, owners: np.ndarray, floor: int) -> np.ndarray:
    """Return the support of each column, int64 [X, Y]: 0 is the floor, -1 none, else an owner.

    A flat object on a table can fill the cells of its top; then the top beside it counts.
    """
    object_ = (labels >= OBJECT_CLASSES[0]) & (labels <= OBJECT_CLASSES[-1])
    holder = np.where(object_ & (labels != SemanticClass.OBJS) & (owners > 0), owners, -1)
    holder = np.where(labels == SemanticClass.FLOOR, 0, holder).astype(np.int64)
    support = np.full(own.shape[:2], -1, np.int64)
    for x, y in np.argwhere(own.any(axis=2)):
        first = int(own[x, y].argmax())
        if first - floor < UNDER_CELLS:
            support[x, y] = 0
            continue
        near = (slice(max(x - 1, 0), x + 2), slice(max(y - 1, 0), y + 2))
        below = holder[x, y, max(first - UNDER_CELLS, 0) : first]
        adjacent = holder[near][:, :, max(first - 1, 0) : first + 1]
        for held in (below[::-1], np.sort(adjacent.reshape(-1))[::-1]):
            known = held[held >= 0]
            if len(known):
                support[x, y] = known[0]
                break
    return support


def _split_disconnected(own: np.ndarray, parts: np.ndarray) -> np.ndarray:
    """Return parts, int32 [X, Y, Z], split into connected parts."""
    result = np.zeros_like(parts)
    for number in range(1, int(parts.max(initial=0)) + 1):
        pieces, _ = label_components(own & (parts == number))
        result = np.where(pieces > 0, pieces + result.max(), result)
    return result.astype(np.int32)


def _merge_small_parts(parts: np.ndarray) -> np.ndarray:
    """Renumber the parts from 1; cells of small parts are added to the largest."""
    counts = np.bincount(parts)
    keep = counts >= MIN_CELLS
    keep[0] = False
    if not keep.any():
        return np.ones(len(parts), np.int32)
    largest = int(np.where(keep, counts, 0).argmax())
    merged = np.where(keep[parts], parts, largest)
    return (np.unique(merged, return_inverse=True)[1] + 1).astype(np.int32)

"""Stage 5, the core of Algorithm 1: find the objects of a room in its semantic occupancy.

``find_objects`` follows the paper: density D, candidates C, clusters C' and the cells O_k of each
object. The clusters make a whole kitchen one object, but two of a table's top and foot, so
``PASSES`` merge and split the objects afterwards.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.coordinates import cell_centers_m
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OBSERVED, UNSEEN, ObjectInstance, OccupancyGrid
from world2minecraft.furniture.front_estimation import (
    Surroundings,
    estimate_facing,
    read_surroundings,
)
from world2minecraft.reconstruction.instances.cabinet_runs import split_cabinet_runs
from world2minecraft.reconstruction.instances.denoise import find_wall_lumps, relabel_specks
from world2minecraft.reconstruction.instances.density_clustering import (
    assign_voxels,
    candidate_cells,
    cluster_candidates,
    density_map,
    object_cells,
)
from world2minecraft.reconstruction.instances.merge_named import merge_same_names
from world2minecraft.reconstruction.instances.merge_pieces import (
    merge_flush_pieces,
    merge_lamp_parts,
    merge_small_pieces,
    merge_stacked,
)
from world2minecraft.reconstruction.instances.object_extent import (
    min_area_rectangle,
    vertical_extent,
)
from world2minecraft.reconstruction.instances.parameters import InstanceParameters
from world2minecraft.reconstruction.instances.split_by_colour import split_by_colour
from world2minecraft.reconstruction.instances.split_by_support import split_by_support
from world2minecraft.reconstruction.instances.split_by_votes import split_by_votes
from world2minecraft.reconstruction.instances.split_chairs import (
    merge_chair_backs,
    split_touching_chairs,
)

MAX_OBJECTS = 65535

# A pass takes the owner of each cell, int32 [X, Y, Z] with 0 for none, and returns a new array.
Pass = Callable[[np.ndarray, OccupancyGrid, InstanceParameters], np.ndarray]
PASSES: tuple[Pass, ...] = (
    merge_stacked,
    merge_small_pieces,
    split_touching_chairs,
    merge_chair_backs,
    split_cabinet_runs,
    split_by_support,
    split_by_colour,
    merge_lamp_parts,
)


@dataclass(frozen=True, eq=False)
class CenterMap:
    """The paper's D and C, and the cluster of each candidate, as stored in ``centers.npz``."""

    density: np.ndarray  # float32 [X, Y, Z], 0 to 1
    candidates: np.ndarray  # int32 [M, 3]
    cluster: np.ndarray  # int32 [M], -1 for none


@dataclass(frozen=True, eq=False)
class FoundObjects:
    """The objects found in a room.

    Attributes:
        grid: Grid with the instance id of each cell and the new classes of merged pieces.
        instances: The objects.
        centers: Density, candidates and clusters.
        leftover: Number of object cells that belong to no object; their instance is 0.
    """

    grid: OccupancyGrid
    instances: tuple[ObjectInstance, ...]
    centers: CenterMap
    leftover: int


def find_objects(
    grid: OccupancyGrid,
    parameters: InstanceParameters | None = None,
    *,
    stated: np.ndarray | None = None,
    votes: tuple[np.ndarray, np.ndarray] | None = None,
) -> FoundObjects:
    """Find the objects of a room.

    Objects are sorted by class, then by the centre of their cells (x, y, z), and numbered from 1.
    Lumps on walls become part of the wall. Pieces that touch an object of the same colour become
    part of that object, and pieces of one recognised thing become one object. Other labels are not
    changed, even those of specks that are assigned to another object.

    Args:
        grid: Grid with labels and colours.
        parameters: Parameters of the detection.
        stated: Cells whose class label images state, bool [X, Y, Z]. Objects that consist
            mostly of them are not changed.
        votes: Cells int [N, 3], and their votes for the NYU40 classes from 1, float [N, 40].

    Raises:
        UsageError: If there are more objects than ids, so that ``min_cells`` must be increased.
    """
    chosen = parameters or InstanceParameters()
    given = grid
    if not chosen.paper_compat:
        grid = replace(grid, labels=relabel_specks(grid.labels))
    binary = object_cells(grid.labels)
    density = density_map(binary, chosen.density_kernel)
    candidates = candidate_cells(binary, density, chosen.density_threshold)
    classes = grid.labels[tuple(candidates.T)]
    cluster = cluster_candidates(candidates, classes, chosen.cluster_radius, chosen.min_samples)
    owners = assign_voxels(grid.labels, binary, candidates, cluster)
    for refine in () if chosen.paper_compat else PASSES:
        owners = refine(owners, grid, chosen)
    if not chosen.paper_compat:
        fixed = np.zeros(0, np.int64) if stated is None else _mostly(owners, stated)
        lumps = find_wall_lumps(owners, grid) & ~np.isin(owners, fixed)
        owners = np.where(lumps, 0, owners)
        binary &= ~lumps
        before = owners
        if votes is not None:
            owners = split_by_votes(owners, grid, *votes)
            owners, labels = merge_same_names(owners, grid, _votes_of(owners, *votes))
            grid = replace(grid, labels=labels)
        merged, labels = merge_flush_pieces(owners, grid, fixed)
        changed = merged != before
        owners = merged
        labels[lumps] = SemanticClass.WALL
        given = replace(given, labels=np.where(changed | lumps, labels, given.labels))
        grid = replace(grid, labels=labels)
    instances = _instances(grid, owners, reach=not chosen.paper_compat)
    marked = np.zeros(grid.shape, np.uint16)
    for instance in instances:
        marked[tuple(instance.cells.T)] = instance.id
    leftover = int(np.count_nonzero(binary & (marked == 0)))
    centers = CenterMap(density, candidates, cluster)
    return FoundObjects(replace(given, instance=marked), instances, centers, leftover)


def _votes_of(owners: np.ndarray, cells: np.ndarray, votes: np.ndarray) -> np.ndarray:
    """Return the votes for each object, float32 [count + 1, 40]; those for no object are 0."""
    result = np.zeros((int(owners.max(initial=0)) + 1, votes.shape[1]), np.float32)
    np.add.at(result, owners[tuple(cells.T)], votes)
    result[0] = 0
    return result


def _mostly(owners: np.ndarray, mask: np.ndarray) -> np.ndarray:
    """Return the numbers of the objects of which most cells are in a mask, int [N]."""
    sizes = np.bincount(owners.reshape(-1))
    inside = np.bincount(owners[mask], minlength=len(sizes))
    return np.flatnonzero(2 * inside > sizes)


def _instances(
    grid: OccupancyGrid, owners: np.ndarray, *, reach: bool
) -> tuple[ObjectInstance, ...]:
    cells = np.argwhere(owners).astype(np.int32)
    numbers = owners[tuple(cells.T)]
    order = np.argsort(numbers, kind="stable")
    starts = np.unique(numbers[order], return_index=True)[1][1:]
    groups = np.split(cells[order], starts) if len(cells) else []
    if len(groups) > MAX_OBJECTS:
        raise UsageError(
            f"found {len(groups):,} objects, the limit is {MAX_OBJECTS:,}; ignore small objects "
            "with a larger find.min_cells, such as --set find.min_cells=20"
        )
    around = read_surroundings(grid.labels)
    return tuple(
        _instance(number, grid, group, around, reach)
        for number, group in enumerate(sorted(groups, key=lambda g: _rank(grid, g)), start=1)
    )


def measure_object(
    grid: OccupancyGrid, number: int, class_id: int, cells: np.ndarray
) -> ObjectInstance:
    """Measure the box and the front of the object that consists of cells int32 [N, 3].

    Args:
        grid: Grid around the object; the labels of the object's own cells may differ.
        number: Id of the object.
        class_id: Class of the object, 5 to 11.
        cells: At least one cell.
    """
    labels = grid.labels.copy()
    labels[tuple(cells.T)] = class_id
    source = np.where(labels == UNKNOWN, UNSEEN, OBSERVED).astype(np.uint8)
    grid = replace(grid, labels=labels, source=source)
    return _instance(number, grid, cells, read_surroundings(labels), True)


def _rank(grid: OccupancyGrid, cells: np.ndarray) -> tuple[int, ...]:
    first = tuple(int(value) for value in cells[0])
    middle = cells.min(axis=0) + cells.max(axis=0)
    return (int(grid.labels[first]), *(int(value) for value in middle), *first)


def _box_m(
    grid: OccupancyGrid, cells: np.ndarray, class_id: int, reach: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Return the low corner and the size, both float64 [3], of an object's box in metres."""
    first, last = cells.min(axis=0), cells.max(axis=0) + 1
    if reach:
        first[2], last[2] = vertical_extent(cells, grid, class_id)
    low = cell_centers_m(first, grid.origin_m, grid.voxel_m) - grid.voxel_m / 2
    return low, (last - first) * grid.voxel_m


def _instance(
    number: int,
    grid: OccupancyGrid,
    cells: np.ndarray,
    around: Surroundings,
    reach: bool,
) -> ObjectInstance:
    class_id = int(grid.labels[tuple(cells[0])])
    front = estimate_facing(cells, class_id, around)
    low, size = _box_m(grid, cells, class_id, reach)
    center = low + size / 2
    rotated = min_area_rectangle(cells, class_id, grid.voxel_m) if reach else None
    if rotated is not None:
        center[:2] = grid.origin_m[:2] + rotated.middle * grid.voxel_m
        size[:2] = rotated.sides * grid.voxel_m
    own_axes = size[[1, 0, 2]] if front.quarter_turns % 2 else size
    yaw = 90.0 * front.quarter_turns + (rotated.angle_deg if rotated else 0.0)
    votes = float(grid.confidence[tuple(cells.T)].astype(np.float64).mean())
    return ObjectInstance(
        id=number,
        class_id=class_id,
        center_m=np.round(center, 9),
        size_m=np.round(own_axes, 9),
        yaw_deg=yaw % 360.0,
        cells=cells,
        confidence=round(min(votes, 1.0), 6),
    )

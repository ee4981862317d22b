"""Passes that merge parts of the same object.

These are stacked parts of one class, small loose pieces next to an object of their class, the post,
cord and foot of a lamp with its shade, and pieces of any class that lie flat against an object of
their colour or are surrounded by others.
"""

import numpy as np
from scipy import ndimage
from scipy.spatial import KDTree

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.connected_components import label_components, touching_pairs
from world2minecraft.reconstruction.instances.density_clustering import object_cells
from world2minecraft.reconstruction.instances.object_voxels import (
    STANDING,
    cells_by_owner,
    colour_distance,
    floor_layer_below,
)
from world2minecraft.reconstruction.instances.parameters import InstanceParameters

# Bits of a lamp: its foot on the floor, a piece of its cord, join the shade over or under them.
MAX_POST_CELLS = 2  # A post or a cord is at most so wide,
MAX_FOOT_CELLS = 1  # a foot so high.
MAX_GAP_M = 1.4  # Between the foot of a lamp and its shade.

# Parts of one object that stand on one another: a table's top on its post, a bed on a bed.
MIN_OVERLAP = 0.5  # The share of the smaller part's plan that must lie over or under the other.

# Pieces of the colour of what they lie against. Of 17 such pieces in 81 NYUv2 frames, 16 were of
# the same true class as their host; 16 of the 126 objects of a flat's cloud are such pieces. In
# ten scans of generated rooms there are two, none of which is an object.
MAX_PIECE_CELLS = 120  # A cushion.
MIN_HOST_FACTOR = 2  # The host has so many times the cells of the piece.
MIN_CONTACT = 0.4  # Share of the piece's cells next to the host.
# Share of the cells around a piece of class objs that belong to other objects: a gap between
# things, whatever its colour. At 0.4 it merges 24 of 110 objects of a flat's sparse cloud, one of
# the 109 of six other real captures and none of the 277 of 16 runs of generated rooms; at 0.3, 7 of
# the latter.
MIN_COVERED = 0.4
SAME_COLOUR = 0.03  # Oklab distance of medians, with reduced weight of lightness.
NEIGHBOURHOOD = np.ones((3, 3, 3), np.bool_)
STANDING_FACTOR = 4  # Times ``min_cells``: 32 cells are the star of a chair's foot.


def merge_lamp_parts(
    owners: np.ndarray, grid: OccupancyGrid, _parameters: InstanceParameters
) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], in which posts, cords and feet belong to their lamps.

    Parts that are completely inside the floor and belong to no object are removed.
    """
    result = owners.copy()
    pieces = dict(cells_by_owner(owners, grid.labels, SemanticClass.OBJS))
    fragments = {number: cells for number, cells in pieces.items() if _is_fragment(cells, grid)}
    whole = {number: cells for number, cells in pieces.items() if number not in fragments}
    for cells in fragments.values():
        gaps = {one: _vertical_gap(cells, other, grid) for one, other in whole.items()}
        near = {one: gap for one, gap in gaps.items() if gap is not None}
        if near:
            result[tuple(cells.T)] = min(near, key=lambda one: (near[one], one))
        elif int(cells[:, 2].max()) < floor_layer_below(cells, grid):
            result[tuple(cells.T)] = 0
    return result


def _is_fragment(cells: np.ndarray, grid: OccupancyGrid) -> bool:
    wide, deep, tall = np.ptp(cells, axis=0) + 1
    if max(wide, deep) <= MAX_POST_CELLS:
        return True
    low = int(cells[:, 2].min()) - floor_layer_below(cells, grid)
    return bool(tall <= MAX_FOOT_CELLS and low <= 0)


def _vertical_gap(fragment: np.ndarray, whole: np.ndarray, grid: OccupancyGrid) -> int | None:
    """Return the layers between a fragment and an object above or below it, or None."""
    middle = fragment[:, :2].mean(axis=0)
    inside = (middle >= whole[:, :2].min(axis=0) - 1) & (middle <= whole[:, :2].max(axis=0) + 1)
    if not inside.all():
        return None
    first = min(int(fragment[:, 2].max()), int(whole[:, 2].max())) + 1
    last = max(int(fragment[:, 2].min()), int(whole[:, 2].min()))
    if last - first > MAX_GAP_M / grid.voxel_m:
        return None
    x, y = (int(value) for value in np.round(middle))
    between = grid.labels[x, y, first:last]
    blocked = (between > 0) & (between != UNKNOWN) & (between != SemanticClass.OBJS)
    return None if blocked.any() else max(last - first, 0)


def merge_stacked(
    owners: np.ndarray, grid: OccupancyGrid, _parameters: InstanceParameters
) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], with stacked parts of one class merged.

    A thin post is too sparse for candidates, so clustering separates a top from its foot. Two
    touching parts of the same class are merged if at least half of the smaller part's plan overlaps
    the other.
    """
    pairs = touching_pairs(owners, grid.labels)
    parent = list(range(int(owners.max(initial=0)) + 1))
    plans = _columns(owners, {number for pair in pairs for number in pair})
    for first, second in pairs:
        smaller = min(len(plans[first]), len(plans[second]))
        if len(plans[first] & plans[second]) >= MIN_OVERLAP * smaller:
            a, b = sorted((_root(parent, first), _root(parent, second)))
            parent[b] = a
    roots = np.array([_root(parent, number) for number in range(len(parent))], np.int32)
    return roots[owners]


def _columns(owners: np.ndarray, numbers: set[int]) -> dict[int, set[tuple[int, int]]]:
    """Return the columns that each numbered part covers."""
    plans: dict[int, set[tuple[int, int]]] = {number: set() for number in numbers}
    cells = np.argwhere(np.isin(owners, sorted(numbers)))
    for (x, y, _), number in zip(cells.tolist(), owners[tuple(cells.T)].tolist(), strict=True):
        plans[number].add((x, y))
    return plans


def _root(parent: list[int], number: int) -> int:
    while parent[number] != number:
        number = parent[number]
    return number


def merge_flush_pieces(
    owners: np.ndarray, grid: OccupancyGrid, fixed: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Merge small pieces into objects of their colour that they lie against, or that surround them.

    Args:
        owners: Number of the object of each cell, int32 [X, Y, Z], 0 for none.
        grid: Grid with labels and colours.
        fixed: Numbers of objects that are not merged into others, int [N].

    Returns:
        The owners, and the labels, uint8 [X, Y, Z], in which merged cells have the host's class.
    """
    result, labels = owners.copy(), grid.labels.copy()
    sizes = np.bincount(owners.reshape(-1))
    sizes[0] = 0
    boxes = ndimage.find_objects(owners)
    small = np.setdiff1d(np.flatnonzero((sizes > 0) & (sizes <= MAX_PIECE_CELLS)), fixed)
    for number in small[np.argsort(sizes[small], kind="stable")].tolist():
        box = tuple(slice(max(side.start - 1, 0), side.stop + 1) for side in boxes[number - 1])
        own = owners[box] == number
        host = _host_of(own, result[box], sizes)
        if host == 0:
            continue
        beside = boxes[host - 1]
        whole = owners[beside] == host
        is_thing = grid.labels[box][own].max() == SemanticClass.OBJS
        embedded = is_thing and _covered_share(own, result[box], number) >= MIN_COVERED
        if embedded or (
            colour_distance(grid.colour[box][own], grid.colour[beside][whole]) < SAME_COLOUR
        ):
            moved = result == number  # With what was merged into it before.
            result[moved] = host
            labels[moved] = np.bincount(grid.labels[beside][whole]).argmax()
    return result, labels


def _host_of(own: np.ndarray, owners: np.ndarray, sizes: np.ndarray) -> int:
    """Return the larger object that a piece, bool [A, B, C], mostly lies against, or 0."""
    around = owners[ndimage.binary_dilation(own, NEIGHBOURHOOD) & ~own]
    counts = np.bincount(around, minlength=len(sizes))
    counts[sizes < MIN_HOST_FACTOR * np.count_nonzero(own)] = 0
    host = int(counts.argmax())
    if counts[host] == 0:
        return 0
    contact = ndimage.binary_dilation(owners == host, NEIGHBOURHOOD)[own].mean()
    return host if contact >= MIN_CONTACT else 0


def _covered_share(own: np.ndarray, owners: np.ndarray, number: int) -> float:
    """Return the share of the cells around a piece, across faces, that are other objects."""
    around = owners[ndimage.binary_dilation(own) & ~own]
    return float(((around > 0) & (around != number)).mean()) if len(around) else 0.0


def merge_small_pieces(
    owners: np.ndarray, grid: OccupancyGrid, parameters: InstanceParameters
) -> np.ndarray:
    """Return owners in which no object has fewer than ``min_cells`` cells.

    Loose pieces and small objects are merged into the nearest object of their class within
    ``join_radius`` cells. For chairs, beds, sofas and tables, somewhat larger fragments are merged
    as well. A loose piece without such a neighbour becomes an object if it is large enough; other
    cells belong to no object (owner 0).
    """
    result, labels = owners.copy(), grid.labels
    for class_id in np.unique(labels[object_cells(labels)]):
        factor = STANDING_FACTOR if class_id in STANDING else 1
        _merge_class(labels == class_id, result, factor * parameters.min_cells, parameters)
    return result


def _merge_class(
    mask: np.ndarray, owners: np.ndarray, min_whole_cells: int, parameters: InstanceParameters
) -> None:
    """Merge, in place, the loose pieces and the small objects of a class."""
    sizes = np.bincount(owners[mask])
    small = np.flatnonzero((sizes > 0) & (sizes < min_whole_cells))
    loose = mask & ((owners == 0) | np.isin(owners, small[small > 0]))
    if not loose.any():
        return
    anchors = np.argwhere(mask & ~loose)
    owners[loose] = 0
    tree = KDTree(anchors) if len(anchors) else None
    next_id = int(owners.max())
    for cells in _connected_pieces(loose):
        owner = _nearest_object(tree, anchors, owners, cells, parameters.join_radius)
        if owner == 0 and len(cells) >= parameters.min_cells:
            next_id += 1
            owner = next_id
        owners[tuple(cells.T)] = owner


def _connected_pieces(loose: np.ndarray) -> list[np.ndarray]:
    """Return the cells, int64 [N, 3], of each connected piece."""
    pieces, _ = label_components(loose)
    cells = np.argwhere(pieces)
    numbers = pieces[tuple(cells.T)]
    order = np.argsort(numbers, kind="stable")
    ends = np.cumsum(np.bincount(numbers)[1:])[:-1]
    return np.split(cells[order], ends)


def _nearest_object(
    tree: KDTree | None,
    anchors: np.ndarray,
    owners: np.ndarray,
    cells: np.ndarray,
    join_radius: float,
) -> int:
    if tree is None:
        return 0
    distance, _ = tree.query(cells, distance_upper_bound=join_radius + 1e-9)
    if not np.isfinite(distance.min()):
        return 0
    source = cells[int(np.argmin(distance))]
    # Of equally near objects the lowest number, so that the tree's order does not matter.
    near = tree.query_ball_point(source, float(distance.min()) + 1e-9)
    return int(owners[tuple(anchors[near].T)].min())

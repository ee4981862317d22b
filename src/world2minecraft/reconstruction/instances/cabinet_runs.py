"""Split runs of cabinets, furniture that stands in a row, into single cupboards.

Hanging cupboards are separated from standing ones, taller from lower ones, the arms of an L from
each other, and along an arm cupboards that look different. The paper has no such step: its clusters
make a whole kitchen one object.
"""

from itertools import pairwise

import numpy as np
from scipy import ndimage
from scipy.spatial import KDTree

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.reconstruction.instances.change_points import change_points
from world2minecraft.reconstruction.instances.density_clustering import joined_parts
from world2minecraft.reconstruction.instances.object_voxels import (
    COLOUR_WEIGHTS,
    ObjectVoxels,
    object_voxels,
    split_owners,
)
from world2minecraft.reconstruction.instances.parameters import InstanceParameters

# Slivers of a cut go back to the piece that they touch most.
SLIVER_WIDTH_M = 0.2  # A piece this thin in plan
SLIVER_LENGTH_M = 0.75  # and this short is the flank or the edge of its neighbour,
MIN_CELLS = 40  # and one of so few cells a sliver of it.

# The arms of an L or a U of furniture, each a rectangle of the plan.
MIN_EMPTY_M2 = 0.2  # A plan whose box holds less air than this is one arm: half a unit's place.
MIN_EMPTY_SHARE = 0.2  # And so large a share of its box: noise makes no arm.
MIN_FREED_SHARE = 0.5  # A cut frees the boxes of so much of that air.
MIN_ARM_M = 0.3
NEARLY_BEST = 0.85  # Cuts that free so much of what the best one frees are as good.
MIN_NEIGHBOURS = 4  # Minimum number of the 9 columns around and including one.
OPEN_SHARE = 0.5  # A column of which this much was seen free is air; the inside of a case is not.

# What hangs over something else of its class: a wall cupboard over a counter.
MIN_HANGING_HEIGHT_M = 1.0  # Objects that begin lower stand, such as shelves and drawers.
MIN_GAP_M = 0.24  # Free height below a hanging unit, in metres; over a counter it is 0.5.
MIN_HANGING_M2 = 0.06  # A plan of less is a stray cell or a tap.
MAX_LAYER_SHARE = 0.28  # In the gap less of the plan is filled: kitchens 0.2, bookcases 0.38.
PLAN_BOX = np.ones((3, 3), np.bool_)

# Plans of pieces that are each of about one height: a fridge beside a counter.
HEIGHT_STEP_M = 0.2  # Tops of neighbours that differ by less are one piece: a hob, a sink.
MIN_COLUMNS = 6

# Where a row of cupboards changes along its front: in colour or in how deep it lies.
MIN_UNIT_M = 0.32  # The narrowest unit of a row.
MIN_RUN_M = 0.9  # A run that is shorter is one unit.
COLOUR_STEP = 0.05  # In Oklab: a front that differs by less looks the same; light alone gives 0.03.
# Arms with more of their tops seen are units of their own. Of the kitchen's counter 0.43 and 0.51
# are seen; of the two units at each corner of generated kitchens, one has 0.8 or more.
MAX_TOP_SHARE = 0.7
MIN_FRONT_LAYERS = 3  # A slice that shows fewer layers of its front says nothing.


def merge_slivers(pieces: np.ndarray, voxels: ObjectVoxels) -> np.ndarray:
    """Merge slivers into neighbouring pieces, int32 [X, Y, Z], and renumber the pieces from 1.

    The smallest sliver is merged first; slivers that touch no other piece are kept.
    """
    result = pieces.copy()
    retained: set[int] = set()
    while True:
        sliver = _smallest_sliver(result, voxels, retained)
        if sliver is None:
            break
        into = _most_adjacent(result, sliver)
        if into:
            result[result == sliver] = into
        else:
            retained.add(sliver)
    numbers = np.unique(result[result > 0])
    return np.searchsorted(numbers, result).astype(np.int32) + (result > 0)


def _smallest_sliver(pieces: np.ndarray, voxels: ObjectVoxels, retained: set[int]) -> int | None:
    found = []
    for number, box in enumerate(ndimage.find_objects(pieces), start=1):
        if box is None or number in retained:
            continue
        sides = sorted((side.stop - side.start) * voxels.voxel_m for side in box[:2])
        cells = int(np.count_nonzero(pieces[box] == number))
        if cells < MIN_CELLS or (sides[0] <= SLIVER_WIDTH_M and sides[1] <= SLIVER_LENGTH_M):
            found.append((cells, number))
    return min(found)[1] if found else None


def _most_adjacent(pieces: np.ndarray, number: int) -> int:
    """Return the piece with the most cells next to those of ``number``; the lowest wins a tie."""
    own = pieces == number
    adjacent = pieces[ndimage.binary_dilation(own, np.ones((3, 3, 3), np.bool_)) & ~own]
    counts = np.bincount(adjacent[adjacent > 0])
    return int(counts.argmax()) if len(counts) else 0


def split_into_arms(plan: np.ndarray, voxels: ObjectVoxels) -> list[np.ndarray]:
    """Split a plan into rectangles, bool [X, Y] each.

    Straight cuts are chosen that exclude the most observed air from the bounding boxes. Of the two
    ways to cut an L, the longer arm keeps the corner.
    """
    layers = (voxels.own & plan[:, :, None]).any(axis=(0, 1))
    air = voxels.free[:, :, layers].mean(axis=2) >= OPEN_SHARE
    return _arms(plan, air & ~plan, voxels)


def _arms(plan: np.ndarray, air: np.ndarray, voxels: ObjectVoxels) -> list[np.ndarray]:
    cut = _best_cut(_remove_fringe(plan), air, voxels)
    if cut is None:
        return [plan]
    axis, place = cut
    first = plan.copy()
    first[(slice(None),) * axis + (slice(place, None),)] = False
    return [*_arms(first, air, voxels), *_arms(plan & ~first, air, voxels)]


def _best_cut(plan: np.ndarray, air: np.ndarray, voxels: ObjectVoxels) -> tuple[int, int] | None:
    box, empty = _plan_box(plan), _count_air(plan, air)
    if box is None or empty < max(
        MIN_EMPTY_M2 / voxels.voxel_m**2, MIN_EMPTY_SHARE * air[box].size
    ):
        return None
    arm = voxels.cells_of(MIN_ARM_M)
    cuts = []
    for axis in (0, 1):
        for place in range(box[axis].start + arm, box[axis].stop - arm + 1):
            low, high = plan.copy(), plan.copy()
            low[(slice(None),) * axis + (slice(place, None),)] = False
            high[(slice(None),) * axis + (slice(place),)] = False
            freed = empty - _count_air(low, air) - _count_air(high, air)
            cuts.append((freed, max(_longest_side(low), _longest_side(high)), axis, place))
    most = max((cut[0] for cut in cuts), default=0)
    if most < MIN_FREED_SHARE * empty:
        return None
    good = [cut for cut in cuts if cut[0] >= NEARLY_BEST * most]
    _, _, axis, place = max(good, key=lambda cut: (cut[1], cut[0], -cut[2], -cut[3]))
    return axis, place


def _remove_fringe(plan: np.ndarray) -> np.ndarray:
    """Return the plan without columns that have few neighbours, as noise would widen its box."""
    near = ndimage.convolve(plan.astype(np.int32), np.ones((3, 3), np.int32), mode="constant")
    return plan & (near >= MIN_NEIGHBOURS)


def _plan_box(plan: np.ndarray) -> tuple[slice, slice] | None:
    found = ndimage.find_objects(plan.astype(np.int8))
    return found[0] if found else None


def _count_air(plan: np.ndarray, air: np.ndarray) -> int:
    """Return the number of air columns in the bounding box of a plan."""
    box = _plan_box(plan)
    return int(np.count_nonzero(air[box])) if box else 0


def _longest_side(plan: np.ndarray) -> int:
    box = _plan_box(plan)
    return max(side.stop - side.start for side in box) if box else 0


def hanging_cells(voxels: ObjectVoxels) -> np.ndarray:
    """Return the mask of an object's cells, bool [X, Y, Z], that hang above standing parts.

    Cells above the inside of a bookcase do not hang: its sides and back fill the layers of the gap.
    """
    hung = np.zeros(voxels.own.shape, np.bool_)
    bottoms = _hanging_bottoms(voxels)
    regions, count = label_components(bottoms > 0)
    for region in range(1, count + 1):
        plan = regions == region
        if plan.sum() * voxels.voxel_m**2 < MIN_HANGING_M2:
            continue
        around = ndimage.binary_dilation(plan, PLAN_BOX, iterations=2)
        bottom = int(np.median(bottoms[plan]))
        if _is_clear(voxels, around, bottom):
            hung[:, :, bottom:] |= voxels.own[:, :, bottom:] & around[:, :, None]
    return hung


def _hanging_bottoms(voxels: ObjectVoxels) -> np.ndarray:
    """Return the first layer of a hanging object in each column, or 0, int64 [X, Y]."""
    first = max(voxels.floor + voxels.cells_of(MIN_HANGING_HEIGHT_M), 1)
    gap = voxels.cells_of(MIN_GAP_M)
    result = np.zeros(voxels.own.shape[:2], np.int64)
    for k in range(voxels.own.shape[2] - 1, first - 1, -1):
        below = voxels.free[:, :, max(k - gap, 0) : k]
        # One cell of the gap may be unseen.
        airy = below.sum(axis=2) >= max(gap - 1, 1)
        result = np.where(voxels.own[:, :, k] & airy, k, result)
    return result


def _is_clear(voxels: ObjectVoxels, plan: np.ndarray, bottom: int) -> bool:
    """Return whether the layers below a plan are nearly empty, without the sides of a case."""
    own = voxels.own & plan[:, :, None]
    columns = own[:, :, bottom:].any(axis=2).sum()
    gap = own[:, :, max(bottom - voxels.cells_of(MIN_GAP_M), 0) : bottom]
    return bool((gap.sum(axis=(0, 1)) < MAX_LAYER_SHARE * columns).all())


def split_by_height(voxels: ObjectVoxels) -> list[np.ndarray]:
    """Return the plans, bool [X, Y], of the parts of different height, the widest first."""
    own = voxels.own
    top = (own * np.arange(1, own.shape[2] + 1)).max(axis=2)
    number = _height_regions(top, HEIGHT_STEP_M / voxels.voxel_m)
    cells = np.bincount(number.reshape(-1), own.sum(axis=2).reshape(-1), number.max() + 1)
    columns = np.bincount(number.reshape(-1), minlength=number.max() + 1)
    retained = [
        region
        for region in range(1, len(columns))
        if columns[region] >= MIN_COLUMNS and cells[region] >= MIN_CELLS
    ]
    plans = [number == region for region in sorted(retained, key=lambda one: (-columns[one], one))]
    return _merge_plans(plans, top, HEIGHT_STEP_M / voxels.voxel_m)


def _merge_plans(plans: list[np.ndarray], top: np.ndarray, step: float) -> list[np.ndarray]:
    """Merge adjacent plans of the same height, including stray columns between them."""
    result: list[np.ndarray] = []
    for plan in plans:
        height = float(np.median(top[plan]))
        wide = ndimage.binary_dilation(plan, np.ones((3, 3), np.bool_), iterations=2)
        for n, other in enumerate(result):
            if abs(height - float(np.median(top[other]))) < step and (wide & other).any():
                result[n] = other | plan
                break
        else:
            result.append(plan.copy())
    return result


def _height_regions(top: np.ndarray, step: float) -> np.ndarray:
    """Label the regions of columns with similar top heights, int64 [X, Y]."""
    index = np.arange(top.size).reshape(top.shape)
    pairs = []
    for near, far in (
        ((slice(None, -1), slice(None)), (slice(1, None), slice(None))),
        ((slice(None), slice(None, -1)), (slice(None), slice(1, None))),
    ):
        joined = (top[near] > 0) & (top[far] > 0) & (np.abs(top[near] - top[far]) < step)
        pairs.append(np.stack([index[near][joined], index[far][joined]]))
    number = joined_parts(np.concatenate(pairs, axis=1), top.size)
    result = np.where(top.reshape(-1) > 0, number + 1, 0)
    _, compact = np.unique(result, return_inverse=True)
    compact = compact.reshape(top.shape)
    return compact if (top == 0).any() else compact + 1


def split_at_seams(voxels: ObjectVoxels) -> list[np.ndarray]:
    """Split one arm of a row at the seams of its fronts into pieces, bool [X, Y, Z]."""
    plan: np.ndarray = np.asarray(voxels.own.any(axis=2))
    spans = [np.flatnonzero(plan.any(axis=1)), np.flatnonzero(plan.any(axis=0))]
    if not len(spans[0]):
        return []
    axis = int(np.ptp(spans[1]) > np.ptp(spans[0]))
    first, last = int(spans[axis][0]), int(spans[axis][-1]) + 1
    if (last - first) * voxels.voxel_m < MIN_RUN_M:
        return [voxels.own]
    colours = _front_colours(voxels, axis)[first:last]
    step = _colour_step(colours)
    cuts = [
        first,
        *(first + cut for cut in change_points(colours / step, voxels.cells_of(MIN_UNIT_M))),
        last,
    ]
    pieces = []
    for begin, end in pairwise(cuts):
        piece = np.zeros_like(voxels.own)
        span = (slice(None),) * axis + (slice(begin, end),)
        piece[span] = voxels.own[span]
        pieces.append(piece)
    return pieces


def join_corners(arms: list[list[np.ndarray]], voxels: ObjectVoxels) -> list[np.ndarray]:
    """Join pieces of different arms, bool [X, Y, Z], that are one counter around a corner.

    Such pieces meet, have the same front colour, and are of about one height, but their worktop was
    hardly seen: depth sensors do not measure polished stone. A piece with a seen top is a box of
    its own.

    Args:
        arms: Pieces of each arm.
        voxels: The object.
    """
    groups: list[list[tuple[int, np.ndarray]]] = []
    for number, arm in enumerate(arms):
        for piece in arm:
            alike = [one for one in groups if _continue_each_other(number, piece, one, voxels)]
            merged = [member for one in alike for member in one]
            groups = [one for one in groups if not any(one is other for other in alike)]
            groups.append([*merged, (number, piece)])
    return [np.logical_or.reduce([piece for _, piece in group]) for group in groups]


def _continue_each_other(
    number: int, piece: np.ndarray, group: list[tuple[int, np.ndarray]], voxels: ObjectVoxels
) -> bool:
    if _seen_top_share(piece) > MAX_TOP_SHARE:
        return False
    near = ndimage.binary_dilation(piece, np.ones((3, 3, 3), np.bool_), iterations=2)
    others = [one for arm, one in group if arm != number and (near & one).any()]
    others = [one for one in others if _seen_top_share(one) <= MAX_TOP_SHARE]
    colours = [_side_colour(one, voxels) for one in (piece, *others)]
    return any(np.linalg.norm(colours[0] - one) < COLOUR_STEP for one in colours[1:])


def _seen_top_share(piece: np.ndarray) -> float:
    """Return the share of a piece's plan that has cells next to its fullest layer."""
    areas = piece.sum(axis=(0, 1))
    level = int(areas.argmax())
    top = np.asarray(piece[:, :, max(level - 1, 0) : level + 2].any(axis=2))
    box = _plan_box(np.asarray(piece.any(axis=2)))
    return float(top[box].mean()) if box else 0.0


def _side_colour(piece: np.ndarray, voxels: ObjectVoxels) -> np.ndarray:
    """Return the median colour of a piece below its top, float64 [3]; NaN if unseen."""
    layers = np.flatnonzero(piece.any(axis=(0, 1)))
    side = piece.copy()
    side[:, :, max(int(layers[-1]) - 1, int(layers[0]) + 1) :] = False
    colours = voxels.colour[side]
    colours = colours[colours.any(axis=1)]
    if not len(colours):
        return np.full(3, np.nan)
    return np.median(srgb_to_oklab(colours) * COLOUR_WEIGHTS, axis=0)


def _front_colours(voxels: ObjectVoxels, axis: int) -> np.ndarray:
    """Return the front colour of each slice across the run, float64 [N, 3]; NaN if unseen."""
    across = 1 - axis
    own = np.moveaxis(voxels.own, (axis, across, 2), (0, 1, 2))
    free = np.moveaxis(voxels.free, (axis, across, 2), (0, 1, 2))
    colour = srgb_to_oklab(np.moveaxis(voxels.colour, (axis, across, 2), (0, 1, 2)))
    if _count_front_cells(own[:, ::-1], free[:, ::-1]) > _count_front_cells(own, free):
        own, colour = own[:, ::-1], colour[:, ::-1]
    # The front is the first own cell from the free side, layer by layer; tops are left out.
    shown: np.ndarray = np.asarray(own.any(axis=1))
    top = shown.shape[1] - 1 - shown[:, ::-1].argmax(axis=1)
    shown[np.arange(len(shown)), np.maximum(top, 0)] = False
    place = own.argmax(axis=1)
    n, k = np.indices(place.shape)
    fronts = np.where(shown[..., None], colour[n, place, k], np.nan)
    enough = shown.sum(axis=1) >= MIN_FRONT_LAYERS
    result = np.full((len(own), 3), np.nan)
    result[enough] = np.nanmedian(fronts[enough], axis=1)
    return result


def _count_front_cells(own: np.ndarray, free: np.ndarray) -> int:
    """Count the object's cells with free air in front, on the side of index 0."""
    return int((own[:, 1:] & free[:, :-1]).sum())


def _colour_step(colours: np.ndarray) -> float:
    """Return the threshold of a colour change, larger if neighbours differ, as books do."""
    change = np.linalg.norm(np.diff(colours, axis=0), axis=1)
    usual = float(np.nanmedian(change)) if np.isfinite(change).any() else 0.0
    return max(COLOUR_STEP, 2 * usual)


def split_cabinet_runs(
    owners: np.ndarray, grid: OccupancyGrid, _parameters: InstanceParameters
) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], with a separate number for each cupboard of a row."""

    def parts_of(cells: np.ndarray) -> np.ndarray | None:
        size_m = (np.ptp(cells, axis=0) + 1) * grid.voxel_m
        if size_m[:2].max() < MIN_RUN_M:
            return None
        return split_run(object_voxels(grid, cells))[tuple((cells - cells.min(axis=0)).T)]

    return split_owners(owners, grid.labels, SemanticClass.FURN, parts_of)


def split_run(voxels: ObjectVoxels) -> np.ndarray:
    """Return the piece number, int32 [X, Y, Z] from 1, of each cell of an object; 0 elsewhere."""
    seeds = np.zeros(voxels.own.shape, np.int32)
    hung = hanging_cells(voxels)
    for storey in (voxels.own & ~hung, hung):
        for level in split_by_height(voxels.only(storey)):
            arms = [
                split_at_seams(voxels.only(storey & arm[:, :, None]))
                for arm in split_into_arms(level, voxels)
            ]
            for piece in join_corners(arms, voxels):
                seeds[piece] = seeds.max() + 1
    return merge_slivers(_assign_to_nearest(voxels.own, seeds), voxels)


def _assign_to_nearest(own: np.ndarray, seeds: np.ndarray) -> np.ndarray:
    """Assign every cell of an object to the nearest seed; the lowest number wins a tie."""
    if seeds.max(initial=0) < 2:
        return own.astype(np.int32)
    loose = np.argwhere(own & (seeds == 0))
    if not len(loose):
        return seeds
    placed = np.argwhere(seeds)
    numbers = seeds[tuple(placed.T)]
    order = np.argsort(numbers, kind="stable")
    distance, nearest = KDTree(placed[order]).query(loose, k=min(4, len(placed)))
    distance, nearest = distance.reshape(len(loose), -1), nearest.reshape(len(loose), -1)
    tied = np.round(distance, 9) <= np.round(distance[:, :1], 9)
    claims = np.where(tied, numbers[order][nearest], seeds.max() + 1)
    seeds[tuple(loose.T)] = claims.min(axis=1)
    return seeds

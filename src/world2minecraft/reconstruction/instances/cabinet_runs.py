"""Furniture that stands in a row, told apart.

What hangs is parted from what stands, what is taller from what is lower, each arm of an L from the
other, and along an arm what looks different from its neighbour.

In: owners from the clusters. Out: owners in which each cupboard has a number of its own. The paper
has no such step: its clusters take a whole kitchen for one object.
"""

from itertools import pairwise

import numpy as np
from scipy import ndimage
from scipy.spatial import KDTree

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.reconstruction.instances.object_voxels import Heap, cells_by_owner, heap_of

# Splinters of a cut go back to the piece that they touch most.

THIN_M = 0.2  # A piece this thin in plan
SHORT_M = 0.75  # and this short is the flank or the edge of its neighbour,
LEAST_CELLS = 40  # and one of so few cells a splinter of it.


def absorbed(pieces: np.ndarray, heap: Heap) -> np.ndarray:
    """Return pieces, int32 [X, Y, Z], numbered anew from 1, without splinters.

    The smallest goes first; one that touches no other piece stays.
    """
    result = pieces.copy()
    kept: set[int] = set()
    while True:
        splinter = _smallest_splinter(result, heap, kept)
        if splinter is None:
            break
        into = _most_touched(result, splinter)
        if into:
            result[result == splinter] = into
        else:
            kept.add(splinter)
    numbers = np.unique(result[result > 0])
    return np.searchsorted(numbers, result).astype(np.int32) + (result > 0)


def _smallest_splinter(pieces: np.ndarray, heap: Heap, kept: set[int]) -> int | None:
    found = []
    for number, box in enumerate(ndimage.find_objects(pieces), start=1):
        if box is None or number in kept:
            continue
        sides = sorted((side.stop - side.start) * heap.voxel_m for side in box[:2])
        cells = int(np.count_nonzero(pieces[box] == number))
        if cells < LEAST_CELLS or (sides[0] <= THIN_M and sides[1] <= SHORT_M):
            found.append((cells, number))
    return min(found)[1] if found else None


def _most_touched(pieces: np.ndarray, number: int) -> int:
    """Return the piece that has most cells beside those of ``number``; of equals the lowest."""
    own = pieces == number
    beside = pieces[ndimage.binary_dilation(own, np.ones((3, 3, 3), np.bool_)) & ~own]
    counts = np.bincount(beside[beside > 0])
    return int(counts.argmax()) if len(counts) else 0


# The arms of an L or a U of furniture, each a rectangle of the plan.

LEAST_EMPTY_M2 = 0.2  # A plan whose box holds less air than this is one arm: half a unit's place.
LEAST_SHARE = 0.2  # And so large a share of its box: noise makes no arm.
LEAST_FREED = 0.5  # A cut frees the boxes of so much of that air.
LEAST_ARM_M = 0.3
ALIKE = 0.85  # Cuts that free so much of what the best one frees are as good.
FRINGE = 4  # Of the 9 columns around and with one.
OPEN_SHARE = 0.5  # A column of which this much was seen free is air; the inside of a case is not.


def arms(plan: np.ndarray, heap: Heap) -> list[np.ndarray]:
    """Return the plans, bool [X, Y], of the rectangles that a plan is made of.

    A plan is cut straight through where that frees its boxes of most air that was seen. Of the
    two ways to cut an L that in which its longer arm keeps the corner is taken.
    """
    layers = (heap.own & plan[:, :, None]).any(axis=(0, 1))
    air = heap.free[:, :, layers].mean(axis=2) >= OPEN_SHARE
    return _arms(plan, air & ~plan, heap)


def _arms(plan: np.ndarray, air: np.ndarray, heap: Heap) -> list[np.ndarray]:
    cut = _best_cut(_without_fringe(plan), air, heap)
    if cut is None:
        return [plan]
    axis, place = cut
    first = plan.copy()
    first[(slice(None),) * axis + (slice(place, None),)] = False
    return [*_arms(first, air, heap), *_arms(plan & ~first, air, heap)]


def _best_cut(plan: np.ndarray, air: np.ndarray, heap: Heap) -> tuple[int, int] | None:
    box, empty = _box(plan), _empty(plan, air)
    if box is None or empty < max(LEAST_EMPTY_M2 / heap.voxel_m**2, LEAST_SHARE * air[box].size):
        return None
    arm = heap.cells_of(LEAST_ARM_M)
    cuts = []
    for axis in (0, 1):
        for place in range(box[axis].start + arm, box[axis].stop - arm + 1):
            low, high = plan.copy(), plan.copy()
            low[(slice(None),) * axis + (slice(place, None),)] = False
            high[(slice(None),) * axis + (slice(place),)] = False
            freed = empty - _empty(low, air) - _empty(high, air)
            cuts.append((freed, max(_longest(low), _longest(high)), axis, place))
    most = max((cut[0] for cut in cuts), default=0)
    if most < LEAST_FREED * empty:
        return None
    good = [cut for cut in cuts if cut[0] >= ALIKE * most]
    _, _, axis, place = max(good, key=lambda cut: (cut[1], cut[0], -cut[2], -cut[3]))
    return axis, place


def _without_fringe(plan: np.ndarray) -> np.ndarray:
    """Return the plan without columns that have few neighbours: noise would widen its box."""
    near = ndimage.convolve(plan.astype(np.int32), np.ones((3, 3), np.int32), mode="constant")
    return plan & (near >= FRINGE)


def _box(plan: np.ndarray) -> tuple[slice, slice] | None:
    found = ndimage.find_objects(plan.astype(np.int8))
    return found[0] if found else None


def _empty(plan: np.ndarray, air: np.ndarray) -> int:
    """Return how many columns of the box around a plan are air."""
    box = _box(plan)
    return int(np.count_nonzero(air[box])) if box else 0


def _longest(plan: np.ndarray) -> int:
    box = _box(plan)
    return max(side.stop - side.start for side in box) if box else 0


# What hangs over something else of its class: a wall cupboard over a counter.

LOWEST_M = 1.0  # What begins below this stands: a shelf of a bookcase, a drawer.
GAP_M = 0.24  # So much free air under a piece; over a counter it is 0.5 m.
LEAST_M2 = 0.06  # A plan of less is a stray cell or a tap.
THIN_LAYER = 0.28  # In the gap, less of the plan is filled: kitchens 0.2 at most, bookcases 0.38.
PLAN_BOX = np.ones((3, 3), np.bool_)


def hung_cells(heap: Heap) -> np.ndarray:
    """Return the own cells, bool [X, Y, Z], that hang clear of what stands below them.

    Nothing hangs where the air below is but the inside of a bookcase: its sides and back fill
    the layers of the gap.
    """
    hung = np.zeros(heap.own.shape, np.bool_)
    bottoms = _bottoms(heap)
    regions, count = label_components(bottoms > 0)
    for region in range(1, count + 1):
        plan = regions == region
        if plan.sum() * heap.voxel_m**2 < LEAST_M2:
            continue
        around = ndimage.binary_dilation(plan, PLAN_BOX, iterations=2)
        bottom = int(np.median(bottoms[plan]))
        if _is_clear(heap, around, bottom):
            hung[:, :, bottom:] |= heap.own[:, :, bottom:] & around[:, :, None]
    return hung


def _bottoms(heap: Heap) -> np.ndarray:
    """Return int64 [X, Y]: the layer in which a hanging thing begins in each column, or 0."""
    first = max(heap.floor + heap.cells_of(LOWEST_M), 1)
    gap = heap.cells_of(GAP_M)
    result = np.zeros(heap.own.shape[:2], np.int64)
    for k in range(heap.own.shape[2] - 1, first - 1, -1):
        below = heap.free[:, :, max(k - gap, 0) : k]
        # One cell of the gap may be unseen.
        airy = below.sum(axis=2) >= max(gap - 1, 1)
        result = np.where(heap.own[:, :, k] & airy, k, result)
    return result


def _is_clear(heap: Heap, plan: np.ndarray, bottom: int) -> bool:
    """Tell whether the layers under a plan hold next to nothing: no side, no back of a case."""
    own = heap.own & plan[:, :, None]
    columns = own[:, :, bottom:].any(axis=2).sum()
    gap = own[:, :, max(bottom - heap.cells_of(GAP_M), 0) : bottom]
    return bool((gap.sum(axis=(0, 1)) < THIN_LAYER * columns).all())


# Plans of pieces that are each of about one height: a fridge beside a counter.

STEP_M = 0.2  # Tops of neighbours that differ by less are one piece: a hob, a sink, a box's lid.
LEAST_COLUMNS = 6


def levels(heap: Heap) -> list[np.ndarray]:
    """Return plans, bool [X, Y], of the pieces, the widest first."""
    own = heap.own
    top = (own * np.arange(1, own.shape[2] + 1)).max(axis=2)
    number = _regions(top, STEP_M / heap.voxel_m)
    cells = np.bincount(number.reshape(-1), own.sum(axis=2).reshape(-1), number.max() + 1)
    columns = np.bincount(number.reshape(-1), minlength=number.max() + 1)
    kept = [
        region
        for region in range(1, len(columns))
        if columns[region] >= LEAST_COLUMNS and cells[region] >= LEAST_CELLS
    ]
    plans = [number == region for region in sorted(kept, key=lambda one: (-columns[one], one))]
    return _joined(plans, top, STEP_M / heap.voxel_m)


def _joined(plans: list[np.ndarray], top: np.ndarray, step: float) -> list[np.ndarray]:
    """Join plans of one height that lie beside one another, stray columns between them or not."""
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


def _regions(top: np.ndarray, step: float) -> np.ndarray:
    """Number the regions, int64 [X, Y], of columns whose tops differ little between neighbours."""
    from scipy.sparse import coo_matrix  # noqa: PLC0415
    from scipy.sparse.csgraph import connected_components  # noqa: PLC0415

    index = np.arange(top.size).reshape(top.shape)
    pairs = []
    for near, far in (
        ((slice(None, -1), slice(None)), (slice(1, None), slice(None))),
        ((slice(None), slice(None, -1)), (slice(None), slice(1, None))),
    ):
        joined = (top[near] > 0) & (top[far] > 0) & (np.abs(top[near] - top[far]) < step)
        pairs.append(np.stack([index[near][joined], index[far][joined]]))
    first, second = np.concatenate(pairs, axis=1)
    graph = coo_matrix((np.ones(len(first)), (first, second)), shape=(top.size, top.size))
    _, number = connected_components(graph, directed=False)
    result = np.where(top.reshape(-1) > 0, number + 1, 0)
    _, compact = np.unique(result, return_inverse=True)
    compact = compact.reshape(top.shape)
    return compact if (top == 0).any() else compact + 1


# Where a row of cupboards changes along its front: in colour or in how deep it lies.

LEAST_M = 0.32  # The narrowest unit of a row.
LONG_M = 0.9  # A run that is shorter is one unit.
STEP = 0.05  # In Oklab: a front that differs by less looks the same; light alone gives 0.03.
PENALTY = 5.0  # What a seam costs, in squared steps summed over the slices of a run.
LEAST_LAYERS = 3  # A slice that shows fewer layers of its front says nothing.


def seams(heap: Heap) -> list[np.ndarray]:
    """Return the pieces, bool [X, Y, Z], into which the fronts part one arm of a row."""
    plan: np.ndarray = np.asarray(heap.own.any(axis=2))
    spans = [np.flatnonzero(plan.any(axis=1)), np.flatnonzero(plan.any(axis=0))]
    if not len(spans[0]):
        return []
    axis = int(np.ptp(spans[1]) > np.ptp(spans[0]))
    first, last = int(spans[axis][0]), int(spans[axis][-1]) + 1
    if (last - first) * heap.voxel_m < LONG_M:
        return [heap.own]
    look = _look(heap, axis)[first:last]
    cuts = [first, *(first + cut for cut in _cuts(look, heap.cells_of(LEAST_M))), last]
    pieces = []
    for begin, end in pairwise(cuts):
        piece = np.zeros_like(heap.own)
        span = (slice(None),) * axis + (slice(begin, end),)
        piece[span] = heap.own[span]
        pieces.append(piece)
    return pieces


def _look(heap: Heap, axis: int) -> np.ndarray:
    """Return the front's colour, float64 [N, 3], of each slice across the run, NaN if unseen."""
    across = 1 - axis
    own = np.moveaxis(heap.own, (axis, across, 2), (0, 1, 2))
    free = np.moveaxis(heap.free, (axis, across, 2), (0, 1, 2))
    colour = srgb_to_oklab(np.moveaxis(heap.colour, (axis, across, 2), (0, 1, 2)))
    if _fronts(own[:, ::-1], free[:, ::-1]) > _fronts(own, free):
        own, colour = own[:, ::-1], colour[:, ::-1]
    # The front is the first own cell from the free side, layer by layer; tops are left out.
    shown: np.ndarray = np.asarray(own.any(axis=1))
    top = shown.shape[1] - 1 - shown[:, ::-1].argmax(axis=1)
    shown[np.arange(len(shown)), np.maximum(top, 0)] = False
    place = own.argmax(axis=1)
    n, k = np.indices(place.shape)
    fronts = np.where(shown[..., None], colour[n, place, k], np.nan)
    enough = shown.sum(axis=1) >= LEAST_LAYERS
    result = np.full((len(own), 3), np.nan)
    result[enough] = np.nanmedian(fronts[enough], axis=1)
    return result


def _fronts(own: np.ndarray, free: np.ndarray) -> int:
    """Count the own cells that have free air before them, on the side of index 0."""
    return int((own[:, 1:] & free[:, :-1]).sum())


def _cuts(look: np.ndarray, least: int) -> list[int]:
    """Return where a run changes: the cuts of least squared change, each worth its penalty."""
    known = np.asarray(np.isfinite(look).all(axis=1))
    values = np.where(known[:, None], look, 0.0) / _step(look)
    total = np.vstack([np.zeros(3), np.cumsum(values, axis=0)])
    square = np.concatenate([[0.0], np.cumsum((values**2).sum(axis=1))])
    count = np.concatenate([[0], np.cumsum(known)])
    best = np.full(len(look) + 1, np.inf)
    best[0] = -PENALTY
    before = np.zeros(len(look) + 1, np.int64)
    for end in range(least, len(look) + 1):
        for begin in [0, *range(least, end - least + 1)]:
            seen = max(int(count[end] - count[begin]), 1)
            spread = square[end] - square[begin]
            spread -= float(((total[end] - total[begin]) ** 2).sum()) / seen
            cost = best[begin] + PENALTY + spread
            if cost < best[end] - 1e-9:
                best[end], before[end] = cost, begin
    cuts: list[int] = []
    at = int(before[len(look)])
    while at > 0:
        cuts.append(at)
        at = int(before[at])
    return cuts[::-1]


def _step(look: np.ndarray) -> float:
    """Return what counts as one step of colour: more where neighbours differ, as books do."""
    change = np.linalg.norm(np.diff(look, axis=0), axis=1)
    usual = float(np.nanmedian(change)) if np.isfinite(change).any() else 0.0
    return max(STEP, 2 * usual)


def part_rows(owners: np.ndarray, grid: OccupancyGrid) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], in which cupboards of a row have own numbers."""
    result = owners.copy()
    fresh = int(owners.max(initial=0))
    for _, cells in cells_by_owner(owners, grid.labels, SemanticClass.FURN):
        size_m = (np.ptp(cells, axis=0) + 1) * grid.voxel_m
        if size_m[:2].max() < LONG_M:
            continue
        parts = pieces(heap_of(grid, cells))[tuple((cells - cells.min(axis=0)).T)]
        moved = parts > 1
        result[tuple(cells[moved].T)] = fresh + parts[moved] - 1
        fresh += int(parts.max()) - 1
    return result


def pieces(heap: Heap) -> np.ndarray:
    """Return the piece, int32 [X, Y, Z] from 1, of each own cell; 0 elsewhere."""
    seeds = np.zeros(heap.own.shape, np.int32)
    hung = hung_cells(heap)
    for storey in (heap.own & ~hung, hung):
        for level in levels(heap.only(storey)):
            for arm in arms(level, heap):
                for piece in seams(heap.only(storey & arm[:, :, None])):
                    seeds[piece] = seeds.max() + 1
    return absorbed(_to_nearest(heap.own, seeds), heap)


def _to_nearest(own: np.ndarray, seeds: np.ndarray) -> np.ndarray:
    """Give every own cell the number of its seed, or of the nearest one; of equals the lowest."""
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

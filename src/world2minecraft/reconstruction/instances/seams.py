"""Where a row of cupboards changes along its front: in colour or in how deep it lies."""

from itertools import pairwise

import numpy as np

from world2minecraft.geometry.colour import oklab_of_srgb
from world2minecraft.reconstruction.instances.heap import Heap

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
    colour = oklab_of_srgb(np.moveaxis(heap.colour, (axis, across, 2), (0, 1, 2)))
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

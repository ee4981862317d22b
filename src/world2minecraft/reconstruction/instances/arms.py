"""The arms of an L or a U of furniture, each a rectangle of the plan."""

import numpy as np
from scipy import ndimage

from world2minecraft.reconstruction.instances.heap import Heap

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

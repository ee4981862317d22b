"""What hangs over something else of its class: a wall cupboard over a counter."""

import numpy as np
from scipy import ndimage

from world2minecraft.geometry.connected_components import connected_parts
from world2minecraft.reconstruction.instances.heap import Heap

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
    regions, count = connected_parts(bottoms > 0)
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

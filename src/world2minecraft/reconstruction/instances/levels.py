"""Plans of pieces that are each of about one height: a fridge beside a counter."""

import numpy as np
from scipy import ndimage

from world2minecraft.reconstruction.instances.heap import Heap

STEP_M = 0.2  # Tops of neighbours that differ by less are one piece: a hob, a sink, a box's lid.
LEAST_CELLS = 40  # A piece of fewer cells is no cupboard: at 0.08 m, a front of 0.5 m side.
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

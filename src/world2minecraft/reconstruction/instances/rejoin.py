"""What scans tear off: loose pieces join an object of their class near by, or become one."""

import numpy as np
from scipy.spatial import KDTree

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.connected_components import connected_parts

STANDING = (SemanticClass.CHAIR, SemanticClass.BED, SemanticClass.SOFA, SemanticClass.TABLE)
STANDING_BIT = 4  # Times ``min_cells``: 32 cells are the star of a chair's foot.


def rejoin(
    labels: np.ndarray, owners: np.ndarray, *, min_cells: int, join_radius: float
) -> np.ndarray:
    """Return owners in which no object is smaller than ``min_cells``.

    What stands on the floor is large: of chairs, beds, sofas and tables bits of some more cells
    join a neighbour too, where there is one.

    Loose pieces and too small objects join the nearest object of their own class within
    ``join_radius`` cells. A loose piece that finds none becomes an object where it is large
    enough; the rest belongs to none (owner 0).
    """
    result = owners.copy()
    for class_id in np.unique(labels[(labels >= 5) & (labels <= 11)]):
        bit = STANDING_BIT * min_cells if class_id in STANDING else min_cells
        _rejoin_class(labels == class_id, result, (min_cells, bit), join_radius)
    return result


def _rejoin_class(
    mask: np.ndarray, owners: np.ndarray, limits: tuple[int, int], join_radius: float
) -> None:
    min_cells, bit = limits
    sizes = np.bincount(owners[mask])
    small = np.flatnonzero((sizes > 0) & (sizes < bit))
    loose = mask & ((owners == 0) | np.isin(owners, small[small > 0]))
    if not loose.any():
        return
    kept = mask & ~loose
    owners[loose] = 0
    anchors = np.argwhere(kept)
    tree = KDTree(anchors) if len(anchors) else None
    fresh = int(owners.max())
    for cells in _grouped(loose):
        owner = _nearest(tree, anchors, owners, cells, join_radius)
        if owner == 0 and len(cells) >= min_cells:
            fresh += 1
            owner = fresh
        owners[tuple(cells.T)] = owner


def _grouped(loose: np.ndarray) -> list[np.ndarray]:
    """Return the cells, int64 [N, 3], of each connected piece."""
    pieces, _ = connected_parts(loose)
    cells = np.argwhere(pieces)
    numbers = pieces[tuple(cells.T)]
    order = np.argsort(numbers, kind="stable")
    ends = np.cumsum(np.bincount(numbers)[1:])[:-1]
    return np.split(cells[order], ends)


def _nearest(
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

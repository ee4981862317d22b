"""What hangs in the air: small pieces of cells that hold to nothing.

A piece is all occupied cells, of whatever classes, that hold together by faces, edges or corners.
It floats where it is small and not the largest of the scene: what holds to a wall, a floor or a
large piece is part of that piece. A piece with cells of structure floats only where it is smaller
than the smallest wall, however large one asks for: a ceiling without walls is no dirt. A lamp whose
cord was not seen floats by this rule too, so the list names its object.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import STRUCTURE_CLASSES
from world2minecraft.editing.scene.draft import SceneDraft
from world2minecraft.editing.scene.planes import WALL_M2
from world2minecraft.geometry.connected_components import label_components

# A football. In ten tuning rooms 13 pieces floated, 12 of them things that are truly there and had
# lost their hold: so one looks before deleting, and does not begin with large ones.
MAX_CELLS = 30


@dataclass(frozen=True, eq=False)
class Floater:
    """One piece: its cells int32 [N, 3], the class of most of them, the objects it is part of."""

    cells: np.ndarray
    class_id: int
    object_ids: tuple[int, ...]


def find_floaters(draft: SceneDraft, max_cells: int = MAX_CELLS) -> list[Floater]:
    """Return the pieces of at most ``max_cells`` that hold to nothing, the largest first."""
    occupied = (draft.labels > 0) & (draft.labels < 255)
    parts, count = label_components(occupied)
    sizes = np.bincount(parts.ravel(), minlength=count + 1)
    sizes[0] = 0
    small = (sizes > 0) & (sizes <= max_cells)
    built = np.unique(parts[np.isin(draft.labels, STRUCTURE_CLASSES)])
    small[built] &= sizes[built] < WALL_M2 / draft.voxel_m**2
    small[int(sizes.argmax())] = False
    at = np.argwhere(small[parts]).astype(np.int32)
    numbers = parts[tuple(at.T)]
    order = np.argsort(numbers, kind="stable")
    pieces = np.split(at[order], np.flatnonzero(np.diff(numbers[order])) + 1) if len(at) else []
    return sorted((_floater(draft, cells) for cells in pieces), key=_largest_first)


def _floater(draft: SceneDraft, cells: np.ndarray) -> Floater:
    owners = np.unique(draft.instance[tuple(cells.T)])
    class_id = int(np.bincount(draft.labels[tuple(cells.T)]).argmax())
    return Floater(cells, class_id, tuple(int(one) for one in owners if one))


def _largest_first(one: Floater) -> tuple:
    return (-len(one.cells), *map(int, one.cells[0]))

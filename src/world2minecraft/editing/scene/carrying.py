"""Cells that go where their object goes: whole cells, onto free ones, within the grid."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.core.coordinates import metres_to_cells
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import GridCells, Operation, SceneObject
from world2minecraft.editing.scene.draft import ARRAYS, SceneDraft
from world2minecraft.editing.scene.object_boxes import said, shifted
from world2minecraft.editing.scene.patch import Patch


def planned_shift(draft: SceneDraft, one: SceneObject, shift: np.ndarray, kind: str) -> Operation:
    """Return the operation that moves an object by whole cells, int [3].

    Raises:
        UsageError: it would leave the grid.
    """
    cells = draft.cells_of(one.id)
    check_within(draft, one, cells, shift)
    patch = Patch(draft)
    put_cells(draft, patch, one, cells, cells + shift)
    moved = shifted(one, shift * draft.voxel_m)
    return patch.planned(kind, objects=[moved], counts_as="move", class_id=one.class_id)


def put_cells(
    draft: SceneDraft, patch: Patch, one: SceneObject, cells: np.ndarray, there: np.ndarray
) -> None:
    """Carry what an object's cells hold to other cells, [N, 3] each, as far as they are free."""
    patch.empty(cells)
    free = is_free(draft, there) | (draft.instance[tuple(there.T)] == one.id)
    patch.put(there[free], some(draft.held(cells), free))


def cells_to(draft: SceneDraft, one: SceneObject, to_m: Sequence[float]) -> np.ndarray:
    """Return the whole cells, int64 [3], that bring an object's centre nearest to a point."""
    return np.floor((np.array(to_m) - one.center_m) / draft.voxel_m + 0.5).astype(np.int64)


def check_within(draft: SceneDraft, one: SceneObject, cells: np.ndarray, shift: np.ndarray) -> None:
    """Raise ``UsageError`` where an object that is shifted by cells, int [3], leaves the grid."""
    held = cells if len(cells) else middle_cell(draft, one)[None]
    if within_grid(draft, held + shift).all():
        return
    low, high = held.min(axis=0), held.max(axis=0)
    to = one.center_m + draft.voxel_m * np.stack([-low, np.array(draft.shape) - 1 - high])
    spans = [
        f"{name} {first:.2f} to {last:.2f}" for name, first, last in zip("xyz", *to, strict=True)
    ]
    raise UsageError(f"{said(one)} would leave the grid; its centre may be {', '.join(spans)} m")


def within_grid(draft: SceneDraft, cells: np.ndarray) -> np.ndarray:
    """Return whether each of cells int [N, 3] lies in the grid, bool [N]."""
    return np.asarray(((cells >= 0) & (cells < draft.shape)).all(axis=1))


def is_free(draft: SceneDraft, cells: np.ndarray) -> np.ndarray:
    """Return whether each of cells int [N, 3] lies in the grid and is empty or unseen, bool [N]."""
    inside = within_grid(draft, cells)
    at = np.where(inside[:, None], cells, 0)
    return inside & (draft.labels[tuple(at.T)] % 255 == 0)


def some(held: GridCells, mask: np.ndarray) -> GridCells:
    """Return what the cells hold that a bool mask [N] names."""
    return GridCells(*(getattr(held, name)[mask] for name in ARRAYS))


def owned(held: GridCells, number: int) -> GridCells:
    """Return what cells hold, as those of another object."""
    fields = {name: getattr(held, name) for name in ARRAYS}
    return GridCells(**fields | {"instance": np.full(len(held.labels), number, np.uint16)})


def middle_cell(draft: SceneDraft, one: SceneObject) -> np.ndarray:
    """Return the cell, int64 [3], that holds an object's centre."""
    return metres_to_cells(one.center_m, draft.origin_m, draft.voxel_m)

"""Clean-up of small holes in walls, floors and ceilings that are one block thick.

A hole is a small gap in one plane, surrounded by structure on all sides, through which the outside
is visible. Doorways and open windows are larger. Holes that contain an object are not closed.
"""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.editing.cleanup.draft_blocks import (
    free_cells,
    metres_to_blocks,
    structure_blocks,
)
from world2minecraft.editing.volume_draft import Draft
from world2minecraft.geometry.connected_components import label_components

HOLE_M = 0.5  # A hole is no larger than a square of this side.
SHELLS = (SemanticClass.WALL, SemanticClass.FLOOR, SemanticClass.CEILING)


def close_holes(draft: Draft) -> None:
    """Close the holes of a draft. Each repair is an edit."""
    solid, free = structure_blocks(draft), free_cells(draft)
    for axis in (1, 0, 2):
        for layer in range(draft.states.shape[axis]):
            plane = np.take(solid, layer, axis)
            if plane.any():
                _close_in_plane(draft, solid, free, axis, layer)


def _close_in_plane(
    draft: Draft, solid: np.ndarray, free: np.ndarray, axis: int, layer: int
) -> None:
    plane = np.take(solid, layer, axis)
    gaps, count = label_components(~plane, corners=False)
    sizes = np.bincount(gaps.ravel(), minlength=count + 1)
    most = metres_to_blocks(draft, HOLE_M) ** 2
    border = np.unique(np.concatenate([gaps[0], gaps[-1], gaps[:, 0], gaps[:, -1]]))
    for number in range(1, count + 1):
        if sizes[number] > most or number in border:
            continue
        flat = np.argwhere(gaps == number)
        cells = np.insert(flat, axis, layer, axis=1)
        beside = [one for one in (layer - 1, layer + 1) if 0 <= one < solid.shape[axis]]
        is_thin = not any(np.take(solid, one, axis)[tuple(flat.T)].any() for one in beside)
        if is_thin and free[tuple(cells.T)].all():
            _fill(draft, cells, _rim(cells, axis, solid), axis)


def _rim(cells: np.ndarray, axis: int, solid: np.ndarray) -> np.ndarray:
    """Return the structure cells around a hole in its plane."""
    steps = np.delete(np.eye(3, dtype=int), axis, axis=0)
    around = np.concatenate([cells + side * step for step in steps for side in (-1, 1)])
    return np.unique(around[solid[tuple(around.T)]], axis=0)


def _fill(draft: Draft, cells: np.ndarray, rim: np.ndarray, axis: int) -> None:
    """Fill a hole with the most frequent block and class around it."""
    classes = draft.semantic[tuple(rim.T)]
    wanted = SHELLS[1:] if axis == 1 else SHELLS[:1]
    counts = {int(kind): int((classes == kind).sum()) for kind in wanted}
    kind = max(counts, key=lambda one: counts[one])
    if counts[kind] * 2 < len(rim):
        return  # A niche between other surfaces, not a hole in this one.
    of_kind = rim[classes == kind]
    numbers = draft.states[tuple(of_kind.T)]
    state = draft.palette[np.bincount(numbers).argmax()]
    name = SemanticClass(kind).name.lower()
    draft.fill("fill", cells, state, as_class=kind, reason=f"hole in the {name}", class_id=kind)

"""Questions about the cells of a scene: what floats, where holes are, how it differs."""

from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from world2minecraft.core.classes import CLASS_NAMES, UNKNOWN
from world2minecraft.core.errors import UsageError
from world2minecraft.editing.scene.difference import difference
from world2minecraft.editing.scene.draft import SceneDraft
from world2minecraft.editing.scene.floaters import MAX_CELLS, find_floaters
from world2minecraft.editing.scene.holes import HOLE_M2, hole_cells, plane_gaps
from world2minecraft.editing.scene.planes import find_planes
from world2minecraft.editing.scene.runs import runs_of_cells
from world2minecraft.evaluation.metrics.occupancy import count_occupancy
from world2minecraft.sceneforge.comparison import labels_of_file, labels_of_truth, truth_folder
from world2minecraft.sceneforge.query import QueriedScene, Query

OPENED, TRUTH = "opened", "truth"
DECIMALS = 4


class Floaters(Query):
    """Pieces of at most ``max_cells`` that hold to nothing, the largest first."""

    max_cells: Annotated[int, Field(ge=1)] = MAX_CELLS

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``[{"cells", "runs", "class_id", "object_ids", "at_m"}]``."""
        draft = scene.draft
        scene.progress("pieces", 0, 0)
        return [
            {
                "cells": len(one.cells),
                "runs": runs_of_cells(one.cells, draft.shape).tolist(),
                "class_id": one.class_id,
                "object_ids": list(one.object_ids),
                "at_m": middle_m(draft, one.cells),
            }
            for one in find_floaters(draft, self.max_cells)
        ]


class Holes(Query):
    """The planes of the room, and the holes and openings of each.

    ``share`` is the part of the plane that is holes; openings, such as doors, are left out of it.
    ``runs`` are the cells that ``fill_holes`` would fill, ``openings`` what it leaves open unless
    a cell of it is named.
    """

    hole_m2: Annotated[float, Field(ge=0)] = HOLE_M2

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``[{"plane", "class_id", "axis", "at_m", "area_m2", "share", "cells", "runs",
        "openings"}]``, floors and ceilings first.
        """  # noqa: D205
        draft, rows, progress = scene.draft, [], scene.progress
        progress("planes", 0, 0)
        planes = find_planes(draft)
        for done, plane in enumerate(planes):
            progress("planes", done, len(planes))
            gaps = plane_gaps(draft, plane, hole_m2=self.hole_m2)
            holes = hole_cells(draft, gaps, gaps.holes)
            area = int(gaps.own[plane.window].sum() + gaps.holes.sum())
            at_m = draft.origin_m[plane.axis] + (plane.layer + 0.5) * draft.voxel_m
            openings = hole_cells(draft, gaps, gaps.openings)
            rows.append(
                {
                    "plane": plane.name,
                    "class_id": plane.class_id,
                    "axis": plane.axis,
                    "at_m": round(float(at_m), DECIMALS),
                    "area_m2": round(area * draft.voxel_m**2, 3),
                    "share": round(gaps.share, DECIMALS),
                    "cells": len(holes),
                    "runs": runs_of_cells(holes, draft.shape).tolist(),
                    "openings": runs_of_cells(openings, draft.shape).tolist(),
                }
            )
        return rows


class Compare(Query):
    """How the scene differs from another occupancy of the same room, and the IoU.

    ``path`` is a file in the scene's folder, such as a prediction; or ``truth``, of a generated
    room that was scanned; or ``opened``: the scene as it was when it was opened, its unseen cells
    taken for empty. The other one counts as the truth.
    """

    path: Annotated[str, Field(max_length=1000)] = OPENED

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``{"added", "removed", "changed"}`` runs, ``cells`` of each and the figures."""
        return compared(scene.draft, self._other(scene))

    def _other(self, scene: QueriedScene) -> np.ndarray:
        if self.path == OPENED:
            labels = scene.opened.grid.labels
            return np.where(labels == UNKNOWN, 0, labels).astype(np.uint8)
        folder = scene.opened.folder
        if self.path != TRUTH:
            return labels_of_file(file_within(folder, self.path), scene.draft)
        place = truth_folder(folder, None)
        if place is None:
            raise UsageError("no truth lies in the scene's folder; only generated rooms have one")
        return labels_of_truth(place, scene.draft, scene.opened.scan_to_room)


def compared(draft: SceneDraft, other: np.ndarray) -> dict[str, Any]:
    """Return what ``compare`` answers for other labels uint8 [X, Y, Z] in the scene's cells."""
    found = difference(draft.labels, other)
    masks = {"added": found.added, "removed": found.removed, "changed": found.changed}
    counts = count_occupancy(draft.labels, other)
    classes = zip(CLASS_NAMES[1:], counts.class_iou[1:].tolist(), strict=True)
    return {
        **{name: runs_of_mask(mask, draft) for name, mask in masks.items()},
        "cells": {name: int(mask.sum()) for name, mask in masks.items()},
        "iou": round(counts.iou, DECIMALS),
        "miou": round(counts.miou_present, DECIMALS),
        "class_iou": {name: round(iou, DECIMALS) for name, iou in classes},
    }


def file_within(folder: Path, path: str) -> Path:
    """Return a file in a folder or below it.

    Raises:
        UsageError: the path leads out of it.
    """
    place = (folder / path).resolve()
    if not place.is_relative_to(folder.resolve()):
        raise UsageError(f"{path[:80]!r} lies outside the scene's folder: copy the file into it")
    return place


def runs_of_mask(mask: np.ndarray, draft: SceneDraft) -> list[list[int]]:
    """Return the runs of a mask bool [X, Y, Z]."""
    return runs_of_cells(np.argwhere(mask), draft.shape).tolist()


def middle_m(draft: SceneDraft, cells: np.ndarray) -> list[float]:
    """Return the middle of cells int [N, 3] in the room, rounded to a millimetre."""
    return np.round(draft.origin_m + (cells.mean(axis=0) + 0.5) * draft.voxel_m, 3).tolist()


CELL_QUERIES: dict[str, type[Query]] = {
    "floaters": Floaters,
    "holes": Holes,
    "compare": Compare,
}

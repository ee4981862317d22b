"""Read-only queries about a scene, which ``Editor.ask`` and ``POST /api/ask`` answer by name.

Like a command, a query is a small validated object. To add a query, define a class and register it
in ``QUERIES``.
"""

from abc import abstractmethod
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Protocol

import numpy as np
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from world2minecraft.core.classes import CLASS_NAMES, UNKNOWN
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.progress import Progress
from world2minecraft.core.vocabulary import object_title
from world2minecraft.editing.scene import SceneDraft
from world2minecraft.editing.scene.cell_patch import runs_of_cells
from world2minecraft.editing.scene.command_registry import first_error
from world2minecraft.editing.scene.diagnostics import Diagnostic, find_diagnostics, rank_diagnostics
from world2minecraft.editing.scene.difference import compare_labels
from world2minecraft.editing.scene.furniture_commands import ObjectClass
from world2minecraft.editing.scene.object_boxes import object_by_id
from world2minecraft.editing.scene.object_conversion import instance_of, placements_of
from world2minecraft.editing.scene.object_transforms import Id
from world2minecraft.editing.scene.plane_detection import find_planes
from world2minecraft.editing.scene.repair import (
    HOLE_M2,
    MAX_CELLS,
    find_floaters,
    hole_cells,
    plane_gaps,
)
from world2minecraft.furniture.layout_checks import collisions, out_of_rooms
from world2minecraft.reconstruction.instances import InstanceParameters
from world2minecraft.reconstruction.instances.density_clustering import (
    candidate_cells,
    centroids,
    cluster_candidates,
    density_map,
    object_cells,
)
from world2minecraft.reconstruction.retrieval import ranked_matches
from world2minecraft.sceneforge.comparison import (
    Reference,
    find_truth_folder,
    read_file_labels,
    read_truth,
)
from world2minecraft.sceneforge.scene_sources import OpenedScene
from world2minecraft.sceneforge.wire_format import counts_json

OPENED, TRUTH = "opened", "truth"
DECIMALS = 4
OFFERED = 5
MIN_DOUBT = 0.3  # Less doubtful places are not listed.
MAX_PLACES = 200


class QueriedScene(Protocol):
    """The part of a scene that a query may read. An open ``Editor`` satisfies this protocol."""

    progress: Progress

    @property
    def draft(self) -> SceneDraft:
        """The current scene."""
        ...

    @property
    def opened(self) -> OpenedScene:
        """The scene as it was first opened."""
        ...


class Query(BaseModel):
    """A read-only query about a scene, with validated fields."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    @abstractmethod
    def answer(self, scene: QueriedScene) -> Any:
        """Return the answer as JSON values.

        Raises:
            UsageError: If the query cannot be answered for this scene. The message states the
                reason.
        """


class Floaters(Query):
    """Unsupported pieces of at most ``max_cells`` cells, largest first."""

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
    """The planes of the room (floors, ceilings and walls) with their holes and openings.

    ``share`` is the fraction of the plane that is holes. It does not include openings such as
    doors. ``runs`` are the cells that ``fill_holes`` would fill. ``openings`` are the cells that
    ``fill_holes`` leaves open unless it is given a cell of the opening.
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
    """The differences between the scene and another occupancy of the same room, with the IoU.

    ``path`` names the reference: a file in the scene's folder, such as a prediction; ``truth`` for
    the ground truth of a generated room that was scanned; or ``opened`` for the scene as it was
    first opened, with unseen cells treated as empty.
    """

    path: Annotated[str, Field(max_length=1000)] = OPENED

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``added``, ``removed`` and ``changed`` runs, their ``cells``, and the IoUs."""
        return compare_draft(scene.draft, self._other(scene))

    def _other(self, scene: QueriedScene) -> Reference:
        if self.path == OPENED:
            labels = scene.opened.grid.labels
            return Reference(np.where(labels == UNKNOWN, 0, labels).astype(np.uint8))
        folder = scene.opened.folder
        if self.path != TRUTH:
            return Reference(read_file_labels(file_within(folder, self.path), scene.draft))
        place = find_truth_folder(folder, None)
        if place is None:
            raise UsageError("no ground truth in the scene's folder; only generated rooms have one")
        return read_truth(folder, place, scene.draft, scene.opened.scan_to_room)


def compare_draft(draft: SceneDraft, other: Reference) -> dict[str, Any]:
    """Return the answer of ``compare`` for a reference in the cells of the scene."""
    found = compare_labels(draft.labels, other.labels)
    masks = {"added": found.added, "removed": found.removed, "changed": found.changed}
    counts = other.counts(draft.labels)
    classes = zip(CLASS_NAMES[1:], counts.class_iou[1:].tolist(), strict=True)
    return {
        **{name: runs_of_mask(mask, draft) for name, mask in masks.items()},
        "cells": {name: int(mask.sum()) for name, mask in masks.items()},
        "iou": round(counts.iou, DECIMALS),
        "miou": round(counts.miou_present, DECIMALS),
        "class_iou": {name: round(iou, DECIMALS) for name, iou in classes},
    }


def file_within(folder: Path, path: str) -> Path:
    """Return the path of a file in a folder or below it.

    Raises:
        UsageError: If the path leads out of the folder or contains a null character.
    """
    try:
        place = (folder / path).resolve()
    except ValueError as error:  # A null character.
        raise UsageError(f"invalid file name {path[:80]!r}") from error
    if not place.is_relative_to(folder.resolve()):
        raise UsageError(f"{path[:80]!r} is outside the scene's folder; copy the file into it")
    return place


def runs_of_mask(mask: np.ndarray, draft: SceneDraft) -> list[list[int]]:
    """Return the runs of the True cells of a mask bool [X, Y, Z]."""
    return runs_of_cells(np.argwhere(mask), draft.shape).tolist()


def middle_m(draft: SceneDraft, cells: np.ndarray) -> list[float]:
    """Return the centre of cells int [N, 3] in room coordinates, rounded to a millimetre."""
    return np.round(draft.origin_m + (cells.mean(axis=0) + 0.5) * draft.voxel_m, 3).tolist()


CELL_QUERIES: dict[str, type[Query]] = {
    "floaters": Floaters,
    "holes": Holes,
    "compare": Compare,
}


def _odd(value: int) -> int:
    if value % 2 == 0:
        raise ValueError("density_kernel must be odd")
    return value


class Alternatives(Query):
    """The five best furniture templates for an object, each at its best rotation, with IoU."""

    id: Id

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``[{"template", "quarter_turns", "iou"}]``, best first; empty without cells."""
        one = object_by_id(scene.draft, self.id)
        found = instance_of(one, scene.draft.cells_of(one.id))
        rows = ranked_matches(scene.draft.grid(), found, OFFERED, scene.opened.rooms)
        return [{"template": name, "quarter_turns": turns, "iou": iou} for name, turns, iou in rows]


class Centers(Query):
    """The object centres that given clustering parameters yield, as a preview without changes.

    ``recluster`` uses these clusters: it splits objects that span several clusters, and merges
    objects that share a cluster.
    """

    density_kernel: Annotated[int, Field(ge=1, le=31), AfterValidator(_odd)]
    density_threshold: Annotated[float, Field(ge=0, le=1)]
    cluster_radius: Annotated[float, Field(gt=0, le=100)]
    class_id: ObjectClass | None = None

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``[{"class_id", "at_m", "cells"}]``: each centre with the number of its cells."""
        draft = scene.draft
        binary = object_cells(draft.labels)
        density = density_map(binary, self.density_kernel)
        if self.class_id is not None:
            binary &= draft.labels == self.class_id
        candidates = candidate_cells(binary, density, self.density_threshold)
        classes = draft.labels[tuple(candidates.T)]
        samples = InstanceParameters.min_samples
        clusters = cluster_candidates(candidates, classes, self.cluster_radius, samples)
        middles_m = draft.origin_m + (centroids(candidates, clusters) + 0.5) * draft.voxel_m
        kinds = dict(zip(clusters.tolist(), classes.tolist(), strict=True))
        counts = np.bincount(clusters[clusters >= 0], minlength=len(middles_m)).tolist()
        return [
            {"class_id": kinds[n], "at_m": np.round(at, 4).tolist(), "cells": counts[n]}
            for n, at in enumerate(middles_m)
        ]


class Warnings(Query):
    """Furniture that collides or extends beyond its room, by the metrics of the report."""

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``[{"kind": "collision" or "outside", "ids", "at_m"}]``, sorted by id."""
        return list(_clashes(scene))


class Doubtful(Query):
    """Places that may need correction, most doubtful first, each with the reason in ``why``.

    ``kind`` is ``outside``, ``collision``, ``floater``, ``unsupported``, ``low_iou``, ``near_tie``,
    ``no_template`` (built from its cells), ``low_confidence``, ``unsure_cells``, ``crumb`` or
    ``completed``.
    """

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``[{"at_m", "why", "kind", "doubt", "object_id"}]``.

        ``doubt`` is 0 to 1, and ``object_id`` is null if the place belongs to no object.
        """
        found = rank_diagnostics(
            [*_clash_doubts(scene), *find_diagnostics(scene.draft, scene.progress)]
        )
        return [
            {
                "at_m": np.round(one.at_m, 3).tolist(),
                "why": one.why,
                "kind": one.kind,
                "doubt": round(one.doubt, 3),
                "object_id": one.object_id or None,
            }
            for one in found[:MAX_PLACES]
            if one.doubt >= MIN_DOUBT
        ]


def _clash_doubts(scene: QueriedScene) -> Iterator[Diagnostic]:
    for clash in _clashes(scene):
        number = clash["ids"][-1]
        one = scene.draft.objects[number]
        name = object_title(one.name, one.class_id)
        doubt, why = 1.0, f"{name}: extends beyond the room"
        if clash["kind"] == "collision":
            other = scene.draft.objects[clash["ids"][0]]
            title = object_title(other.name, other.class_id)
            doubt, why = 0.95, f"{name}: collides with {title} {other.id}"
        yield Diagnostic(clash["kind"], why, doubt, np.array(clash["at_m"]), number)


def _clashes(scene: QueriedScene) -> Iterator[dict[str, Any]]:
    placed = placements_of(scene.draft.objects.values())
    for m, n in collisions(placed, grid=scene.draft.grid()):
        middle = np.round((placed[m].center_m + placed[n].center_m) / 2, 3).tolist()
        ids = [placed[m].object_id, placed[n].object_id]
        yield {"kind": "collision", "ids": ids, "at_m": middle}
    for index in out_of_rooms(placed, scene.opened.rooms):
        at_m = np.round(placed[index].center_m, 3).tolist()
        yield {"kind": "outside", "ids": [placed[index].object_id], "at_m": at_m}


OBJECT_QUERIES: dict[str, type[Query]] = {
    "alternatives": Alternatives,
    "centers": Centers,
    "doubtful": Doubtful,
    "warnings": Warnings,
}


class Counts(Query):
    """The number of cells of each class, and the number of objects."""

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``{"cells": [number for each class id], "objects": number}``."""
        counts = counts_json(scene.draft.counts)
        return {"cells": counts, "objects": len(scene.draft.objects)}


QUERIES: dict[str, type[Query]] = {"counts": Counts, **CELL_QUERIES, **OBJECT_QUERIES}


def parse_query(name: str, fields: dict[str, Any]) -> Query:
    """Return the query of a given name with its fields.

    Raises:
        UnknownNameError: If no query has this name.
        UsageError: If a field is invalid. The message names the field.
    """
    if name not in QUERIES:
        raise UnknownNameError("query", name, QUERIES)
    try:
        return QUERIES[name].model_validate(fields)
    except ValidationError as error:
        raise UsageError(first_error(name, error)) from error

"""Questions about the objects of a scene: other furniture, centres, clashes, doubtful places."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from pydantic import AfterValidator, Field

from world2minecraft.edit.scene.boxes import object_named
from world2minecraft.edit.scene.furnishing import ObjectClass
from world2minecraft.edit.scene.objects import Id
from world2minecraft.edit.scene.objects_of import instance_of, placements_of
from world2minecraft.find import FindParameters
from world2minecraft.find.clusters import centroids, cluster_candidates
from world2minecraft.find.density import candidate_cells, density_map, object_cells
from world2minecraft.forge.query import Query
from world2minecraft.furnish import ranked_matches
from world2minecraft.geometry.parts import connected_parts
from world2minecraft.metrics.layout import collisions, floaters, out_of_rooms

if TYPE_CHECKING:
    from world2minecraft.edit.scene import SceneDraft
    from world2minecraft.forge.editor import Editor

OFFERED = 5
LEAST_DOUBT = 0.3  # Of what is surer than this nobody needs to be told.
UNSURE = 0.5  # The confidence under which a cell is rather wrong than right.
UNSURE_CELLS = 30  # About 0.2 m2 at 0.08 m; fewer are the edges of things.
MOST_PLACES = 200


def _odd(value: int) -> int:
    if value % 2 == 0:
        raise ValueError("density_kernel must be odd")
    return value


class Alternatives(Query):
    """The best five templates for an object, each in its best turn, with the IoU of its cells."""

    id: Id

    def answer(self, editor: "Editor") -> Any:
        """Return ``[{"template", "quarter_turns", "iou"}]``, best first; none without cells."""
        one = object_named(editor.draft, self.id)
        found = instance_of(one, editor.draft.cells_of(one.id))
        rows = ranked_matches(editor.draft.grid(), found, OFFERED)
        return [{"template": name, "quarter_turns": turns, "iou": iou} for name, turns, iou in rows]


class Centers(Query):
    """The paper's centres for some figures of its clustering, as a preview; nothing is changed.

    ``recluster`` goes on from these clusters: it parts what they join and joins what they part.
    """

    density_kernel: Annotated[int, Field(ge=1, le=31), AfterValidator(_odd)]
    density_threshold: Annotated[float, Field(ge=0, le=1)]
    cluster_radius: Annotated[float, Field(gt=0, le=100)]
    class_id: ObjectClass | None = None

    def answer(self, editor: "Editor") -> Any:
        """Return ``[{"class_id", "at_m", "cells"}]``: a centre and how many cells it has."""
        draft = editor.draft
        binary = object_cells(draft.labels)
        density = density_map(binary, self.density_kernel)
        if self.class_id is not None:
            binary &= draft.labels == self.class_id
        candidates = candidate_cells(binary, density, self.density_threshold)
        classes = draft.labels[tuple(candidates.T)]
        samples = FindParameters.min_samples
        clusters = cluster_candidates(candidates, classes, self.cluster_radius, samples)
        middles_m = draft.origin_m + (centroids(candidates, clusters) + 0.5) * draft.voxel_m
        kinds = dict(zip(clusters.tolist(), classes.tolist(), strict=True))
        counts = np.bincount(clusters[clusters >= 0], minlength=len(middles_m)).tolist()
        return [
            {"class_id": kinds[n], "at_m": np.round(at, 4).tolist(), "cells": counts[n]}
            for n, at in enumerate(middles_m)
        ]


class Warnings(Query):
    """Furniture that collides or reaches out of its room, by the metrics of the report."""

    def answer(self, editor: "Editor") -> Any:
        """Return ``[{"kind": "collision" or "outside", "ids", "at_m"}]``, in the order of ids."""
        return list(_clashes(editor))


class Doubtful(Query):
    """Places worth a look, the most doubtful first.

    ``why`` is ``outside``, ``collision``, ``floater``, ``no_template`` (built from its cells),
    ``low_iou``, ``low_confidence`` or ``unsure_cells``.
    """

    def answer(self, editor: "Editor") -> Any:
        """Return ``[{"at_m", "why", "doubt" 0 to 1, "object_id" or null}]``."""
        found = [*_doubtful_objects(editor), *_doubtful_cells(editor.draft)]
        seen: set[int] = set()
        rows = []
        for doubt, why, number, at in sorted(found, key=lambda row: (-row[0], row[1], row[2])):
            if number in seen or doubt < LEAST_DOUBT:
                continue
            seen |= {number} if number else set()
            at_m = np.round(at, 3).tolist()
            row = {"at_m": at_m, "why": why, "doubt": round(doubt, 3), "object_id": number or None}
            rows.append(row)
        return rows[:MOST_PLACES]


Doubt = tuple[float, str, int, np.ndarray]  # How much, why, the object or 0, where.


def _clashes(editor: "Editor") -> Iterator[dict[str, Any]]:
    placed = placements_of(editor.draft.objects.values())
    for m, n in collisions(placed, grid=editor.draft.grid()):
        middle = np.round((placed[m].center_m + placed[n].center_m) / 2, 3).tolist()
        ids = [placed[m].object_id, placed[n].object_id]
        yield {"kind": "collision", "ids": ids, "at_m": middle}
    rooms = editor.opened.rooms
    for index in out_of_rooms(placed, rooms) if rooms else ():
        at_m = np.round(placed[index].center_m, 3).tolist()
        yield {"kind": "outside", "ids": [placed[index].object_id], "at_m": at_m}


def _doubtful_objects(editor: "Editor") -> Iterator[Doubt]:
    objects = editor.draft.objects
    for clash in _clashes(editor):
        doubt = 1.0 if clash["kind"] == "outside" else 0.95
        yield doubt, clash["kind"], clash["ids"][-1], np.array(clash["at_m"])
    for one in objects.values():
        yield 1 - one.confidence, "low_confidence", one.id, one.center_m
        if one.confidence == 1:
            continue  # A person has looked at it.
        for placed in one.placements:
            why = "no_template" if placed.template == "cells" else "low_iou"
            yield 1 - placed.iou, why, one.id, placed.center_m


def _doubtful_cells(draft: "SceneDraft") -> Iterator[Doubt]:
    unsure = (draft.labels % 255 > 0) & (draft.confidence < UNSURE) & (draft.instance == 0)
    for mask, why, least in (
        (floaters(draft.labels).mask, "floater", 1),
        (unsure, "unsure_cells", UNSURE_CELLS),
    ):
        parts, count = connected_parts(mask)
        sizes = np.bincount(parts.ravel(), minlength=count + 1)
        for number in np.flatnonzero(sizes[1:] >= least) + 1:
            cells = np.argwhere(parts == number)
            held = draft.confidence[tuple(cells.T)].astype(np.float64)
            doubt = 0.97 if why == "floater" else float(1 - held.mean())
            owner = int(np.bincount(draft.instance[tuple(cells.T)]).argmax())
            at_m = draft.origin_m + (cells.mean(axis=0) + 0.5) * draft.voxel_m
            yield doubt, why, owner if owner in draft.objects else 0, at_m


OBJECT_QUERIES: dict[str, type[Query]] = {
    "alternatives": Alternatives,
    "centers": Centers,
    "doubtful": Doubtful,
    "warnings": Warnings,
}

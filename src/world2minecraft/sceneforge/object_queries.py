"""Questions about the objects of a scene: other furniture, centres, clashes, doubtful places."""

from collections.abc import Iterator
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, Field

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.editing.scene.diagnostics import Doubt, find_doubts, ordered
from world2minecraft.editing.scene.furniture_commands import ObjectClass
from world2minecraft.editing.scene.object_boxes import object_named
from world2minecraft.editing.scene.objects import Id
from world2minecraft.editing.scene.objects_of import instance_of, placements_of
from world2minecraft.furniture.layout_checks import collisions, out_of_rooms
from world2minecraft.reconstruction.instances import FindParameters
from world2minecraft.reconstruction.instances.clusters import centroids, cluster_candidates
from world2minecraft.reconstruction.instances.density import (
    candidate_cells,
    density_map,
    object_cells,
)
from world2minecraft.reconstruction.retrieval import ranked_matches
from world2minecraft.sceneforge.query import QueriedScene, Query

OFFERED = 5
LEAST_DOUBT = 0.3  # Of what is surer than this nobody needs to be told.
MOST_PLACES = 200


def _odd(value: int) -> int:
    if value % 2 == 0:
        raise ValueError("density_kernel must be odd")
    return value


class Alternatives(Query):
    """The best five templates for an object, each in its best turn, with the IoU of its cells."""

    id: Id

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``[{"template", "quarter_turns", "iou"}]``, best first; none without cells."""
        one = object_named(scene.draft, self.id)
        found = instance_of(one, scene.draft.cells_of(one.id))
        rows = ranked_matches(scene.draft.grid(), found, OFFERED, scene.opened.rooms)
        return [{"template": name, "quarter_turns": turns, "iou": iou} for name, turns, iou in rows]


class Centers(Query):
    """The paper's centres for some figures of its clustering, as a preview; nothing is changed.

    ``recluster`` goes on from these clusters: it parts what they join and joins what they part.
    """

    density_kernel: Annotated[int, Field(ge=1, le=31), AfterValidator(_odd)]
    density_threshold: Annotated[float, Field(ge=0, le=1)]
    cluster_radius: Annotated[float, Field(gt=0, le=100)]
    class_id: ObjectClass | None = None

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``[{"class_id", "at_m", "cells"}]``: a centre and how many cells it has."""
        draft = scene.draft
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

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``[{"kind": "collision" or "outside", "ids", "at_m"}]``, in the order of ids."""
        return list(_clashes(scene))


class Doubtful(Query):
    """Places worth a look, the most doubtful first, each with the reason in ``why``.

    ``kind`` is ``outside``, ``collision``, ``floater``, ``unsupported``, ``low_iou``,
    ``near_tie``, ``no_template`` (built from its cells), ``low_confidence``, ``unsure_cells``,
    ``crumb`` or ``completed``.
    """

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``[{"at_m", "why", "kind", "doubt" 0 to 1, "object_id" or null}]``."""
        found = ordered([*_clash_doubts(scene), *find_doubts(scene.draft, scene.progress)])
        return [
            {
                "at_m": np.round(one.at_m, 3).tolist(),
                "why": one.why,
                "kind": one.kind,
                "doubt": round(one.doubt, 3),
                "object_id": one.object_id or None,
            }
            for one in found[:MOST_PLACES]
            if one.doubt >= LEAST_DOUBT
        ]


def _clash_doubts(scene: QueriedScene) -> Iterator[Doubt]:
    for clash in _clashes(scene):
        number = clash["ids"][-1]
        name = CLASS_NAMES[scene.draft.objects[number].class_id]
        doubt, why = 1.0, f"this {name} reaches out of its room"
        if clash["kind"] == "collision":
            other = scene.draft.objects[clash["ids"][0]]
            doubt, why = 0.95, f"this {name} and {CLASS_NAMES[other.class_id]} {other.id} collide"
        yield Doubt(clash["kind"], why, doubt, np.array(clash["at_m"]), number)


def _clashes(scene: QueriedScene) -> Iterator[dict[str, Any]]:
    placed = placements_of(scene.draft.objects.values())
    for m, n in collisions(placed, grid=scene.draft.grid()):
        middle = np.round((placed[m].center_m + placed[n].center_m) / 2, 3).tolist()
        ids = [placed[m].object_id, placed[n].object_id]
        yield {"kind": "collision", "ids": ids, "at_m": middle}
    rooms = scene.opened.rooms
    for index in out_of_rooms(placed, rooms) if rooms else ():
        at_m = np.round(placed[index].center_m, 3).tolist()
        yield {"kind": "outside", "ids": [placed[index].object_id], "at_m": at_m}


OBJECT_QUERIES: dict[str, type[Query]] = {
    "alternatives": Alternatives,
    "centers": Centers,
    "doubtful": Doubtful,
    "warnings": Warnings,
}

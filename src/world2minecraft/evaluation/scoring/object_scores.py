"""Score the objects of a run: against those of the truth, and for physical sense.

Objects are matched with the true ones: found where they are, as what they are, and turned. The
layout is judged by collisions, bounds and the classes that got lost.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.core.coordinates import apply
from world2minecraft.core.types import Layout, LayoutObject, OccupancyGrid
from world2minecraft.evaluation.metrics.objects import ObjectCounts, count_objects, match_objects
from world2minecraft.evaluation.scoring.observed_cells import Reached
from world2minecraft.evaluation.scoring.truth_files import Truth, read_instances
from world2minecraft.formats.layout import read_rooms
from world2minecraft.formats.objects_and_placements import read_placements
from world2minecraft.furniture.layout_checks import category_integrity, collisions, out_of_rooms


@dataclass(frozen=True, eq=False)
class TrueObjects:
    """The true objects in the estimated room frame, and which of them a ray met."""

    objects: tuple[LayoutObject, ...]
    seen: np.ndarray  # bool [N]
    have_fronts: bool = True  # Whether the truth knows which way chairs, sofas and beds look.


def true_objects(truth: Truth, truth_to_room: np.ndarray, reached: Reached) -> TrueObjects:
    """Carry the objects into the room and tell which of them were seen."""
    turn = math.degrees(math.atan2(truth_to_room[1, 0], truth_to_room[0, 0]))
    moved = tuple(
        replace(
            item, center_m=apply(truth_to_room, item.center_m), yaw_deg=(item.yaw_deg + turn) % 360
        )
        for item in truth.objects
    )
    seen = np.zeros(len(moved) + 1, bool)
    if moved:
        met = read_instances(truth).reshape(-1)[reached.voxels]
        seen[met[met <= len(moved)]] = True
    return TrueObjects(moved, seen[1:], not truth.is_partial)


def object_counts(found: Sequence[Any], true: TrueObjects) -> ObjectCounts:
    """Count the objects of a run; nobody asks for those that no ray met."""
    matched = {n for _, n in match_objects(found, true.objects)}
    expected = [item for n, item in enumerate(true.objects) if bool(true.seen[n]) or n in matched]
    counts = count_objects(found, expected)
    return counts if true.have_fronts else replace(counts, turns_asked=0, turns_right=0)


def object_facts(counts: ObjectCounts) -> dict[str, Any]:
    """Return the object scores by name, and those of each class that is there or was found."""
    rows = {
        CLASS_NAMES[n]: {
            "found": int(counts.found[n]),
            "true": int(counts.true[n]),
            "matched": int(counts.matched[n]),
            "f1": float(counts.class_f1[n]),
        }
        for n in OBJECT_CLASSES
        if counts.found[n] + counts.true[n]
    }
    return {
        "f1": counts.f1,
        "precision": counts.precision,
        "recall": counts.recall,
        "found": int(counts.found.sum()),
        "true": int(counts.true.sum()),
        "matched": int(counts.matched.sum()),
        "orientation_right": counts.orientation_right,
        "orientation_asked": counts.turns_asked,
        "orientation_hits": counts.turns_right,
        "by_class": rows,
    }


def layout_facts(
    out: Path, grid: OccupancyGrid, true_rooms: Sequence[Layout], objects: TrueObjects
) -> dict[str, Any]:
    """Return the counts of the placements of a run; empty where it was not furnished.

    ``out_of_bounds`` is judged by the rooms that the run itself found, ``out_of_true_rooms`` by
    the true ones; an object may stand in any of several rooms. ``semantic_integrity`` is the
    share of the object classes that were seen in the true room and were placed.

    Args:
        out: the folder of the run.
        grid: its ``room.npz``.
        true_rooms: the true rooms in the room frame.
        objects: the true objects.
    """
    if not (out / "placements.json").is_file():
        return {}
    placements = read_placements(out / "placements.json")
    pairs = zip(objects.objects, objects.seen, strict=True)
    judged = {"out_of_true_rooms": _outside(placements, true_rooms)} if true_rooms else {}
    return judged | {
        "placements": len(placements),
        "collisions": len(collisions(placements, grid=grid)),
        "out_of_bounds": _outside(placements, read_rooms(out, grid)),
        "semantic_integrity": category_integrity(
            {item.class_id for item in placements}, {item.class_id for item, seen in pairs if seen}
        ),
    }


def in_room(layouts: Sequence[Layout], truth_to_room: np.ndarray) -> tuple[Layout, ...]:
    """Carry the outlines of true rooms into the estimated frame; their openings stay behind."""
    moved = []
    for layout in layouts:
        heights = np.full((len(layout.floor_polygon_m), 1), layout.floor_z_m)
        corners = apply(truth_to_room, np.hstack([layout.floor_polygon_m, heights]))
        floor = float(corners[:, 2].mean())
        moved.append(
            replace(
                layout, floor_polygon_m=corners[:, :2], floor_z_m=floor, openings=(), objects=()
            )
        )
    return tuple(moved)


def _outside(placements: Sequence[Any], rooms: Sequence[Layout]) -> int:
    """Return how many placements lie wholly within none of the rooms, where any are known."""
    return len(out_of_rooms(placements, rooms)) if rooms else 0

"""Scores of a run's objects against the ground truth, and of its layout.

Objects are matched to true objects by class and position, and their orientation is compared. The
layout is assessed by collisions, bounds and missing classes.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.core.coordinates import apply
from world2minecraft.core.types import Layout, LayoutObject, ObjectInstance, OccupancyGrid
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.evaluation.metrics.objects import ObjectCounts, count_objects, match_objects
from world2minecraft.evaluation.scoring.observed_cells import Reached
from world2minecraft.evaluation.scoring.pose_errors import floor_corners
from world2minecraft.evaluation.scoring.truth_files import Truth, read_instances
from world2minecraft.formats.layout import read_rooms
from world2minecraft.formats.objects_and_placements import read_objects, read_placements
from world2minecraft.furniture.layout_checks import category_integrity, collisions, out_of_rooms
from world2minecraft.reconstruction.verification.built_names import stands_for

GENERIC_NAMES = ("object", "furniture")  # They say no more than the class.


@dataclass(frozen=True, eq=False)
class TrueObjects:
    """The true objects in the estimated room frame.

    Attributes:
        objects: The objects.
        seen: Whether a ray met each object, as bool [N].
        have_fronts: Whether the orientation of chairs, sofas and beds is known.
    """

    objects: tuple[LayoutObject, ...]
    seen: np.ndarray
    have_fronts: bool = True


def true_objects(truth: Truth, truth_to_room: np.ndarray, reached: Reached) -> TrueObjects:
    """Transform the true objects to the room frame, and determine which were seen.

    Args:
        truth: The ground truth.
        truth_to_room: The rigid 4x4 transform from the frame of the ground truth to that of the
            room.
        reached: The cells and voxels that rays reached.
    """
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
    """Count the objects of a run, ignoring true objects that no ray met and nothing matches."""
    matched = {n for _, n in match_objects(found, true.objects)}
    expected = [item for n, item in enumerate(true.objects) if bool(true.seen[n]) or n in matched]
    counts = count_objects(found, expected)
    return counts if true.have_fronts else replace(counts, turns_asked=0, turns_right=0)


def name_facts(found: Sequence[ObjectInstance], true: TrueObjects) -> dict[str, Any]:
    """Return the scores of the fine names of objects; empty if the truth has none.

    A true object is found if an object of its name lies within ``MATCH_DISTANCE_M``. True objects
    whose name is not in the vocabulary, or that no ray met, do not count, and neither do objects
    found at their place. An object named only by its class claims nothing: it lowers the recall.
    """
    vocabulary = read_vocabulary()
    names = [vocabulary.find(item.name.replace("_", " ")) for item in true.objects]
    if not any(names):
        return {}
    numbers = {name: number for number, name in enumerate(vocabulary.names)}
    wanted, ignored = [], []
    for item, entry, seen in zip(true.objects, names, true.seen, strict=True):
        is_scored = entry is not None and bool(seen)
        named = replace(item, class_id=numbers[entry.name] if entry is not None else 0)
        (wanted if is_scored else ignored).append(named)
    claimed = [
        LayoutObject(numbers[item.name], item.center_m, item.size_m, 0.0)
        for item in found
        if item.name in numbers and item.name not in GENERIC_NAMES
    ]
    matched = match_objects(claimed, wanted)
    used = {number for number, _ in matched}
    spare = [replace(one, class_id=0) for n, one in enumerate(claimed) if n not in used]
    excused = len(match_objects(spare, [replace(item, class_id=0) for item in ignored]))
    told = len(claimed) - excused
    precision = len(matched) / told if told else 0.0
    recall = len(matched) / len(wanted) if wanted else 0.0
    both = precision + recall
    return {
        "f1": 2 * precision * recall / both if both else 0.0,
        "precision": precision,
        "recall": recall,
        "named": told,
        "true": len(wanted),
        "matched": len(matched),
    }


def object_facts(counts: ObjectCounts) -> dict[str, Any]:
    """Return the object scores by name, and by class for classes with any object."""
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
    """Return the layout counts of a run, or an empty mapping if it was not furnished.

    ``out_of_bounds`` uses the rooms found by the run, and ``out_of_true_rooms`` the true rooms. An
    object may be in any of several rooms. ``semantic_integrity`` is the share of the seen true
    object classes of which furniture was placed that can stand for an object of the class.

    Args:
        out: The folder of the run.
        grid: The occupancy grid from ``room.npz``.
        true_rooms: The true rooms in the room frame.
        objects: The true objects.
    """
    if not (out / "placements.json").is_file():
        return {}
    placements = read_placements(out / "placements.json")
    found = read_objects(out / "objects.json", grid)
    pairs = zip(objects.objects, objects.seen, strict=True)
    judged = {"out_of_true_rooms": len(out_of_rooms(placements, true_rooms))} if true_rooms else {}
    return judged | {
        "placements": len(placements),
        "collisions": len(collisions(placements, grid=grid)),
        "out_of_bounds": len(out_of_rooms(placements, read_rooms(out, grid))),
        "semantic_integrity": category_integrity(
            {item.class_id for item in found if stands_for(item, placements)},
            {item.class_id for item, seen in pairs if seen},
        ),
    }


def in_room(layouts: Sequence[Layout], truth_to_room: np.ndarray) -> tuple[Layout, ...]:
    """Transform the outlines of true rooms to the estimated frame, without openings."""
    moved = []
    for layout in layouts:
        corners = floor_corners(layout, truth_to_room)
        floor = float(corners[:, 2].mean())
        moved.append(
            replace(
                layout, floor_polygon_m=corners[:, :2], floor_z_m=floor, openings=(), objects=()
            )
        )
    return tuple(moved)

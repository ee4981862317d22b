"""Objects of a run against those of the truth: found where they are, as what they are, turned."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.core.coordinates import apply
from world2minecraft.core.types import LayoutObject
from world2minecraft.evaluation.metrics.objects import ObjectCounts, count_objects, match_objects
from world2minecraft.evaluation.scoring.truth import Truth, read_instances
from world2minecraft.evaluation.scoring.visibility import Reached


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
    asked = [item for n, item in enumerate(true.objects) if bool(true.seen[n]) or n in matched]
    counts = count_objects(found, asked)
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

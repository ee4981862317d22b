"""Object scores: detection by class and position, and orientation.

The input is two lists of objects (ObjectInstance, LayoutObject, Placement or any type with a class
and a centre). The results are counts that can be summed over scenes, the object F1 and the share of
correct orientations.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from scipy.optimize import linear_sum_assignment

from world2minecraft.core.classes import CLASS_COUNT, SemanticClass
from world2minecraft.evaluation.metrics.occupancy import ratio

MATCH_DISTANCE_M = 0.3  # Less than half a chair.
TURN_TOLERANCE_DEG = 45.0  # The nearest quarter turn is the right one.
TURNED_CLASSES = (SemanticClass.CHAIR, SemanticClass.SOFA, SemanticClass.BED)


class LocatedObject(Protocol):
    """The interface of objects that can be scored."""

    @property
    def class_id(self) -> int:
        """The semantic class, 5 to 11."""
        ...

    @property
    def center_m(self) -> np.ndarray:
        """The centre of the bounding box as float64 [3]."""
        ...


@dataclass(frozen=True, eq=False)
class ObjectCounts:
    """Counts of detected, true and matched objects, and of the orientations of matched ones.

    Attributes:
        found: The number of detected objects by class, as int64 [12].
        true: The number of true objects by class, as int64 [12].
        matched: The number of matches by class, as int64 [12].
        turns_asked: The number of matched objects whose orientation is scored.
        turns_right: The number of these with the correct orientation.
    """

    found: np.ndarray = field(default_factory=lambda: np.zeros(CLASS_COUNT, np.int64))
    true: np.ndarray = field(default_factory=lambda: np.zeros(CLASS_COUNT, np.int64))
    matched: np.ndarray = field(default_factory=lambda: np.zeros(CLASS_COUNT, np.int64))
    turns_asked: int = 0
    turns_right: int = 0

    def __add__(self, other: "ObjectCounts") -> "ObjectCounts":
        return ObjectCounts(
            self.found + other.found,
            self.true + other.true,
            self.matched + other.matched,
            self.turns_asked + other.turns_asked,
            self.turns_right + other.turns_right,
        )

    @property
    def precision(self) -> float:
        """The share of detected objects that match a true one."""
        return ratio(int(self.matched.sum()), int(self.found.sum()))

    @property
    def recall(self) -> float:
        """The share of true objects that are detected."""
        return ratio(int(self.matched.sum()), int(self.true.sum()))

    @property
    def f1(self) -> float:
        """The F1 score over all classes, or 0 if there are no objects."""
        return ratio(2 * int(self.matched.sum()), int(self.found.sum() + self.true.sum()))

    @property
    def class_f1(self) -> np.ndarray:
        """The F1 score of each class as float64 [12], with 0 for absent classes."""
        both = self.found + self.true
        return np.divide(2 * self.matched, both, out=np.zeros(CLASS_COUNT), where=both > 0)

    @property
    def orientation_right(self) -> float:
        """The share of correct orientations among matched chairs, sofas and beds, or 0."""
        return ratio(self.turns_right, self.turns_asked)


def count_objects(
    found: Sequence[LocatedObject],
    true: Sequence[LocatedObject],
) -> ObjectCounts:
    """Match the objects of one scene, and count them.

    Each detected object matches at most one true object of its class within ``MATCH_DISTANCE_M``.
    The matching maximises the number of matches, then minimises the sum of distances.

    Args:
        found: The objects of the reconstruction, with ``yaw_deg`` or ``quarter_turns``.
        true: The true objects in the same frame.
    """
    matches = match_objects(found, true)
    counts = np.zeros((3, CLASS_COUNT), np.int64)
    for row, classes in enumerate(
        (
            [item.class_id for item in found],
            [item.class_id for item in true],
            [true[n].class_id for _, n in matches],
        )
    ):
        counts[row] = np.bincount(np.array(classes, np.int64), minlength=CLASS_COUNT)
    compared = [(found[m], true[n]) for m, n in matches if true[n].class_id in TURNED_CLASSES]
    right = sum(
        turn_between_deg(_yaw_deg(a), _yaw_deg(b)) <= TURN_TOLERANCE_DEG for a, b in compared
    )
    return ObjectCounts(*counts, turns_asked=len(compared), turns_right=int(right))


def match_objects(
    found: Sequence[LocatedObject],
    true: Sequence[LocatedObject],
    *,
    distance_m: float = MATCH_DISTANCE_M,
) -> list[tuple[int, int]]:
    """Match objects of the same class by the distance of their centres.

    Args:
        found: The objects of the reconstruction.
        true: The true objects in the same frame.
        distance_m: The maximum distance of two centres in metres.

    Returns:
        The matching pairs (index in ``found``, index in ``true``), sorted.
    """
    if not found or not true:
        return []
    places = np.array([item.center_m for item in found], np.float64)
    true_places = np.array([item.center_m for item in true], np.float64)
    apart_m = np.linalg.norm(places[:, None] - true_places[None], axis=2)
    classes = np.array([item.class_id for item in found])
    same = classes[:, None] == np.array([item.class_id for item in true])[None]
    allowed = same & (apart_m <= distance_m)
    # A pair that may not match costs more than all that may, so that most matches come first.
    cost = np.where(allowed, apart_m, distance_m * (len(found) + len(true) + 1) + 1.0)
    rows, columns = linear_sum_assignment(cost)
    retained = allowed[rows, columns]
    return sorted(zip(rows[retained].tolist(), columns[retained].tolist(), strict=True))


def turn_between_deg(yaw_deg: float, other_deg: float) -> float:
    """Return the angle between two yaws in degrees, 0 to 180.

    Example:
        >>> turn_between_deg(350, 10)
        20.0
    """
    return float(abs((yaw_deg - other_deg + 180.0) % 360.0 - 180.0))


def _yaw_deg(item: Any) -> float:
    if hasattr(item, "yaw_deg"):
        return float(item.yaw_deg)
    return 90.0 * item.quarter_turns

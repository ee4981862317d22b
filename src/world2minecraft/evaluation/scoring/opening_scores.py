"""Scores of detected windows, doors and doorways against those of the true rooms."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from world2minecraft.core.coordinates import apply
from world2minecraft.core.types import Layout
from world2minecraft.evaluation.metrics.occupancy import ratio
from world2minecraft.evaluation.scoring.observed_cells import Reached

KINDS = ("window", "door", "doorway")
MATCH_DISTANCE_M = 0.3  # Maximum distance between centres, as for objects.
ASKED_SHARE = 0.5  # Minimum share of an opening's face that rays reached.
STEP_M = 0.04  # Distance of points on an opening's face: half a default cell.


def opening_facts(
    found: Sequence[Layout], true: Sequence[Layout], truth_to_room: np.ndarray, reached: Reached
) -> dict[str, Any]:
    """Return F1, precision and recall of the openings, in total and by kind.

    A found opening matches at most one true opening of its kind whose centre is within 0.3 m. A
    door between two rooms occurs in both rooms but counts once. True openings that few rays reached
    are ignored.

    Args:
        found: The rooms of the run in the room frame.
        true: The true rooms in the frame of the ground truth.
        truth_to_room: The rigid 4x4 transform from ground truth to room.
        reached: The cells that rays reached.
    """
    reported = _once(_middles(found, np.eye(4)))
    there = _once(_middles(true, truth_to_room))
    facts: dict[str, Any] = {}
    sums = np.zeros(3, np.int64)
    for kind in KINDS:
        places = np.array([middle for k, middle, _ in reported if k == kind]).reshape(-1, 3)
        wanted = [(middle, face) for k, middle, face in there if k == kind]
        pairs = _matched(places, np.array([middle for middle, _ in wanted]).reshape(-1, 3))
        matched = {n for _, n in pairs}
        expected = [n for n, (_, face) in enumerate(wanted) if n in matched or _seen(face, reached)]
        counts = np.array([len(places), len(expected), len(pairs)])
        sums += counts
        if counts.any():
            facts[kind] = _rates(counts)
    return _rates(sums) | {"by_kind": facts}


def _rates(counts: np.ndarray) -> dict[str, Any]:
    found, true, matched = (int(value) for value in counts)
    return {
        "f1": ratio(2 * matched, found + true),
        "precision": ratio(matched, found),
        "recall": ratio(matched, true),
        "found": found,
        "true": true,
        "matched": matched,
    }


def _middles(rooms: Sequence[Layout], to_room: np.ndarray) -> list[tuple[str, np.ndarray, Any]]:
    """Return the kind, the centre [3] and points on the face [N, 3] of each opening."""
    rows = []
    for room in rooms:
        for opening in room.openings:
            low, high = room.floor_z_m + opening.sill_m, room.floor_z_m + opening.head_m
            middle = np.array([*(opening.start_m + opening.end_m) / 2, (low + high) / 2])
            along = opening.end_m - opening.start_m
            steps = max(round(float(np.hypot(*along)) / STEP_M), 1)
            shares = (np.arange(steps) + 0.5) / steps
            line = opening.start_m + shares[:, None] * along
            heights = np.arange(low + STEP_M / 2, high, STEP_M)
            face = np.hstack(
                [np.repeat(line, len(heights), axis=0), np.tile(heights, len(line))[:, None]]
            )
            rows.append((opening.kind, apply(to_room, middle), apply(to_room, face)))
    return rows


def _once(rows: list[tuple[str, np.ndarray, Any]]) -> list[tuple[str, np.ndarray, Any]]:
    """Remove openings that another room already contains, from the other side of the wall."""
    unique: list[tuple[str, np.ndarray, Any]] = []
    for row in rows:
        if not any(
            row[0] == k and np.linalg.norm(row[1] - m) < MATCH_DISTANCE_M for k, m, _ in unique
        ):
            unique.append(row)
    return unique


def _matched(found_m: np.ndarray, true_m: np.ndarray) -> list[tuple[int, int]]:
    """Return the matching pairs, maximising their number, then minimising the distances."""
    if not (len(found_m) and len(true_m)):
        return []
    distance = np.linalg.norm(found_m[:, None] - true_m[None], axis=2)
    far = MATCH_DISTANCE_M * (len(found_m) + len(true_m) + 1)
    rows, columns = linear_sum_assignment(np.where(distance <= MATCH_DISTANCE_M, distance, far))
    return [
        (m, n) for m, n in zip(rows, columns, strict=True) if distance[m, n] <= MATCH_DISTANCE_M
    ]


def _seen(face_m: np.ndarray, reached: Reached) -> bool:
    """Return whether rays reached at least half of the cells of an opening's face."""
    cells = np.floor(face_m / reached.voxel_m).astype(np.int64) - reached.low
    inside = ((cells >= 0) & (cells < reached.flags.shape)).all(axis=1)
    return bool((reached.flags[tuple(cells[inside].T)] > 0).sum() >= ASKED_SHARE * len(cells))

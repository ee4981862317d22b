"""Alignment of a floor plan with a scan, by their common frame or by their walls.

Apps that export a scan and a plan of the same recording use one frame for both. Otherwise, the
walls of the plan are aligned with the upright surfaces of the scan, over four quarter turns and all
shifts by whole cells.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.types import FusedEvidence
from world2minecraft.formats.roomplan import CapturedPlan
from world2minecraft.furniture.layout_checks import inside_polygon
from world2minecraft.geometry.morphology import dilate
from world2minecraft.reconstruction.floorplans.room_outlines import (
    move_plan,
    place_plan_rooms,
    straighten_plan,
)

BAND_M = (0.4, 2.0)  # Range of heights in which walls are compared.
UPRIGHT_SHARE = 0.35  # Minimum share of a column's layers: walls may be half hidden.
THINGS_M = (0.15, 1.6)  # Range of heights in which furniture is compared.
STEP_M = 0.04
SAME_FIT = 0.6  # Minimum share of the observed walls on a surface, for the same room.
LAID_FIT = 0.6
MIN_LEAD = 0.05  # Minimum lead over the second best position; a square room has four.
APART_M = 0.4  # Closer positions count as one.
MAX_TILT_DEG = 3.0


class PlanMismatchError(ValueError):
    """A plan does not match the scanned room. The message states how well it fits."""


@dataclass(frozen=True, eq=False)
class AlignedPlan:
    """A plan in the room frame of a scan, the share of matching walls, and a note on the fit."""

    plan: CapturedPlan
    fit: float
    note: str


def align_plan(plan: CapturedPlan, evidence: FusedEvidence) -> AlignedPlan:
    """Align a plan with the room frame of fused evidence.

    Raises:
        PlanMismatchError: If the plan fits nowhere, or about equally well in several positions.
    """
    upright = upright_columns(evidence)
    same = _same_session(plan, evidence)
    if same is not None:
        fit = fit_of(same, evidence, upright)
        if fit >= SAME_FIT:
            note = f"the plan shares the scan's frame; {fit:.0%} of its walls match the scan"
            return AlignedPlan(same, fit, note)
    return _laid_on_walls(straighten_plan(plan), evidence, upright)


def upright_columns(evidence: FusedEvidence) -> np.ndarray:
    """Return the bool [X, Y] mask of columns with upright surface, dilated by one cell."""
    low, high = (
        int(np.clip(round((z - evidence.origin_m[2]) / evidence.voxel_m), 0, None)) for z in BAND_M
    )
    band = np.asarray(evidence.log_odds[:, :, low:high] > 0)
    return dilate(band.sum(axis=2) >= max(UPRIGHT_SHARE * band.shape[2], 1))


def fit_of(plan: CapturedPlan, evidence: FusedEvidence, upright: np.ndarray) -> float:
    """Return the share of a plan's walls in the observed region that match the scan.

    The result is 0 if less than a third of the walls is in the observed region.
    """
    cells = np.floor((_wall_points(plan) - evidence.origin_m[:2]) / evidence.voxel_m).astype(int)
    if not len(cells):
        return 0.0
    held = ((cells >= 0) & (cells < upright.shape)).all(axis=1)
    x, y = cells[held].T
    seen = dilate((evidence.log_odds != 0).any(axis=2))[x, y]
    if seen.sum() < len(cells) / 3:
        return 0.0
    return float(upright[x, y][seen].mean())


def _wall_points(plan: CapturedPlan) -> np.ndarray:
    """Return points along the foot of all walls except in openings, float64 [N, 2]."""
    points = [np.zeros((0, 2))]
    for room in plan.rooms:
        gaps = [one for one in room.openings if one.kind != "window"]
        for wall in room.walls:
            count = max(1, round(wall.length_m / STEP_M))
            share = (np.arange(count) + 0.5)[:, None] / count
            line = wall.start_m + share * (wall.end_m - wall.start_m)
            free = np.ones(count, bool)
            for gap in gaps:
                middle, half = (gap.start_m + gap.end_m) / 2, gap.length_m / 2
                free &= np.linalg.norm(line - middle, axis=1) > half
            points.append(line[free])
    return np.concatenate(points)


def _same_session(plan: CapturedPlan, evidence: FusedEvidence) -> CapturedPlan | None:
    """Return the plan in the scan's alignment, or None if its walls would not be axis-aligned."""
    move = evidence.scan_to_room @ plan.plan_to_session
    tilt = np.degrees(np.arccos(np.clip(move[2, 2], -1, 1)))
    if tilt > MAX_TILT_DEG:
        return None
    yaw = float(np.degrees(np.arctan2(move[1, 0], move[0, 0])))
    flat = rotation_about_z(yaw)
    flat[:3, 3] = move[:3, 3]
    return move_plan(plan, flat)


def _laid_on_walls(plan: CapturedPlan, evidence: FusedEvidence, upright: np.ndarray) -> AlignedPlan:
    places: list[tuple[float, int, np.ndarray]] = []
    for turns in range(4):
        turned = move_plan(plan, rotation_about_z(90.0 * turns))
        points = _wall_points(turned)
        if len(points):
            places += [(fit, turns, shift) for fit, shift in _shifts(points, evidence, upright)]
    places.sort(key=lambda place: (-place[0], place[1], place[2].tolist()))
    if not places or places[0][0] < LAID_FIT:
        best = places[0][0] if places else 0.0
        raise PlanMismatchError(
            f"the plan does not match the scan: at most {best:.0%} of its walls coincide with "
            f"scanned walls, {LAID_FIT:.0%} are required; omit the plan (--plan) or pass the "
            "plan of this room"
        )
    rivals = [places[0]]
    for place in places[1:]:
        if places[0][0] - place[0] < MIN_LEAD and not any(_is_one(place, one) for one in rivals):
            rivals.append(place)
    laid = [move_plan(plan, _move_of(turns, shift)) for _, turns, shift in rivals]
    if len(laid) == 1:
        note = f"the plan was aligned with the scanned walls; {rivals[0][0]:.0%} of them match"
        return AlignedPlan(laid[0], rivals[0][0], note)
    inner = [furniture_fit(one, evidence) for one in laid]
    order = sorted(range(len(laid)), key=lambda n: (-inner[n], n))
    first, second = order[:2]
    if inner[first] - inner[second] < MIN_LEAD:
        raise PlanMismatchError(
            f"the plan fits the scan in several positions ({rivals[first][0]:.0%} and "
            f"{rivals[second][0]:.0%} of its walls coincide); export the scan and the plan from "
            "the same recording, so that they share a coordinate frame"
        )
    fit = rivals[first][0]
    note = f"the plan was aligned by walls and furniture; {fit:.0%} of its walls match"
    return AlignedPlan(laid[first], fit, note)


def furniture_fit(plan: CapturedPlan, evidence: FusedEvidence) -> float:
    """Return how well the boxes of a plan's furniture cover the scanned objects, from 0 to 1.

    The score is the overlap, seen from above, of the boxes with the columns that have surface at
    the height of the boxes, divided by their union within the rooms.
    """
    low, high = (
        int(np.clip(round((z - evidence.origin_m[2]) / evidence.voxel_m), 0, None))
        for z in THINGS_M
    )
    stands = (evidence.log_odds[:, :, low:high] > 0).any(axis=2)
    axes = [
        evidence.origin_m[axis] + (np.arange(stands.shape[axis]) + 0.5) * evidence.voxel_m
        for axis in (0, 1)
    ]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    within = np.zeros(len(points), bool)
    boxes = np.zeros(len(points), bool)
    for room in place_plan_rooms(plan):
        within |= inside_polygon(points, room.outline_m, 0.0)
        for item in room.room.objects:
            turn = np.radians(item.yaw_deg)
            front = np.array([np.cos(turn), np.sin(turn)])
            offset = points - item.center_m[:2]
            deep, wide = offset @ front, offset @ np.array([-front[1], front[0]])
            boxes |= (np.abs(deep) <= item.size_m[0] / 2) & (np.abs(wide) <= item.size_m[1] / 2)
    held = stands.reshape(-1) & within
    boxes &= within
    return float((held & boxes).sum() / max(int((held | boxes).sum()), 1))


def _move_of(turns: int, shift: np.ndarray) -> np.ndarray:
    move = rotation_about_z(90.0 * turns)
    move[:2, 3] = shift
    return move


def _is_one(place: tuple, other: tuple) -> bool:
    return place[1] == other[1] and float(np.linalg.norm(place[2] - other[2])) <= APART_M


def _shifts(
    points: np.ndarray, evidence: FusedEvidence, upright: np.ndarray
) -> list[tuple[float, np.ndarray]]:
    """Return the best shifts of wall points onto upright columns, with their matching shares.

    All shifts by whole cells are evaluated by a correlation; of close shifts only the best is kept.
    """
    # Imported late: it takes half a second, which a run without a plan need not pay.
    from scipy.signal import fftconvolve  # noqa: PLC0415

    low = points.min(axis=0)
    cells = np.floor((points - low) / evidence.voxel_m).astype(int)
    walls = np.zeros(cells.max(axis=0) + 1)
    np.add.at(walls, tuple(cells.T), 1.0 / len(cells))
    fits = fftconvolve(upright.astype(np.float64), walls[::-1, ::-1], mode="full")
    fits = np.round(fits, 6)
    reach = max(1, round(APART_M / evidence.voxel_m))
    found = []
    left = fits.copy()
    for _ in range(4):
        i, j = np.unravel_index(int(left.argmax()), left.shape)
        first = np.array([i, j]) - (np.array(walls.shape) - 1)
        shift = evidence.origin_m[:2] + first * evidence.voxel_m - low
        found.append((float(left[i, j]), shift))
        left[max(i - reach, 0) : i + reach + 1, max(j - reach, 0) : j + reach + 1] = -1.0
    return found

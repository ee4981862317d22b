"""Add a plan to a scan: its votes after fusion, its openings after labelling.

Only cells with observed surface get votes; no cell is added or removed. Floor, ceiling and walls
are taken from the scan, whose planes are more precise.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, SemanticClass
from world2minecraft.core.coordinates import cell_centers_m
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import FusedEvidence, Layout, Opening
from world2minecraft.formats.layout import read_layouts, write_layouts
from world2minecraft.formats.roomplan import CapturedPlan, PlanObject, read_roomplan
from world2minecraft.formats.run_arrays import read_evidence
from world2minecraft.reconstruction.floorplans.furniture_categories import class_of
from world2minecraft.reconstruction.floorplans.plan_alignment import (
    AlignedPlan,
    PlanMismatchError,
    align_plan,
)
from world2minecraft.reconstruction.floorplans.room_outlines import (
    PlacedRoom,
    layouts_of,
    place_plan_rooms,
)

EDGE_M = 0.02
IN_WALL_M = (-0.02, 0.15)  # Behind a wall's face: glass and leaves stand back.
LEVEL_M = 0.05
ON_WALL_M = 0.30  # Maximum distance of an opening of the plan from a wall of the scan.
PLAN_SHARE = 0.5  # Weight of the plan in cells with votes: label images see edges, plans do not.
CLASS_OF_KIND = {"window": SemanticClass.WINDOW, "door": SemanticClass.OBJS}


def plan_votes(evidence: FusedEvidence, plan: CapturedPlan) -> FusedEvidence:
    """Return the evidence with the votes of a plan added to its own.

    Args:
        evidence: Fused evidence of the scan.
        plan: Plan in the room frame; see ``align_plan``.
    """
    cells = np.argwhere(evidence.log_odds > 0)
    hits = np.maximum(evidence.hits[tuple(cells.T)], 1)[:, None]
    points = cell_centers_m(cells, evidence.origin_m, evidence.voxel_m)
    points = points + evidence.offset_sum[tuple(cells.T)] / hits
    label, weight = np.zeros(len(points), np.int64), np.zeros(len(points))
    for room in place_plan_rooms(plan):
        _vote_for_objects(points, room, label, weight)
        _vote_for_openings(points, room, label, weight)
    votes = evidence.votes.astype(np.float32)
    named = label > 0
    at = tuple(cells[named].T)
    own = votes[at].sum(axis=1)
    added = np.zeros((int(named.sum()), CLASS_COUNT), np.float32)
    added[np.arange(len(added)), label[named]] = weight[named] * (1 + PLAN_SHARE * own)
    votes[at] += added
    return replace(evidence, votes=np.minimum(votes, np.finfo(np.float16).max).astype(np.float16))


def merge_plan_openings(layouts: Sequence[Layout], planned: Sequence[Layout]) -> tuple[Layout, ...]:
    """Return rooms with the openings of a plan that are in their walls and were not found.

    Args:
        layouts: Rooms of the scan.
        planned: Rooms of the plan in the same frame.
    """
    every = [opening for room in planned for opening in room.openings]
    result = []
    for layout in layouts:
        found = list(layout.openings)
        for opening in every:
            on_wall = _on_wall(opening, layout)
            if on_wall is not None and not any(_meet(on_wall, other) for other in found):
                found.append(on_wall)
        result.append(replace(layout, openings=tuple(found)))
    return tuple(result)


def _vote_for_openings(
    points: np.ndarray, room: PlacedRoom, label: np.ndarray, weight: np.ndarray
) -> None:
    """Label points in a wall by its windows and doors, except curtains in front of them."""
    middle = room.outline_m.mean(axis=0)
    for opening in room.room.openings:
        kind = CLASS_OF_KIND.get(opening.kind)
        if kind is None:
            continue
        along = (opening.end_m - opening.start_m) / max(opening.length_m, 1e-9)
        out = np.array([along[1], -along[0]])
        out = out if (opening.start_m - middle) @ out >= 0 else -out
        offset = points[:, :2] - opening.start_m
        place, depth = offset @ along, offset @ out
        high = (points[:, 2] > opening.bottom_m + EDGE_M) & (points[:, 2] < opening.top_m - EDGE_M)
        cut = (place > EDGE_M) & (place < opening.length_m - EDGE_M) & high
        cut &= (depth > IN_WALL_M[0]) & (depth < IN_WALL_M[1])
        cut &= points[:, 2] > room.floor_z_m + LEVEL_M
        label[cut], weight[cut] = kind, opening.confidence


def _vote_for_objects(
    points: np.ndarray, room: PlacedRoom, label: np.ndarray, weight: np.ndarray
) -> None:
    """Label points in the boxes of furniture; the smaller of overlapping boxes wins."""
    over = points[:, 2] > room.floor_z_m + LEVEL_M
    for item in sorted(room.room.objects, key=lambda item: -float(np.prod(item.size_m))):
        claimed = over & _in_box(points, item)
        label[claimed], weight[claimed] = class_of(item), item.confidence


def _in_box(points: np.ndarray, item: PlanObject) -> np.ndarray:
    """Return which points are in the box of an object, without margin behind it at the wall."""
    turn = np.radians(item.yaw_deg)
    front = np.array([np.cos(turn), np.sin(turn)])
    offset = points - item.center_m
    across = np.stack(
        [offset[:, :2] @ front, offset[:, :2] @ np.array([-front[1], front[0]]), offset[:, 2]]
    )
    inside = np.abs(across) <= item.size_m[:, None] / 2
    return np.asarray(inside.all(axis=0))


def _on_wall(opening: Opening, layout: Layout) -> Opening | None:
    """Return an opening moved onto the nearest wall of a room, or None if no wall is near."""
    corners = layout.floor_polygon_m
    best, least = None, ON_WALL_M
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along = end - start
        length = float(np.linalg.norm(along))
        if length < 0.1:
            continue
        along = along / length
        places = [float((point - start) @ along) for point in (opening.start_m, opening.end_m)]
        middle = (opening.start_m + opening.end_m) / 2 - start
        off = abs(float(middle @ np.array([-along[1], along[0]])))
        direction = opening.end_m - opening.start_m
        parallel = abs(float(direction @ along)) > 0.95 * float(np.linalg.norm(direction))
        low, high = max(min(places), 0.0), min(max(places), length)
        if parallel and off < least and high - low > 0.5 * abs(places[1] - places[0]):
            ends = [np.round(start + place * along, 4) for place in (low, high)]
            best = replace(opening, start_m=ends[0], end_m=ends[1])
            least = off
    if best is None or best.sill_m >= layout.wall_height_m:
        return None
    return replace(best, head_m=min(best.head_m, layout.wall_height_m))


def _meet(one: Opening, other: Opening) -> bool:
    """Return whether two openings are at the same position of a wall."""
    distance = np.linalg.norm((one.start_m + one.end_m) / 2 - (other.start_m + other.end_m) / 2)
    reach = np.linalg.norm(one.end_m - one.start_m) + np.linalg.norm(other.end_m - other.start_m)
    return bool(distance < reach / 2)


def add_plan_votes(evidence: FusedEvidence, plan: Path) -> tuple[FusedEvidence, tuple[str, ...]]:
    """Add the votes of a plan file to evidence, and return notes on its alignment.

    Raises:
        InputError: If the file is not a valid plan.
        CaptureError: If the plan does not match the scanned room.
    """
    laid = _laid(plan, evidence)
    return plan_votes(evidence, laid.plan), (laid.note,)


def add_plan_openings(folder: Path, plan: Path) -> None:
    """Add the doors and windows that only the plan contains to ``layout.json`` of a run."""
    laid = _laid(plan, read_evidence(folder / "evidence.npz"))
    layouts = merge_plan_openings(read_layouts(folder / "layout.json"), layouts_of(laid.plan))
    write_layouts(folder / "layout.json", layouts)


def _laid(plan: Path, evidence: FusedEvidence) -> AlignedPlan:
    try:
        return align_plan(read_roomplan(plan), evidence)
    except PlanMismatchError as error:
        raise CaptureError(plan, str(error)) from error

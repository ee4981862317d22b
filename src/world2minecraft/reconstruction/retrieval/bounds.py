"""Placements kept within the room they stand in: trimmed at its walls, or moved off them.

In: placements and the rooms' outlines, the walls' inner faces. A scan's surface is thick and its
walls are found to a centimetre or two, so boxes reach into walls by a cell.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.core.types import Layout, Placement
from world2minecraft.furniture import template
from world2minecraft.furniture.layout_checks import inside_polygon
from world2minecraft.furniture.solids import OWN_CELLS, box_m
from world2minecraft.reconstruction.retrieval.axis_aligned_runs import largest_rectangle

STEP_M = 0.04  # How finely a slanted wall is followed.
LOST_M = 0.6  # What lies farther outside was seen through an opening or in a mirror.
MOST_STAYS = 0.7  # Of each side of what is cut; else it is moved as a whole.
HAIR_M = 1e-6


def within_rooms(placement: Placement, rooms: Sequence[Layout], voxel_m: float) -> Placement | None:
    """Return a placement wholly within one of the rooms, or None where it lies outside them all.

    It goes to the room that holds most of it. What reaches out is cut off, as far as its
    template may be that small; what then still reaches out is moved in as a whole.

    Args:
        placement: what was matched.
        rooms: their outlines; without any nothing is changed.
        voxel_m: the cell; nothing becomes thinner.
    """
    if not rooms:
        return placement
    box = box_m(placement)
    room = max(rooms, key=lambda one: round(_shared(box, one), 6))
    if _shared(box, room) <= -LOST_M:
        return None
    low_z, high_z = room.floor_z_m, room.floor_z_m + room.wall_height_m
    least = least_sides_m(placement, voxel_m)
    box = _within_span(box, 2, low_z, high_z, least[2])
    polygon = room.floor_polygon_m
    for axis in (0, 1):
        ends = polygon[:, axis]
        box = _within_span(box, axis, float(ends.min()), float(ends.max()), least[axis])
    if not inside_polygon(_rim(box, polygon), polygon, HAIR_M).all():
        inner = _within_outline(box, polygon, least)
        return None if inner is None else with_box(placement, inner)
    return with_box(placement, box)


def floor_under_m(middle_m: np.ndarray, rooms: Sequence[Layout], voxel_m: float) -> float:
    """Return how high the floor lies on which something with a middle, float64 [3], stands.

    It is the highest under its middle of the rooms around it, of all rooms where none is; 0, the
    ground storey's, where no room tells.
    """
    under = [one for one in rooms if one.floor_z_m <= middle_m[2] + voxel_m]
    plan = np.asarray(middle_m, np.float64)[None, :2]
    around = [one for one in under if inside_polygon(plan, one.floor_polygon_m, 0.0)[0]]
    return max((one.floor_z_m for one in around or under), default=0.0)


def least_sides_m(placement: Placement, voxel_m: float) -> np.ndarray:
    """Return how small a placement's turned box may become, float64 [3]."""
    if placement.template == OWN_CELLS:
        own = np.full(3, voxel_m)
    else:
        spans = template(placement.template).size_m
        own = np.array([max(span.minimum, voxel_m) for span in spans])
    own = np.minimum(own, placement.size_m)
    return own[[1, 0, 2]] if placement.quarter_turns % 2 else own


def with_box(placement: Placement, box: np.ndarray) -> Placement:
    """Return a placement whose turned box is ``box`` float64 [2, 3]."""
    size = box[1] - box[0]
    own = size[[1, 0, 2]] if placement.quarter_turns % 2 else size
    return replace(placement, center_m=np.round(box.mean(axis=0), 4), size_m=np.round(own, 4))


def _shared(box: np.ndarray, room: Layout) -> float:
    """Return the volume that a box shares with the box around a room; how far it is off below 0."""
    corners = room.floor_polygon_m
    low = np.array([*corners.min(axis=0), room.floor_z_m])
    high = np.array([*corners.max(axis=0), room.floor_z_m + room.wall_height_m])
    sides = np.minimum(box[1], high) - np.maximum(box[0], low)
    if (sides <= 0).any():
        return float(sides.min())
    inner = np.concatenate([_rim(box, corners), [box.mean(axis=0)[:2]]])
    share = float(inside_polygon(inner, corners, HAIR_M).mean())
    return float(np.prod(sides)) * max(share, 1e-3)


def _within_span(box: np.ndarray, axis: int, low: float, high: float, least: float) -> np.ndarray:
    """Return a box cut to a span along one axis, or moved into it where too little would stay."""
    result = box.copy()
    result[:, axis] = np.clip(box[:, axis], low, high)
    if result[1, axis] - result[0, axis] >= least - HAIR_M:
        return result
    side = min(least, high - low)
    start = min(max(float(box[0, axis]), low), high - side)
    if box[1, axis] > high:
        start = high - side
    result[:, axis] = start, start + side
    return result


def _within_outline(box: np.ndarray, polygon: np.ndarray, least: np.ndarray) -> np.ndarray | None:
    """Return a box cut to a polygon where most of it stays, else moved, else as small as may be."""
    first = _largest_within(box[:, :2], polygon)
    wanted = np.maximum(least[:2], MOST_STAYS * np.ptp(box, axis=0)[:2])
    if first is not None and (np.ptp(first, axis=0) >= wanted - HAIR_M).all():
        return np.column_stack([first, box[:, 2]])
    moved = _moved_within(box, polygon)
    if moved is not None:
        return moved
    grown = np.stack([box[0, :2] - least[:2], box[1, :2] + least[:2]])
    wider = _largest_within(grown, polygon)
    if wider is None:
        return None
    middle, half = box[:, :2].mean(axis=0), np.minimum(least[:2], np.ptp(wider, axis=0)) / 2
    middle = np.clip(middle, wider[0] + half, wider[1] - half)
    return np.column_stack([np.stack([middle - half, middle + half]), box[:, 2]])


def _moved_within(box: np.ndarray, polygon: np.ndarray) -> np.ndarray | None:
    """Return a box moved by the least way, up to ``LOST_M`` along x and y, that lets it in."""
    steps = np.arange(-LOST_M, LOST_M + HAIR_M, 2 * STEP_M)
    ways = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
    ways = ways[np.argsort(np.round((ways**2).sum(axis=1), 6), kind="stable")]
    rim = _rim(box, polygon)
    for way in ways:
        if inside_polygon(rim + way, polygon, HAIR_M).all():
            return box + np.array([*way, 0.0])
    return None


def _largest_within(plan: np.ndarray, polygon: np.ndarray) -> np.ndarray | None:
    """Return the largest upright rectangle, float64 [2, 2], of a plan's that lies in a polygon."""
    edges = [_steps(plan[:, axis], polygon[:, axis]) for axis in (0, 1)]
    corners = np.stack(np.meshgrid(*edges, indexing="ij"), axis=-1)
    shape = corners.shape[:2]
    inside = inside_polygon(corners.reshape(-1, 2), polygon, HAIR_M).reshape(shape)
    middles = (corners[:-1, :-1] + corners[1:, 1:]) / 2
    whole = inside[:-1, :-1] & inside[1:, :-1] & inside[:-1, 1:] & inside[1:, 1:]
    whole &= inside_polygon(middles.reshape(-1, 2), polygon, HAIR_M).reshape(whole.shape)
    if not whole.any():
        return None
    cells = whole.astype(np.uint8)
    _, x0, y0, x1, y1 = largest_rectangle(cells, np.zeros_like(cells))
    return np.array([[edges[0][x0], edges[1][y0]], [edges[0][x1], edges[1][y1]]])


def _steps(span: np.ndarray, marks: np.ndarray) -> np.ndarray:
    """Return the places, rising, at which a span is cut: its ends, the marks and every few cm."""
    count = max(int(np.ceil((span[1] - span[0]) / STEP_M)), 1)
    inner = marks[(marks > span[0]) & (marks < span[1])]
    ends = np.linspace(span[0], span[1], count + 1)
    return np.unique(np.round(np.concatenate([ends, inner]), 6))


def _rim(box: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """Return points on the outline of a box, float64 [N, 2], with those level with corners."""
    xs, ys = (_steps(box[:, axis], polygon[:, axis]) for axis in (0, 1))
    low, high = box[0, :2], box[1, :2]
    sides = [
        np.column_stack([xs, np.full(len(xs), low[1])]),
        np.column_stack([xs, np.full(len(xs), high[1])]),
        np.column_stack([np.full(len(ys), low[0]), ys]),
        np.column_stack([np.full(len(ys), high[0]), ys]),
    ]
    return np.concatenate(sides)

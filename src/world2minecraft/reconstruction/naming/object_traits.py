"""The traits of the objects of a room that its name model sees."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.core.types import Layout, LayoutObject, ObjectInstance
from world2minecraft.furniture.layout_checks import inside_polygon
from world2minecraft.reconstruction.naming.name_model import ObjectTraits, name_objects
from world2minecraft.reconstruction.naming.room_context import name_by_context

FAR_M = 9.0  # Of walls and ceilings where there is no layout.


def layout_of(item: ObjectInstance | LayoutObject, layouts: Sequence[Layout]) -> int:
    """Return the number of the layout that an object belongs to, -1 without layouts.

    That is the one on its storey whose outline contains its centre, or is nearest to it.
    """
    distances = []
    for layout in layouts:
        height_m = item.center_m[2] - layout.floor_z_m
        off_m = max(-height_m, height_m - layout.wall_height_m, 0.0)
        inside = inside_polygon(item.center_m[None, :2], layout.floor_polygon_m, 0.0)[0]
        distances.append(off_m + (0 if inside else _wall_distance_m(item, layout)))
    return int(np.argmin(distances)) if distances else -1


def name_instances(
    instances: Sequence[ObjectInstance], layouts: Sequence[Layout], votes: np.ndarray
) -> list[tuple[str, float]]:
    """Return the fine name of each object and its probability, room by room.

    Args:
        instances: Objects of a run.
        layouts: Layouts of its rooms.
        votes: Votes for the label ids from 1, float [N, 40] or [N, K].
    """
    rooms = [layout_of(item, layouts) for item in instances]
    result: list[tuple[str, float]] = [("", 0.0)] * len(instances)
    for room in sorted(set(rooms)):
        mine = [number for number, own in enumerate(rooms) if own == room]
        layout = None if room < 0 else layouts[room]
        traits = traits_of([instances[n] for n in mine], layout, votes[mine])
        named = name_by_context(traits, name_objects(traits))
        for number, one in zip(mine, named, strict=True):
            result[number] = one
    return result


def traits_of(
    items: Sequence[ObjectInstance | LayoutObject], layout: Layout | None, votes: np.ndarray
) -> list[ObjectTraits]:
    """Return the traits of the objects of one room.

    Args:
        items: Objects in the frame of the room.
        layout: Layout of the room, or None if it is unknown.
        votes: Votes for the label ids from 1, float [N, 40] or [N, K].
    """
    shares = votes / np.maximum(votes.sum(axis=1, keepdims=True), 1e-6)
    result = []
    for item, share, count in zip(items, shares, votes.sum(axis=1).tolist(), strict=True):
        depth, width, height = item.size_m.tolist()
        floor_m = 0.0 if layout is None else layout.floor_z_m
        bottom_m = float(item.center_m[2]) - height / 2 - floor_m
        wall_m, gap_m = FAR_M, FAR_M
        if layout is not None:
            wall_m = _wall_distance_m(item, layout)
            gap_m = layout.wall_height_m - bottom_m - height
        result.append(
            ObjectTraits(
                item.class_id, (depth, width, height), bottom_m, wall_m, gap_m, share, count
            )
        )
    return result


def _wall_distance_m(item: ObjectInstance | LayoutObject, layout: Layout) -> float:
    """Return the distance of an object's footprint to the nearest wall of a layout."""
    yaw = np.radians(item.yaw_deg)
    turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    half = item.size_m[:2] / 2
    signs = np.array([[-1, -1], [-1, 1], [1, 1], [1, -1], [-1, 0], [1, 0], [0, 1], [0, -1]])
    points = item.center_m[:2] + (signs * half) @ turn.T
    starts = layout.floor_polygon_m
    along = np.roll(starts, -1, axis=0) - starts
    lengths = np.maximum((along**2).sum(axis=1), 1e-9)
    offsets = points[:, None] - starts
    share = np.clip((offsets * along).sum(axis=2) / lengths, 0, 1)
    return float(np.linalg.norm(offsets - share[..., None] * along, axis=2).min())

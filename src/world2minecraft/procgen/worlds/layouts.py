"""The rooms of a made house as metric layouts: outlines, openings, and what stands in them."""

import numpy as np

from world2minecraft.core.types import Layout, LayoutObject, Opening
from world2minecraft.procgen.worlds.furnishing import Thing
from world2minecraft.procgen.worlds.house import BlockGap, BlockHouse, BlockRoom


def house_layouts(house: BlockHouse, things: tuple[Thing, ...]) -> tuple[Layout, ...]:
    """Return one layout a room, in the order of the rooms; objects are named by their design."""
    return tuple(_layout(house, room, things) for room in house.rooms)


def _layout(house: BlockHouse, room: BlockRoom, things: tuple[Thing, ...]) -> Layout:
    scale = house.blocks_per_metre
    own = [gap for gap in house.gaps if room.number in gap.rooms]
    return Layout(
        floor_polygon_m=_outline(room) / scale,
        wall_height_m=room.height / scale,
        openings=tuple(_opening(gap, room, scale) for gap in own),
        objects=tuple(_object(thing, scale) for thing in things if thing.room == room.number),
        floor_z_m=room.ground / scale,
        name=f"{room.kind} {room.number + 1}",
    )


def _outline(room: BlockRoom) -> np.ndarray:
    """Return the corners of a room's floor, counter-clockwise, float64 [N, 2] in blocks."""
    (x0, y0), (x1, y1) = room.low, room.high
    if not room.blocked:
        return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], np.float64)
    bay, top = room.blocked[0][:2]  # The corridor runs to x1, the bay of the stairs to y1.
    corners = [[x0, y0], [x1, y0], [x1, top], [bay, top], [bay, y1], [x0, y1]]
    return np.array(corners, np.float64)


def _opening(gap: BlockGap, room: BlockRoom, scale: float) -> Opening:
    """Return an opening on the face of its wall that looks into the room."""
    across, along = gap.turn % 2, 1 - gap.turn % 2
    faces_up = (gap.turn < 2) == (room.number == gap.rooms[0])
    at = gap.high[across] if faces_up else gap.low[across]
    ends = np.zeros((2, 2))
    ends[:, across] = at
    ends[:, along] = gap.low[along], gap.high[along]
    sill, head = (gap.bottom - room.ground) / scale, (gap.top - room.ground) / scale
    return Opening(gap.kind, ends[0] / scale, ends[1] / scale, sill, head)


def _object(thing: Thing, scale: float) -> LayoutObject:
    low, high = np.array(thing.low) / scale, np.array(thing.high) / scale
    sides = high - low
    size = sides[[1, 0, 2]] if thing.quarter_turns % 2 else sides
    yaw = 90.0 * thing.quarter_turns
    return LayoutObject(thing.class_id, (low + high) / 2, size, yaw, thing.design)

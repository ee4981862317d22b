"""The shell of a house: floors, walls, ceilings, windows, doors and stairs in each room's style."""

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.worlds.block_house import (
    RAIL,
    BlockGap,
    BlockHouse,
    BlockRoom,
    person_size_blocks,
)
from world2minecraft.procgen.worlds.canvas import WorldCanvas
from world2minecraft.procgen.worlds.styles import RoomLook

FLOOR, WALL = int(SemanticClass.FLOOR), int(SemanticClass.WALL)
CEILING, WINDOW = int(SemanticClass.CEILING), int(SemanticClass.WINDOW)
OBJS = int(SemanticClass.OBJS)
GLASS = "minecraft:glass"
BARS, RAIL_M = "minecraft:iron_bars", 0.9  # Codes ask for 0.9 m.
EIGHT = np.ones((3, 3), bool)
# Which way a block looks that looks by 0 to 3 quarter turns from +x, in the game's words.
FACINGS = ("east", "north", "west", "south")


def put_shell(canvas: WorldCanvas, house: BlockHouse, looks: tuple[RoomLook, ...]) -> None:
    """Set the floors, walls and ceilings of a house, with openings for doors and windows."""
    _put_levels(canvas, house, looks)
    for room in house.rooms:
        _put_walls(canvas, room, looks[room.number], house)
    for gap in house.gaps:
        _put_gap(canvas, gap, looks[gap.rooms[0]])


def _put_levels(canvas: WorldCanvas, house: BlockHouse, looks: tuple[RoomLook, ...]) -> None:
    """Set the floor and the ceiling of each room, and the layers below and above walls."""
    shape = canvas.states.shape[:2]
    for storey, ground in enumerate(house.grounds):
        rooms = [room for room in house.rooms if room.storey == storey]
        every = np.any([_columns(canvas, room, shape) for room in rooms], axis=0)
        rim = ndimage.binary_dilation(every, EIGHT) & ~every
        below, above = canvas.at(0, 0, ground - 1)[2], canvas.at(0, 0, ground + house.height)[2]
        hall = looks[rooms[0].number]
        for level, kind, state in ((below, WALL, hall.wall), (above, WALL, hall.wall)):
            canvas.set((*np.nonzero(rim), level), state, kind)
        for room in rooms:
            inside, look = _columns(canvas, room, shape), looks[room.number]
            canvas.set((*np.nonzero(inside), above), look.ceiling, CEILING)
            _put_floor(canvas, inside, below, look)


def _put_floor(canvas: WorldCanvas, inside: np.ndarray, level: int, look: RoomLook) -> None:
    x, y = np.nonzero(inside)
    count = len(look.floor)
    step = {"plain": 0 * x, "rows": x % count, "checked": (x // 2 + y // 2) % count}
    chosen = step[look.floor_pattern if count > 1 else "plain"]
    for number, state in enumerate(look.floor):
        own = chosen == number
        canvas.set((x[own], y[own], np.full(own.sum(), level)), state, FLOOR)


def _columns(canvas: WorldCanvas, room: BlockRoom, shape: tuple[int, ...]) -> np.ndarray:
    inner = room.floor((shape[0] - 2 * canvas.margin, shape[1] - 2 * canvas.margin))
    return np.pad(inner, canvas.margin)


def _put_walls(canvas: WorldCanvas, room: BlockRoom, look: RoomLook, house: BlockHouse) -> None:
    """Set the walls around a room, except blocks that another room has already set."""
    inside = _columns(canvas, room, canvas.states.shape[:2])
    rim = ndimage.binary_dilation(inside, EIGHT) & ~inside
    others = [r for r in house.rooms if r.storey == room.storey and r is not room]
    for other in others:
        rim &= ~_columns(canvas, other, canvas.states.shape[:2])
    low, high = canvas.at(0, 0, room.ground)[2], canvas.at(0, 0, room.ground + room.height)[2]
    for turn, side in enumerate(_sides(rim, inside)):
        x, y = np.nonzero(side)
        for level in range(low, high):
            free = canvas.states[x, y, level] == 0
            height = level - low
            state = look.skirting if height < look.skirting_height else look.accents[turn]
            if height == high - low - 1 and look.cornice:
                state = look.cornice
            canvas.set((x[free], y[free], np.full(free.sum(), level)), state, WALL)


def _sides(rim: np.ndarray, inside: np.ndarray) -> list[np.ndarray]:
    """Split a rim by the direction into the room: +x, +y, -x, -y. Corners are in the last part."""
    steps = ((0, -1), (1, -1), (0, 1), (1, 1))
    left, sides = rim.copy(), []
    for axis, step in steps:
        side = left & np.roll(inside, step, axis)
        left &= ~side
        sides.append(side)
    sides[3] |= left
    return sides


def _put_gap(canvas: WorldCanvas, gap: BlockGap, look: RoomLook) -> None:
    box = canvas.box((*gap.low, gap.bottom), (*gap.high, gap.top))
    if gap.kind == "window":
        canvas.set(box, GLASS, WINDOW)
    elif len(gap.rooms) == 1:
        _put_front_door(canvas, gap, look)
    else:
        canvas.set(box, "minecraft:air", 0)


def _put_front_door(canvas: WorldCanvas, gap: BlockGap, look: RoomLook) -> None:
    """Fill the front door with a leaf that never opens, so that walks stay inside the house.

    The leaf has a frame, a rail at half its height and a window above the rail.
    """
    along = 1 - gap.turn % 2
    rail = (gap.bottom + gap.top) // 2
    inner_low, inner_high = list(gap.low), list(gap.high)
    inner_low[along] += 1
    inner_high[along] -= 1

    def put(low: list[int], high: list[int], layers: tuple[int, int], block: str) -> None:
        box = canvas.box((low[0], low[1], layers[0]), (high[0], high[1], layers[1]))
        canvas.set(box, block, OBJS)

    put([*gap.low], [*gap.high], (gap.bottom, gap.top), look.frame)
    put(inner_low, inner_high, (gap.bottom + 1, rail), f"minecraft:{look.wood}_planks")
    put(inner_low, inner_high, (rail + 1, gap.top - 1), GLASS)


def put_stairs(canvas: WorldCanvas, house: BlockHouse, look: RoomLook, instance: int) -> None:
    """Set the stairs, open the floor above them, and add railings around the opening."""
    flight = house.flight
    if flight is None:
        return
    upper, first, end = house.grounds[1], flight.hole, flight.end
    hole = canvas.box((flight.x0, first, upper - 2), (flight.x1, end, upper))
    canvas.set(hole, "minecraft:air", 0)
    for n in range(flight.steps):
        row = flight.y0 + n
        tread = f"{look.stairs}[facing=north,half=bottom]"
        under = f"{look.stairs}[facing=south,half=top]"
        step = canvas.box((flight.x0, row, n), (flight.x1, row + 1, n + 1))
        canvas.set(step, tread, OBJS, instance)
        if n:
            below = canvas.box((flight.x0, row, n - 1), (flight.x1, row + 1, n))
            canvas.set(below, under, OBJS, instance)
    top = upper + max(1, round(RAIL_M * house.blocks_per_metre) - 1)
    for low, high in rails(house):
        canvas.set(canvas.box((*low, upper), (*high, top)), BARS, OBJS, instance + 1)
        hand = canvas.box((*low, top), (*high, top + 1))
        canvas.set(hand, f"{look.handrail}[type=bottom]", OBJS, instance + 1)


def rails(house: BlockHouse) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    """Return the columns, [low, high), of the railings around the opening above the stairs.

    A side has no railing if its floor is too narrow for a railing and a person.
    """
    flight = house.flight
    if flight is None:
        return []
    upper = next(room for room in house.rooms if room.storey == 1)
    wide, before = person_size_blocks(house.blocks_per_metre)[0], flight.hole - RAIL
    has_beside = upper.blocked[0][0] - flight.x1 >= wide + RAIL
    end = flight.x1 + RAIL * has_beside
    found = []
    if before - upper.low[1] >= wide:
        found.append(((flight.x0, before), (end, flight.hole)))
    if has_beside:
        found.append(((flight.x1, flight.hole), (end, flight.end - 1)))
    return found

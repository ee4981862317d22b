"""Decoration of furnished rooms with door leaves, curtains, lamps and rugs."""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.worlds.block_house import BlockGap, BlockRoom
from world2minecraft.procgen.worlds.furnishing import Furnisher
from world2minecraft.procgen.worlds.shell import FACINGS

OBJS = int(SemanticClass.OBJS)
HANDLE, HANDLE_M = "minecraft:polished_blackstone_button", 0.9
LEAF_SHARE = 0.6  # Share of inner doors with a leaf; the others are open frames.
CURTAINS = ("curtain", "curtain_sheer", "curtain_single")
BLINDS = ("roller_blind", "venetian_blind")
CEILING_LAMPS = ("ceiling_lamp", "pendant_lamp", "globe_lamp", "lantern_lamp", "chandelier")
RUGS = ("rug", "rug_checked", "rug_round", "rug_striped")
RUNNER_M = 3.4  # Length of hall per rug, in metres.
LAMP_AREA_M2 = (20.0, 12.0)  # Of floor that a ceiling lamp is for, by day and by night.
MAX_LAMPS = 2


def hang_leaves(furnisher: Furnisher, gaps: tuple[BlockGap, ...], rng: np.random.Generator) -> None:
    """Add open door leaves to some inner doors.

    A leaf is placed along the wall beside its door if there is space, or else across it.
    """
    for gap in gaps:
        if gap.kind == "door" and len(gap.rooms) == 2 and rng.random() < LEAF_SHARE:
            room = furnisher.house.rooms[gap.rooms[0]]
            sides = [bool(side) for side in rng.permutation(2)]
            for side, flat in [(side, flat) for flat in (True, False) for side in sides]:
                if _hang_leaf(furnisher, gap, room, side, flat):
                    break


def _hang_leaf(
    furnisher: Furnisher, gap: BlockGap, room: BlockRoom, at_low: bool, flat: bool
) -> bool:
    """Place a leaf beside its door, along the wall or across, and return whether it fits."""
    canvas, look = furnisher.canvas, furnisher.looks[room.number]
    across, along = gap.turn % 2, 1 - gap.turn % 2
    width = gap.high[along] - gap.low[along]
    long, deep = (width, 1) if flat else (1, width)
    low = [0, 0]
    low[along] = gap.low[along] - long if at_low else gap.high[along]
    low[across] = gap.high[across] if gap.turn < 2 else gap.low[across] - deep
    size = (long, deep) if along == 0 else (deep, long)
    high = (low[0] + size[0], low[1] + size[1])
    columns = np.argwhere(np.ones(size, bool)) + low
    inside = room.floor(furnisher.house.size)
    box = canvas.box((low[0], low[1], gap.bottom), (*high, gap.top))
    if not all(x < inside.shape[0] and y < inside.shape[1] for x, y in columns.tolist()):
        return False
    if min(low) < 0 or not inside[tuple(columns.T)].all() or canvas.states[box].any():
        return False
    if not furnisher.ways.stay(room, columns):
        return False
    instance = furnisher.next_instance()
    canvas.set(box, look.frame, OBJS, instance)
    long_axis = along if flat else across
    inner = [[*low], [*high]]
    inner[0][long_axis] += 1
    inner[1][long_axis] -= 1
    middle = (gap.bottom + gap.top) // 2
    for bottom, top in ((gap.bottom + 1, middle), (middle + 1, gap.top - 1)):
        panel = canvas.box((inner[0][0], inner[0][1], bottom), (inner[1][0], inner[1][1], top))
        canvas.set(panel, f"minecraft:{look.wood}_planks", OBJS, instance)
    furnisher.ways.take(room, columns)
    if flat:
        _put_handle(furnisher, gap, low[along] if at_low else high[along] - 1, instance)
    return True


def _put_handle(furnisher: Furnisher, gap: BlockGap, place: int, instance: int) -> None:
    """Set a handle on a leaf along the wall, at the side away from the door, if there is space."""
    across, along = gap.turn % 2, 1 - gap.turn % 2
    at = [0, 0, gap.bottom + round(HANDLE_M * furnisher.house.blocks_per_metre)]
    at[along] = place
    at[across] = gap.high[across] + 1 if gap.turn < 2 else gap.low[across] - 2
    cell = furnisher.canvas.at(at[0], at[1], at[2])
    if furnisher.canvas.states[cell] == 0:
        state = f"{HANDLE}[face=wall,facing={FACINGS[gap.turn]}]"
        furnisher.canvas.set(cell, state, OBJS, instance)


def dress_windows(furnisher: Furnisher, room: BlockRoom, rng: np.random.Generator) -> None:
    """Add curtains of one kind, or blinds, to most windows of a room."""
    draw = rng.random()
    curtain, blind = (furnisher.rarest_first(names, rng)[0] for names in (CURTAINS, BLINDS))
    for gap in furnisher.house.gaps:
        if gap.kind != "window" or gap.rooms[0] != room.number:
            continue
        if draw < 0.6:
            _hang(furnisher, gap, room, curtain, rng, True)
        elif draw < 0.8:
            _hang(furnisher, gap, room, blind, rng, False)


def _hang(
    furnisher: Furnisher,
    gap: BlockGap,
    room: BlockRoom,
    name: str,
    rng: np.random.Generator,
    is_long: bool,
) -> int:
    """Place a curtain or a blind at a window, and return its instance number or 0."""
    scale = furnisher.house.blocks_per_metre
    along = 1 - gap.turn % 2
    wide = gap.high[along] - gap.low[along] + (4 if is_long else 0)
    top = min(gap.top + 1, room.ground + room.height) if is_long else gap.top
    for bottom in (room.ground, gap.bottom) if is_long else (gap.bottom,):
        size = (0.1, wide / scale, (top - bottom) / scale)
        found = furnisher.design(name, room, gap.turn, rng, size)
        if found is None:
            return 0
        low = [0, 0, top - found.size[1]]
        own = found.size[0] if along == 0 else found.size[2]
        low[along] = (gap.low[along] + gap.high[along] - own + 1) // 2
        low[along] = int(np.clip(low[along], room.low[along], room.high[along] - own))
        low[1 - along] = gap.high[1 - along] if gap.turn < 2 else gap.low[1 - along] - 1
        if low[2] >= room.ground and (placed := furnisher.put(name, found, low, room, gap.turn)):
            return placed
    return 0


def hang_lamps(
    furnisher: Furnisher, room: BlockRoom, rng: np.random.Generator, *, by_night: bool
) -> int:
    """Hang ceiling lamps of one kind in a room, more of them by night; return their number.

    Lamps that hang there already, such as one above a table, count.
    """
    scale = furnisher.house.blocks_per_metre
    placed = furnisher.placed[room.number]
    names = furnisher.rarest_first(CEILING_LAMPS, rng)
    names = tuple(sorted(names, key=lambda name: not placed[name]))
    if room.kind in ("storage", "bathroom", "laundry"):
        names = CEILING_LAMPS[:1]
    area = room.size[0] * room.size[1] / scale**2
    count = min(max(1, round(area / LAMP_AREA_M2[by_night])), MAX_LAMPS)
    count -= sum(placed[name] for name in CEILING_LAMPS)
    for name in names:
        if hung := sum(
            hang_one(furnisher, room, name, (n + 0.5) / count, rng) for n in range(count)
        ):
            return hung
    return 0


def hang_one(
    furnisher: Furnisher, room: BlockRoom, name: str, share: float, rng: np.random.Generator
) -> bool:
    """Hang a design from the ceiling at a fraction of the room's length.

    Designs below the height of a person's head are not placed, except flat lamps.

    Returns:
        Whether the design fits.
    """
    long = int(room.size[1] > room.size[0])
    found = furnisher.design(name, room, 0, rng)
    if found is None:
        return False
    low = [0, 0, room.ground + room.height - found.size[1]]
    if low[2] < room.ground + furnisher.ways.head and name != "ceiling_lamp":
        return False
    for axis, side in ((0, found.size[0]), (1, found.size[2])):
        own = share if axis == long else 0.5
        wide = room.high[axis] - room.low[axis]
        if room.blocked and axis == 1:
            wide = room.blocked[0][1] - room.low[1]
        low[axis] = room.low[axis] + round(own * wide - side / 2)
    nudges = ((0, 0), (1, 0), (0, 1), (-1, 0), (0, -1), (2, 0), (-2, 0), (0, 2), (0, -2))
    return bool(furnisher.put(name, found, low, room, 0, nudges))


def lay_rugs(furnisher: Furnisher, room: BlockRoom, rng: np.random.Generator) -> None:
    """Place a rug in the middle of most living areas, and runners along a hall."""
    if room.kind in ("bathroom", "kitchen", "storage", "workshop", "greenhouse", "laundry"):
        return
    if room.kind == "hall":
        _lay_runners(furnisher, room, rng)
    elif rng.random() < 0.75:
        middle = [(a + b) / 2 for a, b in zip(room.low, room.high, strict=True)]
        furnisher.put_flat(furnisher.rarest_first(RUGS, rng)[0], room, rng, middle)


def _lay_runners(furnisher: Furnisher, room: BlockRoom, rng: np.random.Generator) -> None:
    scale, name = furnisher.house.blocks_per_metre, furnisher.rarest_first(RUGS, rng)[0]
    end = room.blocked[0][1] if room.blocked else room.high[1]
    wide, long = end - room.low[1], room.size[0]
    count = max(1, round(long / scale / RUNNER_M))
    size_m = (max(1, wide - 2) / scale, (long / count - 2) / scale, 0.05)
    for n in range(count):
        middle = (room.low[0] + (n + 0.5) * long / count, (room.low[1] + end) / 2)
        furnisher.put_flat(name, room, rng, middle, turns=1, size_m=size_m)

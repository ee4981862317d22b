"""What makes a furnished room whole: door leaves, curtains, lamps, rugs and things on walls."""

import numpy as np

from world2minecraft.classes import SemanticClass
from world2minecraft.rooms.worlds.furnishing import Furnisher
from world2minecraft.rooms.worlds.house import BlockGap, BlockRoom
from world2minecraft.rooms.worlds.shell import FACINGS

OBJS = int(SemanticClass.OBJS)
LEAF_SHARE = 0.6  # Of doors between rooms that have a leaf; the others are open frames.
CURTAINS = ("curtain", "curtain_sheer", "curtain_single")
BLINDS = ("roller_blind", "venetian_blind")
CEILING_LAMPS = ("ceiling_lamp", "pendant_lamp", "globe_lamp", "lantern_lamp", "chandelier")
RUGS = ("rug", "rug_checked", "rug_round", "rug_striped")
LAMP_AREA_M2 = (14.0, 6.0)  # Of floor that a ceiling lamp is for, by day and by night.


def hang_leaves(furnisher: Furnisher, gaps: tuple[BlockGap, ...], rng: np.random.Generator) -> None:
    """Hang open leaves of trapdoors beside doors, within the room that each door is of."""
    for gap in gaps:
        if gap.kind == "door" and len(gap.rooms) == 2 and rng.random() < LEAF_SHARE:
            _hang_leaf(furnisher, gap, furnisher.house.rooms[gap.rooms[0]])


def _hang_leaf(furnisher: Furnisher, gap: BlockGap, room: BlockRoom) -> None:
    canvas, look = furnisher.canvas, furnisher.looks[room.number]
    across, along = gap.turn % 2, 1 - gap.turn % 2
    width = gap.high[along] - gap.low[along]
    near = gap.low[along] - room.low[along] <= room.high[along] - gap.high[along]
    beside = gap.low[along] - 1 if near else gap.high[along]
    if not room.low[along] <= beside < room.high[along]:
        beside = gap.low[along] if near else gap.high[along] - 1
    inward = gap.high[across] if gap.turn < 2 else gap.low[across] - width
    low, high = [0, 0], [0, 0]
    low[along], high[along] = beside, beside + 1
    low[across], high[across] = inward, inward + width
    box = canvas.box((low[0], low[1], gap.bottom), (high[0], high[1], gap.top))
    if canvas.states[box].any():
        return
    # The panel of an open trapdoor stands on the side that it looks away from.
    turn = (along + 2 if near else along) % 4 if along == 0 else (1 if not near else 3)
    facing = FACINGS[turn] if along == 0 else FACINGS[(turn + 2) % 4]
    state = f"minecraft:{look.wood}_trapdoor[facing={facing},half=bottom,open=true]"
    columns = np.argwhere(np.ones((high[0] - low[0], high[1] - low[1]), bool)) + low
    if not furnisher.ways.stay(room, columns):
        return
    canvas.set(box, state, OBJS, furnisher.next_instance())
    furnisher.ways.take(room, columns)


def dress_windows(furnisher: Furnisher, room: BlockRoom, rng: np.random.Generator) -> None:
    """Give most windows of a room curtains of one kind, or blinds."""
    draw = rng.random()
    for gap in furnisher.house.gaps:
        if gap.kind != "window" or gap.rooms[0] != room.number:
            continue
        if draw < 0.55 and _hang(furnisher, gap, room, CURTAINS[int(draw * 6) % 3], rng, True):
            continue
        if draw < 0.8:
            _hang(furnisher, gap, room, BLINDS[int(draw * 20) % 2], rng, False)


def _hang(
    furnisher: Furnisher,
    gap: BlockGap,
    room: BlockRoom,
    name: str,
    rng: np.random.Generator,
    is_long: bool,
) -> int:
    """Hang a curtain or a blind before a window; 0 where something is in its way."""
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
    """Hang lamps of one kind from a room's ceiling, more of them by night; return how many."""
    scale = furnisher.house.blocks_per_metre
    if room.kind in ("hall", "shop", "storage", "bathroom", "laundry"):
        names = CEILING_LAMPS[:1]
    else:
        names = tuple(CEILING_LAMPS[int(n)] for n in rng.permutation(len(CEILING_LAMPS)))
    area = room.size[0] * room.size[1] / scale**2
    count = max(1, round(area / LAMP_AREA_M2[by_night]))
    for name in names:
        if hung := sum(
            hang_one(furnisher, room, name, (n + 0.5) / count, rng) for n in range(count)
        ):
            return hung
    return 0


def hang_one(
    furnisher: Furnisher, room: BlockRoom, name: str, share: float, rng: np.random.Generator
) -> bool:
    """Hang a design from the ceiling at a share of the room's length; say whether it fits.

    What would hang lower than a person's head stays away, but flat lamps.
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
    """Lay a rug in the middle of most rooms that are lived in."""
    if room.kind in ("bathroom", "kitchen", "storage", "workshop", "greenhouse", "laundry"):
        return
    if rng.random() < 0.75:
        middle = [(a + b) / 2 for a, b in zip(room.low, room.high, strict=True)]
        furnisher.put_flat(RUGS[int(rng.integers(len(RUGS)))], room, rng, middle)

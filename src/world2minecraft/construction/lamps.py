"""Lamps that a builder would hang: over tables, and over the middle of what stays dark.

A lamp hangs from the ceiling by chains where there is room to walk under it, and else lies flush
in the ceiling. Where no ceiling was built nothing can hang, and the hidden lights do all.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.construction.canvas import AIR, Canvas
from world2minecraft.construction.palettes import Palette
from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.morphology import nearest_set_cells

LAMP_M = 0.3  # A shade's width.
CORD_M = 0.35
WALK_M, WALK_BLOCKS = 2.0, 2  # What stays free under a lamp: a person, and a player.
TABLE_M = 1.45  # Over a table nobody walks.
REACH_M = 2.6  # How far one lamp is taken to light. A guess: about 4 m between two.
WALL_M = 0.5  # No lamp hangs nearer to a wall, unless the room is that narrow.
MOST = 24  # Lamps a storey.
CHAIN = "minecraft:chain[axis=y,waterlogged=false]"
LANTERN = "minecraft:lantern[hanging=true,waterlogged=false]"
SHADE = "minecraft:sea_lantern"
DOWNLIGHT = "minecraft:ochre_froglight[axis=y]"


class _Room(NamedTuple):
    """Where lamps may hang in a storey: its first layer, the ceiling's layer, and the columns."""

    ground: int
    level: int
    columns: np.ndarray  # bool [X, Y]


def hang_lamps(canvas: Canvas, footprints: tuple[np.ndarray, ...], palette: Palette) -> int:
    """Hang lamps, in place, in every storey that has a ceiling.

    Args:
        canvas: its finished blocks.
        footprints: bool [X, Y] for each storey, the columns within its rooms.
        palette: what may be used; none hangs where it leaves out what lamps are made of.

    Returns:
        How many hang.
    """
    if not all(map(palette.allows, (CHAIN, LANTERN, SHADE, DOWNLIGHT))):
        return 0
    count = 0
    for (ground, end), footprint in zip(canvas.lattice.storeys, footprints, strict=True):
        room = _room(canvas, footprint, ground, end)
        if room is None:
            continue
        for x, y in _places(canvas, room):
            _hang(canvas, room, x, y)
            count += 1
    return count


def _room(canvas: Canvas, footprint: np.ndarray, ground: int, end: int) -> _Room | None:
    ceiling = canvas.semantic[:, :, ground : end + 1] == SemanticClass.CEILING
    if end < canvas.states.shape[2]:
        # The floor over a storey is its ceiling where no other was seen.
        ceiling |= canvas.semantic[:, :, ground : end + 1] == SemanticClass.FLOOR
    layers = (ceiling & footprint[:, :, None]).sum((0, 1))
    if not layers.any():
        return None
    level = ground + int(layers.argmax())
    return _Room(ground, level, footprint & ceiling[:, :, level - ground])


def _places(canvas: Canvas, room: _Room) -> list[tuple[int, int]]:
    """Return the columns of lamps: tables first, then the middles of what stays dark."""
    scale = canvas.lattice.blocks_per_metre
    free = canvas.mask_of(AIR)[:, :, : room.level]
    clear = room.columns & free[:, :, -max(1, round(CORD_M * scale) + 1) :].all(2)
    away = nearest_set_cells(~np.pad(room.columns, 1))[1][1:-1, 1:-1]
    places: list[tuple[int, int]] = []
    for middle in _tables(canvas, room):
        _take(places, clear, middle)
    reach = REACH_M * scale
    dark = clear & (away >= min(WALL_M * scale, away.max()))
    while len(places) < MOST:
        for place in places:
            dark &= _distance(dark.shape, place) > reach
        if not dark.any():
            return places
        best = np.unravel_index(int(np.where(dark, away, -1).argmax()), dark.shape)
        places.append((int(best[0]), int(best[1])))
    return places


def _tables(canvas: Canvas, room: _Room) -> list[np.ndarray]:
    """Return the middles, float64 [2] each, of a storey's tables, the largest first."""
    layers = slice(room.ground, room.level)
    tables = canvas.semantic[:, :, layers] == SemanticClass.TABLE
    plan = np.where(tables, canvas.instance[:, :, layers], 0).max(2)
    numbers, counts = np.unique(plan[plan > 0], return_counts=True)
    order = np.lexsort((numbers, -counts))
    return [np.argwhere(plan == numbers[i]).mean(0) for i in order]


def _take(places: list[tuple[int, int]], clear: np.ndarray, middle: np.ndarray) -> None:
    """Add the column nearest to a table's middle, where one is free within a block."""
    x, y = np.floor(middle + 0.5).astype(int).tolist()
    if clear[x, y] and (x, y) not in places:
        places.append((x, y))


def _distance(shape: tuple[int, ...], place: tuple[int, int]) -> np.ndarray:
    x, y = np.indices(shape, sparse=True)
    return np.hypot(x - place[0], y - place[1])


def _hang(canvas: Canvas, room: _Room, x: int, y: int) -> None:
    scale = canvas.lattice.blocks_per_metre
    wide = max(1, round(LAMP_M * scale))
    tall = max(1, round(wide / 2))
    column = canvas.semantic[x, y, room.ground : room.level]
    under = TABLE_M if (column == SemanticClass.TABLE).any() else WALK_M
    lowest = room.ground + max(WALK_BLOCKS, int(np.ceil(under * scale)))
    cord = min(round(CORD_M * scale), room.level - tall - lowest)
    kind = int(SemanticClass.OBJS)
    if cord < 0 or (wide > 1 and not _fits(canvas, room, x, y, wide, tall + cord)):
        canvas.put((x, y, room.level), canvas.id_of(DOWNLIGHT), int(SemanticClass.CEILING))
        return
    for z in range(room.level - cord, room.level):
        canvas.put((x, y, z), canvas.id_of(CHAIN), kind)
    low = room.level - cord - tall
    start = (x - (wide - 1) // 2, y - (wide - 1) // 2)
    box = (*(slice(a, a + wide) for a in start), slice(low, low + tall))
    canvas.put(box, canvas.id_of(LANTERN if wide == 1 else SHADE), kind)


def _fits(canvas: Canvas, room: _Room, x: int, y: int, wide: int, depth: int) -> bool:
    """Whether a wide shade has air around it."""
    low_x, low_y = x - (wide - 1) // 2, y - (wide - 1) // 2
    if min(low_x, low_y) < 0:
        return False
    box = canvas.mask_of(AIR)[
        low_x : low_x + wide, low_y : low_y + wide, room.level - depth : room.level
    ]
    return box.shape[:2] == (wide, wide) and bool(box.all())

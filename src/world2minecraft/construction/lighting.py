"""Light for a room: hanging lamps, and invisible light blocks in dark places.

A lamp hangs from the ceiling by chains if a person can walk under it, otherwise it is set flush
into the ceiling. Without a ceiling no lamp hangs. Light blocks start as a regular lattice; more are
added where a floor or the air of the room stays too dark. Lamps and glowing furniture are included.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.construction.canvas import AIR, LIGHT, Canvas
from world2minecraft.construction.palettes import Palette
from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.connected_components import label_face_components
from world2minecraft.geometry.morphology import nearest_set_cells
from world2minecraft.minecraft.rules.light import (
    BRIGHTEST,
    emitted_light,
    lets_light_through,
    spread_light,
)

LAMP_M = 0.3  # A shade's width.
CORD_M = 0.35
WALK_M, WALK_BLOCKS = 2.0, 2  # Headroom below a lamp for a person and a player.
TABLE_M = 1.45  # Over a table nobody walks.
REACH_M = 2.6  # Assumed range of a lamp, in metres; lamps stand about 4 m apart.
WALL_M = 0.5  # No lamp hangs nearer to a wall, unless the room is that narrow.
MAX_LAMPS = 24  # Lamps a storey.
CHAIN = "minecraft:chain[axis=y,waterlogged=false]"
LANTERN = "minecraft:lantern[hanging=true,waterlogged=false]"
SHADE = DOWNLIGHT = "minecraft:ochre_froglight[axis=y]"
LEVEL = BRIGHTEST
MIN_LIGHT = 8  # Minimum light on walkable floor cells; monsters spawn at 0.
MIN_CORNER_LIGHT = 5  # Assumed minimum light in the air of a room; walls there are dim.
ABOVE_FLOOR = 2  # Over the head of a player that stands.
SPACING = 8  # Blocks between lights: half way, at the floor, the light is still 8 or more.
APART = 6  # Blocks between lights that are added in one round.


class _Room(NamedTuple):
    """The space for lamps in a storey: its first layer, its ceiling layer and the columns."""

    ground: int
    level: int
    columns: np.ndarray  # bool [X, Y]


def hang_lamps(canvas: Canvas, footprints: tuple[np.ndarray, ...], palette: Palette) -> int:
    """Hang lamps, in place, in every storey that has a ceiling.

    Args:
        canvas: Canvas with the finished blocks.
        footprints: Bool [X, Y] mask of the columns within the rooms, for each storey.
        palette: Allowed blocks; no lamp is placed if the palette excludes the lamp's blocks.

    Returns:
        The number of lamps.
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
    """Return the columns of lamps: above tables first, then in the centres of dark areas."""
    scale = canvas.lattice.blocks_per_metre
    free = canvas.mask_of(AIR)[:, :, : room.level]
    clear = room.columns & free[:, :, -max(1, round(CORD_M * scale) + 1) :].all(2)
    away = nearest_set_cells(~np.pad(room.columns, 1))[1][1:-1, 1:-1]
    places: list[tuple[int, int]] = []
    for middle in _tables(canvas, room):
        _take(places, clear, middle)
    reach = REACH_M * scale
    dark = clear & (away >= min(WALL_M * scale, away.max()))
    while len(places) < MAX_LAMPS:
        for place in places:
            dark &= _distance(dark.shape, place) > reach
        if not dark.any():
            return places
        best = np.unravel_index(int(np.where(dark, away, -1).argmax()), dark.shape)
        places.append((int(best[0]), int(best[1])))
    return places


def _tables(canvas: Canvas, room: _Room) -> list[np.ndarray]:
    """Return the centres of a storey's tables, float64 [2] each, the largest first."""
    layers = slice(room.ground, room.level)
    tables = canvas.semantic[:, :, layers] == SemanticClass.TABLE
    plan = np.where(tables, canvas.instance[:, :, layers], 0).max(2)
    numbers, counts = np.unique(plan[plan > 0], return_counts=True)
    order = np.lexsort((numbers, -counts))
    return [np.argwhere(plan == numbers[i]).mean(0) for i in order]


def _take(places: list[tuple[int, int]], clear: np.ndarray, middle: np.ndarray) -> None:
    """Add the column closest to a table's centre if one is free within a block."""
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
    """Return whether a wide lampshade is surrounded by air."""
    low_x, low_y = x - (wide - 1) // 2, y - (wide - 1) // 2
    if min(low_x, low_y) < 0:
        return False
    box = canvas.mask_of(AIR)[
        low_x : low_x + wide, low_y : low_y + wide, room.level - depth : room.level
    ]
    return box.shape[:2] == (wide, wide) and bool(box.all())


def put_lights(canvas: Canvas, footprints: tuple[np.ndarray, ...]) -> None:
    """Place light blocks in a canvas, in place, storey by storey.

    Args:
        canvas: Canvas with the finished blocks.
        footprints: Bool [X, Y] mask of the columns within the rooms, for each storey.
    """
    gives = np.array([emitted_light(state) for state in canvas.palette], np.uint8)[canvas.states]
    clear = passes_light(canvas.palette)[canvas.states]
    air = canvas.mask_of(AIR)
    for (ground, end), footprint in zip(canvas.lattice.storeys, footprints, strict=True):
        _light_storey(canvas, gives, air, clear, footprint, ground, end)
    canvas.states[(gives == LEVEL) & air] = canvas.id_of(LIGHT)


def _light_storey(canvas, gives, air, clear, footprint, ground, end) -> None:
    """Choose, in place, the lights of a storey, given its first layer and exclusive end."""
    offset = SPACING // 2
    top = min(_top_of(canvas, ground), end - 1)
    spots = np.zeros_like(air)
    for z in {ground + ABOVE_FLOOR, *range(ground + ABOVE_FLOOR + SPACING, top, SPACING)}:
        spots[offset::SPACING, offset::SPACING, min(z, top)] = True
    spots &= air & footprint[:, :, None]
    if (gives > 0).any():
        spots &= spread_light(gives, clear) < MIN_LIGHT  # Where a lamp shines none is needed.
    gives[spots] = LEVEL
    walkable = walkable_cells(canvas.states, canvas.palette, footprint, ground)
    least = np.zeros(air.shape, np.uint8)
    least[_air_of(air, walkable, footprint, (ground, top))] = MIN_CORNER_LIGHT
    least[:, :, ground][walkable] = MIN_LIGHT
    _light_the_dark(gives, least, air, clear)


def _air_of(air, walkable, footprint, layers) -> np.ndarray:
    """Return the visible air of a storey, bool [X, Y, Z], without the inside of cupboards."""
    ground, top = layers
    room = np.zeros_like(air)
    inside = slice(ground, top + 1)
    room[:, :, inside] = air[:, :, inside] & footprint[:, :, None]
    parts, _ = label_face_components(room)
    seen = np.unique(parts[:, :, ground][walkable])
    return np.isin(parts, seen[seen > 0])


def _light_the_dark(gives, least, air, clear) -> None:
    """Add lights, in place, until every cell has its minimum light."""
    while True:
        dark = spread_light(gives, clear) < least
        if not dark.any():
            return
        # One for each box of a few blocks, so that few rounds are needed.
        cells = np.argwhere(dark)
        _, first = np.unique(cells // APART, axis=0, return_index=True)
        for x, y, z in cells[first].tolist():
            above = z + 1 < air.shape[2] and air[x, y, z + 1] and not air[x, y, z]
            gives[x, y, z + 1 if above else z] = LEVEL


def _top_of(canvas: Canvas, ground: int) -> int:
    """Return the highest layer below the highest visible block, at least that above the floor."""
    layers = np.flatnonzero((canvas.semantic > 0).any((0, 1)))
    least = ground + ABOVE_FLOOR
    return min(max(int(layers.max()) - 1 if len(layers) else 0, least), canvas.states.shape[2] - 1)


def passes_light(palette: tuple[str, ...]) -> np.ndarray:
    """Return the bool [N] mask of states that block light passes, which are not full cubes."""
    return np.array([lets_light_through(state) for state in palette], bool)


def walkable_cells(
    states: np.ndarray, palette: tuple[str, ...], footprint: np.ndarray, ground: int
) -> np.ndarray:
    """Return the bool [X, Y] mask of the columns with two blocks of air above the floor."""
    numbers = [i for i, state in enumerate(palette) if state in (AIR, LIGHT)]
    free = np.isin(states[:, :, ground : ground + 2], numbers).all(2)
    floor = states[:, :, ground - 1] != 0
    return free & floor & footprint

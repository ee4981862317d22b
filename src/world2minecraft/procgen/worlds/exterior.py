"""The outside of houses: an outer wall with a plinth, corner posts and framed openings; a roof.

Its blocks have the unknown class because they are not part of any room.
"""

from dataclasses import dataclass, replace
from itertools import groupby
from typing import Literal

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.minecraft.block_states import known_blocks
from world2minecraft.procgen.worlds.block_house import BlockGap, BlockHouse
from world2minecraft.procgen.worlds.canvas import WorldCanvas
from world2minecraft.procgen.worlds.styles import RoomLook, Style

EAVES_M, PLINTH_M, CHIMNEY_M = 0.4, 0.5, 0.7
SHED_RISE = 4  # Half blocks that the roof of a part lower than its neighbour rises at most.
PITCHES = (1.0, 1.0, 1.5)  # Half blocks per block: 27 or 37 degrees.
CHIMNEY_SHARE = 0.7
EIGHT = np.ones((3, 3), bool)


@dataclass(frozen=True)
class Exterior:
    """The form and the materials of the outside of a house.

    Attributes:
        form: Whether the walls below the roof's ends rise to the ridge or the roof slopes there.
        pitch: Rise of the roof in half blocks per block.
        wall: Block of the outer wall.
        plinth: Block of the plinth, of the sills and of the chimney.
        wood: Planks of gables and the edges of roofs, without the ending.
        post: Block of the corner posts and of the frames.
        roof: The roof's block that has a slab, without the ending.
        has_chimney: Whether the roof has a chimney.
    """

    form: Literal["gable", "hip"]
    pitch: float
    wall: str
    plinth: str
    wood: str
    post: str
    roof: str
    has_chimney: bool


def draw_exterior(style: Style, look: RoomLook, rng: np.random.Generator) -> Exterior:
    """Choose a random exterior of a style, in a wood of a room that its walls are not of."""
    draws = rng.random(4)
    wall = style.facades[int(draws[2] * len(style.facades))]
    if wall.startswith(look.wood):
        look = replace(look, wood=look.second_wood)
    return Exterior(
        form="gable" if draws[0] < 0.6 else "hip",
        pitch=PITCHES[int(draws[1] * len(PITCHES))],
        wall=wall,
        plinth=style.plinths[int(rng.integers(len(style.plinths)))],
        wood=look.wood,
        post=look.frame.removeprefix("minecraft:"),
        roof=style.roofs[int(rng.integers(len(style.roofs)))],
        has_chimney=bool(draws[3] < CHIMNEY_SHARE),
    )


def roof_layers(house: BlockHouse, exterior: Exterior) -> int:
    """Return an upper bound of the layers that the roof and chimney need above the ceiling."""
    half = (house.size[1] + 4) / 2 + eaves_blocks(house.blocks_per_metre)
    return int(np.ceil(exterior.pitch * (half + 1) / 2)) + 4


def eaves_blocks(blocks_per_metre: float) -> int:
    """Return by how many blocks the roof overhangs the outer wall."""
    return max(1, round(EAVES_M * blocks_per_metre))


def outer_walls(canvas: WorldCanvas, house: BlockHouse, storey: int) -> np.ndarray:
    """Return the columns of a storey's rooms and walls, both layers of them, as bool [X, Y]."""
    rooms = [room.floor(house.size) for room in house.rooms if room.storey == storey]
    inside = np.pad(np.any(rooms, axis=0), canvas.margin)
    return np.asarray(ndimage.binary_dilation(inside, EIGHT, iterations=2), bool)


def put_facade(canvas: WorldCanvas, house: BlockHouse, exterior: Exterior) -> None:
    """Set an outer wall in front of the walls of each storey, with openings and their trim."""
    plinth = max(1, round(PLINTH_M * house.blocks_per_metre))
    for storey, ground in enumerate(house.grounds):
        every = outer_walls(canvas, house, storey)
        skin = every & ~np.asarray(ndimage.binary_erosion(every, EIGHT), bool)
        beside = ndimage.convolve(every.astype(int), [[0, 1, 0], [1, 0, 1], [0, 1, 0]])
        corner = skin & (beside <= 2)
        for z in range(ground - 1 - (storey == 0), ground + house.height + 1):
            wall = exterior.plinth if storey == 0 and z < plinth else exterior.wall
            if z >= ground + house.height or (storey and z == ground - 1):
                wall = exterior.post
            level = canvas.at(0, 0, z)[2]
            _fill(canvas, skin & ~corner, level, wall)
            post = exterior.plinth if wall == exterior.plinth else exterior.post
            _fill(canvas, corner, level, post)
    for gap in house.gaps:
        if len(gap.rooms) == 1:
            _trim(canvas, gap, exterior)


def outward(gap: BlockGap) -> int:
    """Return the step along the axis across the wall that leads out of a gap's first room."""
    return -1 if gap.turn < 2 else 1


def _trim(canvas: WorldCanvas, gap: BlockGap, exterior: Exterior) -> None:
    """Open the outer wall before a gap, and frame it: posts or a sill below, a lintel above."""
    across, along = gap.turn % 2, 1 - gap.turn % 2

    def put(out: int, ends: tuple[int, int], layers: tuple[int, int], block: str) -> None:
        low, high = [0, 0], [0, 0]
        low[across] = gap.low[across] + out * outward(gap)
        high[across] = low[across] + 1
        low[along], high[along] = ends
        box = canvas.box((low[0], low[1], layers[0]), (high[0], high[1], layers[1]))
        canvas.set(box, f"minecraft:{block}", UNKNOWN if block != "air" else 0)

    first, last = gap.low[along], gap.high[along]
    put(1, (first, last), (gap.bottom, gap.top), "air")
    put(1, (first - 1, last + 1), (gap.top, gap.top + 1), exterior.post)
    if gap.kind == "window":
        put(1, (first - 1, last + 1), (gap.bottom - 1, gap.bottom), exterior.post)
        slab = f"{exterior.wood}_slab[type=top]"
        put(2, (first - 1, last + 1), (gap.bottom - 1, gap.bottom), slab)
    else:
        for at in (first - 1, last):
            put(1, (at, at + 1), (gap.bottom, gap.top), exterior.post)


def put_roof(canvas: WorldCanvas, house: BlockHouse, exterior: Exterior) -> None:
    """Set a roof over each part of a house, the ends of gables, and a chimney."""
    eaves = eaves_blocks(house.blocks_per_metre)
    covered = np.zeros(canvas.states.shape[:2], bool)
    for storey in reversed(range(len(house.grounds))):
        walls = outer_walls(canvas, house, storey)
        level = canvas.at(0, 0, house.grounds[storey] + house.height)[2]
        if covered.any():
            _put_shed(canvas, walls, covered, level, eaves, exterior)
        elif exterior.form == "hip":
            wide = ndimage.binary_dilation(walls, EIGHT, iterations=eaves)
            away = ndimage.distance_transform_cdt(wide, "chessboard")
            _put_slope(canvas, np.asarray(away), walls, level, exterior)
        else:
            _put_gables(canvas, walls, level, eaves, exterior)
        if not covered.any() and exterior.has_chimney:
            _put_chimney(canvas, walls, level, house.blocks_per_metre, exterior)
        covered |= walls


def _put_shed(
    canvas: WorldCanvas,
    walls: np.ndarray,
    covered: np.ndarray,
    level: int,
    eaves: int,
    exterior: Exterior,
) -> None:
    """Set a low roof over the walls that no storey covers, which leans on the storey above."""
    lower = walls & ~covered
    if not lower.any():
        return
    wide = ndimage.binary_dilation(lower, EIGHT, iterations=eaves) & ~covered
    away = np.asarray(ndimage.distance_transform_cdt(wide | covered, "chessboard"))
    _put_slope(canvas, np.where(wide, np.minimum(away, SHED_RISE), 0), walls, level, exterior)


def _put_slope(
    canvas: WorldCanvas,
    away: np.ndarray,
    walls: np.ndarray,
    level: int,
    exterior: Exterior,
    edge: np.ndarray | None = None,
) -> None:
    """Set a slope that rises with the distance from its edge, int [X, Y], 0 beside the roof.

    The edge of the roof, by default its lowest blocks, is of wood. Above the columns ``walls``,
    bool [X, Y], the roof is solid: nobody stands in an attic, which tours would take for a room.
    """
    high = np.floor(exterior.pitch * away).astype(int)
    edge = away == 1 if edge is None else edge
    for half in range(1, int(high.max(initial=0)) + 1):
        own = high == half
        top = level + (half - 1) // 2
        for rim in (False, True):
            base = exterior.wood if rim else exterior.roof
            at = own & (edge == rim)
            state = f"{base}_slab[type=bottom]" if half % 2 else full_block(base)
            _fill(canvas, at, top, state)
            for below in range(level, top):
                _fill(canvas, at & (walls | (below == top - 1)), below, full_block(base))


def _fill(canvas: WorldCanvas, columns: np.ndarray, level: int, block: str) -> None:
    """Set a block in the columns that have air at a layer of the canvas."""
    x, y = np.nonzero(columns & (canvas.states[:, :, level] == 0))
    canvas.set((x, y, np.full(len(x), level)), f"minecraft:{block}", UNKNOWN)


def full_block(base: str) -> str:
    """Return the name of the full block of a slab's material.

    Example:
        >>> full_block("oak"), full_block("brick"), full_block("dark_prismarine")
        ('oak_planks', 'bricks', 'dark_prismarine')
    """
    known = known_blocks()
    endings = ("_planks", "s", "_block", "")
    return next(base + end for end in endings if f"minecraft:{base}{end}" in known)


def _put_gables(
    canvas: WorldCanvas, walls: np.ndarray, level: int, eaves: int, exterior: Exterior
) -> None:
    """Set a roof with a ridge along x over each stretch of equal depth, and fill its ends."""
    stretches = []
    columns = np.flatnonzero(walls.any(axis=1)).tolist()
    for (low, high), own in groupby(columns, key=lambda x: _extent(walls[x])):
        xs = list(own)
        stretches.append((xs[0], xs[-1], low, high))
    for first, last, low, high in sorted(stretches, key=lambda one: one[2] - one[3]):
        y = np.arange(walls.shape[1])
        away = np.minimum(y - (low - eaves), high + eaves - y) + 1
        plan = np.zeros(walls.shape, int)
        plan[first - eaves : last + eaves + 1] = np.maximum(away, 0)
        edge = plan == 1
        edge[[first - eaves, last + eaves]] = plan[[first - eaves, last + eaves]] > 0
        tall = np.floor(exterior.pitch * away).astype(int)
        for end in (first, last):
            _put_gable_end(canvas, end, (low, high), level, tall, exterior)
        _put_slope(canvas, plan, walls, level, exterior, edge)


def _extent(row: np.ndarray) -> tuple[int, int]:
    filled = np.flatnonzero(row)
    return int(filled[0]), int(filled[-1])


def _put_gable_end(
    canvas: WorldCanvas,
    x: int,
    ends: tuple[int, int],
    level: int,
    tall: np.ndarray,
    exterior: Exterior,
) -> None:
    """Fill the wall below one end of a roof with planks, and set a small window in its middle."""
    for y in range(ends[0], ends[1] + 1):
        for z in range(level + 1, level + (int(tall[y]) - 1) // 2):
            if canvas.states[x, y, z] == 0:
                canvas.set((x, y, z), f"minecraft:{full_block(exterior.wood)}", UNKNOWN)
    middle = (ends[0] + ends[1]) // 2
    free = (int(tall[middle]) - 1) // 2 - 3  # Layers of wall, without the lowest and highest.
    if free >= 2:
        low = level + 1 + free // 3
        window = (x, slice(middle - 1, middle + 2), slice(low, low + min(3, free - free // 3)))
        canvas.set(window, f"minecraft:{exterior.post}", UNKNOWN)
        canvas.set((x, middle, window[2]), "minecraft:glass", UNKNOWN)


def _put_chimney(
    canvas: WorldCanvas, walls: np.ndarray, level: int, scale: float, exterior: Exterior
) -> None:
    """Set a chimney near the ridge that stands out above it."""
    wide = max(1, round(CHIMNEY_M * scale))
    x0, x1 = _extent(np.asarray(walls.any(axis=1)))
    x = x0 + (x1 - x0) // 3
    low, high = _extent(walls[x])
    y = (low + high) // 2 + wide
    ridge = int(np.flatnonzero(canvas.states[x : x + wide].any(axis=(0, 1))).max())
    box = (slice(x, x + wide), slice(y, y + wide), slice(level + 1, ridge + 3))
    canvas.set(box, f"minecraft:{exterior.plinth}", UNKNOWN)

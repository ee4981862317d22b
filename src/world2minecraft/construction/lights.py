"""Light for a room: invisible light blocks in free air, so that no floor and no corner is dark.

A lattice of lights comes first; where it leaves a place one stands at, or any air of the room, too
dark, more are set. Lamps and glowing furniture that stand already count.
"""

import numpy as np

from world2minecraft.construction.canvas import AIR, LIGHT, Canvas
from world2minecraft.geometry.connected_components import label_face_components
from world2minecraft.minecraft.rules.light import (
    BRIGHTEST,
    lets_light_through,
    light_of,
    spread_light,
)

LEVEL = BRIGHTEST
LEAST = 8  # Of a walkable floor cell; monsters need 0, and a person reads at 8.
LEAST_CORNER = 5  # Of any air in the room. A guess: a wall there is dim, and not black.
ABOVE_FLOOR = 2  # Over the head of a player that stands.
SPACING = 8  # Blocks between lights: half way, at the floor, the light is still 8 or more.
APART = 6  # Blocks between lights that are added in one round.


def put_lights(canvas: Canvas, footprints: tuple[np.ndarray, ...]) -> None:
    """Light a canvas in place, storey by storey.

    Args:
        canvas: its finished blocks.
        footprints: bool [X, Y] for each storey, the columns within its rooms.
    """
    gives = np.array([light_of(state) for state in canvas.palette], np.uint8)[canvas.states]
    clear = passes_light(canvas.palette)[canvas.states]
    air = canvas.mask_of(AIR)
    for (ground, end), footprint in zip(canvas.lattice.storeys, footprints, strict=True):
        _light_storey(canvas, gives, air, clear, footprint, ground, end)
    canvas.states[(gives == LEVEL) & air] = canvas.id_of(LIGHT)


def _light_storey(canvas, gives, air, clear, footprint, ground, end) -> None:
    """Choose, in place, the lights of one storey: its first layer over the floor and its end."""
    offset = SPACING // 2
    top = min(_top_of(canvas, ground), end - 1)
    spots = np.zeros_like(air)
    for z in {ground + ABOVE_FLOOR, *range(ground + ABOVE_FLOOR + SPACING, top, SPACING)}:
        spots[offset::SPACING, offset::SPACING, min(z, top)] = True
    spots &= air & footprint[:, :, None]
    if (gives > 0).any():
        spots &= spread_light(gives, clear) < LEAST  # Where a lamp shines none is needed.
    gives[spots] = LEVEL
    walkable = walkable_cells(canvas.states, canvas.palette, footprint, ground)
    least = np.zeros(air.shape, np.uint8)
    least[_air_of(air, walkable, footprint, (ground, top))] = LEAST_CORNER
    least[:, :, ground][walkable] = LEAST
    _light_the_dark(gives, least, air, clear)


def _air_of(air, walkable, footprint, layers) -> np.ndarray:
    """Return the air, bool [X, Y, Z], of a storey that one sees into: none within cupboards."""
    ground, top = layers
    room = np.zeros_like(air)
    inside = slice(ground, top + 1)
    room[:, :, inside] = air[:, :, inside] & footprint[:, :, None]
    parts, _ = label_face_components(room)
    seen = np.unique(parts[:, :, ground][walkable])
    return np.isin(parts, seen[seen > 0])


def _light_the_dark(gives, least, air, clear) -> None:
    """Add lights, in place, until every cell has its least light."""
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
    """Return the highest layer under the highest visible block, at least that over the floor."""
    layers = np.flatnonzero((canvas.semantic > 0).any((0, 1)))
    least = ground + ABOVE_FLOOR
    return min(max(int(layers.max()) - 1 if len(layers) else 0, least), canvas.states.shape[2] - 1)


def passes_light(palette: tuple[str, ...]) -> np.ndarray:
    """Return which states let block light through, bool [N]: those that fill no whole cube."""
    return np.array([lets_light_through(state) for state in palette], bool)


def walkable_cells(
    states: np.ndarray, palette: tuple[str, ...], footprint: np.ndarray, ground: int
) -> np.ndarray:
    """Return the columns, bool [X, Y], where a player stands on the floor: two blocks of air."""
    numbers = [i for i, state in enumerate(palette) if state in (AIR, LIGHT)]
    free = np.isin(states[:, :, ground : ground + 2], numbers).all(2)
    floor = states[:, :, ground - 1] != 0
    return free & floor & footprint

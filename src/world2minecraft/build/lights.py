"""Light for a room: invisible light blocks in free air, so that no floor is dark.

Block light falls by one for each block it goes, and opaque blocks stop it. A lattice of lights
comes first; floor cells that stay dark get one of their own.
"""

import numpy as np

from world2minecraft.build.canvas import AIR, LIGHT, Canvas
from world2minecraft.minecraft.shapes import is_full_cube
from world2minecraft.types import BlockVolume

LEVEL = 15
LEAST = 8  # Of a walkable floor cell; monsters need 0, and a person reads at 8.
ABOVE_FLOOR = 2  # Over the head of a player that stands.
SPACING = 8  # Blocks between lights: half way, at the floor, the light is still 8 or more.
_TRANSPARENT = ("glass", "_pane", "barrier", "light")


def put_lights(canvas: Canvas, footprints: tuple[np.ndarray, ...]) -> None:
    """Light a canvas in place, storey by storey.

    Args:
        canvas: its finished blocks.
        footprints: bool [X, Y] for each storey, the columns within its rooms.
    """
    clear = passes_light(canvas.palette)[canvas.states]
    air = canvas.mask_of(AIR)
    chosen = np.zeros(air.shape, bool)
    for (ground, end), footprint in zip(canvas.lattice.storeys, footprints, strict=True):
        _light_storey(canvas, chosen, air, clear, footprint, ground, end)
    canvas.states[chosen] = canvas.id_of(LIGHT)


def _light_storey(canvas, chosen, air, clear, footprint, ground, end) -> None:
    """Choose, in place, the lights of one storey: its first layer over the floor and its end."""
    spots = air & footprint[:, :, None]
    offset = SPACING // 2
    top = min(_top_of(canvas, ground), end - 1)
    held = chosen.copy()
    for z in {ground + ABOVE_FLOOR, *range(ground + ABOVE_FLOOR + SPACING, top, SPACING)}:
        chosen[offset::SPACING, offset::SPACING, min(z, top)] = True
    chosen &= spots | held
    walkable = walkable_cells(canvas.states, canvas.palette, footprint, ground)
    _light_the_dark(chosen, walkable, air, clear, ground)


def _light_the_dark(chosen, walkable, air, clear, ground) -> None:
    """Add lights, in place, until every walkable floor cell is lit."""
    while True:
        light = spread_light(np.where(chosen, LEVEL, 0).astype(np.uint8), clear)
        dark = walkable & (light[:, :, ground] < LEAST)
        if not dark.any():
            return
        # The first dark cell and all that are out of its reach: so few rounds are needed.
        taken: list[tuple[int, int]] = []
        for x, y in np.argwhere(dark).tolist():
            if all(abs(x - a) + abs(y - b) > LEVEL - LEAST for a, b in taken):
                taken.append((x, y))
                z = ground + 1 if air[x, y, ground + 1] else ground
                chosen[x, y, z] = True


def _top_of(canvas: Canvas, ground: int) -> int:
    """Return the highest layer under the highest visible block, at least that over the floor."""
    layers = np.flatnonzero((canvas.semantic > 0).any((0, 1)))
    least = ground + ABOVE_FLOOR
    return min(max(int(layers.max()) - 1 if len(layers) else 0, least), canvas.states.shape[2] - 1)


def passes_light(palette: tuple[str, ...]) -> np.ndarray:
    """Return which states let block light through, bool [N]: those that fill no whole cube."""
    names = [state.partition("[")[0] for state in palette]
    return np.array(
        [
            name.endswith(_TRANSPARENT) or not is_full_cube(state)
            for name, state in zip(names, palette, strict=True)
        ]
    )


def walkable_cells(
    states: np.ndarray, palette: tuple[str, ...], footprint: np.ndarray, ground: int
) -> np.ndarray:
    """Return the columns, bool [X, Y], where a player stands on the floor: two blocks of air."""
    numbers = [i for i, state in enumerate(palette) if state in (AIR, LIGHT)]
    free = np.isin(states[:, :, ground : ground + 2], numbers).all(2)
    floor = states[:, :, ground - 1] != 0
    return free & floor & footprint


def spread_light(sources: np.ndarray, clear: np.ndarray) -> np.ndarray:
    """Return the block light everywhere, uint8 [X, Y, Z].

    Args:
        sources: uint8 [X, Y, Z], the light that a block gives itself, 0 to 15.
        clear: bool [X, Y, Z], where light goes through.
    """
    light = sources.copy()
    for level in range(LEVEL, 1, -1):
        bright = np.argwhere(light == level)
        for axis in range(3):
            for step in (-1, 1):
                near = bright.copy()
                near[:, axis] += step
                near = near[(near[:, axis] >= 0) & (near[:, axis] < light.shape[axis])]
                at = tuple(near.T)
                grows = clear[at] & (light[at] < level - 1)
                light[tuple(near[grows].T)] = level - 1
    return light


def light_of_volume(volume: BlockVolume) -> np.ndarray:
    """Return the block light of a finished volume, uint8 [X, Y, Z], from its light blocks."""
    glows = np.array([LEVEL if state == LIGHT else 0 for state in volume.palette], np.uint8)
    return spread_light(glows[volume.states], passes_light(volume.palette)[volume.states])

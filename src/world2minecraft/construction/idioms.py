"""Vanilla designs of furniture in their places and in the real colours.

The materials of a design say which roles take the object's colour (``tinting``). A template of
another package that says nothing of materials is recoloured by the names of its blocks: the room
chooses the wood and the dye, and a full block whose colour is far off becomes a plain one.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.lattice import Lattice
from world2minecraft.construction.palettes import Palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.tinting import Hue, tinted
from world2minecraft.core.coordinates import cells_to_block_axes
from world2minecraft.core.types import Placement
from world2minecraft.furniture import Idiom
from world2minecraft.furniture.block_designs import block_size
from world2minecraft.geometry.colour import oklab_of_srgb
from world2minecraft.minecraft.block_colours import (
    DYES,
    WOODS,
    colour_of,
    colours_of,
    nearest_oklab,
)
from world2minecraft.minecraft.collision_shapes import is_full_cube

_KEPT_DYES = ("white",)  # A design's own white is meant: a pillow, a sheet.
LIFTED_UNDER, HIGH_M = (
    1.5,
    1.2,
)  # Blocks per metre; what hangs so high over the floor has air below.
TIE = 1e-6
OWN_COLOUR = 0.1  # Oklab distance up to which a design's full block keeps its own look. A guess.


class Thing(NamedTuple):
    """Whose blocks are set."""

    class_id: int
    instance: int


def idiom_box(
    design: Idiom, placement: Placement, lattice: Lattice
) -> tuple[np.ndarray, np.ndarray]:
    """Return the first block and the size, int [3] each in room axes, of a design in its place.

    Handles and the like that stand out to the front do not push the rest into the wall behind.
    """
    along, up, across = design.size
    size = np.array([along, across, up])
    middle = lattice.coordinates_of(placement.center_m)
    bottom = middle[2] - placement.size_m[2] * lattice.blocks_per_metre / 2
    axis, out = placement.quarter_turns % 2, _standing_out(design, placement, lattice)
    solid = size - np.where(np.arange(3) == axis, out, 0)
    low = np.floor(np.array([*(middle[:2] - solid[:2] / 2), bottom]) + 0.5).astype(int)
    if placement.quarter_turns >= 2:  # The front looks to where coordinates fall.
        low[axis] -= out
    ground = lattice.ground_under(float(bottom))
    if (
        lattice.blocks_per_metre < LIFTED_UNDER
        and (bottom - ground) / lattice.blocks_per_metre >= HIGH_M
    ):
        low[2] = int(np.ceil(bottom - TIE))  # Else a wall unit would stand on the counter below.
    most = np.maximum(np.array(lattice.shape) - size, 0)
    least = [0, 0, ground]
    return np.clip(low, least, np.maximum(most, least)), size


def body_box(
    design: Idiom, placement: Placement, lattice: Lattice, low: np.ndarray, size: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the first block and the size, int [3] each, of a design without what stands out.

    An object's front colours the front of its body, not the handles before it.
    """
    axis, out = placement.quarter_turns % 2, _standing_out(design, placement, lattice)
    along = np.arange(3) == axis
    start = low + np.where(along & (placement.quarter_turns >= 2), out, 0)
    return start, size - np.where(along, out, 0)


def _standing_out(design: Idiom, placement: Placement, lattice: Lattice) -> int:
    """Return by how many blocks a design stands out to its front alone."""
    own = block_size(placement.size_m, lattice.blocks_per_metre)
    along, _, across = design.size
    depth, width = (across, along) if placement.quarter_turns % 2 else (along, across)
    return max(depth - own.depth, 0) if width <= own.width else 0


def filled_by(design: Idiom) -> np.ndarray:
    """Return the blocks that a design fills, bool [X, Y, Z] in room axes."""
    along, up, across = design.size
    filled = np.zeros((along, across, up), bool)
    filled[tuple(_cells_of(design).T)] = True
    return filled


def _cells_of(design: Idiom) -> np.ndarray:
    """Return where the blocks of a design stand in its box, int [N, 3] in room axes."""
    offsets = np.array([block.offset for block in design.blocks]).reshape(-1, 3)
    # Offsets are in block axes already: their inverse map is the map itself.
    return cells_to_block_axes(offsets[:, [0, 2, 1]], design.size[2])[:, [0, 2, 1]]


def put_idiom(
    canvas: Canvas,
    design: Idiom,
    low: np.ndarray,
    thing: Thing,
    hue: Hue,
    palette: Palette,
    within: np.ndarray,
    parameters: BuildParameters | None = None,
) -> None:
    """Set a design, as far as nothing stands there, in the object's colours.

    Args:
        canvas: where to set it.
        design: blocks with offsets in block axes.
        low: int [3], its first block on the canvas, in room axes.
        thing: the object's class and instance.
        hue: the object's colours in its box of blocks.
        palette: the blocks that may replace the design's own full ones.
        within: bool [X, Y, Z], where things may stand.
        parameters: how colours are weighed.
    """
    shape = canvas.states.shape
    local = _cells_of(design)
    states = _states(design, local, thing, hue, palette, parameters or BuildParameters())
    for cell, state in zip(local.tolist(), states, strict=True):
        at = tuple((low + cell).tolist())
        if any(i >= side for i, side in zip(at, shape, strict=True)) or canvas.states[at]:
            continue
        if within[at]:
            canvas.put(at, canvas.id_of(state), thing.class_id, thing.instance)


def _states(
    design: Idiom,
    cells: np.ndarray,
    thing: Thing,
    hue: Hue,
    palette: Palette,
    parameters: BuildParameters,
) -> list[str]:
    if design.materials:
        blocks, materials = design.blocks, design.materials
        return tinted(blocks, cells, materials, hue, thing.class_id, palette, parameters)
    median = np.median(hue.colours[hue.known], axis=0) if hue.known.any() else hue.paint
    states = []
    for cell, block in zip(cells.tolist(), design.blocks, strict=True):
        colour = hue.colours[tuple(cell)] if hue.known[tuple(cell)] else median
        states.append(
            block.state if colour is None else _in_colour(block.state, colour, thing, palette)
        )
    return states


def _in_colour(state: str, colour: np.ndarray, thing: Thing, palette: Palette) -> str:
    own = recoloured(state, colour)
    apart = np.linalg.norm(oklab_of_srgb(np.array(colour_of(own), np.uint8)) - colour)
    if apart <= OWN_COLOUR or not is_full_cube(own):
        return own
    choices = palette.blocks[thing.class_id]
    return choices[int(nearest_oklab(colour[None], oklab_of_srgb(colours_of(choices)))[0])]


def recoloured(state: str, colour: np.ndarray) -> str:
    """Return a state of the same kind in the wood or dye nearest to an Oklab colour."""
    namespace, _, rest = state.partition(":")
    name, bracket, properties = rest.partition("[")
    for kinds, sample in ((WOODS, "_planks"), (DYES, "_wool")):
        kind = _kind_of(name, kinds)
        if kind is None or kind in _KEPT_DYES:
            continue
        offered = oklab_of_srgb(colours_of([each + sample for each in kinds]))
        best = kinds[int(nearest_oklab(colour[None], offered)[0])]
        return f"{namespace}:{best}{name.removeprefix(kind)}{bracket}{properties}"
    return state


def _kind_of(name: str, kinds: tuple[str, ...]) -> str | None:
    fitting = [kind for kind in kinds if name.startswith(kind + "_")]
    return max(fitting, key=len, default=None)

"""Vanilla designs of furniture, for scales at which parts would crumble, in the real colours.

A design names blocks of one wood and one dye; the room's own colours choose which. A full block
whose colour is far from the object's becomes a plain block of the right colour: so red cupboards
come out red, and a wooden bookcase keeps its books.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.build.canvas import Canvas
from world2minecraft.build.lattice import Lattice
from world2minecraft.build.palettes import Palette
from world2minecraft.coordinates import cells_to_block_axes
from world2minecraft.furniture import Idiom
from world2minecraft.geometry.colour import oklab_of_srgb
from world2minecraft.minecraft.colours import colour_of, colours_of, nearest_oklab
from world2minecraft.minecraft.shapes import is_full_cube
from world2minecraft.types import Placement

WOODS = ("oak", "spruce", "birch", "jungle", "acacia", "dark_oak", "mangrove")
DYES = (
    "white",
    "light_gray",
    "gray",
    "black",
    "brown",
    "red",
    "orange",
    "yellow",
    "lime",
    "green",
    "cyan",
    "light_blue",
    "blue",
    "purple",
    "magenta",
    "pink",
)
_KEPT_DYES = ("white",)  # A design's own white is meant: a pillow, a sheet.
OWN_COLOUR = 0.1  # Oklab distance up to which a design's full block keeps its own look. A guess.


class Thing(NamedTuple):
    """Whose blocks are set."""

    class_id: int
    instance: int


def idiom_box(
    design: Idiom, placement: Placement, lattice: Lattice
) -> tuple[np.ndarray, np.ndarray]:
    """Return the first block and the size, int [3] each in room axes, of a design in its place."""
    along, up, across = design.size
    size = np.array([along, across, up])
    middle = lattice.coordinates_of(placement.center_m)
    bottom = middle[2] - placement.size_m[2] * lattice.blocks_per_metre / 2
    low = np.floor(np.array([*(middle[:2] - size[:2] / 2), bottom]) + 0.5).astype(int)
    most = np.maximum(np.array(lattice.shape) - size, 0)
    least = [0, 0, lattice.ground_under(float(bottom))]
    return np.clip(low, least, np.maximum(most, least)), size


def put_idiom(
    canvas: Canvas,
    design: Idiom,
    low: np.ndarray,
    thing: Thing,
    colours: tuple[np.ndarray, np.ndarray],
    palette: Palette,
    within: np.ndarray,
) -> None:
    """Set a design, as far as nothing stands there, in the object's colours.

    Args:
        canvas: where to set it.
        design: blocks with offsets in block axes.
        low: int [3], its first block on the canvas, in room axes.
        thing: the object's class and instance.
        colours: float32 [X, Y, Z, 3], Oklab, of its box of blocks; bool [X, Y, Z], where known.
        palette: the blocks that may replace the design's own full ones.
        within: bool [X, Y, Z], where things may stand.
    """
    tinted, known = colours
    median = np.median(tinted[known], axis=0) if known.any() else None
    offsets = np.array([block.offset for block in design.blocks]).reshape(-1, 3)
    # Offsets are in block axes already: their inverse map is the map itself.
    local = cells_to_block_axes(offsets[:, [0, 2, 1]], design.size[2])[:, [0, 2, 1]]
    shape = canvas.states.shape
    for cell, block in zip(local.tolist(), design.blocks, strict=True):
        at = tuple((low + cell).tolist())
        if any(i >= side for i, side in zip(at, shape, strict=True)) or canvas.states[at]:
            continue
        if not within[at]:
            continue
        colour = tinted[tuple(cell)] if known[tuple(cell)] else median
        state = block.state if colour is None else _in_colour(block.state, colour, thing, palette)
        canvas.put(at, canvas.id_of(state), thing.class_id, thing.instance)


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

"""Vanilla designs of furniture, for scales at which parts would crumble, in the real colours.

A design names blocks of one wood and one dye; the room's own colour chooses which.
"""

import numpy as np

from world2minecraft.build.canvas import Canvas
from world2minecraft.build.palettes import Palette
from world2minecraft.coordinates import cells_to_block_axes
from world2minecraft.furniture import Idiom
from world2minecraft.geometry.colour import oklab_of_srgb
from world2minecraft.minecraft.colours import colours_of, nearest_oklab
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
# The design's own white is meant (a pillow, a sheet) and stays.
_KEPT_DYES = ("white",)


def put_idiom(
    canvas: Canvas,
    design: Idiom,
    placement: Placement,
    colour: np.ndarray | None,
    palette: Palette,
) -> None:
    """Set a design in its place, as far as nothing stands there, in the object's colour.

    Args:
        canvas: where to set it.
        design: blocks with offsets in block axes.
        placement: where it stands.
        colour: float32 [3], the object's median colour in Oklab, or None for the design's own.
        palette: not every palette has vanilla woods; those that do are recoloured.
    """
    lattice = canvas.lattice
    along, up, across = design.size
    middle = lattice.coordinates_of(placement.center_m)
    bottom = middle[2] - placement.size_m[2] * lattice.blocks_per_metre / 2
    size = np.array([along, across, up])
    low = np.floor(np.array([*(middle[:2] - size[:2] / 2), bottom]) + 0.5).astype(int)
    low = np.clip(low, [0, 0, lattice.ground], np.maximum(np.array(lattice.shape) - size, 0))
    offsets = np.array([block.offset for block in design.blocks]).reshape(-1, 3)
    cells = cells_to_block_axes(offsets[:, [0, 2, 1]], across)[:, [0, 2, 1]] + low
    for cell, block in zip(cells.tolist(), design.blocks, strict=True):
        at = tuple(cell)
        if (
            all(0 <= i < n for i, n in zip(at, lattice.shape, strict=True))
            and not canvas.states[at]
        ):
            state = block.state if colour is None else recoloured(block.state, colour)
            canvas.put(at, canvas.id_of(state), placement.class_id, placement.object_id)


def recoloured(state: str, colour: np.ndarray) -> str:
    """Return a state of the same kind in the wood or dye nearest to an Oklab colour."""
    namespace, _, rest = state.partition(":")
    name, bracket, properties = rest.partition("[")
    for kinds, sample in ((WOODS, "_planks"), (DYES, "_wool")):
        kind = _kind_of(name, kinds)
        if kind is None or kind in _KEPT_DYES or name.startswith("stripped_"):
            continue
        offered = oklab_of_srgb(colours_of([each + sample for each in kinds]))
        best = kinds[int(nearest_oklab(colour[None], offered)[0])]
        return f"{namespace}:{best}{name.removeprefix(kind)}{bracket}{properties}"
    return state


def _kind_of(name: str, kinds: tuple[str, ...]) -> str | None:
    fitting = [kind for kind in kinds if name.startswith(kind + "_")]
    return max(fitting, key=len, default=None)

"""Average colours of blocks, and search for the block that is nearest to a colour.

The file ``data/block_colours.json`` contains estimates of the mean sRGB colour of blocks in 1.20.1
and later. Derived blocks such as slabs, stairs and fences have the colour of their material. A mod
block that is not in the table has the colour of the wood or dye that its name starts with, or else
a colour computed from its name, so that it looks the same in every image.
"""

import json
from collections.abc import Sequence
from functools import cache
from hashlib import sha256
from importlib.resources import files

import numpy as np

from world2minecraft.geometry.colour import srgb_to_oklab

# A shape and the endings that its material may have: oak_slab is made of oak_planks,
# stone_brick_wall of stone_bricks, quartz_stairs of quartz_block, white_carpet of white_wool.
WOODS = ("oak", "spruce", "birch", "jungle", "acacia", "dark_oak", "mangrove")
# In the order of the numbers that the game gives them.
DYES = (
    "white",
    "orange",
    "magenta",
    "light_blue",
    "yellow",
    "lime",
    "pink",
    "gray",
    "light_gray",
    "cyan",
    "purple",
    "blue",
    "brown",
    "green",
    "red",
    "black",
)
_SHAPES = (
    "_stairs",
    "_slab",
    "_wall",
    "_fence_gate",
    "_fence",
    "_trapdoor",
    "_door",
    "_button",
    "_pressure_plate",
    "_wall_hanging_sign",
    "_hanging_sign",
    "_wall_sign",
    "_sign",
    "_wall_banner",
    "_candle_cake",
    "_carpet",
    "_bed",
    "_pane",
    "_wood",
    "_hyphae",
    "_cauldron",
    "_wall_head",
    "_wall_skull",
)
_BARKS = ("_log", "_stem")  # Wood and hyphae are bark on all six sides.
_MATERIAL_ENDINGS = (
    "_planks",  # Before the bare name: a bamboo slab is of planks, not of the plant.
    "",
    "s",
    "_block",
    "_wool",
    "_log",
    "_stem",
    "_banner",
    "_candle",
    "_head",
    "_skull",
)
_PREFIXES = ("waxed_", "infested_", "potted_")
_NEAREST_CHUNK = 65_536


@cache
def _table() -> dict[str, tuple[int, int, int]]:
    source = files("world2minecraft.minecraft") / "data" / "block_colours.json"
    return {name: tuple(rgb) for name, rgb in json.loads(source.read_text("utf-8")).items()}


@cache
def colour_of(state: str) -> tuple[int, int, int]:
    """Return the mean sRGB colour of a block state as three bytes.

    Properties are ignored and the namespace is optional. An unknown block has a fixed colour
    computed from its name.

    Example:
        >>> colour_of("minecraft:red_carpet") == colour_of("red_wool")
        True
    """
    name = state.partition("[")[0]
    namespace, _, plain = name.rpartition(":")
    if namespace in ("", "minecraft"):
        found = _known_colour(plain)
        if found is not None:
            return found
    return _hinted_colour(plain) or _name_colour(name)


def _hinted_colour(name: str) -> tuple[int, int, int] | None:
    """Return the colour of the wood or dye at the start of a name such as ``dark_oak_chair``."""
    words = name.split("_")
    for count in (2, 1):
        for ending in ("_planks", "_wool"):
            found = _table().get("_".join(words[:count]) + ending)
            if found is not None and len(words) > count:
                return found
    return None


def _known_colour(name: str) -> tuple[int, int, int] | None:
    table = _table()
    for prefix in _PREFIXES:
        name = name.removeprefix(prefix)
    if name in table:
        return table[name]
    for shape in _SHAPES:
        if name.endswith(shape):
            stem = name.removesuffix(shape)
            for ending in _BARKS if shape in ("_wood", "_hyphae") else _MATERIAL_ENDINGS:
                if stem + ending in table:
                    return table[stem + ending]
    return None


def _name_colour(name: str) -> tuple[int, int, int]:
    red, green, blue = sha256(name.encode()).digest()[:3]
    return 64 + red // 2, 64 + green // 2, 64 + blue // 2  # Neither black nor glaring.


def colours_of(states: Sequence[str]) -> np.ndarray:
    """Return the mean sRGB colours of N block states as uint8 [N, 3]."""
    return np.array([colour_of(state) for state in states], np.uint8).reshape(-1, 3)


def nearest_block(rgb: np.ndarray, candidates: Sequence[str]) -> np.ndarray:
    """Find the block whose colour is nearest to each given colour in Oklab.

    If several candidates are equally near, the first is used.

    Args:
        rgb: sRGB colours, uint8 [N, 3].
        candidates: Block states or block names, at least one.

    Returns:
        Indices into ``candidates``, intp [N].

    Raises:
        ValueError: If ``candidates`` is empty.
    """
    if not candidates:
        raise ValueError("nearest_block needs at least one candidate block")
    return nearest_oklab(srgb_to_oklab(rgb), srgb_to_oklab(colours_of(candidates)))


def nearest_oklab(colours: np.ndarray, candidates: np.ndarray) -> np.ndarray:
    """Return the index of the candidate [M, 3] nearest to each colour [N, 3], as intp [N]."""
    nearest = np.empty(len(colours), np.intp)
    for start in range(0, len(colours), _NEAREST_CHUNK):
        chunk = colours[start : start + _NEAREST_CHUNK, None, :]
        nearest[start : start + _NEAREST_CHUNK] = ((chunk - candidates) ** 2).sum(-1).argmin(1)
    return nearest

"""Small pixel images on block faces, such as a furnace front, the TNT letters or a pumpkin face.

The images were drawn for this program, in ``data/pictures.json``, and are laid over a texture of
another generator: ``own:picture#rrggbb[,#rrggbb...]?base=planks&name=crafting_side``. The first
colour is that of the base, the others are inks 1, 2 and 3.
"""

import json
from collections.abc import Mapping
from functools import cache, lru_cache
from importlib.resources import files
from typing import Any

import numpy as np

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.rendering.block_models.texture_recipes import PREFIX, hex_colour, split_recipe
from world2minecraft.rendering.texture import Texture
from world2minecraft.rendering.textures import GENERATORS, texture_of
from world2minecraft.rendering.textures.pixel_art import letters as stencil_letters

PICTURE = "picture"
# Letters that make the base darker or lighter, and inks that every picture may use.
SHADES = {".": 1.0, "d": 0.74, "D": 0.52, "x": 0.34, "l": 1.16, "L": 1.32}
HOLE = "_"


def picture_of(recipe: str, size_px: int) -> Texture:
    """Return the texture with a pixel image.

    Args:
        recipe: Texture name, as explained in the module docstring.
        size_px: Texture size, 16 to 128, a multiple of the letters per row.

    Raises:
        UnknownNameError: If there is no image of this name.
    """
    _, colours, options = split_recipe(recipe)
    name = options.get("name", "")
    if name not in load_pictures():
        raise UnknownNameError("picture", name, load_pictures())
    under = texture_of(f"{PREFIX}{options.get('base', 'plain')}{hex_colour(colours[0])}", size_px)
    return _paint(under, load_pictures()[name], colours)


@lru_cache(maxsize=1 << 14)
def has_texture(words: str) -> bool:
    """Return whether the generator, and the pixel image if one is named, of a skin exist."""
    generator, *rest = words.split()
    if generator != PICTURE:
        return generator in GENERATORS
    pairs = [word.partition("=") for word in rest]
    options = {key: value for key, _, value in pairs}
    return options.get("name") in load_pictures() and options.get("base", "plain") in GENERATORS


@cache
def load_pictures() -> Mapping[str, Mapping[str, Any]]:
    """Load the pixel images, once: rows of letters, inks, and which inks glow."""
    path = files("world2minecraft.rendering.block_models").joinpath("data/pictures.json")
    raw = json.loads(path.read_text("utf-8"))
    common = {"common": raw["common"]}
    return {name: {**common, **entry} for name, entry in raw["pictures"].items()}


def letters_of(picture: Mapping[str, Any]) -> np.ndarray:
    """Return the letters of a pixel image, str [N, N]. Half images are mirrored to the right."""
    rows = [row + row[::-1] if picture.get("mirror") else row for row in picture["rows"]]
    return np.array([list(row) for row in rows])


def _enlarge(rows: np.ndarray, size_px: int, is_round: bool) -> np.ndarray:
    """Return the letter of each texel; above a letter a texel, what is round gets round corners."""
    if is_round:
        return stencil_letters(" ".join("".join(row) for row in rows), size_px)
    times = size_px // rows.shape[0]
    return np.repeat(np.repeat(rows, times, axis=0), times, axis=1)


def _paint(
    under: Texture, picture: Mapping[str, Any], colours: tuple[tuple[int, int, int], ...]
) -> Texture:
    size_px = under.colour.shape[0]
    letters = _enlarge(letters_of(picture), size_px, bool(picture.get("round")))
    colour = under.colour.copy()
    emission = np.zeros((size_px, size_px), np.uint8)
    for letter in np.unique(letters):
        here = letters == letter
        if letter == HOLE:
            colour[here] = 0
        elif letter in SHADES:
            shaded = colour[here][:, :3] * SHADES[str(letter)]
            colour[here, :3] = np.minimum(shaded.round(), 255).astype(np.uint8)
        else:
            ink = _ink(str(letter), picture, colours)
            colour[here, :3] = _add_grain(ink, under.colour[here][:, :3], colours[0])
            colour[here, 3] = 255
        if letter in picture.get("glow", ""):
            emission[here] = 255
    return Texture(
        colour,
        under.normal,
        under.roughness,
        under.metal,
        emission if emission.any() else under.emission,
        under.translucent and HOLE not in letters,
    )


def _ink(letter: str, picture: Mapping[str, Any], colours) -> tuple[int, int, int]:
    if letter.isdigit() and int(letter) < len(colours):
        return colours[int(letter)]
    inks = {**picture["common"], **picture.get("inks", {})}
    if letter not in inks:
        raise UnknownNameError("ink", letter, inks)
    text = inks[letter]
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16)


def _add_grain(ink, under: np.ndarray, mean) -> np.ndarray:
    """Return an ink, uint8 [N, 3], with half the grain of what lies under it."""
    grain = under.mean(axis=1, keepdims=True) - float(np.mean(mean))
    return np.clip(np.array(ink) + 0.5 * grain, 0, 255).round().astype(np.uint8)

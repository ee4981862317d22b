"""Conversion of a painted surface to a texture with the required mean colour."""

from dataclasses import dataclass, field

import numpy as np

from world2minecraft.rendering.texture import Texture
from world2minecraft.rendering.textures.canvas import SIDE, Canvas
from world2minecraft.rendering.textures.recipe import Recipe

Field = np.ndarray | float  # [N, N], or the same everywhere.

# A tone of 1 is so much lighter, in sRGB levels: a part of the colour, and a floor so that black
# wool has a weave.
TONE_OF_COLOUR, TONE_FLOOR = 0.62, 24.0
WARMTH = np.array([1.04, 1.0, 0.95])  # Light is a little warmer than shadow.
MEAN_MARGIN = 1.0  # White and black may miss their mean by this, so that they are not flat.
# Shares of the way to black or white that the main colour goes to make room for accents: in light,
# and apart from it in each of red, green and blue.
MAX_LIGHT, MAX_HUE = 0.4, 0.08
MIN_MAIN_SHARE = 0.2  # Of all texels; fewer of the main colour would be too far from it.
ROUNDS = 24  # Iterations of a bisection over -1 to 1.
SLOPE = 0.6  # Strength of the normals relative to the height's slope.


@dataclass(frozen=True, eq=False)
class Surface:
    """The result of a generator. Every field is float64 [N, N] or a number.

    ``tone`` is the lightness relative to the colours, about -1 to 1. ``paints`` are accents laid
    over the main colour in order, each a colour float64 [3] and its amount, 0 to 1. ``height`` is
    in sixteenths of a block. ``alpha`` is 0 to 1. ``bold`` lets the main colour change as much as
    the accents require, as for the head of a flower on its green stem.
    """

    tone: Field
    height: Field = 0.0
    paints: tuple[tuple[np.ndarray, Field], ...] = field(default=())
    alpha: Field = 1.0
    roughness: Field = 0.85
    metal: Field = 0.0
    emission: Field = 0.0
    translucent: bool = False
    bold: bool = False


def texture_from(canvas: Canvas, recipe: Recipe, surface: Surface) -> Texture:
    """Return the texture of a surface, with the recipe's first colour as its mean."""
    alpha = _bytes(canvas, surface.alpha)
    if not surface.translucent:
        alpha = np.where(alpha < 128, 0, 255).astype(np.uint8)
    seen = alpha > 0
    colour, give = _colours(canvas, recipe, surface)
    settled = match_mean(colour[seen], give[seen], recipe.ink(0), surface.bold)
    rgba = np.empty((*alpha.shape, 4), np.uint8)
    rgba[..., :3] = np.array(recipe.colours[0], np.uint8)  # Holes too, for filters that mix them.
    rgba[seen, :3] = np.rint(settled)
    rgba[..., 3] = alpha
    texture = Texture(
        rgba,
        _normals(canvas, surface.height),
        _bytes(canvas, surface.roughness),
        _bytes(canvas, surface.metal),
        _bytes(canvas, surface.emission),
        surface.translucent,
    )
    for array in (rgba, texture.normal, texture.roughness, texture.metal, texture.emission):
        if array is not None:
            array.setflags(write=False)  # Textures are shared by all who ask for them.
    return texture


def _full(canvas: Canvas, value: Field) -> np.ndarray:
    return np.broadcast_to(np.asarray(value, np.float64), (canvas.size_px, canvas.size_px))


def _bytes(canvas: Canvas, value: Field) -> np.ndarray:
    return np.rint(np.clip(_full(canvas, value), 0.0, 1.0) * 255).astype(np.uint8)


def _colours(canvas: Canvas, recipe: Recipe, surface: Surface) -> tuple[np.ndarray, np.ndarray]:
    """Return colours float64 [N, N, 3], not yet of the right mean, and where they are the main."""
    side = canvas.size_px
    colour = np.broadcast_to(recipe.ink(0), (side, side, 3))
    give = np.ones((side, side))
    for ink, share in surface.paints:
        part = _full(canvas, share)
        colour = colour + (ink - colour) * part[..., None]
        give = give * (1.0 - part)
    tone = _full(canvas, surface.tone)[..., None] * recipe.number("contrast")
    lit = colour + tone * (colour * TONE_OF_COLOUR + TONE_FLOOR) * WARMTH
    return np.clip(lit, 0.0, 255.0), give


def match_mean(
    colour: np.ndarray, give: np.ndarray, target: np.ndarray, bold: bool = False
) -> np.ndarray:
    """Return colours, float64 [M, 3] in 0 to 255, adjusted so that their mean is the target.

    The main colour is adjusted first, so that accents are preserved, and then all colours. An
    adjustment moves colours by a fraction of the distance to white or black, so that nothing is
    clipped and contrast remains.

    Args:
        colour: Colours, float64 [M, 3], 0 to 255.
        give: 1 for the main colour, 0 for accents, float64 [M].
        target: Target mean, float64 [3]. It is matched within one level after rounding, and within
            two levels near black and white.
        bold: Whether the main colour may change in lightness and hue as much as needed.
    """
    goal = np.clip(target, MEAN_MARGIN, 255.0 - MEAN_MARGIN)
    share = _share(colour, give[:, None], goal)
    if not bold:
        light = np.clip(share.mean(), -MAX_LIGHT, MAX_LIGHT)
        share = light + np.clip(share - share.mean(), -MAX_HUE, MAX_HUE)
        share = share * (give.mean() > MIN_MAIN_SHARE)
    moved = _shift(colour, share, give[:, None])
    every = np.ones((len(give), 1))
    return _shift(moved, _share(moved, every, goal), every)


def _shift(colour: np.ndarray, share: np.ndarray, give: np.ndarray) -> np.ndarray:
    """Return colours that went a share of the way to white, or to black where it is negative."""
    return colour + give * np.abs(share) * (np.where(share > 0, 255.0, 0.0) - colour)


def _share(colour: np.ndarray, give: np.ndarray, goal: np.ndarray) -> np.ndarray:
    """Return the share, float64 [3], after which the rounded mean is nearest the goal."""
    low, high = np.full(3, -1.0), np.full(3, 1.0)
    for _ in range(ROUNDS):
        middle = (low + high) / 2
        above = np.rint(_shift(colour, middle, give)).mean(axis=0) > goal
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return low  # Rounding makes the mean jump by up to a level: stay on one side.


def _normals(canvas: Canvas, height: Field) -> np.ndarray:
    """Return normals of a height field that tiles, uint8 [N, N, 3]."""
    field_16 = _full(canvas, height)
    scale = SLOPE * canvas.size_px / SIDE / 2
    across = (np.roll(field_16, -1, axis=1) - np.roll(field_16, 1, axis=1)) * scale
    down = (np.roll(field_16, -1, axis=0) - np.roll(field_16, 1, axis=0)) * scale
    normal = np.stack([-across, -down, np.ones_like(across)], axis=-1)
    normal /= np.sqrt((normal * normal).sum(axis=-1, keepdims=True))
    return np.clip(np.rint(normal * 127.0 + 128.0), 0, 255).astype(np.uint8)

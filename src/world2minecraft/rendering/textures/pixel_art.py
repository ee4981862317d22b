"""Pixel art of sixteen rows of sixteen letters, which can be painted at any size.

A letter gives the ink and its lightness; ``.`` is a hole::

    main   k darkest  d dark  m  l light  h lightest
    1st    K          D       M  L        H          accent
    2nd               1       2  3
    3rd               4       5  6

At 16 px a letter is a texel. At larger sizes, areas keep their place and steps become slopes.
"""

from collections.abc import Mapping
from functools import lru_cache

import numpy as np

from world2minecraft.rendering.textures.canvas import Canvas
from world2minecraft.rendering.textures.recipe import Recipe

TONES = {
    **dict(zip("kdmlh", (-0.75, -0.35, 0.0, 0.25, 0.5), strict=True)),
    **dict(zip("KDMLH", (-0.75, -0.35, 0.0, 0.25, 0.5), strict=True)),
    **dict(zip("123456", (-0.35, 0.0, 0.3) * 2, strict=True)),
    ".": 0.0,
}
INKS = {
    **dict.fromkeys("kdmlh.", 0),
    **dict.fromkeys("KDMLH", 1),
    **dict.fromkeys("123", 2),
    **dict.fromkeys("456", 3),
}


@lru_cache(maxsize=256)
def letters(art: str, size_px: int) -> np.ndarray:
    """Return the letter of each texel, str [N, N], for 16 lines of 16 letters."""
    drawn = np.array([list(line) for line in art.split()])
    if drawn.shape != (16, 16):
        raise ValueError(f"a stencil must have 16 lines of 16 letters, got {drawn.shape}")
    while len(drawn) < size_px:
        drawn = doubled(drawn)
    return drawn


def doubled(drawn: np.ndarray) -> np.ndarray:
    """Return an image of letters at twice the size, with steps turned into slopes.

    Each quarter of a texel takes the letter of the two adjacent neighbours if these are equal and
    the two opposite neighbours are not.
    """
    edge = np.pad(drawn, 1, mode="edge")
    up, down, left, right = edge[:-2, 1:-1], edge[2:, 1:-1], edge[1:-1, :-2], edge[1:-1, 2:]
    fine = drawn.repeat(2, axis=0).repeat(2, axis=1)
    for row, column, first, second, third, fourth in (
        (0, 0, up, left, down, right),
        (0, 1, up, right, down, left),
        (1, 0, down, left, up, right),
        (1, 1, down, right, up, left),
    ):
        turn = (first == second) & (first != fourth) & (second != third)
        fine[row::2, column::2] = np.where(turn, first, drawn)
    return fine


def by_letter(drawn: np.ndarray, values: Mapping[str, float]) -> np.ndarray:
    """Return the value assigned to each texel's letter, float64 [N, N]."""
    result = np.zeros(drawn.shape)
    for letter, value in values.items():
        result[drawn == letter] = value
    return result


def paints_of(drawn: np.ndarray, recipe: Recipe) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """Return the accents of a recipe at the texels whose letters use them."""
    index = by_letter(drawn, INKS)
    return tuple(
        (recipe.ink(number), (index == number).astype(np.float64))
        for number in range(1, len(recipe.colours))
    )


def draw(canvas: Canvas, art: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the letters, their tones and a mask of the texels that are not holes, each [N, N]."""
    drawn = letters(art, canvas.size_px)
    return drawn, by_letter(drawn, TONES), (drawn != ".").astype(np.float64)

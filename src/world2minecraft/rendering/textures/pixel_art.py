"""Pictures drawn as sixteen rows of sixteen letters, at any size.

A letter says the ink and how light it is; ``.`` is a hole::

    main   k darkest  d dark  m  l light  h lightest
    1st    K          D       M  L        H          accent
    2nd               1       2  3
    3rd               4       5  6

At 16 px a letter is a texel. Above, areas keep their place, and their stairs become slopes.
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
    """Return the letter of each texel, str [N, N], of 16 lines of 16 letters."""
    drawn = np.array([list(line) for line in art.split()])
    if drawn.shape != (16, 16):
        raise ValueError(f"a stencil must have 16 lines of 16 letters, got {drawn.shape}")
    while len(drawn) < size_px:
        drawn = doubled(drawn)
    return drawn


def doubled(drawn: np.ndarray) -> np.ndarray:
    """Return a picture of letters at twice the size; a stair becomes a slope.

    Each quarter of a texel takes the letter of the two neighbours beside it where they agree and
    the two across from it do not.
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


def by_letter(drawn: np.ndarray, values: Mapping[str, float], rest: float = 0.0) -> np.ndarray:
    """Return the value of each texel's letter, float64 [N, N]."""
    result = np.full(drawn.shape, rest)
    for letter, value in values.items():
        result[drawn == letter] = value
    return result


def paints_of(drawn: np.ndarray, recipe: Recipe) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """Return the accents of a recipe where the letters say."""
    index = by_letter(drawn, INKS)
    return tuple(
        (recipe.ink(number), (index == number).astype(np.float64))
        for number in range(1, len(recipe.colours))
    )


def draw(canvas: Canvas, art: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the letters, their tones and where there is no hole, each [N, N]."""
    drawn = letters(art, canvas.size_px)
    return drawn, by_letter(drawn, TONES), (drawn != ".").astype(np.float64)

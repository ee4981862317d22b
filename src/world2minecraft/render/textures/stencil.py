"""Pictures drawn as sixteen rows of sixteen letters, at any size.

A letter says the ink and how light it is; ``.`` is a hole::

    main   k darkest  d dark  m  l light  h lightest
    1st    K          D       M  L        H          accent
    2nd               1       2  3
    3rd               4       5  6

At 16 px a letter is a texel. Above, the areas of letters keep their place and get round corners.
"""

from collections.abc import Mapping
from functools import lru_cache

import numpy as np

from world2minecraft.render.textures.canvas import SIDE, Canvas
from world2minecraft.render.textures.recipe import Recipe

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
SOLID_FIRST = 0.06  # So that a line of one texel stays in one piece where it goes askew.


@lru_cache(maxsize=256)
def letters(art: str, size_px: int) -> np.ndarray:
    """Return the letter of each texel, str [N, N], of 16 lines of 16 letters."""
    rows = np.array([list(line) for line in art.split()])
    if rows.shape != (16, 16):
        raise ValueError(f"a stencil has 16 lines of 16 letters, not {rows.shape}")
    if size_px == 16:
        return rows
    kinds = np.unique(rows)
    weight = np.stack([_grown((rows == kind).astype(np.float64), size_px) for kind in kinds])
    weight[kinds != "."] += SOLID_FIRST
    return kinds[weight.argmax(axis=0)]


def _grown(mask: np.ndarray, size_px: int) -> np.ndarray:
    """Return a 16 by 16 mask between its texels' centres, float64 [N, N]."""
    place = (np.arange(size_px) + 0.5) * (SIDE / size_px) - 0.5
    low = np.floor(place).astype(np.int64)
    part = place - low
    first, second = np.clip(low, 0, 15), np.clip(low + 1, 0, 15)
    across = mask[:, first] * (1 - part) + mask[:, second] * part
    return across[first] * (1 - part)[:, None] + across[second] * part[:, None]


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

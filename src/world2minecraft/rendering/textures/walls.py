"""Texture generators for plain surfaces of rooms: paint, plaster, paper, slabs, tiles, bricks."""

import numpy as np

from world2minecraft.rendering.textures.canvas import (
    SIDE,
    Canvas,
    fractal,
    noise,
    pick,
    relief,
    smooth,
)
from world2minecraft.rendering.textures.recipe import Recipe
from world2minecraft.rendering.textures.texture_baking import Surface
from world2minecraft.rendering.textures.tiling_layouts import bevel, bricks, rim


def plain(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the plain texture: paint, concrete or terracotta with almost no grain."""
    grain = recipe.number("grain")
    fine = fractal(canvas, 16, 16, 1)
    slow = noise(canvas, 4, 4, 2)
    tone = grain * (0.05 * fine + 0.03 * slow)
    return Surface(tone, 0.02 * grain * fine, roughness=0.8 + 0.06 * grain * fine)


def plaster(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the plaster texture: hand-applied plaster with soft strokes and a fine grain."""
    x, y = canvas.x + 2 * noise(canvas, 4, 4, 1), canvas.y + 2 * noise(canvas, 4, 4, 2)
    strokes = noise(canvas, 4, 8, 3, x, y) + 0.6 * noise(canvas, 8, 4, 4, x, y)
    fine = fractal(canvas, 16, 16, 5)
    height = 0.08 * strokes + 0.015 * fine
    tone = 0.035 * strokes + 0.025 * fine + 0.05 * relief(canvas, height)
    return Surface(tone, height, roughness=0.9)


def paper(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the paper texture: wallpaper or paper, optionally with vertical stripes (accent)."""
    count = recipe.number("stripes")
    stripes = np.floor(canvas.x * 2 * count / SIDE) % 2 if count else np.zeros(canvas.x.shape)
    fine = fractal(canvas, 16, 16, 1)
    tone = 0.02 * fine + 0.02 * noise(canvas, 16, 2, 2)
    return Surface(tone, 0.02 * fine, ((recipe.ink(1), 0.8 * stripes),), roughness=0.88)


def polished(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the polished stone texture: a slab with a bevelled frame."""
    edge = rim(canvas)
    width = 1.0 if canvas.size_px <= 32 else 0.7
    height = bevel(canvas, edge - 0.2 * canvas.fineness, width)
    fine, slow = fractal(canvas, 16, 16, 1), fractal(canvas, 4, 4, 2)
    tone = 0.035 * fine + 0.05 * slow
    if canvas.size_px == 16:
        lit = (canvas.x < 1) | (canvas.y < 1)
        dark = (canvas.x > 15) | (canvas.y > 15)
        tone = tone + 0.13 * (lit & ~dark) - 0.17 * dark
    else:
        light = _smooth_frame(canvas, edge, width)
        tone = tone + 0.15 * light
    return Surface(tone, 0.5 * height, roughness=0.38 + 0.05 * fine)


def _smooth_frame(canvas: Canvas, edge: np.ndarray, width: float) -> np.ndarray:
    """Return light, 1 on the upper and left bevel, -1 on the others."""
    near = 1 - smooth(edge, 0.6 * width, 1.4 * width)
    upper = np.minimum(canvas.x, canvas.y) < np.minimum(SIDE - canvas.x, SIDE - canvas.y)
    return near * np.where(upper, 1.0, -1.2)


def brick_wall(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the brick wall texture: bricks in a bond with mortar (accent), or stone blocks."""
    rows = int(recipe.number("rows"))
    pieces = bricks(canvas, rows, max(1, rows // 2))
    body = bevel(canvas, pieces.edge, 0.5) * (1 - pieces.joint)
    fine = fractal(canvas, 16, 16, 1)
    shade = pick(canvas, pieces.identity, 2)
    strength = 0.1 if rows > 2 else 0.05
    solid = 1 - pieces.joint
    tone = solid * (strength * shade + 0.06 * fine + 0.12 * relief(canvas, body))
    tone = tone + pieces.joint * 0.05 * fine
    height = 0.6 * body + 0.03 * fine
    return Surface(tone, height, ((recipe.ink(1), pieces.joint),), roughness=0.86)


def tiles(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the tile texture: glazed square tiles with grout (accent)."""
    count = int(recipe.number("count"))
    pieces = bricks(canvas, count, count, 0.0)
    body = bevel(canvas, pieces.edge, 0.6) * (1 - pieces.joint)
    solid = 1 - pieces.joint
    tone = solid * (0.03 * pick(canvas, pieces.identity, 1) + 0.03 * fractal(canvas, 4, 4, 2))
    tone = tone + 0.1 * solid * relief(canvas, body)
    roughness = 0.18 + 0.6 * pieces.joint + 0.03 * noise(canvas, 8, 8, 3)
    return Surface(tone, 0.4 * body, ((recipe.ink(1), pieces.joint),), roughness=roughness)

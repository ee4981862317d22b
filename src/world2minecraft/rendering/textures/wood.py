"""Texture generators for wood: boards, parquet, bark, log ends, bare grain."""

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
from world2minecraft.rendering.textures.tiling_layouts import Pieces, bevel, boards, rim


def fibre(canvas: Canvas, x: np.ndarray, y: np.ndarray, salt: int) -> np.ndarray:
    """Return wood grain along x, about -1 to 1: streaks, with fine arcs at larger sizes.

    ``x`` and ``y`` float64 [N, N] are positions in sixteenths. The grain tiles with the texture.
    """
    streaks = 0.75 * noise(canvas, 4, 16, salt, x, y) + 0.45 * noise(canvas, 2, 8, salt + 1, x, y)
    if not canvas.fineness:
        return streaks
    bend = 1.3 * noise(canvas, 2, 4, salt + 2, x, y) + 0.25 * noise(canvas, 8, 8, salt + 3, x, y)
    arcs = np.sin(2 * np.pi * (0.75 * y + bend))
    pores = noise(canvas, 8, min(4 * 16, canvas.size_px), salt + 4, x, y)
    lines = noise(canvas, 16, canvas.size_px, salt + 5, x, y)
    return streaks + canvas.fineness * (0.3 * arcs + 0.4 * pores + 0.25 * lines)


def planks(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the plank texture: horizontal boards with grain, individual shades and gaps."""
    pieces = boards(canvas, int(recipe.number("boards")))
    shift = 8 * pick(canvas, pieces.identity, 1)
    grain = fibre(canvas, canvas.x + shift, canvas.y, 2)
    gaps = {"dark": 1.0, "light": 0.45, "none": 0.0}[recipe.word("gaps")]
    return _boarded(canvas, pieces, grain, pick(canvas, pieces.identity, 9), gaps)


def _boarded(
    canvas: Canvas, pieces: Pieces, grain: np.ndarray, shade: np.ndarray, gaps: float
) -> Surface:
    wood = bevel(canvas, pieces.edge, 0.4) * (1 - pieces.joint)
    height = 0.45 * gaps * wood + 0.05 * grain
    tone = 0.1 * shade + (0.1 + 0.03 * canvas.fineness) * grain - 0.46 * gaps * pieces.joint
    tone = tone + 0.07 * gaps * relief(canvas, wood) * (1 - pieces.joint)
    roughness = 0.58 + 0.07 * grain + 0.2 * pieces.joint
    return Surface(tone, height, roughness=roughness)


def parquet(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the parquet texture: short strips in squares, every other square rotated."""
    squares = int(recipe.number("squares"))
    step, strips = SIDE / squares, 2 if squares == 4 else 4
    column, row = np.floor(canvas.x / step), np.floor(canvas.y / step)
    turned = (column + row) % 2 == 1
    inside_x, inside_y = canvas.x - column * step, canvas.y - row * step
    along = np.where(turned, inside_y, inside_x)
    over = np.where(turned, inside_x, inside_y)
    width = step / strips
    strip = np.floor(over / width)
    place = over - strip * width
    joint = canvas.joint * 0.6 if canvas.size_px > 16 else 0.0
    edge = np.minimum.reduce([along, step - joint - along, place, width - joint - place])
    identity = ((row * squares + column) * strips + strip).astype(np.int64)
    pieces = Pieces(identity, along, place, edge, (edge < 0).astype(np.float64))
    x = np.where(turned, canvas.y, canvas.x) + 8 * pick(canvas, identity, 1)
    grain = fibre(canvas, x, np.where(turned, canvas.x, canvas.y), 2)
    shade = 1.2 * pick(canvas, identity, 9) + 0.5 * (2 * turned - 1)
    last = (place > width - 1) & (canvas.size_px == 16)
    surface = _boarded(canvas, pieces, grain, shade - 1.1 * last, 0.7)
    return Surface(surface.tone, surface.height, roughness=surface.roughness - 0.2)


def bark(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the bark texture: the side of a log, with vertical ridges and dark furrows."""
    bend = canvas.x + 1.2 * noise(canvas, 4, 4, 1)
    ridges = noise(canvas, 8, 2, 2, bend) + 0.7 * noise(canvas, 16, 4, 3, bend)
    ridges = ridges + 0.35 * canvas.fineness * fractal(canvas, 32, 8, 4, x=bend)
    cracks = smooth(-ridges, 0.35, 0.75)
    tone = 0.16 * ridges - 0.24 * cracks + 0.04 * fractal(canvas, 16, 16, 5)
    tone = tone + 0.06 * relief(canvas, 0.8 * ridges)
    return Surface(tone, 0.9 * smooth(ridges, -0.9, 0.6), roughness=0.92)


def grain(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the bare wood texture: vertical grain without gaps, as of a stripped log."""
    lines = fibre(canvas, canvas.y, canvas.x, 1)
    return Surface(0.13 * lines, 0.08 * lines, roughness=0.6 + 0.05 * lines)


def rings(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the log end texture: growth rings within a border of bark (accent)."""
    x, y = np.abs(canvas.x - SIDE / 2), np.abs(canvas.y - SIDE / 2)
    away = np.maximum(x, y)
    if canvas.fineness:
        round_away = (x**3 + y**3) ** (1 / 3)
        away = round_away + 0.35 * noise(canvas, 4, 4, 1) + 0.1 * noise(canvas, 16, 16, 6)
        years = np.sin(np.pi * away) + 0.5 * np.sin(np.pi * 2.0 * away + 1.0)
        wave = 0.6 * years + 0.5 * pick(canvas, np.floor(away / 2), 2)
    else:
        wave = np.where(away % 2 < 1, 1.0, -1.0)
    border = (rim(canvas) < 1.0).astype(np.float64)
    speck = fractal(canvas, 16, 16, 3)
    core = 1 - smooth(away, 0.7, 1.1)
    tone = (1 - border) * (0.12 * wave + 0.05 * speck - 0.2 * core) + border * 0.2 * speck
    inner = ((rim(canvas) >= 1.0) & (rim(canvas) < 1.0 + canvas.joint)).astype(np.float64)
    height = 0.4 * border + 0.05 * wave
    return Surface(tone - 0.14 * inner, height, ((recipe.ink(1), border),), roughness=0.75)

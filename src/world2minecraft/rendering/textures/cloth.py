"""Texture generators for fabrics and similar materials: wool, carpet, leather, beds, straw."""

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
from world2minecraft.rendering.textures.tiling_layouts import box, stones


def wool(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the wool texture: a knit of soft, short loops."""
    tufts = noise(canvas, 8, 8, 1) + 0.7 * noise(canvas, 16, 16, 2)
    row = np.floor(canvas.y / 2)
    loops = np.where((np.floor(canvas.x) + row) % 4 < 2, 1.0, -1.0)
    tone = 0.065 * tufts + 0.035 * loops
    height = 0.2 * tufts
    if canvas.fineness:
        body = _loops(canvas)
        tone = tone - 0.035 * loops + canvas.fineness * 0.24 * (body - 0.6)
        tone = tone + 0.05 * fractal(canvas, 32, 32, 3)
        height = height + 0.45 * body
    return Surface(tone, height, roughness=1.0)


def _loops(canvas: Canvas) -> np.ndarray:
    """Return the height, 0 to 1, of stitches that lean left and right in turn."""
    column = np.floor(canvas.x)
    inside = canvas.x - column - 0.5
    lean = np.where(column % 2 == 0, 1.0, -1.0)
    place = (canvas.y + lean * inside * 1.2) % SIDE
    part = place - np.floor(place) - 0.5
    return np.clip(1 - 2.6 * part * part, 0, 1) * np.clip(1 - 2.2 * inside * inside, 0, 1)


def carpet(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the carpet texture: a short, even pile."""
    pile, slow = noise(canvas, 16, 16, 1), noise(canvas, 4, 4, 2)
    tone, height = 0.06 * pile + 0.025 * slow, 0.05 * pile
    if canvas.fineness:  # Tufts of yarn, as many as there is room for.
        cells = canvas.size_px // 2
        tufts = noise(canvas, cells, cells, 3) + 0.7 * noise(canvas, 2 * cells, 2 * cells, 4)
        tone, height = tone + 0.1 * canvas.fineness * tufts, height + 0.12 * tufts
    return Surface(tone, height, roughness=1.0)


def leather(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the leather texture: a net of fine creases, optionally with buttons."""
    cells = stones(canvas, 8, 1, 0.9)
    crease = 1 - smooth(cells.edge, 0.05, 0.5)
    tone = 0.06 * noise(canvas, 4, 4, 3) - 0.12 * crease + 0.03 * pick(canvas, cells.identity, 4)
    height = -0.15 * crease
    if recipe.word("buttons") == "1":
        x, y = canvas.x % 8 - 4, canvas.y % 8 - 4
        away = np.sqrt(x * x + y * y)
        fold = np.minimum(np.abs(np.abs(x) - np.abs(y)), 9.0)
        tone = tone - 0.14 * (1 - smooth(fold, 0.0, 1.0)) - 0.2 * (1 - smooth(away, 0.6, 1.2))
        height = height + 0.6 * smooth(fold, 0.0, 3.0)
        tone = tone + 0.05 * relief(canvas, 0.6 * smooth(fold, 0.0, 3.0))
    return Surface(tone, height, roughness=0.5 + 0.15 * crease)


def bed_top(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the bed top texture: a quilted cover with a pillow (accent), v towards the foot."""
    x, y = canvas.x, canvas.y
    slopes = (x + y) % 8, (x - y) % 8
    seam_away = np.minimum.reduce([slopes[0], 8 - slopes[0], slopes[1], 8 - slopes[1]])
    seam = 1 - smooth(seam_away, 0.15, 0.3 + 0.6 * (1 - canvas.fineness))
    cloth = 0.03 * fractal(canvas, 16, 16, 1)
    side = 1 - smooth(np.minimum(x, SIDE - x), 0.6, 1.6)
    tone, height = cloth - 0.12 * seam - 0.14 * side, 0.5 * smooth(seam_away, 0.0, 3.0)
    if recipe.word("part") == "foot":
        end = 1 - smooth(SIDE - y, 0.6, 1.6)
        return Surface(tone - 0.12 * end * (1 - side), height, roughness=0.95)
    fold, under = (y >= 7.0) & (y < 9.0), (y >= 9.0) & (y < 9.0 + canvas.joint)
    sheet = y < 7.0
    tone = np.where(sheet, cloth - 0.1, np.where(fold, cloth + 0.2, tone - 0.16 * under))
    edge = box(canvas, 2.0, 1.0, 14.0, 6.0)
    pillow, soft = edge > 0, smooth(edge, 0.0, 2.0)
    shadow = (box(canvas, 2.0, 1.0, 14.0 + canvas.joint, 6.0 + canvas.joint) > 0) & ~pillow
    tone = np.where(pillow, 0.09 * soft + 0.6 * cloth, tone - 0.2 * shadow)
    height = np.where(pillow, 1.6 * soft, np.where(sheet, 0.0, height + 0.3 * fold))
    return Surface(tone, height, ((recipe.ink(1), pillow * 1.0),), roughness=0.95)


def straw(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the straw texture: vertical stalks tied by a band (accent), or thatch."""
    stalks = noise(canvas, 16, 2, 1) + 0.6 * noise(canvas, 16, 4, 2)
    if canvas.fineness:
        stalks = stalks + 0.5 * canvas.fineness * fractal(canvas, 32, 4, 3)
    band = np.zeros(canvas.x.shape)
    if recipe.word("band") == "1":
        band = ((np.abs(canvas.y - 3) < 1) | (np.abs(canvas.y - 13) < 1)).astype(np.float64)
    tone = 0.15 * stalks * (1 - 0.6 * band)
    return Surface(tone, 0.4 * stalks + 0.3 * band, ((recipe.ink(1), band),), roughness=0.95)


def drape(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the curtain texture: soft vertical folds."""
    place = canvas.x + 0.5 * noise(canvas, 2, 2, 1)
    folds = np.cos(place * (2 * np.pi / 4)) + 0.4 * np.cos(place * (2 * np.pi / 8) + 1.0)
    tone = 0.13 * folds + 0.03 * fractal(canvas, 16, 16, 2)
    return Surface(tone, 0.9 * folds, roughness=0.97)

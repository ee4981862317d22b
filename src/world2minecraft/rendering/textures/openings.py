"""What closes an opening: glass, doors, ladders."""

import numpy as np

from world2minecraft.rendering.textures.canvas import SIDE, Canvas, noise, relief, smooth
from world2minecraft.rendering.textures.layout import box, rim
from world2minecraft.rendering.textures.recipe import Recipe
from world2minecraft.rendering.textures.surface import Surface
from world2minecraft.rendering.textures.wood import fibre

GLINTS = ((7.0, 1.0, 2.5, 5.5), (9.0, 1.0, 3.0, 5.0), (23.0, 1.0, 10.5, 13.5))


def glass(canvas: Canvas, recipe: Recipe) -> Surface:
    """Glass: a frame and slanted glints; clear glass is a hole elsewhere, stained lets light by."""
    edge = rim(canvas)
    frame = edge < (1.0 if canvas.size_px <= 16 else 0.75)
    slant, across = canvas.x + canvas.y, canvas.x - canvas.y
    glint = np.zeros(edge.shape, bool)
    for place, width, low, high in GLINTS:
        inside = (
            (canvas.x > low - 0.5) & (canvas.x < high + 0.5) if place < 20 else np.abs(across) < 5
        )
        glint |= (np.abs(slant - place) < width / 2 + 0.01) & inside
    glint &= ~frame
    lit = canvas.x + canvas.y < SIDE
    tone = np.where(frame, np.where(lit, 0.1, -0.12), 0.0) + 0.3 * glint
    if recipe.word("stained") == "1":
        alpha = 0.42 + 0.34 * frame + 0.2 * glint
        return Surface(tone, 0.3 * frame, alpha=alpha, roughness=0.05, translucent=True)
    return Surface(tone, 0.3 * frame, alpha=frame | glint, roughness=0.08)


def door(canvas: Canvas, recipe: Recipe) -> Surface:
    """Half a door: a wooden frame with panels, or panes that are holes; the accent is its knob."""
    upper = recipe.word("half") == "upper"
    panes = int(recipe.number("panes"))
    top, bottom = (2.0, 16.0) if upper else (0.0, 14.0)
    x, y = canvas.x, canvas.y
    field = np.minimum.reduce([x - 2.0, 14.0 - x, y - top, bottom - y])
    middle = np.abs(x - 8.0) < 1.0
    rail = (y > 14.0) if upper else (y < 1.0)
    inner = (field > 0) & ~middle & ~rail
    glazed = inner & (y > 3.0) & (y < 13.0) & upper & (panes > 0)
    if panes == 4:
        glazed &= np.abs(y - 8.0) > 1.0
    grain = fibre(canvas, y, x, 1)
    height = np.where(inner, 0.0, 1.0)
    groove = inner & (np.roll(height, 1, axis=1) + np.roll(height, 1, axis=0) > 0)
    tone = 0.08 * grain - 0.1 * inner - 0.2 * groove + 0.1 * relief(canvas, height) * ~inner
    side = (x < 1.0 * canvas.joint) | (x > SIDE - canvas.joint)
    side |= (y < canvas.joint) if upper else (y > SIDE - canvas.joint)
    tone = tone - 0.2 * side
    knob = box(canvas, 12.0, 1.0, 14.0, 3.0) > 0
    knob = knob & (not upper)
    height = height + knob
    paints = ((recipe.ink(1), knob.astype(np.float64)),)
    tone = np.where(knob, 0.25 * relief(canvas, height), tone)
    return Surface(tone, height, paints, ~glazed, roughness=0.55 - 0.2 * knob, metal=knob * 1.0)


def ladder(canvas: Canvas, recipe: Recipe) -> Surface:
    """Two rails along v and four rungs, with holes between."""
    rails = (np.abs(canvas.x - 3.0) < 1) | (np.abs(canvas.x - 13.0) < 1)
    place = canvas.y % 4
    rung = (place > 1.0) & (place < 3.0) & (canvas.x > 1) & (canvas.x < 15)
    along = fibre(canvas, canvas.y, canvas.x, 1)
    over = fibre(canvas, canvas.x, canvas.y, 5)
    height = np.where(rung, 1.0, 0.6) * (rung | rails)
    tone = np.where(rung, 0.1 * over + np.where(place < 2, 0.12, -0.14), 0.1 * along - 0.08)
    if canvas.fineness:
        tone = (
            tone + 0.06 * relief(canvas, height) - 0.08 * smooth(np.abs(place - 2), 0.6, 1.0) * rung
        )
    return Surface(tone + 0.02 * noise(canvas, 8, 8, 9), height, alpha=rung | rails, roughness=0.7)

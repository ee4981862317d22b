"""Texture generators for metal, glass and light: metal, copper, screens, lamps, grates, rails."""

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
from world2minecraft.rendering.textures.pixel_art import draw, paints_of
from world2minecraft.rendering.textures.recipe import Recipe
from world2minecraft.rendering.textures.texture_baking import Surface
from world2minecraft.rendering.textures.tiling_layouts import bevel, box, bricks, rim, stones
from world2minecraft.rendering.textures.wood import fibre

# What clear glass shows of its colour; marks would be a grid of dots on windows of many blocks.
CLEAR_ALPHA = 0.07
CHAIN = """
......ml........ ......ml........ .....m..l....... .....m..l.......
.....m..l....... .....d..m....... ......dm........ ......ml........
......ml........ .....m..l....... .....m..l....... .....m..l.......
.....d..m....... ......dm........ ......dm........ ......ml........
"""
RAIL = """
..lm........lm.. .Mlm.MMMMMM.lmM. .DdmDDDDDDDDdmD. ..lm........lm..
..lm........lm.. .Mlm.MMMMMM.lmM. .DdmDDDDDDDDdmD. ..lm........lm..
..lm........lm.. .Mlm.MMMMMM.lmM. .DdmDDDDDDDDdmD. ..lm........lm..
..lm........lm.. .Mlm.MMMMMM.lmM. .DdmDDDDDDDDdmD. ..lm........lm..
"""


def glass(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the glass texture: stained with a faint border, or a clear film, the same all over."""
    if recipe.word("stained") != "1":
        tone = 0.1 * fractal(canvas, 4, 4, 1)
        return Surface(tone, alpha=CLEAR_ALPHA, roughness=0.08, translucent=True)
    border = rim(canvas) < SIDE / canvas.size_px
    lit = canvas.x + canvas.y < SIDE
    tone = np.where(border, np.where(lit, 0.1, -0.08), 0.0)
    alpha = 0.5 + 0.1 * border
    return Surface(tone, 0.3 * border, alpha=alpha, roughness=0.05, translucent=True)


def door(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the half door texture: a wooden frame with panels or panes, and a knob (accent)."""
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
    """Return the ladder texture: two vertical rails and four rungs, with holes between."""
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


def metal(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the metal texture: brushed metal with a soft sheen, optionally framed and riveted."""
    strokes = noise(canvas, 2, 16, 1)
    if canvas.fineness:
        strokes = 0.6 * strokes + 0.6 * fractal(canvas, 2, 32, 2)
    sheen = np.cos(canvas.y * (2 * np.pi / SIDE) + 0.6)
    tone = 0.045 * strokes + 0.05 * sheen
    height: np.ndarray = 0.02 * strokes
    if recipe.word("frame") == "1":
        edge = rim(canvas)
        lit = canvas.x + canvas.y < SIDE
        tone = tone + (edge < 1) * np.where(lit, 0.16, -0.2)
        x, y = np.abs(canvas.x - 8) - 5.5, np.abs(canvas.y - 8) - 5.5
        rivet = 1 - smooth(np.sqrt(x * x + y * y), 0.35, 0.75)
        tone = tone - 0.25 * rivet
        height = height + 0.4 * bevel(canvas, edge, 0.8) + 0.4 * rivet
    return Surface(tone, height, roughness=0.36 + 0.08 * strokes, metal=1.0)


def copper(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the copper texture: sheets with seams, optionally with verdigris (accent)."""
    pieces = bricks(canvas, 2, 2, 0.0)
    body = bevel(canvas, pieces.edge, 0.6) * (1 - pieces.joint)
    blotch = noise(canvas, 8, 8, 1) + 0.6 * fractal(canvas, 16, 16, 2)
    wanted = recipe.number("verdigris")
    green = smooth(blotch + 2.6 * wanted - 1.5, 0.0, 0.5) * (wanted > 0)
    tone = 0.06 * blotch - 0.2 * pieces.joint + 0.1 * relief(canvas, body) * (1 - pieces.joint)
    roughness = 0.42 + 0.4 * green
    return Surface(
        tone, 0.3 * body, ((recipe.ink(1), 0.85 * green),), roughness=roughness, metal=1 - green
    )


def screen(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the screen texture: a dark screen in a frame (accent), with an image if it is on."""
    edge = rim(canvas)
    frame = (edge < 1).astype(np.float64) if recipe.word("frame") == "1" else 0.0 * edge
    slant = canvas.x + canvas.y
    sheen = ((slant > 9) & (slant < 12)) * 0.5 + ((slant > 13) & (slant < 14.5)) * 0.35
    tone = 0.75 * sheen * (1 - frame) + 0.1 * (1 - canvas.y / 8) * (1 - frame)
    glow = np.zeros(edge.shape)
    if recipe.word("on") == "1":
        hills = 9.5 + 2 * np.sin(canvas.x * 0.7) + np.sin(canvas.x * 1.7 + 1)
        tone = np.where(canvas.y > hills, -0.3, 0.25 + 0.03 * (8 - canvas.y)) * (1 - frame)
        glow = 0.8 * (1 - frame)
    roughness = 0.08 + 0.4 * frame
    return Surface(tone, 0.3 * frame, ((recipe.ink(1), frame),), roughness=roughness, emission=glow)


def lamp(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the lamp texture: panes in a lattice (accent), bright if on and dark otherwise."""
    count = int(recipe.number("panes"))
    step = SIDE / count
    x, y = canvas.x % step, canvas.y % step
    edge = np.minimum.reduce([x, y, step - x, step - y])
    bar = (edge < max(0.5, canvas.joint)).astype(np.float64)
    middle = np.sqrt((x - step / 2) ** 2 + (y - step / 2) ** 2) / step
    on = recipe.word("lit") == "1"
    pane = (0.3 if on else 0.12) * (0.55 - 1.5 * middle)
    tone = (1 - bar) * (pane + 0.05 * noise(canvas, 8, 8, 1)) + bar * 0.1 * relief(canvas, bar)
    emission = (1 - bar) * (1.0 - 0.5 * middle) if on else 0.0
    roughness = 0.3 + 0.3 * bar
    return Surface(tone, 0.5 * bar, ((recipe.ink(1), bar),), roughness=roughness, emission=emission)


def glow(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the glowing stone texture: bright crystals (accent) between dark veins."""
    pieces = stones(canvas, 5, 1, 0.95)
    core = smooth(pieces.edge, 0.1, 1.4)
    shade = pick(canvas, pieces.identity, 3)
    tone = 0.16 * shade + 0.5 * core - 0.35 + 0.07 * fractal(canvas, 16, 16, 4)
    heart = smooth(core + 0.7 * shade, 0.75, 1.4)
    paints = ((recipe.ink(1), 0.85 * heart),)
    return Surface(tone, 0.5 * core, paints, roughness=0.4, emission=0.45 + 0.55 * heart)


def bars(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the bar texture: vertical bars joined at the top and the bottom, with holes."""
    step = SIDE / recipe.number("count")
    place = canvas.x % step - step / 2
    upright = np.abs(place) < 1
    tie = (np.abs(canvas.y - 1.5) < 0.5 + 0.5 * (canvas.size_px == 16)) | (
        np.abs(canvas.y - 14.5) < 0.5 + 0.5 * (canvas.size_px == 16)
    )
    solid = upright | tie
    round_bar = np.where(upright, np.clip(1 - place * place, 0, 1), 0.5)
    tone = np.where(upright, -0.2 * place, -0.12) + 0.05 * noise(canvas, 16, 16, 1)
    return Surface(tone, round_bar, alpha=solid, roughness=0.5, metal=1.0)


def lattice(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the lattice texture: a frame with crossing slats and holes, as in a grate."""
    step = SIDE / recipe.number("holes")
    edge = rim(canvas)
    frame = edge < 2
    x, y = canvas.x % step, canvas.y % step
    slat = (np.minimum(x, step - x) < 1) | (np.minimum(y, step - y) < 1)
    solid = frame | slat
    height = np.where(frame, 1.0, 0.5) * solid
    tone = np.where(frame, 0.04, -0.1) + 0.06 * noise(canvas, 4, 16, 1)
    tone = tone + 0.12 * relief(canvas, height)
    metal = 1.0 if recipe.word("of") == "metal" else 0.0
    return Surface(tone, height, alpha=solid, roughness=0.6 - 0.2 * metal, metal=metal)


def chain(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the chain texture: vertical chain links with holes between."""
    _, tone, solid = draw(canvas, CHAIN)
    return Surface(tone, solid, alpha=solid, roughness=0.45, metal=1.0)


def rail(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the rail texture: two vertical rails on sleepers (accent), with holes between."""
    drawn, tone, solid = draw(canvas, RAIL)
    paints = paints_of(drawn, recipe)
    tone = tone + 0.06 * noise(canvas, 16, 16, 1)
    return Surface(tone, solid, paints, solid, roughness=0.55, metal=1.0 - paints[0][1])

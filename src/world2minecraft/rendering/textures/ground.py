"""Texture generators for ground and natural materials: sand, earth, snow, ice, water, lava."""

import numpy as np

from world2minecraft.rendering.textures.canvas import (
    SIDE,
    Canvas,
    contour,
    fractal,
    hash_values,
    noise,
    pick,
    relief,
    smooth,
)
from world2minecraft.rendering.textures.plants import scatter
from world2minecraft.rendering.textures.recipe import Recipe
from world2minecraft.rendering.textures.texture_baking import Surface
from world2minecraft.rendering.textures.tiling_layouts import stones

# Flames: foot, height and half width, in sixteenths.
FLAMES = ((2.0, 8.0, 2.2), (5.0, 12.5, 2.6), (8.5, 15.5, 3.0), (11.5, 10.5, 2.6), (14.0, 8.5, 2.0))
TURF = 260  # Blades of grass on a block, seen from above.


def sand(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the sand texture: fine grains with faint ripples."""
    fine = fractal(canvas, 16, 16, 1, 0.8)
    ripples = noise(canvas, 2, 8, 2)
    return Surface(0.06 * fine + 0.03 * ripples, 0.02 * fine + 0.1 * ripples, roughness=0.95)


def gravel(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the gravel texture: pebbles of many shades."""
    pieces = stones(canvas, 6, 1, 0.9)
    body = smooth(pieces.edge, 0.0, 1.0)
    shade = pick(canvas, pieces.identity, 3)
    tone = 0.2 * shade + 0.14 * relief(canvas, 0.7 * body) - 0.15 * (1 - body)
    return Surface(tone + 0.05 * fractal(canvas, 16, 16, 4), 0.7 * body, roughness=0.93)


def dirt(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the dirt texture: crumbs of earth with a few pebbles."""
    crumbs = noise(canvas, 16, 16, 1) + 0.6 * noise(canvas, 8, 8, 2)
    pebbles = smooth(noise(canvas, 16, 16, 4), 0.8, 0.95)
    if not canvas.fineness:
        steps = np.rint(crumbs * 1.5) / 1.5
        return Surface(0.14 * steps + 0.22 * pebbles, 0.2 * crumbs, roughness=0.97)
    pieces = stones(canvas, 12, 5, 0.95)
    body = smooth(pieces.edge, 0.0, 0.7)
    tone = 0.11 * crumbs + 0.09 * pick(canvas, pieces.identity, 7) + 0.1 * (body - 0.6)
    tone = tone + 0.08 * relief(canvas, 0.4 * body) + 0.06 * fractal(canvas, 32, 32, 3, 0.8)
    height = 0.12 * crumbs + 0.3 * body + 0.2 * pebbles
    return Surface(tone + 0.18 * pebbles, height, roughness=0.97)


def grass(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the grass texture: turf from above, with short blades in many greens."""
    tufts = noise(canvas, 16, 16, 1) + 0.5 * noise(canvas, 8, 8, 2)
    if not canvas.fineness:
        return Surface(0.15 * tufts, 0.22 * tufts, roughness=0.95)
    blades = scatter(canvas, TURF, 1.5, 0.3, 3)
    here = blades.identity >= 0
    level = blades.identity / TURF  # Later blades lie over earlier ones.
    shade = 0.13 * pick(canvas, np.maximum(blades.identity, 0), 7) + 0.26 * (level - 0.6)
    tone = 0.18 * tufts + np.where(here, shade + 0.06 * blades.along, -0.3)
    height = 0.1 * tufts + np.where(here, 0.2 + 0.35 * level, 0.0)
    return Surface(tone, height, roughness=0.95)


def grass_side(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the grass side texture: earth (main colour) below a fringe of turf (accent)."""
    earth = dirt(canvas, recipe)
    reach = 3.0 + 1.4 * noise(canvas, 16, 1, 11) + 0.7 * noise(canvas, 8, 1, 12)
    if canvas.fineness:
        reach = reach + 0.5 * noise(canvas, 32, 1, 13)
    turf = (canvas.y < reach).astype(np.float64)
    blades = noise(canvas, 16, 8, 14) + 0.5 * canvas.fineness * noise(canvas, 32, 8, 15)
    shadow = ((canvas.y >= reach) & (canvas.y < reach + 1)).astype(np.float64)
    tone = earth.tone * (1 - turf) + 0.16 * blades * turf - 0.2 * shadow
    height = np.asarray(earth.height) + 0.5 * turf
    return Surface(tone, height, ((recipe.ink(1), turf),), roughness=0.96)


def snow(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the snow texture: soft drifts, slightly blue in the hollows."""
    drifts, fine = fractal(canvas, 4, 4, 1), fractal(canvas, 16, 16, 2)
    return Surface(0.03 * drifts + 0.025 * fine, 0.2 * drifts + 0.015 * fine, roughness=0.75)


def ice(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the ice texture: ice with white cracks, transparent unless it is packed."""
    packed = recipe.word("packed") == "1"
    x, y = canvas.x + noise(canvas, 4, 4, 1), canvas.y + noise(canvas, 4, 4, 2)
    cracks = 1 - smooth(contour(canvas, noise(canvas, 3, 3, 3, x, y)), 0.1, 0.8)
    cracks = cracks * smooth(noise(canvas, 4, 4, 5), -0.5, 0.5)
    sheen = np.sin((canvas.x + canvas.y) * (2 * np.pi / SIDE) + 1.0)
    tone = 0.16 * cracks + 0.06 * sheen + 0.03 * fractal(canvas, 8, 8, 4)
    alpha = 1.0 if packed else 0.68 + 0.12 * cracks
    return Surface(tone, -0.1 * cracks, alpha=alpha, roughness=0.08, translucent=not packed)


def water(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the water texture: still, transparent water with slow waves."""
    x, y = canvas.x + 1.5 * noise(canvas, 4, 4, 1), canvas.y + noise(canvas, 4, 4, 2)
    waves = noise(canvas, 2, 4, 3, x, y) + 0.5 * noise(canvas, 4, 8, 4, x, y)
    crests = smooth(waves, 0.5, 1.0)
    return Surface(
        0.08 * waves + 0.14 * crests, 0.15 * waves, alpha=0.62, roughness=0.04, translucent=True
    )


def lava(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the lava texture: bright glowing streams between darker crusts."""
    x, y = canvas.x + 2 * noise(canvas, 4, 4, 1), canvas.y + 2 * noise(canvas, 4, 4, 2)
    flow = noise(canvas, 4, 4, 3, x, y) + 0.5 * noise(canvas, 8, 8, 4, x, y)
    flow = flow + 0.2 * fractal(canvas, 16, 16, 5)
    bright = smooth(flow, 0.1, 0.9)
    tone = 0.16 * flow
    return Surface(
        tone,
        0.3 * flow,
        ((recipe.ink(1), 0.6 * bright),),
        roughness=0.6,
        emission=0.75 + 0.25 * bright,
    )


def moss(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the moss texture: soft cushions of moss, sculk, wart blocks and similar growth."""
    cushions = noise(canvas, 8, 8, 1)
    fine = fractal(canvas, 16, 16, 2, 0.8)
    tone = 0.1 * cushions + 0.11 * fine
    return Surface(tone, 0.5 * cushions + 0.12 * fine, roughness=1.0)


def wart(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the wart texture: dense knobs lit from above, as of nether wart or coral."""
    pieces = stones(canvas, 5, 1, 0.6)
    knob = smooth(pieces.edge, 0.0, 1.3)
    tone = (
        0.13 * pick(canvas, pieces.identity, 3) + 0.16 * relief(canvas, knob) + 0.2 * (knob - 0.6)
    )
    return Surface(tone + 0.04 * fractal(canvas, 16, 16, 4), 0.9 * knob, roughness=0.9)


def coral(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the coral texture: winding ridges, as on a brain coral."""
    x, y = canvas.x + 2 * noise(canvas, 4, 4, 1), canvas.y + 2 * noise(canvas, 4, 4, 2)
    field = noise(canvas, 4, 4, 3, x, y) + 0.5 * noise(canvas, 8, 8, 4, x, y)
    ridge = np.cos(field * 9.0)
    tone = 0.15 * ridge + 0.05 * fractal(canvas, 16, 16, 5)
    return Surface(tone, 0.5 * ridge, roughness=0.85)


def sponge(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the sponge texture: pores of several sizes in a soft body."""
    pieces = stones(canvas, 5, 1, 0.8)
    away = np.sqrt(pieces.x * pieces.x + pieces.y * pieces.y)
    size = 0.9 + 0.35 * pick(canvas, pieces.identity, 3)
    pore = 1 - smooth(away, size - 0.2, size + 0.3)
    tone = 0.08 * fractal(canvas, 16, 16, 4) - 0.36 * pore
    return Surface(tone, -0.8 * pore, roughness=0.98)


def honey(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the honey texture: translucent honey or slime with a denser core."""
    x, y = np.abs(canvas.x - 8), np.abs(canvas.y - 8)
    away = np.maximum(x, y)
    core = 1 - smooth(away, 4.6, 5.4)
    frame = smooth(away, 6.6, 7.4)
    tone = 0.05 * fractal(canvas, 4, 4, 1) - 0.1 * core + 0.14 * frame
    return Surface(tone, 0.2 * core, alpha=0.72 + 0.2 * core, roughness=0.12, translucent=True)


def furrows(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the farmland texture: tilled earth in horizontal rows."""
    earth = dirt(canvas, recipe)
    rows = np.cos(canvas.y * (2 * np.pi / 4) - 0.8)
    return Surface(0.7 * np.asarray(earth.tone) + 0.17 * rows, 0.8 * rows, roughness=0.98)


def fire(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the fire texture: upright glowing flames with a bright centre (accent) and holes."""
    rise = SIDE - canvas.y
    solid, heart = np.zeros(rise.shape, bool), np.zeros(rise.shape)
    edge = np.zeros(rise.shape)
    random = hash_values(canvas.seed, 1, np.arange(len(FLAMES) * 2)).reshape(-1, 2)
    for (foot, tall, wide), (lean, phase) in zip(FLAMES, random, strict=True):
        part = np.clip(rise / tall, 0, 1)
        sway = (1.2 * lean + 0.9 * np.sin(rise * 0.55 + 3 * phase)) * part
        away = np.abs(canvas.x - foot - sway) / (wide * np.sqrt(1 - part) + 1e-6)
        here = (away < 1) & (rise < tall)
        inner = (1 - away) * (1 - part)
        heart, edge = np.maximum(heart, here * inner), np.maximum(edge, here * (1 - away))
        solid |= here
    core = smooth(heart, 0.1, 0.5)
    tone = 0.1 - 0.3 * (1 - smooth(edge, 0.0, 0.35)) - 0.2 * smooth(rise, 6, 14)
    paints = ((recipe.ink(1), 0.9 * core),)
    return Surface(tone, 0.0, paints, solid, roughness=1.0, emission=solid * (0.75 + 0.25 * core))

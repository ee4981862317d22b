"""Texture generators for stone: rock, cobblestone, ore, quartz, gems and similar materials."""

import numpy as np

from world2minecraft.rendering.textures.canvas import (
    SIDE,
    Canvas,
    contour,
    fractal,
    noise,
    pick,
    relief,
    smooth,
)
from world2minecraft.rendering.textures.recipe import Recipe
from world2minecraft.rendering.textures.texture_baking import Surface
from world2minecraft.rendering.textures.tiling_layouts import bevel, rim, stones


def rock(canvas: Canvas) -> tuple[np.ndarray, np.ndarray]:
    """Return the tone and height of natural rock: flat horizontal patches with ragged edges."""
    patches = noise(canvas, 4, 8, 1) + 0.6 * noise(canvas, 8, 16, 2)
    steps = np.rint(patches * 1.6) / 1.6
    if canvas.fineness:
        steps = 0.5 * steps + 0.5 * patches
        steps = steps + 0.3 * canvas.fineness * fractal(canvas, 32, 32, 3, 0.6)
    return 0.12 * steps, 0.16 * steps


def stone(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the stone texture: natural rock in flat patches of low contrast."""
    tone, height = rock(canvas)
    return Surface(tone + 0.05 * relief(canvas, height), height, roughness=0.88)


def speckled(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the speckled stone texture: granite, andesite or terrazzo with visible grains."""
    grains = noise(canvas, 16, 16, 1) + 0.4 * noise(canvas, 8, 8, 2)
    pieces = stones(canvas, 12, 3, 0.9)
    grains = 0.5 * grains + 0.75 * pick(canvas, pieces.identity, 5)
    spots = smooth(grains, 0.8, 0.95)
    tone = 0.1 * grains
    return Surface(tone, 0.04 * grains, ((recipe.ink(1), 0.7 * spots),), roughness=0.7)


def cobble(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the cobblestone texture: round stones with dark joints, or moss (accent) in them."""
    pieces = stones(canvas, int(recipe.number("stones")), 1, 0.9)
    body = smooth(pieces.edge, 0.1, 1.9)
    fine = fractal(canvas, 16, 16, 4)
    light = relief(canvas, 1.1 * body)
    tone = 0.11 * pick(canvas, pieces.identity, 5) + 0.06 * fine + 0.16 * light
    tone = tone + 0.12 * (body - 0.6) - 0.22 * pieces.joint
    wanted = recipe.number("moss")
    growth = noise(canvas, 4, 4, 6) + 0.5 * fine - 0.7 * body + 2.2 * wanted - 1.3
    moss = smooth(growth, 0.0, 0.3) * (wanted > 0)
    return Surface(tone, 1.1 * body + 0.08 * fine, ((recipe.ink(1), 0.9 * moss),), roughness=0.9)


def ore(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the ore texture: rock with nuggets of the accent colour."""
    tone, height = rock(canvas)
    pieces = stones(canvas, 4, 5, 0.5)
    away = np.abs(pieces.x) + np.abs(pieces.y) + 0.5 * noise(canvas, 8, 8, 7)
    kept = pick(canvas, pieces.identity, 8) > -0.35
    nugget = (1 - smooth(away, 1.6, 2.0)) * kept
    shadow = (1 - smooth(away, 2.1, 3.2)) * kept * (1 - nugget)
    light = np.where(pieces.x + pieces.y < 0, 0.3, -0.2) * nugget
    tone = tone * (1 - nugget) + light - 0.16 * shadow
    roughness = 0.88 - 0.45 * nugget
    return Surface(tone, height + 0.4 * nugget, ((recipe.ink(1), nugget),), roughness=roughness)


def slate(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the slate texture: rock in thin horizontal layers, such as deepslate or mud bricks."""
    bend = canvas.y + 0.8 * noise(canvas, 4, 4, 1)
    layers = noise(canvas, 4, 16, 2, y=bend) + 0.5 * noise(canvas, 8, 8, 3)
    layers = layers + 0.3 * canvas.fineness * fractal(canvas, 16, 32, 4)
    tone = 0.15 * layers + 0.06 * relief(canvas, 0.5 * layers)
    return Surface(tone, 0.35 * layers, roughness=0.84)


def quartz(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the quartz texture: smooth bright stone with faint veins, or a fluted pillar."""
    fine, slow = fractal(canvas, 16, 16, 1), fractal(canvas, 4, 4, 2)
    tone = 0.03 * slow + 0.02 * fine
    height = 0.02 * fine
    if recipe.word("form") == "pillar":
        wave = np.cos(canvas.x * (2 * np.pi / 4) + 0.7)
        tone, height = tone + 0.09 * wave, height + 0.3 * wave
    else:
        edge = rim(canvas) < canvas.joint
        lower = edge & ((canvas.x > 15) | (canvas.y > 15))
        tone = tone - 0.08 * lower + 0.02 * (edge & ~lower)
        veins = 1 - smooth(contour(canvas, noise(canvas, 4, 4, 3)), 0.0, 0.8)
        tone = tone - 0.05 * veins
    return Surface(tone, height, roughness=0.3)


def obsidian(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the obsidian texture: dark volcanic glass with sharp flakes and a few bright edges."""
    pieces = stones(canvas, 4, 1, 0.95)
    flakes = pick(canvas, pieces.identity, 3) + 0.06 * (pieces.x - pieces.y)
    glints = (1 - smooth(pieces.edge, 0.2, 0.7)) * (noise(canvas, 8, 8, 4) > 0.2)
    tone = 0.3 * flakes + 0.5 * glints + 0.12 * fractal(canvas, 16, 16, 5)
    return Surface(tone, 0.15 * flakes, roughness=0.16 + 0.1 * glints)


def netherrack(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the netherrack texture: porous rock with lumps and dark pits."""
    lumps = noise(canvas, 8, 8, 1) + 0.8 * noise(canvas, 16, 16, 2)
    lumps = lumps + 0.4 * canvas.fineness * fractal(canvas, 32, 32, 3)
    pits = smooth(-lumps, 0.4, 0.8)
    tone = 0.14 * lumps - 0.22 * pits + 0.06 * relief(canvas, lumps)
    return Surface(tone, 0.5 * smooth(lumps, -0.9, 0.7), roughness=0.95)


def prismarine(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the prismarine texture: cells of stone with light veins (accent) between them."""
    pieces = stones(canvas, 3, 1, 0.9)
    veins = 1 - smooth(pieces.edge, 0.3, 0.9)
    tone = 0.12 * pick(canvas, pieces.identity, 3) + 0.07 * fractal(canvas, 16, 16, 4)
    return Surface(tone, 0.3 * (1 - veins), ((recipe.ink(1), 0.7 * veins),), roughness=0.55)


def facets(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the crystal texture: flat facets of many shades, as of amethyst or diamond blocks."""
    pieces = stones(canvas, 4, 1, 0.95)
    lean = pick(canvas, pieces.identity, 3), pick(canvas, pieces.identity, 4)
    tilt = lean[0] * pieces.x + lean[1] * pieces.y
    tone = 0.17 * pick(canvas, pieces.identity, 5) + 0.09 * tilt
    upper = (pieces.x + pieces.y < 0) & (pieces.edge < max(0.3, canvas.joint * 0.5))
    tone = tone + 0.2 * upper + 0.03 * fractal(canvas, 16, 16, 6)
    return Surface(tone, 0.3 * tilt, roughness=0.14)


def gem(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the gem texture: a mineral or metal block with a bright bevel and a polished face."""
    edge = rim(canvas)
    frame = edge < 1
    lit = frame & (canvas.x + canvas.y < SIDE)
    inner = (edge >= 1) & (edge < 2)
    glint = np.cos((canvas.x + canvas.y) * (2 * np.pi / SIDE)) * 0.5
    tone = (
        0.32 * lit
        - 0.3 * (frame & ~lit)
        + 0.1 * inner * np.where(canvas.x + canvas.y < SIDE, -1, 1)
    )
    tone = tone + (1 - frame) * (0.12 * glint + 0.05 * noise(canvas, 4, 4, 1))
    metal = 1.0 if recipe.word("of") == "metal" else 0.0
    return Surface(tone, 0.5 * bevel(canvas, edge, 1.0), roughness=0.25, metal=metal)


def bone(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the bone texture: pale bone with long vertical pores."""
    pieces = stones(canvas, 6, 1, 0.8)
    kept = pick(canvas, pieces.identity, 4) > 0.45
    away = np.sqrt((pieces.x * 2.2) ** 2 + (pieces.y * 0.8) ** 2)
    pores = (1 - smooth(away, 0.8, 1.3)) * kept
    tone = 0.07 * noise(canvas, 16, 2, 2) - 0.2 * pores + 0.03 * fractal(canvas, 16, 16, 3)
    return Surface(tone, -0.3 * pores, roughness=0.7)


def marble(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the marble texture: polished marble with clouds and veins of the accent colour."""
    x = canvas.x + 2.5 * noise(canvas, 2, 2, 1) + 0.5 * noise(canvas, 8, 8, 2)
    y = canvas.y + 2.5 * noise(canvas, 2, 2, 3) + 0.5 * noise(canvas, 8, 8, 4)
    lines = (
        contour(canvas, noise(canvas, 2, 3, 5, x, y)),
        contour(canvas, noise(canvas, 4, 4, 6, x, y)),
    )
    width = 1.4 if canvas.size_px == 16 else 0.5
    strong = (1 - smooth(lines[0], 0.0, width)) * smooth(noise(canvas, 4, 4, 9), -0.6, 0.6)
    thin = (1 - smooth(lines[1], 0.0, 0.6 * width)) * smooth(noise(canvas, 4, 4, 10), -0.2, 0.9)
    tone = 0.05 * fractal(canvas, 4, 4, 7) + 0.015 * fractal(canvas, 16, 16, 8)
    tone = tone - 0.05 * (1 - smooth(lines[0], 0.0, 2.5))
    share = np.clip(0.75 * strong + 0.35 * thin, 0, 1)
    return Surface(tone, -0.02 * share, ((recipe.ink(1), share),), roughness=0.16)

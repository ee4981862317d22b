"""Texture generators for furniture faces: books, drawers, stoves, paintings, glazed tiles."""

from itertools import pairwise

import numpy as np

from world2minecraft.rendering.textures.canvas import (
    SIDE,
    Canvas,
    fractal,
    hash_values,
    noise,
    relief,
    smooth,
)
from world2minecraft.rendering.textures.pixel_art import draw
from world2minecraft.rendering.textures.recipe import Recipe
from world2minecraft.rendering.textures.texture_baking import Surface
from world2minecraft.rendering.textures.tiling_layouts import boards, box, rim
from world2minecraft.rendering.textures.wood import fibre

SOOT = np.full(3, 28.0)  # sRGB, within a cold stove.
SHELF = 1.0  # Thickness of a shelf's boards, sixteenths.
SPINES = ((1, 2, 2, 1, 2, 1, 2, 2, 1), (2, 1, 2, 1, 1, 2, 2, 1, 2))  # Widths, 14 in all.
FURNACE = """
mmlmmmmmmmmlmmmm mlmmdmmmlmmmmmdm mmmkkkkkkkkkkmmm mdmkmmmmmmmmkmmm
mmmkdmmmlmmdkmlm mlmkmmmmmmmmkmmm mmmkkkkkkkkkkmdm mmmmmlmmmdmmmmmm
mmkkkkkkkkkkkkmm mmkMMKKMMKKMMkmm mlkMMMMMMMMMMkmm mmkKMKMMKMKMMkml
mmkMKMKMMKMKMkmm mmkkkkkkkkkkkkmm mdmmmmlmmmmmmmmm mmmlmmmmmmdmmlmm
"""
FACE = """
mmmdmmmmmdmmmmdm mmmdmmmmmdmmmmdm mmmdmmmmmdmmmmdm mmkkkmmmmmmkkkdm
mkKMKkmmmmkKMKkm mkMMMkmmmmkMMMkm mkkkkkmmmmkkkkkm mmmdmmmkkmmmmmdm
mmmdmmkKKkmmmmdm mmmdmmmmmdmmmmdm mkkmkkmkkmkkmkkm mkMkMMkMMkMMkMkm
mdkMMMMMMMMMMkdm mmmkkMMMMMMkkmmm mmmmmkkkkkkmmmdm mmmdmmmmmdmmmmdm
"""


def books(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the bookshelf texture: two rows of spines (accents) between boards."""
    y = canvas.y % 8
    board = (y < SHELF) | (canvas.x < 1) | (canvas.x > 15)
    identity, left, right = _spines(canvas)
    random = hash_values(canvas.seed, 1, identity)
    tall = 7.0 - np.where(random > 0.55, 1.0, 0.0) - np.where(random < -0.7, 0.5, 0.0)
    gap = (8.0 - y > tall) | (identity % 16 == 15)
    edge = np.minimum(canvas.x - left, right - canvas.x)
    spine = ~board & ~gap
    tone = np.where(spine, 0.16 * hash_values(canvas.seed, 2, identity), 0.0)
    tone = tone + spine * (
        0.12 * smooth(edge, 0.0, 0.6)
        - 0.1
        - 0.22 * (canvas.x > right - max(0.25, 0.7 - canvas.joint / 2)) * (right - left > 1)
    )
    band = spine & (np.abs(8.0 - y - 1.6) < 0.5) & (hash_values(canvas.seed, 3, identity) > 0.0)
    band |= spine & (np.abs(8.0 - y - 5.0) < 0.5) & (hash_values(canvas.seed, 4, identity) > 0.3)
    tone = tone + 0.42 * band - 0.75 * (gap & ~board)
    tone = np.where(
        board, 0.1 * fibre(canvas, canvas.x, canvas.y, 5) + 0.12 * (y < 0.5) - 0.06, tone
    )
    which = (identity * 3 + identity // 4 + recipe.seed % 4) % 4  # Never two alike side by side.
    covers = [(recipe.ink(index + 1), (spine & (which == index)) * 1.0) for index in range(4)]
    paints = (*covers, (recipe.ink(5), board * 1.0))
    height = np.where(spine, 0.5 + 0.5 * smooth(edge, 0.0, 0.7), np.where(board, 1.2, 0.0))
    return Surface(tone, height, paints, roughness=0.75)


def _spines(canvas: Canvas) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return number, left and right side of the spine at each texel, [N, N]."""
    identity = np.zeros(canvas.x.shape, np.int64)
    left, right = np.zeros(canvas.x.shape), np.full(canvas.x.shape, SIDE)
    for shelf, widths in enumerate(SPINES):
        ends = 1.0 + np.cumsum((0, *widths))
        for index, (low, high) in enumerate(pairwise(ends)):
            here = (canvas.x >= low) & (canvas.x < high) & (np.floor(canvas.y / 8) == shelf)
            identity[here], left[here], right[here] = shelf * 16 + index, low, high
    return identity, left, right


def drawers(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the drawer texture: a cupboard, chest or barrel front with knobs (accent)."""
    kind = recipe.word("kind")
    if kind == "barrel":
        return _barrel(canvas, recipe)
    gap = canvas.joint
    panels = {
        "chest": ((1, 1, 15, 5), (1, 6, 15, 15)),
        "doors": ((1, 1, 8 - gap, 15), (8, 1, 15, 15)),
        "two": ((1, 1, 15, 8 - gap), (1, 8, 15, 15)),
        "three": ((1, 1, 15, 5), (1, 6, 15, 10), (1, 11, 15, 15)),
    }[kind]
    knobs = {
        "chest": ((7, 4, 9, 8),),
        "doors": ((6, 7, 7, 9), (9, 7, 10, 9)),
        "two": ((6, 4, 10, 5), (6, 11, 10, 12)),
        "three": ((7, 2, 9, 4), (7, 7, 9, 9), (7, 12, 9, 14)),
    }[kind]
    panel = np.maximum.reduce([box(canvas, *corners) for corners in panels])
    knob = np.maximum.reduce([box(canvas, *corners) for corners in knobs]) > 0
    upright = kind == "doors"
    grain = fibre(canvas, *((canvas.y, canvas.x) if upright else (canvas.x, canvas.y)), 1)
    body = smooth(panel, 0.0, 0.6)
    frame = (panel <= 0) | (rim(canvas) < 1)
    tone = 0.08 * grain - 0.24 * frame + 0.12 * relief(canvas, body) * ~frame
    tone = np.where(knob, 0.2 * relief(canvas, knob * 1.0), tone)
    under = np.roll(knob, canvas.size_px // 16, axis=0) & ~knob
    tone = tone - 0.25 * under
    height = 0.6 * body + 0.8 * knob
    paints = ((recipe.ink(1), knob.astype(np.float64)),)
    return Surface(tone, height, paints, roughness=0.55 - 0.2 * knob, metal=knob * 1.0)


def _barrel(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return staves along v with two hoops of the accent."""
    column = np.floor(canvas.x / 4)
    joint = canvas.x - column * 4 > 4 - canvas.joint
    shade = hash_values(canvas.seed, 2, column.astype(np.int64))
    hoop = (np.abs(canvas.y - 3.0) < 1.0) | (np.abs(canvas.y - 13.0) < 1.0)
    grain = fibre(canvas, canvas.y, canvas.x, 3)
    tone = (0.1 * grain + 0.08 * shade - 0.3 * joint) * ~hoop
    tone = tone + hoop * (0.1 * relief(canvas, hoop * 1.0) + 0.06 * noise(canvas, 16, 4, 4))
    height = 0.5 * hoop + 0.3 * ~joint
    paints = ((recipe.ink(1), hoop.astype(np.float64)),)
    return Surface(tone, height, paints, roughness=0.6, metal=hoop * 1.0)


def table_top(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the workbench top texture: a framed board with a grid of nine squares (accent)."""
    edge = rim(canvas)
    frame = edge < 2
    lines = (np.abs((canvas.x - 2) % 4) < canvas.joint) | (
        np.abs((canvas.y - 2) % 4) < canvas.joint
    )
    lines &= ~frame
    grain = fibre(canvas, canvas.x, canvas.y, 1)
    height = np.where(frame, 0.6, np.where(lines, 0.0, 0.3))
    tone = 0.09 * grain - 0.34 * lines + 0.1 * relief(canvas, height)
    corner = (np.abs(canvas.x - 8) > 6) & (np.abs(canvas.y - 8) > 6)
    tone = tone - 0.18 * corner - 0.1 * ((edge < canvas.joint) & ~corner)
    return Surface(tone, height, ((recipe.ink(1), 0.8 * frame),), roughness=0.6)


def furnace_front(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the stove texture: stone around a grate, with a fire (accent) if it is lit."""
    drawn, tone, _ = draw(canvas, FURNACE)
    mouth = np.isin(drawn, ("M", "K"))
    tone = np.where(mouth, 0.15 * (drawn == "M"), tone + 0.06 * fractal(canvas, 16, 16, 1))
    flame = np.zeros(tone.shape)
    if recipe.word("lit") == "1":
        flame = mouth * smooth(noise(canvas, 8, 8, 2) + 0.45 * (canvas.y - 11.5), -0.3, 0.5)
    dark = SOOT, (mouth & (flame < 0.5)) * 1.0
    paints = (dark, (recipe.ink(1), flame))
    return Surface(tone, ~mouth * 0.6, paints, roughness=0.85, emission=flame)


def face(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the carved face texture: a pumpkin face, dark or lit from within (accent)."""
    drawn, tone, _ = draw(canvas, FACE)
    cut = np.isin(drawn, ("M", "K", "k"))
    lit = recipe.word("lit") == "1"
    ink = recipe.ink(1) if lit else np.array((50.0, 34.0, 12.0))
    inner = np.isin(drawn, ("M", "K")) if lit else cut
    wave = np.cos(canvas.x * (2 * np.pi * 3 / SIDE) + np.pi)
    tone = np.where(inner, 0.0, 0.5 * tone + 0.1 * wave + 0.05 * fractal(canvas, 16, 16, 1))
    glow = inner * (0.9 if lit else 0.0)
    return Surface(tone, -0.8 * cut, ((ink, inner * 1.0),), roughness=0.7, emission=glow)


def painting(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the painting texture: a motif in a frame (first accent) on a ground (main colour)."""
    x, y = canvas.x, canvas.y
    edge = rim(canvas)
    frame = edge < 1
    layers = _MOTIFS[recipe.word("motif")](canvas)
    brush = fractal(canvas, 8, 16, 1)
    tone = 0.06 * brush + 0.16 * (8.0 - y) / SIDE
    lit = np.where((x < 1) | (y < 1), 0.22, -0.18)
    tone = np.where(frame, lit, tone) - 0.3 * ((edge >= 1) & (edge < 1 + canvas.joint / 2))
    paints = [(recipe.ink(index + 2), (layer & ~frame) * 1.0) for index, layer in enumerate(layers)]
    paints.append((recipe.ink(1), frame * 1.0))
    return Surface(tone, 0.6 * frame, tuple(paints), roughness=0.7, bold=True)


def _landscape(canvas: Canvas) -> tuple[np.ndarray, ...]:
    x, y = canvas.x, canvas.y
    far = y > 8.6 - 2.2 * np.sin(0.42 * x + 0.6) - 0.5 * noise(canvas, 8, 1, 2)
    near = y > 11.6 + 1.4 * np.sin(0.36 * x + 2.2)
    sun = (x - 11.5) ** 2 + (y - 4.4) ** 2 < 2.2
    return far, near, sun & ~far


def _figure(canvas: Canvas) -> tuple[np.ndarray, ...]:
    x, y = canvas.x, canvas.y
    hair = ((x - 8) / 3.1) ** 2 + ((y - 5.4) / 3.4) ** 2 < 1
    head = ((x - 8) / 2.2) ** 2 + ((y - 6.2) / 2.8) ** 2 < 1
    neck = (np.abs(x - 8) < 1.0) & (y > 8) & (y < 11)
    dress = (y > 10.2) & (((x - 8) / 5.6) ** 2 + ((y - 15.5) / 5.3) ** 2 < 1)
    return dress | (hair & ~head), head | (neck & ~dress), dress & (np.abs(x - 8) < 0.5)


def _still_life(canvas: Canvas) -> tuple[np.ndarray, ...]:
    x, y = canvas.x, canvas.y
    table = y > 11.5
    vase = (np.abs(x - 6.5) < 1.2 + 0.9 * np.sin(np.clip((12.8 - y) / 4.2, 0, 1) * np.pi)) & (
        (y > 8.4) & (y < 13)
    )
    blooms = np.zeros(x.shape, bool)
    for u, v in ((4.6, 6.2), (6.6, 4.6), (8.6, 6.0), (6.3, 7.0)):
        blooms |= (x - u) ** 2 + (y - v) ** 2 < 1.5
    fruit = ((x - 11.2) ** 2 + (y - 12.0) ** 2 < 2.0) | ((x - 9.9) ** 2 + (y - 12.6) ** 2 < 1.2)
    return table, vase, blooms | fruit


def _abstract(canvas: Canvas) -> tuple[np.ndarray, ...]:
    x, y = canvas.x, canvas.y
    block = (x < 7) & (y > 6)
    band = (x > 9) & (y < 10)
    disc = (x - 10.5) ** 2 + (y - 11.0) ** 2 < 5.5
    return block, band, disc


_MOTIFS = {
    "landscape": _landscape,
    "figure": _figure,
    "still_life": _still_life,
    "abstract": _abstract,
}
MOTIFS = tuple(_MOTIFS)


def glazed(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the glazed tile texture: a quarter of a rosette in two accents."""
    x, y = canvas.x, canvas.y
    away = np.sqrt(x * x + y * y)
    far = np.sqrt((SIDE - x) ** 2 + (SIDE - y) ** 2)
    ring = ((away > 10.0) & (away < 13.0)) | (far < 3.0)
    petal = ((away < 7.0) & (np.abs(x - y) < 3.0)) | ((far > 5.0) & (far < 6.6))
    edge = rim(canvas) < canvas.joint
    tone = 0.03 * noise(canvas, 8, 8, 1) - 0.05 * edge + 0.08 * (away < 3)
    paints = ((recipe.ink(1), ring * 1.0), (recipe.ink(2), (petal & ~ring) * 1.0))
    return Surface(tone, 0.1 * (ring | petal), paints, roughness=0.12)


def crate(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the crate texture: framed boards, as of a composter, a loom or a note block."""
    pieces = boards(canvas, 4)
    edge = rim(canvas)
    frame = edge < 2
    across = (canvas.x < 2) | (canvas.x > 14)
    grain = np.where(
        frame & across, fibre(canvas, canvas.y, canvas.x, 5), fibre(canvas, canvas.x, canvas.y, 1)
    )
    height = np.where(frame, 0.9, 0.45 * (1 - pieces.joint))
    shadow = (edge >= 2) & (edge < 2 + canvas.joint) & ((canvas.x < 8) | (canvas.y < 8))
    tone = 0.09 * grain - 0.34 * pieces.joint * ~frame + 0.12 * relief(canvas, height)
    tone = tone - 0.16 * shadow - 0.12 * (edge < 0.5 * canvas.joint)
    return Surface(tone, height, ((recipe.ink(1), 1.0 * frame),), roughness=0.65)


def cake(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the cake texture: icing with berries (accent) from above, or sponge from the side."""
    fine = fractal(canvas, 16, 16, 1)
    if recipe.word("part") == "side":
        drip = 5.0 + 1.6 * noise(canvas, 8, 1, 2)
        sponge = canvas.y > drip
        layer = np.abs(canvas.y - 11.5) < 0.6
        tone = np.where(sponge, 0.09 * fine - 0.15 * layer, 0.03 * fine)
        paints = ((recipe.ink(2), sponge * 1.0),)
        return Surface(tone, 0.3 * ~sponge, paints, roughness=0.8)
    berry, light = np.zeros(fine.shape), np.zeros(fine.shape)
    for x, y in ((4, 4), (11, 3), (13, 9), (8, 8), (3, 11), (10, 13)):
        across, down = canvas.x - x - 0.5, canvas.y - y - 0.5
        near = np.sqrt(across * across + down * down) < 1.25
        berry = np.where(near, 1.0, berry)
        light = np.where(near, -0.12 * (across + down), light)
    tone = 0.03 * fine + light - 0.1 * (rim(canvas) < 1) * (1 - berry)
    return Surface(tone, 0.6 * berry, ((recipe.ink(1), berry),), roughness=0.6)

"""Texture generators for plants: leaves, blades, flowers, saplings, mushrooms, vines."""

from typing import NamedTuple

import numpy as np

from world2minecraft.rendering.textures.canvas import (
    SIDE,
    Canvas,
    fractal,
    hash_values,
    noise,
    pick,
    smooth,
)
from world2minecraft.rendering.textures.pixel_art import draw, paints_of
from world2minecraft.rendering.textures.recipe import Recipe
from world2minecraft.rendering.textures.texture_baking import Surface
from world2minecraft.rendering.textures.tiling_layouts import stones

FLOWERS = {
    "poppy": """
................ ................ ................ ................
................ ................ .....lmml....... ....lmmmmd......
....mmd1mmd..... ....mm11md...... ....dmmmdd...... ......Md........
......M..M...... ...MM.MMM....... ....MMM......... ......M.........
""",
    "tulip": """
................ ................ ................ ......l.........
.....mlm.l...... .....mlmml...... .....mmmmd...... .....mmmmd......
.....dmmd....... ......dM........ ......M...M..... ..M...M..MM.....
..MM..M.MM...... ...MM.MMM....... ....MMMM........ ......M.........
""",
    "daisy": """
................ ................ ................ ......lm........
....ml.lm.m..... ....lm22.ml..... ...mm.2221mm.... ....dm221md.....
....md.dm.d..... ......dd........ .......M........ ...M...M..M.....
....MM.M.MM..... .....MMMM....... ......MM........ .......M........
""",
    "bush": """
...lm.....lm.... ..lmmd.M.lmmd... ..mm2d.MMmm2d... ...ddM.M.Mdd.M..
.M..MMMMMM..MM.. .MMM.DM.lm.MM... ...MMMMlmmdM.... ..lmMDMmm2dMlm..
.lmmdMMMddM.mmd. .mm2dMDMMM.Mm2d. ..dd.MMMDMMMdd.. ...MMMDMMMDMM...
....MMMMDMMMM... .....MDMMMM..... ......MMDM...... .......DM.......
""",
    "bell": """
................ ................ ................ .....MM.........
....M..MM....... ....l.M..M...... ...lmd.M.M...... ...mmd.M..M.....
....2..lm.l..... ......mmdlmd.... .......2.mmd.... .......M...2....
....M..M........ ....MM.M..M..... .....MMMMM...... .......M........
""",
    "spike": """
.......l........ ......lm........ ......mmd....... .....lmml.......
.....mmdm....... .....lmmd....... ....lmdmml...... ....mmmmd.......
.....lmdm....... .....mmmd....... ......MM........ ...M..M...M.....
...MM.M..MM..... ....MMMMMM...... .....MMMM....... ......MM........
""",
    "ball": """
................ ................ .....lmlm....... ....lmlmmm......
...lmlmmdmm..... ...mlmmmmdm..... ...lmmdmmmd..... ...mmmmmdmd.....
....mdmdmd...... .....dmdd....... ......MM........ ..M...M..M......
..MM..M.MM...... ...MM.MMM....... ....MMMM........ ......MM........
""",
    "sun": """
................ ....l.ml.l...... ...mlmmmmlm..... ..lmm2112mml....
...mm1221mm..... ..lm122221ml.... ..mm122211mm.... ...mm1121mm.....
..lmmm11mmml.... ...m.mmmm.m..... ....m.Mm.m...... ..MM..M.........
...MMDM..MM..... ....DMMMMM...... ......MDM....... ......M.........
""",
}
SAPLINGS = {
    "tree": """
................ ......lm........ ....lmmmmd...... ...lmmmdmmm.....
..lmmdmmmmdm.... ..mmlmmdmmmd.... ...mmmmmmdm..... ..lmdmmlmmmd....
..mmmmdmmmdd.... ...ddMmmMdd..... .....DMMD....... ......MM........
......MD........ ......MD........ .....MMD........ ......MD........
""",
    "conifer": """
.......l........ ......lmm....... ......mmd....... .....lmmmd......
....lmmmdmm..... ......mmd....... .....lmmmd...... ....lmdmmmm.....
...lmmmmdmmd.... .....mmmmd...... ....lmmdmmm..... ...lmmmmmmdm....
..lmd.mMd.dmm... .......MD....... .......MD....... .......MD.......
""",
    "bush": """
................ ................ ................ ....lm...lm.....
...lmmd.lmmd.... ..lmmmdmmmdm.... ..mmdmmmmmmd.... .lmmmmmdmmmmd...
.mmlmdmmmmdmd... .mmmmmmmlmmmdm.. ..dmmdmmmmmdmd.. ..mmmmmdmmdmd...
...dmmMmMmdd.... ....dMDMMd...... ......MM........ ......MD........
""",
    "dead": """
................ ..M.......M..... ...M..M...M..... ...M.M...M......
....MM...MM..M.. .....M..M...M... ..M..M..M..M.... ...M.MM.M.MM....
....M.M.MMM..... .....MMMM....... ......MM........ ......MD........
......MD........ ......MD........ .....MMD........ ......MD........
""",
}
MUSHROOM = """
................ ................ ................ ................
................ .....lmmm....... ....lmHmmmd..... ...lmmmmmHmd....
...mHmmmmmmd.... ...mmmmHmmmd.... ...dddddddd..... ......LM........
......LM........ ......LM........ ......LMD....... .....LMMD.......
"""


BLADES = {
    "grass": (9, 13.0, 3.0),
    "crop": (6, 14.5, 1.0),
    "short": (8, 7.0, 2.0),
    "reed": (3, 16.0, 0.3),
}


class Stamps(NamedTuple):
    """The topmost leaf at each texel, [N, N]: its number, or -1, and the position within it.

    ``along`` is -1 at the base and 1 at the tip, ``across`` is -1 to 1 over the width.
    """

    identity: np.ndarray
    along: np.ndarray
    across: np.ndarray


def scatter(canvas: Canvas, count: int, length: float, width: float, salt: int) -> Stamps:
    """Return ``count`` pointed leaves. ``length`` and ``width`` are half sizes in sixteenths."""
    identity = np.full(canvas.x.shape, -1, np.int64)
    along, across = np.zeros(canvas.x.shape), np.zeros(canvas.x.shape)
    random = hash_values(canvas.seed, salt, np.arange(count * 4)).reshape(count, 4)
    for index, (middle_x, middle_y, turn, size) in enumerate(random):
        x = (canvas.x[0] - SIDE / 2 * middle_x) % SIDE - SIDE / 2
        y = ((canvas.y[:, 0] - SIDE / 2 * middle_y) % SIDE - SIDE / 2)[:, None]
        cosine, sine = np.cos(np.pi * turn), np.sin(np.pi * turn)
        scale = 1.0 + 0.25 * size
        first = (x * cosine + y * sine) / (length * scale)
        second = (y * cosine - x * sine) / (width * scale * np.maximum(1 - first * first, 1e-6))
        inside = (np.abs(first) < 1) & (np.abs(second) < 1)
        identity[inside] = index
        along[inside], across[inside] = first[inside], second[inside]
    return Stamps(identity, along, across)


def leaves(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the leaf texture: foliage with holes, optionally with blossoms (accent)."""
    stamps = scatter(canvas, 76, 1.9, 1.05, 1)
    identity = np.maximum(stamps.identity, 0)
    here = stamps.identity >= 0
    level = stamps.identity / 76.0  # Later leaves lie over earlier ones.
    shade = pick(canvas, identity, 3)
    tone = 0.12 * shade + 0.34 * (level - 0.6) - 0.07 * stamps.across + 0.06 * stamps.along
    vein = (np.abs(stamps.across) < 0.16) * canvas.fineness
    tone = np.where(here, tone - 0.1 * vein, -0.42) + 0.05 * noise(canvas, 16, 16, 4)
    height = np.where(here, 0.4 + 0.7 * level - 0.25 * stamps.across**2, 0.0)
    bloom = here & (pick(canvas, identity, 6) > 0.4) & (recipe.word("blossom") == "1")
    paints = ((recipe.ink(1), bloom.astype(np.float64)),)
    solid = here | (recipe.word("holes") == "0")
    return Surface(tone, height, paints, solid, roughness=0.75)


def blades(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the blade texture: upright grass, crops or reeds with holes and ears (accent)."""
    count, tall, sway = BLADES[recipe.word("kind")]
    solid = np.zeros(canvas.x.shape, bool)
    tone, tip = np.zeros(canvas.x.shape), np.zeros(canvas.x.shape)
    random = hash_values(canvas.seed, 1, np.arange(count * 4)).reshape(count, 4)
    rise = SIDE - canvas.y
    for index, (start, lean, length, shade) in enumerate(random):
        foot = (index + 0.5 + 0.5 * start) * SIDE / count
        foot = foot + (8.0 - foot) * 0.15
        reach = tall * (0.78 + 0.22 * length)
        part = np.clip(rise / reach, 0, 1)
        middle = foot + lean * sway * part * part
        width = 1.1 if sway < 0.5 else 0.72 - 0.35 * part * canvas.fineness
        here = (np.abs(canvas.x - middle) < width) & (rise < reach)
        tone = np.where(here, 0.22 * shade + 0.3 * (part - 0.5) - 0.08 * (canvas.x - middle), tone)
        tip = np.where(here, part, tip)
        solid |= here
    ears = smooth(tip, 0.5, 0.7) * (recipe.number("ears") > 0)
    if recipe.word("kind") == "reed":
        tone = tone - 0.25 * (np.floor(canvas.y) % 5 == 2)
    return Surface(tone, 0.3 * solid, ((recipe.ink(1), ears),), solid, roughness=0.85)


def flower(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the flower texture: a head (main colour) with a centre and a stem (accents)."""
    return _sprite(canvas, recipe, FLOWERS[recipe.word("shape")])


def sapling(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the sapling texture: a small tree with leaves (main colour) on a trunk (accent)."""
    return _sprite(canvas, recipe, SAPLINGS[recipe.word("shape")])


def mushroom(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the mushroom texture: a spotted cap (main colour) on a stem (accent)."""
    return _sprite(canvas, recipe, MUSHROOM)


def _sprite(canvas: Canvas, recipe: Recipe, art: str) -> Surface:
    drawn, tone, solid = draw(canvas, art)
    tone = tone + 0.06 * fractal(canvas, 16, 16, 1)
    paints = paints_of(drawn, recipe)
    return Surface(tone, 0.4 * solid, paints, solid, roughness=0.8, bold=True)


def vine(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the vine texture: hanging shoots with leaves, and holes between."""
    solid = np.zeros(canvas.x.shape, bool)
    tone = np.zeros(canvas.x.shape)
    for index in range(4):
        middle = 2.0 + 4 * index + 1.2 * noise(canvas, 1, 4, 10 + index)
        stem = np.abs(canvas.x - middle) < 0.5
        solid, tone = solid | stem, np.where(stem, -0.2, tone)
    pieces = stones(canvas, 5, 1, 0.9)
    kept = pick(canvas, pieces.identity, 3) > -0.25
    leaf = (np.abs(pieces.x) * 1.1 + np.abs(pieces.y) * 0.8 < 1.5) & kept
    shade = 0.2 * pick(canvas, pieces.identity, 4) - 0.06 * (pieces.x + pieces.y)
    tone = np.where(leaf, shade, tone) + 0.05 * noise(canvas, 16, 16, 5)
    return Surface(tone, 0.5 * leaf, alpha=solid | leaf, roughness=0.85)


def gourd(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the gourd texture: the ribbed side of a pumpkin, melon or cactus (thorns: accent)."""
    ribs = recipe.number("ribs")
    wave = np.cos(canvas.x * (2 * np.pi * ribs / SIDE) + np.pi)
    tone = 0.16 * wave + 0.08 * noise(canvas, 16, 4, 1) + 0.04 * fractal(canvas, 16, 16, 2)
    thorn = np.zeros(wave.shape)
    if recipe.word("thorns") == "1":
        column = np.floor(canvas.x / 4)
        x, y = canvas.x - column * 4 - 2.5, (canvas.y + 2 * column) % 4 - 2.5
        thorn = (np.maximum(np.abs(x), np.abs(y)) < 0.51).astype(np.float64)
    return Surface(tone, 0.8 * wave + 0.3 * thorn, ((recipe.ink(1), thorn),), roughness=0.6)


def mushroom_cap(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the mushroom cap texture: skin with round spots (accent)."""
    pieces = stones(canvas, 3, 1, 0.8)
    away = np.sqrt(pieces.x * pieces.x + pieces.y * pieces.y)
    size = 1.5 + 0.5 * pick(canvas, pieces.identity, 3)
    spot = 1 - smooth(away, size - 0.2, size + 0.2)
    tone = 0.06 * fractal(canvas, 16, 16, 4) + 0.03 * noise(canvas, 4, 4, 5)
    return Surface(tone, 0.3 * spot, ((recipe.ink(1), spot * 0.9),), roughness=0.75)


def crystal(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the crystal cluster texture: upright pointed crystals with holes around."""
    solid = np.zeros(canvas.x.shape, bool)
    tone = np.zeros(canvas.x.shape)
    rise = SIDE - canvas.y
    spikes = (
        (3.5, -0.25, 7.0),
        (12.5, 0.3, 8.0),
        (5.5, -0.12, 11.0),
        (10.0, 0.12, 13.0),
        (8.0, 0.0, 10.0),
    )
    for index, (foot, lean, tall) in enumerate(spikes):
        away = canvas.x - foot - lean * rise
        width = np.minimum(1.7, (tall - rise) * 0.6)
        here = (np.abs(away) < width) & (rise < tall)
        shade = np.where(away < 0, 0.25, -0.15) + 0.05 * (index - 2)
        tone, solid = np.where(here, shade, tone), solid | here
    return Surface(tone, 0.4 * solid, alpha=solid, roughness=0.15, emission=0.15 * solid)


def pad(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the lily pad texture: a round leaf from above, with a notch and veins."""
    x, y = canvas.x - SIDE / 2, canvas.y - SIDE / 2
    away = np.sqrt(x * x + y * y)
    solid = (away < 6.6 + 0.3 * noise(canvas, 8, 8, 1)) & ~((np.abs(x) < -0.45 * y) & (y < 0))
    veins = np.minimum.reduce([np.abs(x), np.abs(y), np.abs(x - y) * 0.7, np.abs(x + y) * 0.7])
    tone = 0.1 * (veins < 0.5) - 0.14 * (away > 5.6) + 0.06 * fractal(canvas, 16, 16, 2)
    return Surface(tone, 0.2 * solid, alpha=solid, roughness=0.45)


def web(canvas: Canvas, recipe: Recipe) -> Surface:
    """Return the web texture: a spider's web of radial threads and rings, with holes between."""
    x, y = canvas.x - 7.5, canvas.y - 7.5  # The middle of a texel at 16 px.
    thick = 0.5 if canvas.size_px == 16 else 0.3
    spokes = np.minimum.reduce([np.abs(x), np.abs(y), np.abs(x - y) * 0.7, np.abs(x + y) * 0.7])
    ring = np.maximum.reduce([np.abs(x), np.abs(y), 0.72 * (np.abs(x) + np.abs(y))])
    away = np.abs((ring + 0.2 * noise(canvas, 8, 8, 1) * canvas.fineness) % 3.0 - 1.5)
    solid = (spokes < thick) | ((away > 1.5 - thick) & (ring > 1.5) & (ring < 7.6))
    return Surface(0.12 * noise(canvas, 8, 8, 2), 0.1 * solid, alpha=solid, roughness=0.6)

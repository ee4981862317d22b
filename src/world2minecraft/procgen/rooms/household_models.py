"""Models of full furnishing: laundry, lamps, radiators, music, and pieces for halls and kitchens.

Their names are names or labels of the vocabulary.
"""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.rooms.bathroom_fittings import STEEL, washing_machine
from world2minecraft.procgen.rooms.children_and_hall_furniture import BRIGHT_COLOURS, bright_colour
from world2minecraft.procgen.rooms.colour_scheme import WHITE
from world2minecraft.procgen.rooms.furniture_model import (
    Bar,
    Colour,
    Model,
    Part,
    legs,
    round_to_step,
    shade,
)
from world2minecraft.procgen.rooms.storage_furniture import BOOKS, DARK
from world2minecraft.procgen.rooms.supersampled_voxelization import make_model

FURN, OBJS, BED = (int(c) for c in (SemanticClass.FURN, SemanticClass.OBJS, SemanticClass.BED))
CHAIR, TABLE = int(SemanticClass.CHAIR), int(SemanticClass.TABLE)
GLOW: Colour = (255, 244, 218)
WICKER: Colour = (196, 160, 112)


def ceiling_lamp() -> Model:
    """Return a model of a round lamp under a ceiling, 0.44 m across."""
    parts = (
        Part((-0.22, -0.22, 0.0, 0.22, 0.22, 0.10), GLOW, "glow", form="drum"),
        Part((-0.24, -0.24, 0.06, 0.24, 0.24, 0.12), WHITE, form="drum"),
    )
    return make_model("ceiling_lamp", OBJS, parts)


def wall_lamp(colour: Colour) -> Model:
    """Return a model of a wall lamp with a cloth shade."""
    parts = (
        Part((-0.10, -0.06, 0.06, -0.08, 0.06, 0.20), STEEL),
        Part((-0.08, -0.02, 0.12, 0.02, 0.02, 0.14), STEEL),
        Part((-0.08, -0.08, 0.14, 0.10, 0.08, 0.32), shade(colour, 1.3), "glow", form="drum"),
    )
    return make_model("wall_lamp", OBJS, parts)


def radiator(width: float) -> Model:
    """Return a model of a ribbed radiator, 0.6 m high and 0.1 m deep."""
    d, w, h = 0.10, round_to_step(width), 0.60
    parts = [Part((-d / 2, -w / 2, 0.02, d / 2 - 0.04, w / 2, h - 0.02), shade(WHITE, 0.9))]
    for y in np.arange(-w / 2, w / 2 - 0.03, 0.08):
        box = (-d / 2 + 0.02, float(y), 0.0, d / 2, min(float(y) + 0.06, w / 2), h)
        parts.append(Part(box, WHITE))
    parts.append(Part((-d / 2, w / 2 - 0.04, 0.0, d / 2, w / 2, 0.08), STEEL))
    return Model("radiator", OBJS, (d, w, h), tuple(parts))


def towel_radiator(towel: Colour) -> Model:
    """Return a model of a heated towel rail with a towel over it: 0.5 x 1.2 m."""
    d, w, h = 0.12, 0.52, 1.20
    parts = [
        Part((-d / 2, y, 0.0, -d / 2 + 0.04, y + 0.04, h), WHITE) for y in (-w / 2, w / 2 - 0.04)
    ]
    for z in np.arange(0.06, h - 0.04, 0.12):
        box = (-d / 2, -w / 2, round_to_step(float(z)), -d / 2 + 0.04, w / 2)
        parts.append(Part((*box, round_to_step(float(z)) + 0.04), WHITE))
    for x in (-d / 2 + 0.04, d / 2 - 0.04):
        parts.append(Part((x, -0.20, 0.46, x + 0.04, 0.18, 1.10), towel, "fabric"))
    return Model("towel_radiator", OBJS, (d, w, h), tuple(parts))


def wall_clock() -> Model:
    """Return a model of a round wall clock, 0.32 m across."""
    parts = (
        Part((-0.02, -0.16, 0.0, 0.0, 0.16, 0.32), DARK, form="drum", axis=0),
        Part((-0.02, -0.14, 0.02, 0.02, 0.14, 0.30), (246, 245, 240), form="drum", axis=0),
        Part((0.0, -0.01, 0.16, 0.02, 0.01, 0.27), DARK),
        Part((0.0, -0.01, 0.15, 0.02, 0.09, 0.17), DARK),
    )
    return make_model("clock", OBJS, parts)


def wall_shelf(width: float, wood: Colour, rng: np.random.Generator) -> Model:
    """Return a model of a board on a wall with books and a plant on it."""
    d, w = 0.24, round_to_step(width)
    parts = [Part((-d / 2, -w / 2, 0.0, d / 2, w / 2, 0.04), wood, "wood")]
    y = -w / 2 + 0.04
    for _ in range(int(rng.integers(4, 9))):
        thick, tall = float(rng.choice([0.02, 0.04])), 0.18 + 0.02 * int(rng.integers(4))
        box = (-d / 2, y, 0.04, 0.06, y + thick, 0.04 + tall)
        parts.append(Part(box, BOOKS[int(rng.integers(len(BOOKS)))]))
        y += thick
    pot = (-0.06, w / 2 - 0.22, 0.04, 0.08, w / 2 - 0.08, 0.16)
    parts.append(Part(pot, bright_colour(rng)))
    leaf = (-0.08, w / 2 - 0.24, 0.16, 0.10, w / 2 - 0.06, 0.32)
    parts.append(Part(leaf, (78, 138, 72), "fabric"))
    return Model("wall_shelf", FURN, (d, w, 0.32), tuple(parts))


def standing_mirror(wood: Colour) -> Model:
    """Return a model of a standing mirror in a wooden frame, 1.7 m high."""
    d, w, h = 0.40, 0.56, 1.70
    parts = (
        Part((-d / 2, -w / 2, 0.0, d / 2, -w / 2 + 0.06, 0.06), wood, "wood"),
        Part((-d / 2, w / 2 - 0.06, 0.0, d / 2, w / 2, 0.06), wood, "wood"),
        Part((-0.02, -w / 2, 0.06, 0.02, w / 2, h), wood, "wood"),
        Part((0.0, -w / 2 + 0.06, 0.14, 0.02, w / 2 - 0.06, h - 0.06), (198, 214, 220)),
    )
    return Model("mirror", OBJS, (d, w, h), parts)


def laundry_basket(rng: np.random.Generator, across: float = 0.48) -> Model:
    """Return a model of a wicker laundry basket with clothes in it, 0.6 m high."""
    r = across / 2
    parts = [
        Part((0.02 - r, 0.02 - r, 0.0, r - 0.02, r - 0.02, 0.50), WICKER, "fabric", form="drum"),
        Part((-r, -r, 0.46, r, r, 0.52), shade(WICKER, 0.8), form="drum"),
    ]
    for x, y in ((-0.3, -0.3), (0.25, 0.25), (-0.1, 0.3)):
        box = ((x - 0.4) * r, (y - 0.4) * r, 0.46, (x + 0.4) * r, (y + 0.4) * r, 0.60)
        parts.append(Part(box, bright_colour(rng), "fabric", form="ball"))
    return make_model("laundry_basket", OBJS, parts)


def dryer() -> Model:
    """Return a model of a clothes dryer: a machine with a large dark door."""
    base = washing_machine()
    d, w, h = base.size_m
    x = d / 2
    parts = (
        Part((-x, -w / 2, 0.0, x - 0.04, w / 2, h), (222, 224, 226)),
        Part((x - 0.04, -w / 2, 0.0, x - 0.02, w / 2, 0.72), (214, 216, 218)),
        Part((x - 0.04, -w / 2, 0.74, x - 0.02, w / 2, h), (66, 70, 76)),
        Part((x - 0.04, -0.24, 0.16, x, 0.24, 0.64), (52, 56, 62), form="drum", axis=0),
        Part((x - 0.02, -0.18, 0.22, x, 0.18, 0.58), (88, 96, 104), form="drum", axis=0),
    )
    return Model("dryer", FURN, (d, w, h), parts)


def drying_rack(rng: np.random.Generator) -> Model:
    """Return a model of an unfolded drying rack with laundry on it: 0.56 x 1.2 m, 0.9 m high."""
    w, h = 1.20, 0.90
    parts: list[Part | Bar] = []
    for y in (-w / 2 + 0.05, w / 2 - 0.05):
        for side in (-1, 1):
            start, end = (side * 0.26, y, 0.02), (-side * 0.26, y, h - 0.02)
            parts.append(Bar(start, end, 0.014, STEEL))
    xs = (-0.26, -0.16, -0.06, 0.04, 0.14, 0.24)
    parts += [Bar((x, -w / 2, h - 0.02), (x, w / 2, h - 0.02), 0.011, STEEL) for x in xs]
    for x in xs[::2]:
        y = -w / 2 + 0.06
        while y < w / 2 - 0.20:
            wide, long = float(rng.uniform(0.16, 0.34)), float(rng.uniform(0.24, 0.52))
            far = min(y + wide, w / 2 - 0.04)
            cloth = (x - 0.02, y, h - long, x + 0.02, far, h)
            parts.append(Part(cloth, bright_colour(rng), "fabric"))
            y += wide + 0.06
    return make_model("drying_rack", OBJS, parts)


def ironing_board(cloth: Colour) -> Model:
    """Return a model of an ironing board with an iron: 0.36 x 1.24 m, 0.88 m high."""
    w, h = 1.24, 0.88
    parts: list[Part | Bar] = [
        Part((-0.18, -w / 2 + 0.30, h - 0.06, 0.18, w / 2, h), cloth, "fabric"),
        Part((-0.18, -w / 2, h - 0.06, 0.18, -w / 2 + 0.60, h), cloth, "fabric", form="drum"),
        Bar((-0.12, -0.46, 0.02), (0.0, 0.42, h - 0.06), 0.016, STEEL),
        Bar((0.12, -0.46, 0.02), (0.0, 0.42, h - 0.06), 0.016, STEEL),
        Bar((-0.14, 0.46, 0.02), (0.0, -0.30, h - 0.06), 0.016, STEEL),
        Bar((0.14, 0.46, 0.02), (0.0, -0.30, h - 0.06), 0.016, STEEL),
        Part((-0.06, w / 2 - 0.34, h, 0.06, w / 2 - 0.08, h + 0.06), (66, 120, 168)),
        Part((-0.03, w / 2 - 0.28, h + 0.06, 0.03, w / 2 - 0.10, h + 0.12), DARK),
    ]
    return make_model("ironing_board", OBJS, parts)


def folded_ironing_board(cloth: Colour) -> Model:
    """Return a model of an ironing board that leans folded against a wall, 1.46 m high."""
    parts = (
        Part((0.0, -0.18, 0.16, 0.06, 0.18, 1.16), cloth, "fabric"),
        Part((0.0, -0.18, 0.86, 0.06, 0.18, 1.46), cloth, "fabric", form="drum", axis=0),
        Bar((-0.04, -0.12, 0.02), (-0.02, -0.10, 1.20), 0.02, STEEL),
        Bar((-0.04, 0.12, 0.02), (-0.02, 0.10, 1.20), 0.02, STEEL),
        Bar((-0.04, -0.20, 0.02), (-0.04, 0.20, 0.02), 0.02, STEEL),
    )
    return make_model("ironing_board", OBJS, parts)


def dishwasher(front: Colour, worktop: Colour) -> Model:
    """Return a model of a dishwasher with a steel door under a piece of worktop."""
    d, w, h = 0.64, 0.60, 0.90
    parts = (
        Part((-d / 2, -w / 2, 0, d / 2 - 0.10, w / 2, 0.10), DARK),
        Part((-d / 2, -w / 2, 0.10, d / 2 - 0.06, w / 2, 0.86), shade(front, 0.9)),
        Part((-d / 2, -w / 2, 0.86, d / 2, w / 2, h), worktop),
        Part((d / 2 - 0.06, -w / 2 + 0.02, 0.12, d / 2 - 0.04, w / 2 - 0.02, 0.72), STEEL),
        Part((d / 2 - 0.06, -w / 2 + 0.02, 0.74, d / 2 - 0.04, w / 2 - 0.02, 0.84), DARK),
        Part((d / 2 - 0.04, -0.22, 0.66, d / 2 - 0.02, 0.22, 0.68), shade(STEEL, 1.2)),
        Part((d / 2 - 0.06, 0.12, 0.78, d / 2 - 0.02, 0.18, 0.80), (96, 196, 120)),
    )
    return Model("dishwasher", FURN, (d, w, h), parts)


def blanket_chest(wood: Colour) -> Model:
    """Return a model of a chest with a lid and iron bands, 0.48 m high."""
    d, w, h = 0.46, 0.96, 0.48
    parts = [
        Part((0.02 - d / 2, 0.02 - w / 2, 0.0, d / 2 - 0.02, w / 2 - 0.02, 0.38), wood, "wood"),
        Part((-d / 2, -w / 2, 0.38, d / 2, w / 2, h), shade(wood, 1.1), "wood"),
    ]
    for y in (-w / 2 + 0.16, w / 2 - 0.20):
        parts.append(Part((d / 2 - 0.02, y, 0.0, d / 2, y + 0.04, h - 0.02), DARK))
    parts.append(Part((d / 2 - 0.02, -0.04, h - 0.16, d / 2, 0.04, h - 0.08), STEEL))
    return Model("blanket_chest", FURN, (d, w, h), tuple(parts))


def display_cabinet(wood: Colour, rng: np.random.Generator) -> Model:
    """Return a model of a glass cabinet with tableware on three boards, 1.86 m high."""
    d, w, h = 0.42, 0.92, 1.86
    parts = [
        Part((-d / 2, -w / 2, 0.0, d / 2, w / 2, 0.52), wood, "wood"),
        Part((-d / 2, -w / 2, 0.52, -d / 2 + 0.02, w / 2, h), shade(wood, 0.8), "wood"),
        Part((-d / 2, -w / 2, h - 0.06, d / 2, w / 2, h), wood, "wood"),
        Part((-d / 2, -w / 2, 0.52, d / 2, -w / 2 + 0.04, h), wood, "wood"),
        Part((-d / 2, w / 2 - 0.04, 0.52, d / 2, w / 2, h), wood, "wood"),
        Part((d / 2 - 0.02, -0.02, 0.52, d / 2, 0.02, h), wood, "wood"),
    ]
    for z in (0.52, 0.92, 1.34):
        parts.append(Part((-d / 2, -w / 2, z, d / 2 - 0.04, w / 2, z + 0.04), wood, "wood"))
        for y in (-0.34, -0.16, 0.08, 0.24):
            tall = 0.12 + 0.02 * int(rng.integers(6))
            tone = (240, 238, 230) if rng.random() < 0.6 else bright_colour(rng)
            parts.append(Part((-0.08, y, z + 0.04, 0.06, y + 0.12, z + 0.04 + tall), tone))
    for y in (-0.24, 0.16):
        parts.append(Part((d / 2 - 0.02, y, 0.40, d / 2, y + 0.08, 0.42), DARK))
    return Model("display_cabinet", FURN, (d, w, h), tuple(parts))


def piano(wood: Colour) -> Model:
    """Return a model of an upright piano with its keys: 0.6 x 1.46 m, 1.2 m high."""
    d, w, h = 0.60, 1.46, 1.20
    tone = shade(wood, 0.8)
    parts = [
        Part((-d / 2, -w / 2, 0.0, 0.0, w / 2, h - 0.04), tone, "wood"),
        Part((-d / 2, -w / 2, h - 0.04, 0.02, w / 2, h), shade(tone, 1.1), "wood"),
        Part((0.0, -w / 2, 0.60, d / 2, w / 2, 0.68), tone, "wood"),
        Part((0.02, -w / 2 + 0.06, 0.68, d / 2 - 0.06, w / 2 - 0.06, 0.72), (246, 244, 236)),
    ]
    for y in np.arange(-w / 2 + 0.10, w / 2 - 0.10, 0.06):
        key = (0.02, round_to_step(float(y)), 0.70, d / 2 - 0.14)
        parts.append(Part((*key, round_to_step(float(y)) + 0.02, 0.74), (28, 28, 30)))
    for y in (-w / 2, w / 2 - 0.06):
        parts.append(Part((0.0, y, 0.0, d / 2, y + 0.06, 0.60), tone, "wood"))
    parts.append(Part((0.0, -0.26, 0.82, 0.04, 0.26, 1.06), (244, 242, 234)))
    return Model("piano", FURN, (d, w, h), tuple(parts))


def piano_stool(cloth: Colour) -> Model:
    """Return a model of a padded stool, 0.46 m high."""
    d, h = 0.40, 0.46
    seat = Part((-d / 2, -d / 2, h - 0.10, d / 2, d / 2, h), cloth, "fabric")
    return Model("stool", CHAIR, (d, d, h), (*legs(d, d, h - 0.10, 0.04, DARK), seat))


def fireplace() -> Model:
    """Return a model of a fireplace with a mantel and burning logs: 1.3 x 1.16 m."""
    d, w, h = 0.42, 1.34, 1.16
    stone: Colour = (206, 200, 190)
    parts = (
        Part((-d / 2, -w / 2 + 0.06, 0.0, d / 2 - 0.06, -0.34, h - 0.08), stone),
        Part((-d / 2, 0.34, 0.0, d / 2 - 0.06, w / 2 - 0.06, h - 0.08), stone),
        Part((-d / 2, -0.34, 0.74, d / 2 - 0.06, 0.34, h - 0.08), stone),
        Part((-d / 2, -0.34, 0.0, -d / 2 + 0.04, 0.34, 0.74), (44, 40, 38)),
        Part((-d / 2, -w / 2, 0.0, d / 2, w / 2, 0.04), shade(stone, 0.8)),
        Part((-d / 2, -w / 2, h - 0.08, d / 2, w / 2, h), shade(stone, 1.1)),
        Part((-0.10, -0.24, 0.04, 0.0, 0.24, 0.14), (96, 66, 44), "wood"),
        Part((-0.06, -0.18, 0.14, 0.02, 0.16, 0.22), (112, 78, 50), "wood"),
        Part((-0.06, -0.14, 0.22, 0.02, 0.0, 0.46), (250, 150, 40), "glow"),
        Part((-0.08, 0.0, 0.22, 0.02, 0.12, 0.38), (252, 190, 70), "glow"),
    )
    return Model("fireplace", FURN, (d, w, h), parts)


def side_table(wood: Colour) -> Model:
    """Return a model of a small round table on one leg, 0.54 m high."""
    parts = (
        Part((-0.22, -0.22, 0.50, 0.22, 0.22, 0.54), wood, "wood", form="drum"),
        Part((-0.04, -0.04, 0.04, 0.04, 0.04, 0.50), shade(wood, 0.8), form="drum"),
        Part((-0.16, -0.16, 0.0, 0.16, 0.16, 0.04), shade(wood, 0.8), form="drum"),
    )
    return make_model("side_table", TABLE, parts)


def ottoman(cloth: Colour) -> Model:
    """Return a model of an upholstered ottoman, 0.42 m high."""
    d, w, h = 0.52, 0.62, 0.42
    parts = (
        *legs(d - 0.04, w - 0.04, 0.10, 0.06, DARK),
        Part((-d / 2, -w / 2, 0.10, d / 2, w / 2, 0.32), shade(cloth, 0.9), "fabric"),
        Part((-d / 2, -w / 2, 0.32, d / 2, w / 2, h), cloth, "fabric"),
    )
    return Model("ottoman", CHAIR, (d, w, h), parts)


def coat_stand(rng: np.random.Generator) -> Model:
    """Return a model of a coat stand with two coats and a hat, 1.8 m high."""
    wood: Colour = (108, 74, 50)
    parts: list[Part | Bar] = [
        Bar((0.0, 0.0, 0.04), (0.0, 0.0, 1.76), 0.025, wood, "wood"),
        Part((-0.20, -0.20, 0.0, 0.20, 0.20, 0.04), wood, form="drum"),
    ]
    for turn in range(4):
        c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[turn]
        parts.append(Bar((0, 0, 1.60), (0.20 * c, 0.20 * s, 1.74), 0.016, wood))
    for c, low in ((1, 0.72), (-1, 0.86)):
        box = (min(0.04 * c, 0.18 * c), -0.18, low, max(0.04 * c, 0.18 * c), 0.18, 1.62)
        tone = ((58, 66, 88), (120, 74, 60), (88, 104, 82))[int(rng.integers(3))]
        parts.append(Part(box, tone, "fabric"))
    parts.append(Part((-0.10, 0.10, 1.68, 0.10, 0.28, 1.80), (70, 60, 52), "fabric", form="ball"))
    return make_model("coat_stand", OBJS, parts)


def umbrella_stand(rng: np.random.Generator) -> Model:
    """Return a model of a round stand with two umbrellas, 0.9 m high."""
    parts: list[Part | Bar] = [Part((-0.12, -0.12, 0, 0.12, 0.12, 0.50), DARK, form="drum")]
    for start, end in (((-0.04, -0.02), (-0.08, -0.06)), ((0.04, 0.04), (0.06, 0.08))):
        tone = BRIGHT_COLOURS[int(rng.integers(len(BRIGHT_COLOURS)))]
        parts.append(Bar((*start, 0.10), (*end, 0.78), 0.034, tone, "fabric"))
        parts.append(Bar((*end, 0.78), (*end, 0.90), 0.014, (108, 74, 50)))
    return make_model("umbrella_stand", OBJS, parts)


def shoe_rack(wood: Colour, rng: np.random.Generator) -> Model:
    """Return a model of an open shoe rack with shoes on two boards, 0.48 m high."""
    d, w, h = 0.30, 0.80, 0.48
    parts = [Part((-d / 2, y, 0.0, d / 2, y + 0.04, h), wood, "wood") for y in (-0.40, 0.36)]
    for z in (0.06, 0.26, h - 0.04):
        parts.append(Part((-d / 2, -w / 2, z, d / 2, w / 2, z + 0.04), wood, "wood"))
    for z in (0.10, 0.30):
        for y in (-0.32, -0.18, 0.00, 0.14):
            tone = ((70, 58, 50), (40, 44, 56), (170, 60, 54), (222, 220, 214))
            box = (-0.12, y, z, 0.12, y + 0.10, z + 0.10)
            parts.append(Part(box, tone[int(rng.integers(4))]))
    return Model("shoe_rack", FURN, (d, w, h), tuple(parts))


def utility_shelf(rng: np.random.Generator) -> Model:
    """Return a model of a steel shelf with detergents, baskets and boxes, 1.8 m high."""
    d, w, h = 0.40, 0.92, 1.80
    parts = []
    for x in (-d / 2, d / 2 - 0.04):
        for y in (-w / 2, w / 2 - 0.04):
            parts.append(Part((x, y, 0.0, x + 0.04, y + 0.04, h), STEEL))
    for z in (0.10, 0.54, 0.98, 1.42):
        parts.append(Part((-d / 2, -w / 2, z, d / 2, w / 2, z + 0.04), STEEL))
        y = -w / 2 + 0.06
        while y < w / 2 - 0.22:
            wide = round_to_step(float(rng.uniform(0.12, 0.32)))
            tall = round_to_step(float(rng.uniform(0.14, 0.32)))
            tone = WICKER if wide > 0.24 else bright_colour(rng)
            far = min(y + wide, w / 2 - 0.06)
            parts.append(Part((-0.14, y, z + 0.04, 0.14, far, z + 0.04 + tall), tone))
            y += wide + 0.04
    return Model("shelf", FURN, (d, w, h), tuple(parts))


def single_bed(wood: Colour, blanket: Colour) -> Model:
    """Return a model of a single bed, 0.9 x 2.1 m, with a head and a foot board."""
    return Model("single_bed", BED, (2.10, 0.90, 0.96), tuple(_bunk(0.0, wood, blanket, 0.96)))


def bunk_bed(wood: Colour, blanket: Colour, second: Colour) -> Model:
    """Return a model of a bunk bed with a ladder: 0.9 x 2.1 m, 1.66 m high."""
    d, w, h = 2.10, 0.90, 1.66
    parts = _bunk(0.0, wood, blanket, 0.80) + _bunk(0.90, wood, second, 0.74)
    for x in (-d / 2, d / 2 - 0.08):
        for y in (-w / 2, w / 2 - 0.08):
            parts.append(Part((x, y, 0.0, x + 0.08, y + 0.08, h), wood, "wood"))
    for y in (-w / 2, w / 2 - 0.04):  # Rails of the upper bed, and the ladder in front.
        parts.append(Part((-d / 2, y, 1.48, d / 2 - 0.52, y + 0.04, 1.54), wood, "wood"))
        for z in (0.28, 0.56, 0.84):
            parts.append(Part((d / 2 - 0.52, y, z, d / 2, y + 0.04, z + 0.06), wood, "wood"))
        parts.append(Part((d / 2 - 0.54, y, 0.0, d / 2 - 0.48, y + 0.04, h), wood, "wood"))
    return Model("bunk_bed", BED, (d, w, h), tuple(parts))


def _bunk(z: float, wood: Colour, blanket: Colour, high: float) -> list[Part]:
    """Return a bed frame with a mattress, a pillow and a blanket, from ``z`` up."""
    d, w = 2.10, 0.90
    head, foot, side = -d / 2 + 0.06, d / 2 - 0.06, w / 2 - 0.02
    low = z + (0.0 if z == 0 else 0.18)
    return [
        Part((-d / 2, -w / 2, low, head, w / 2, z + high), wood, "wood"),
        Part((foot, -w / 2, low, d / 2, w / 2, z + 0.62), wood, "wood"),
        Part((-d / 2, -w / 2, z + 0.20, d / 2, w / 2, z + 0.32), wood, "wood"),
        Part((head, -side, z + 0.32, foot, side, z + 0.48), WHITE, "fabric"),
        Part((head + 0.56, -side, z + 0.32, foot, side, z + 0.52), blanket, "fabric"),
        Part(
            (head + 0.04, -0.32, z + 0.48, head + 0.42, 0.32, z + 0.58), (248, 247, 243), "fabric"
        ),
    ]


def shower_curtain(length: float, cloth: Colour) -> Model:
    """Return a model of a shower curtain on a rail, drawn to one side, 1.2 m high."""
    d, w, h = 0.08, round_to_step(length), 1.20
    parts = [Part((-0.02, -w / 2, h - 0.04, 0.02, w / 2, h), STEEL)]
    for n, y in enumerate(np.arange(-w / 2, -0.02, 0.06)):
        x = -d / 2 if n % 2 else 0.0
        box = (x, round_to_step(float(y)), 0.0, x + 0.04, round_to_step(float(y)) + 0.06, h - 0.04)
        parts.append(Part(box, shade(cloth, 1.25 if n % 2 else 1.15), "fabric"))
    return Model("shower_curtain", OBJS, (d, w, h), tuple(parts))


def candles() -> Model:
    """Return a model of three candles of different heights."""
    parts = [
        Part((-0.02, y, 0.0, 0.02, y + 0.04, tall), (244, 236, 214))
        for y, tall in ((-0.10, 0.14), (-0.02, 0.22), (0.06, 0.18))
    ]
    parts += [
        Part((-0.02, y, tall, 0.02, y + 0.04, tall + 0.02), (252, 190, 70), "glow")
        for y, tall in ((-0.10, 0.14), (-0.02, 0.22), (0.06, 0.18))
    ]
    return Model("candle", OBJS, (0.04, 0.20, 0.24), tuple(parts))

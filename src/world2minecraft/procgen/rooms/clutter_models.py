"""Models of clutter: small loose objects, and large objects with irregular shapes.

Objects have realistic sizes: a mug is 9 cm, a wine bottle 7 x 30 cm, a shoe 10 x 28 cm.
"""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.rooms import decor
from world2minecraft.procgen.rooms.children_and_hall_furniture import BRIGHT_COLOURS, bright_colour
from world2minecraft.procgen.rooms.furniture_model import (
    Bar,
    Colour,
    Model,
    Part,
    round_to_step,
    shade,
)
from world2minecraft.procgen.rooms.supersampled_voxelization import make_model

CHAIR, FURN, OBJS = (int(c) for c in (SemanticClass.CHAIR, SemanticClass.FURN, SemanticClass.OBJS))
CLOTHES: tuple[Colour, ...] = (
    (62, 76, 108), (188, 180, 168), (150, 70, 66), (84, 110, 92), (206, 160, 92), (70, 70, 76),
)  # fmt: skip
ModelFactory = Callable[[np.random.Generator], Model]
WOOD: Colour = (176, 128, 82)
METAL: Colour = (92, 96, 102)


def _pick_colour(rng: np.random.Generator, colours: tuple[Colour, ...]) -> Colour:
    return colours[int(rng.integers(len(colours)))]


def cup(rng: np.random.Generator) -> Model:
    """Return a model of a mug with a handle."""
    colour = _pick_colour(rng, BRIGHT_COLOURS)
    body = Part((-0.04, -0.04, 0, 0.04, 0.04, 0.10), colour, form="drum")
    return make_model("cup", OBJS, (body, Bar((0, 0.05, 0.03), (0, 0.05, 0.07), 0.012, colour)))


def bottle(rng: np.random.Generator) -> Model:
    """Return a model of a glass or plastic bottle."""
    colour = _pick_colour(rng, ((52, 96, 62), (96, 60, 40), (120, 170, 200), (200, 70, 60)))
    high = round_to_step(rng.uniform(0.24, 0.32))
    body = Part((-0.04, -0.04, 0, 0.04, 0.04, high - 0.1), colour, form="drum")
    neck = Part((-0.02, -0.02, high - 0.1, 0.02, 0.02, high), shade(colour, 1.1), form="drum")
    return make_model("bottle", OBJS, (body, neck))


def plate(rng: np.random.Generator) -> Model:
    """Return a model of a plate with food."""
    food = _pick_colour(rng, ((206, 120, 60), (120, 150, 70), (180, 60, 50)))
    rim = Part((-0.12, -0.12, 0, 0.12, 0.12, 0.02), (240, 240, 236), form="drum")
    return make_model(
        "plate", OBJS, (rim, Part((-0.06, -0.05, 0.0, 0.05, 0.06, 0.06), food, form="ball"))
    )


def laptop(rng: np.random.Generator) -> Model:
    """Return a model of an open laptop, 24 x 34 cm, whose front is the keyboard side."""
    grey = (168, 172, 178)
    screen = Part((-0.14, -0.17, 0.02, -0.12, 0.17, 0.24), (40, 44, 52))
    shown = Part((-0.12, -0.15, 0.04, -0.115, 0.15, 0.22), (96, 140, 190))
    return make_model(
        "laptop", OBJS, (Part((-0.12, -0.17, 0, 0.12, 0.17, 0.02), grey), screen, shown)
    )


def shoes(rng: np.random.Generator) -> Model:
    """Return a model of a pair of shoes, one slightly ahead of the other."""
    colour, parts = _pick_colour(rng, CLOTHES), []
    for y, x in ((-0.08, 0.0), (0.06, float(rng.uniform(-0.06, 0.06)))):
        parts.append(Part((x - 0.14, y - 0.05, 0, x + 0.14, y + 0.05, 0.03), shade(colour, 0.6)))
        parts.append(Part((x - 0.14, y - 0.05, 0, x + 0.0, y + 0.05, 0.11), colour, form="ball"))
        parts.append(Part((x - 0.08, y - 0.05, 0, x + 0.14, y + 0.05, 0.08), colour, form="ball"))
    return make_model("shoes", OBJS, parts)


def bag(rng: np.random.Generator) -> Model:
    """Return a model of a school bag or rucksack that stands on the floor."""
    colour = _pick_colour(rng, BRIGHT_COLOURS + CLOTHES)
    parts = (
        Part((-0.12, -0.17, 0, 0.10, 0.17, 0.44), colour, "fabric", form="ball"),
        Part((-0.10, -0.15, 0, 0.08, 0.15, 0.24), colour, "fabric"),
        Part((0.06, -0.11, 0.04, 0.14, 0.11, 0.20), shade(colour, 0.8), "fabric"),
        Bar((-0.02, -0.06, 0.42), (-0.02, 0.06, 0.46), 0.015, shade(colour, 0.6)),
    )
    return make_model("bag", OBJS, parts)


def carton(rng: np.random.Generator) -> Model:
    """Return a model of a cardboard box of a random common size."""
    sides = [
        round_to_step(rng.uniform(low, high))
        for low, high in ((0.24, 0.4), (0.28, 0.6), (0.2, 0.4))
    ]
    return decor.crate((sides[0], sides[1], sides[2]), (190, 152, 106))


def laundry(rng: np.random.Generator) -> Model:
    """Return a model of a heap of clothes."""
    parts = []
    for _ in range(5):
        x, y = rng.uniform(-0.14, 0.14, 2)
        a, b, h = rng.uniform(0.12, 0.2), rng.uniform(0.12, 0.22), rng.uniform(0.10, 0.22)
        box = (x - a, y - b, -0.3 * h, x + a, y + b, h)
        parts.append(Part(box, _pick_colour(rng, CLOTHES), "fabric", form="ball"))
    return _clip_at_floor("laundry", parts)


def ball(rng: np.random.Generator) -> Model:
    """Return a model of a toy ball."""
    r = float(rng.uniform(0.08, 0.12))
    part = Part((-r, -r, 0, r, r, 2 * r), _pick_colour(rng, BRIGHT_COLOURS), form="ball")
    return make_model("ball", OBJS, (part,))


def bricks(rng: np.random.Generator) -> Model:
    """Return a model of toy bricks: a small tower and two bricks beside it."""
    parts = [
        Part((-0.05, -0.05, 0.08 * n, 0.05, 0.05, 0.08 * (n + 1)), bright_colour(rng))
        for n in range(int(rng.integers(2, 5)))
    ]
    for x, y in ((0.12, 0.06), (-0.06, 0.14)):
        parts.append(Part((x, y, 0, x + 0.1, y + 0.06, 0.06), _pick_colour(rng, BRIGHT_COLOURS)))
    return make_model("bricks", OBJS, parts)


def teddy(rng: np.random.Generator) -> Model:
    """Return a model of a sitting teddy bear that faces the front."""
    fur: Colour = _pick_colour(rng, ((156, 106, 64), (196, 160, 116), (120, 92, 72)))
    balls = (
        (0.0, 0.0, 0.10, 0.10), (0.02, 0.0, 0.27, 0.09), (0.0, -0.07, 0.35, 0.04),
        (0.0, 0.07, 0.35, 0.04), (0.14, -0.08, 0.05, 0.05), (0.14, 0.08, 0.05, 0.05),
    )  # fmt: skip
    parts = [
        Part((x - r, y - r, z - r, x + r, y + r, z + r), fur, "fabric", form="ball")
        for x, y, z, r in balls
    ]
    return make_model("teddy", OBJS, parts)


def potted_plant(rng: np.random.Generator) -> Model:
    """Return a model of a small potted plant for a table."""
    green: Colour = (60 + int(rng.integers(40)), 130, 62)
    high = float(rng.uniform(0.24, 0.36))
    parts = (
        Part((-0.07, -0.07, 0, 0.07, 0.07, 0.12), (190, 112, 80), form="drum"),
        Part((-0.11, -0.11, 0.10, 0.11, 0.11, high), green, "fabric", form="ball"),
    )
    return make_model("potted_plant", OBJS, parts)


def _clip_at_floor(name: str, parts: list[Part]) -> Model:
    """Return a model whose parts are clipped at the floor."""
    clipped = []
    for part in parts:
        x0, y0, z0, x1, y1, z1 = part.box_m
        # The upper half of a low, wide ball: as if it had sunk into the floor.
        clipped.append(Part((x0, y0, max(z0, 0.0), x1, y1, z1), part.colour, part.grain, part.form))
    return make_model(name, OBJS, clipped)


ON_TABLES: tuple[ModelFactory, ...] = (
    cup,
    bottle,
    plate,
    laptop,
    decor.book_pile,
    potted_plant,
    cup,
    carton,
)
ON_BEDS: tuple[ModelFactory, ...] = (teddy, laundry, decor.book_pile, bag)
ON_FLOORS: tuple[ModelFactory, ...] = (
    shoes, bag, carton, laundry, ball, bricks, teddy, decor.book_pile, shoes, bottle,
)  # fmt: skip


def beanbag(rng: np.random.Generator) -> Model:
    """Return a model of a beanbag chair, 0.9 m across and higher at the back."""
    cloth = bright_colour(rng)
    parts = (
        Part((-0.45, -0.44, 0.0, 0.43, 0.44, 0.5), cloth, "fabric", form="ball"),
        Part((-0.40, -0.34, 0.0, 0.36, 0.34, 0.2), cloth, "fabric", form="drum"),
        Part((-0.46, -0.34, 0.2, 0.0, 0.34, 0.82), shade(cloth, 1.06), "fabric", form="ball"),
    )
    return make_model("beanbag", CHAIR, parts)


def rocking_horse(rng: np.random.Generator) -> Model:
    """Return a model of a rocking horse, 0.9 m long, on two curved runners."""
    coat, mane = (214, 186, 142), bright_colour(rng)
    parts: list[Part | Bar] = []
    for y in (-0.13, 0.13):
        for a, b in ((-0.45, -0.15), (-0.15, 0.15), (0.15, 0.45)):
            start = (a, y, 0.02 + 0.5 * a * a)
            parts.append(Bar(start, (b, y, 0.02 + 0.5 * b * b), 0.025, WOOD, "wood"))
        for x in (-0.22, 0.22):
            parts.append(Bar((1.3 * x, y, 0.06), (x, 0.6 * y, 0.42), 0.03, coat))
    parts += [
        Part((-0.32, -0.13, 0.38, 0.30, 0.13, 0.64), coat, form="ball"),
        Bar((0.22, 0.0, 0.54), (0.36, 0.0, 0.82), 0.07, coat),
        Part((0.28, -0.07, 0.74, 0.58, 0.07, 0.90), coat, form="ball"),
        Bar((0.16, 0.0, 0.64), (0.30, 0.0, 0.92), 0.03, mane),
        Bar((-0.32, 0.0, 0.54), (-0.46, 0.0, 0.30), 0.03, mane),
        Part((-0.14, -0.14, 0.58, 0.14, 0.14, 0.67), mane, form="ball"),
    ]
    return make_model("rocking_horse", OBJS, parts)


def easel(rng: np.random.Generator) -> Model:
    """Return a model of a painter's easel with a canvas, 1.6 m high."""
    parts: list[Part | Bar] = [
        Bar((0.24, -0.34, 0.0), (0.0, -0.04, 1.6), 0.02, WOOD, "wood"),
        Bar((0.24, 0.34, 0.0), (0.0, 0.04, 1.6), 0.02, WOOD, "wood"),
        Bar((-0.42, 0.0, 0.0), (0.0, 0.0, 1.5), 0.02, WOOD, "wood"),
        Bar((0.16, -0.36, 0.66), (0.16, 0.36, 0.66), 0.025, WOOD, "wood"),
        Part((0.12, -0.30, 0.68, 0.15, 0.30, 1.28), (240, 238, 230)),
        Part((0.15, -0.2, 0.8, 0.17, 0.02, 1.04), bright_colour(rng), form="ball"),
        Part((0.15, -0.02, 0.9, 0.17, 0.22, 1.16), bright_colour(rng), form="ball"),
    ]
    return make_model("easel", OBJS, parts)


def guitar(rng: np.random.Generator) -> Model:
    """Return a model of a guitar on a stand."""
    body: Colour = (186, 116, 58) if rng.random() < 0.6 else (60, 34, 26)
    parts: list[Part | Bar] = [
        Part((-0.06, -0.19, 0.12, 0.04, 0.19, 0.44), body, form="drum", axis=0),
        Part((-0.06, -0.14, 0.36, 0.04, 0.14, 0.62), body, form="drum", axis=0),
        Part((0.02, -0.06, 0.36, 0.045, 0.06, 0.48), (40, 30, 26), form="drum", axis=0),
        Bar((0.02, 0.0, 0.56), (-0.06, 0.0, 1.0), 0.025, (70, 48, 36)),
        Part((-0.10, -0.04, 0.98, -0.06, 0.04, 1.12), (70, 48, 36)),
        Bar((-0.06, 0.0, 0.5), (-0.22, 0.0, 0.02), 0.014, METAL),
        Bar((0.0, -0.05, 0.1), (0.12, -0.16, 0.02), 0.014, METAL),
        Bar((0.0, 0.05, 0.1), (0.12, 0.16, 0.02), 0.014, METAL),
    ]
    return make_model("guitar", OBJS, parts)


def bicycle(rng: np.random.Generator) -> Model:
    """Return a model of a bicycle on its stand, 1.7 m long with wheels of 0.66 m."""
    paint, parts = bright_colour(rng), []
    for middle in (-0.5, 0.5):
        corners = np.linspace(0, 2 * np.pi, 17)
        rim = [(middle + 0.31 * np.cos(a), 0.0, 0.335 + 0.31 * np.sin(a)) for a in corners]
        for a, b in pairwise(rim):
            parts.append(Bar(_as_point(a), _as_point(b), 0.022, (44, 44, 48)))
        for a in corners[:8:2]:
            off = (0.3 * np.cos(a), 0.0, 0.3 * np.sin(a))
            ends = [(middle + s * off[0], 0.0, 0.335 + s * off[2]) for s in (-1, 1)]
            parts.append(Bar(_as_point(ends[0]), _as_point(ends[1]), 0.008, (170, 172, 176)))
    tubes = (
        ((-0.5, 0.335), (-0.06, 0.30)), ((-0.06, 0.30), (-0.18, 0.82)),
        ((-0.5, 0.335), (-0.16, 0.74)),
        ((-0.06, 0.30), (0.36, 0.72)), ((-0.16, 0.74), (0.34, 0.80)), ((0.5, 0.335), (0.32, 0.94)),
    )  # fmt: skip
    for (x, z), (u, w) in tubes:
        parts.append(Bar((x, 0.0, z), (u, 0.0, w), 0.022, paint))
    parts += [
        Part((-0.32, -0.08, 0.80, -0.06, 0.08, 0.88), (40, 40, 44), form="ball"),
        Bar((0.30, -0.28, 0.98), (0.30, 0.28, 0.98), 0.018, METAL),
        Bar((-0.06, -0.12, 0.22), (-0.06, 0.12, 0.38), 0.018, METAL),
        Bar((-0.16, 0.0, 0.30), (-0.22, 0.18, 0.012), 0.012, METAL),
    ]
    return make_model("bicycle", OBJS, parts)


def _as_point(point: tuple[float, ...]) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in point)
    return x, y, z


def spiral_shelf(rng: np.random.Generator) -> Model:
    """Return a model of a spiral shelf with boards around a pole, 1.7 m high."""
    parts: list[Part | Bar] = [Bar((0, 0, 0.03), (0, 0, 1.66), 0.03, METAL)]
    parts.append(Part((-0.2, -0.2, 0, 0.2, 0.2, 0.04), METAL, form="drum"))
    for n in range(8):
        a = 0.85 * n
        z = 0.2 + 0.2 * n
        end = (0.28 * float(np.cos(a)), 0.28 * float(np.sin(a)), z)
        for across in (-0.05, 0.0, 0.05):
            off = (-across * float(np.sin(a)), across * float(np.cos(a)))
            tip = (end[0] + off[0], end[1] + off[1], z)
            parts.append(Bar((off[0], off[1], z), tip, 0.028, WOOD, "wood"))
        if rng.random() < 0.6:
            x, y = 0.22 * float(np.cos(a)), 0.22 * float(np.sin(a))
            box = (x - 0.05, y - 0.05, z + 0.02, x + 0.05, y + 0.05, z + 0.13)
            parts.append(Part(box, bright_colour(rng), form="ball"))
    return make_model("spiral_shelf", FURN, parts)


def sculpture(rng: np.random.Generator) -> Model:
    """Return a model of a random sculpture of overlapping balls."""
    tone: Colour = (200, 196, 188) if rng.random() < 0.5 else bright_colour(rng)
    parts, place = [], np.array([0.0, 0.0, 0.22])
    for _ in range(6):
        r = float(rng.uniform(0.12, 0.24))
        x, y, z = (float(value) for value in place)
        box = (x - r, y - r, max(0.0, z - r), x + r, y + r, z + r)
        parts.append(Part(box, tone, form="ball"))
        place = place + rng.uniform((-0.16, -0.16, 0.0), (0.16, 0.16, 0.2))
    return make_model("sculpture", OBJS, parts)


def cat_tree(rng: np.random.Generator) -> Model:
    """Return a model of a cat tree with posts, platforms at three heights and a cave."""
    cloth: Colour = (186, 172, 150)
    rope: Colour = (206, 180, 130)
    parts: list[Part | Bar] = [
        Part((-0.28, -0.28, 0.0, 0.28, 0.28, 0.06), cloth, "fabric"),
        Bar((-0.12, -0.12, 0.06), (-0.12, -0.12, 1.3), 0.05, rope, "fabric"),
        Bar((0.14, 0.12, 0.06), (0.14, 0.12, 0.8), 0.05, rope, "fabric"),
        Part((-0.04, -0.08, 0.76, 0.34, 0.32, 0.82), cloth, "fabric", form="drum"),
        Part((-0.30, -0.30, 1.26, 0.06, 0.06, 1.34), cloth, "fabric", form="drum"),
        Part((-0.28, -0.02, 0.06, 0.02, 0.28, 0.36), shade(cloth, 0.85), "fabric", form="drum"),
    ]
    return make_model("cat_tree", FURN, parts)


def gym_ball(rng: np.random.Generator) -> Model:
    """Return a model of a gym ball, 0.65 m across."""
    return make_model(
        "gym_ball",
        OBJS,
        (Part((-0.32, -0.32, 0, 0.32, 0.32, 0.65), bright_colour(rng), form="ball"),),
    )


def floor_vase(rng: np.random.Generator) -> Model:
    """Return a model of a large floor vase with dry twigs."""
    clay = bright_colour(rng)
    parts: list[Part | Bar] = [
        Part((-0.16, -0.16, 0.0, 0.16, 0.16, 0.5), clay, form="ball"),
        Part((-0.07, -0.07, 0.4, 0.07, 0.07, 0.6), clay, form="drum"),
        Part((-0.10, -0.10, 0.0, 0.10, 0.10, 0.08), clay, form="drum"),
    ]
    for _ in range(6):
        x, y = (float(value) for value in rng.uniform(-0.24, 0.24, 2))
        parts.append(Bar((0, 0, 0.56), (x, y, float(rng.uniform(0.9, 1.3))), 0.011, (150, 120, 84)))
    return make_model("floor_vase", OBJS, parts)


IRREGULAR: tuple[ModelFactory, ...] = (
    beanbag, rocking_horse, easel, guitar, bicycle, spiral_shelf, sculpture, cat_tree, gym_ball,
    floor_vase,
)  # fmt: skip

"""Small things that lie about: cups, bottles, shoes, bags, boxes, laundry, toys, pots with plants.

Sizes are those of the things themselves: a mug 9 cm, a wine bottle 7 x 30 cm, a shoe 10 x 28 cm.
"""

from collections.abc import Callable

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.rooms import decor
from world2minecraft.procgen.rooms.furniture_model import Bar, Colour, Model, Part, shade, whole
from world2minecraft.procgen.rooms.play_and_hall import BRIGHT
from world2minecraft.procgen.rooms.solid_voxels import modelled

OBJS = int(SemanticClass.OBJS)
CLOTHES: tuple[Colour, ...] = (
    (62, 76, 108), (188, 180, 168), (150, 70, 66), (84, 110, 92), (206, 160, 92), (70, 70, 76),
)  # fmt: skip
Maker = Callable[[np.random.Generator], Model]


def _pick(rng: np.random.Generator, colours: tuple[Colour, ...]) -> Colour:
    return colours[int(rng.integers(len(colours)))]


def cup(rng: np.random.Generator) -> Model:
    """A mug with its handle."""
    colour = _pick(rng, BRIGHT)
    body = Part((-0.04, -0.04, 0, 0.04, 0.04, 0.10), colour, form="drum")
    return modelled("cup", OBJS, (body, Bar((0, 0.05, 0.03), (0, 0.05, 0.07), 0.012, colour)))


def bottle(rng: np.random.Generator) -> Model:
    """A bottle of glass or plastic."""
    colour = _pick(rng, ((52, 96, 62), (96, 60, 40), (120, 170, 200), (200, 70, 60)))
    high = whole(rng.uniform(0.24, 0.32))
    body = Part((-0.04, -0.04, 0, 0.04, 0.04, high - 0.1), colour, form="drum")
    neck = Part((-0.02, -0.02, high - 0.1, 0.02, 0.02, high), shade(colour, 1.1), form="drum")
    return modelled("bottle", OBJS, (body, neck))


def plate(rng: np.random.Generator) -> Model:
    """A plate with something on it."""
    food = _pick(rng, ((206, 120, 60), (120, 150, 70), (180, 60, 50)))
    rim = Part((-0.12, -0.12, 0, 0.12, 0.12, 0.02), (240, 240, 236), form="drum")
    return modelled(
        "plate", OBJS, (rim, Part((-0.06, -0.05, 0.0, 0.05, 0.06, 0.06), food, form="ball"))
    )


def laptop(rng: np.random.Generator) -> Model:
    """An open laptop: 24 by 34 cm; its front is where one types."""
    grey = (168, 172, 178)
    screen = Part((-0.14, -0.17, 0.02, -0.12, 0.17, 0.24), (40, 44, 52))
    shown = Part((-0.12, -0.15, 0.04, -0.115, 0.15, 0.22), (96, 140, 190))
    return modelled(
        "laptop", OBJS, (Part((-0.12, -0.17, 0, 0.12, 0.17, 0.02), grey), screen, shown)
    )


def shoes(rng: np.random.Generator) -> Model:
    """A pair of shoes, one a little ahead."""
    colour, parts = _pick(rng, CLOTHES), []
    for y, x in ((-0.08, 0.0), (0.06, float(rng.uniform(-0.06, 0.06)))):
        parts.append(Part((x - 0.14, y - 0.05, 0, x + 0.14, y + 0.05, 0.03), shade(colour, 0.6)))
        parts.append(Part((x - 0.14, y - 0.05, 0, x + 0.0, y + 0.05, 0.11), colour, form="ball"))
        parts.append(Part((x - 0.08, y - 0.05, 0, x + 0.14, y + 0.05, 0.08), colour, form="ball"))
    return modelled("shoes", OBJS, parts)


def bag(rng: np.random.Generator) -> Model:
    """A school bag or a rucksack that stands on the floor."""
    colour = _pick(rng, BRIGHT + CLOTHES)
    parts = (
        Part((-0.12, -0.17, 0, 0.10, 0.17, 0.44), colour, "fabric", form="ball"),
        Part((-0.10, -0.15, 0, 0.08, 0.15, 0.24), colour, "fabric"),
        Part((0.06, -0.11, 0.04, 0.14, 0.11, 0.20), shade(colour, 0.8), "fabric"),
        Bar((-0.02, -0.06, 0.42), (-0.02, 0.06, 0.46), 0.015, shade(colour, 0.6)),
    )
    return modelled("bag", OBJS, parts)


def carton(rng: np.random.Generator) -> Model:
    """A cardboard box of any common size."""
    sides = [whole(rng.uniform(low, high)) for low, high in ((0.24, 0.4), (0.28, 0.6), (0.2, 0.4))]
    return decor.crate((sides[0], sides[1], sides[2]), (190, 152, 106))


def laundry(rng: np.random.Generator) -> Model:
    """A heap of clothes."""
    parts = []
    for _ in range(5):
        x, y = rng.uniform(-0.14, 0.14, 2)
        a, b, h = rng.uniform(0.12, 0.2), rng.uniform(0.12, 0.22), rng.uniform(0.10, 0.22)
        box = (x - a, y - b, -0.3 * h, x + a, y + b, h)
        parts.append(Part(box, _pick(rng, CLOTHES), "fabric", form="ball"))
    return _grounded("laundry", parts)


def ball(rng: np.random.Generator) -> Model:
    """A ball to play with."""
    r = float(rng.uniform(0.08, 0.12))
    part = Part((-r, -r, 0, r, r, 2 * r), _pick(rng, BRIGHT), form="ball")
    return modelled("ball", OBJS, (part,))


def bricks(rng: np.random.Generator) -> Model:
    """Building bricks: a small tower and two that fell."""
    parts = [
        Part((-0.05, -0.05, 0.08 * n, 0.05, 0.05, 0.08 * (n + 1)), _pick(rng, BRIGHT))
        for n in range(int(rng.integers(2, 5)))
    ]
    for x, y in ((0.12, 0.06), (-0.06, 0.14)):
        parts.append(Part((x, y, 0, x + 0.1, y + 0.06, 0.06), _pick(rng, BRIGHT)))
    return modelled("bricks", OBJS, parts)


def teddy(rng: np.random.Generator) -> Model:
    """A teddy bear that sits and looks along its front."""
    fur: Colour = _pick(rng, ((156, 106, 64), (196, 160, 116), (120, 92, 72)))
    balls = (
        (0.0, 0.0, 0.10, 0.10), (0.02, 0.0, 0.27, 0.09), (0.0, -0.07, 0.35, 0.04),
        (0.0, 0.07, 0.35, 0.04), (0.14, -0.08, 0.05, 0.05), (0.14, 0.08, 0.05, 0.05),
    )  # fmt: skip
    parts = [
        Part((x - r, y - r, z - r, x + r, y + r, z + r), fur, "fabric", form="ball")
        for x, y, z, r in balls
    ]
    return modelled("teddy", OBJS, parts)


def potted(rng: np.random.Generator) -> Model:
    """A small plant in its pot for a table or a sill."""
    green: Colour = (60 + int(rng.integers(40)), 130, 62)
    high = float(rng.uniform(0.24, 0.36))
    parts = (
        Part((-0.07, -0.07, 0, 0.07, 0.07, 0.12), (190, 112, 80), form="drum"),
        Part((-0.11, -0.11, 0.10, 0.11, 0.11, high), green, "fabric", form="ball"),
    )
    return modelled("potted_plant", OBJS, parts)


def _grounded(name: str, parts: list[Part]) -> Model:
    """Return the model of parts with what lies under the floor cut away."""
    kept = []
    for part in parts:
        x0, y0, z0, x1, y1, z1 = part.box_m
        # The upper half of a low, wide ball: as if it had sunk into the floor.
        kept.append(Part((x0, y0, max(z0, 0.0), x1, y1, z1), part.colour, part.grain, part.form))
    return modelled(name, OBJS, kept)


ON_TABLES: tuple[Maker, ...] = (cup, bottle, plate, laptop, decor.book_pile, potted, cup, carton)
ON_BEDS: tuple[Maker, ...] = (teddy, laundry, decor.book_pile, bag)
ON_FLOORS: tuple[Maker, ...] = (
    shoes, bag, carton, laundry, ball, bricks, teddy, decor.book_pile, shoes, bottle,
)  # fmt: skip

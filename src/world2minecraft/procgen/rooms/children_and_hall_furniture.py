"""Models of furniture for children's rooms, halls and offices."""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.rooms.furniture_model import (
    Colour,
    Model,
    Part,
    legs,
    round_to_step,
    shade,
)

FURN, OBJS, CHAIR = (int(c) for c in (SemanticClass.FURN, SemanticClass.OBJS, SemanticClass.CHAIR))
BRIGHT_COLOURS: tuple[Colour, ...] = (
    (214, 68, 58), (240, 186, 60), (66, 132, 196), (96, 168, 88), (232, 128, 60), (156, 96, 170),
)  # fmt: skip


def bright_colour(rng: np.random.Generator) -> Colour:
    """Return a random toy colour."""
    return BRIGHT_COLOURS[int(rng.integers(len(BRIGHT_COLOURS)))]


def stool(colour: Colour) -> Model:
    """Return a model of a children's stool, 0.30 m high."""
    d, h = 0.30, 0.30
    seat = Part((-d / 2, -d / 2, h - 0.04, d / 2, d / 2, h), colour)
    return Model("stool", CHAIR, (d, d, h), (*legs(d, d, h - 0.04, 0.04, shade(colour, 0.8)), seat))


def toy_shelf(wood: Colour, rng: np.random.Generator) -> Model:
    """Return a model of a low shelf of six compartments, some of which contain coloured crates."""
    d, w, h = 0.36, 1.12, 0.78
    parts = [Part((-d / 2, -w / 2, 0.0, -d / 2 + 0.02, w / 2, h), shade(wood, 0.85), "wood")]
    for z in (0.0, 0.36, h - 0.04):
        parts.append(Part((-d / 2, -w / 2, z, d / 2, w / 2, z + 0.04), wood, "wood"))
    for n in range(4):
        y = round_to_step(-w / 2 + (w - 0.04) * n / 3)
        parts.append(Part((-d / 2, y, 0.0, d / 2, y + 0.04, h), wood, "wood"))
    for n in range(3):
        for z in (0.04, 0.40):
            if rng.random() < 0.7:
                y = round_to_step(-w / 2 + (w - 0.04) * n / 3) + 0.08
                box = (-d / 2 + 0.04, y, z, d / 2 - 0.02, y + 0.24, z + 0.22)
                parts.append(Part(box, bright_colour(rng)))
    return Model("toy_shelf", FURN, (d, w, h), tuple(parts))


def shoe_cabinet(body: Colour) -> Model:
    """Return a model of a shallow shoe cabinet with tilting fronts: 0.26 m deep."""
    d, w, h = 0.26, 0.90, 1.04
    parts = [Part((-d / 2, -w / 2, 0.0, d / 2 - 0.02, w / 2, h), shade(body, 0.9))]
    for n in range(3):
        z = 0.06 + 0.32 * n
        face = (d / 2 - 0.02, -w / 2 + 0.02, z, d / 2, w / 2 - 0.02, z + 0.30)
        parts.append(Part(face, body, "wood"))
    return Model("shoe_cabinet", FURN, (d, w, h), tuple(parts))


def coats(rng: np.random.Generator, wood: Colour) -> Model:
    """Return a model of a hook board with coats in several colours: 0.86 m high."""
    d, w, h = 0.20, 0.92, 0.86
    tones: tuple[Colour, ...] = ((58, 66, 88), (120, 74, 60), (88, 104, 82), (176, 150, 110))
    parts = [Part((-d / 2, -w / 2, h - 0.10, -d / 2 + 0.04, w / 2, h), wood, "wood")]
    for n in range(3):
        y = round_to_step(-w / 2 + 0.06 + 0.29 * n)
        low = round_to_step(float(rng.uniform(0.0, 0.14))) if n else 0.0
        box = (-d / 2 + 0.04, y, low, d / 2 if n == 0 else d / 2 - 0.04, y + 0.22, h - 0.08)
        parts.append(Part(box, tones[int(rng.integers(len(tones)))], "fabric"))
    return Model("coats", OBJS, (d, w, h), tuple(parts))


def bench(wood: Colour) -> Model:
    """Return a model of a hall bench: 0.34 x 0.90 m, 0.46 m high."""
    d, w, h = 0.34, 0.90, 0.46
    top = Part((-d / 2, -w / 2, h - 0.04, d / 2, w / 2, h), wood, "wood")
    return Model("bench", FURN, (d, w, h), (*legs(d, w, h - 0.04, 0.06, shade(wood, 0.85)), top))


def whiteboard() -> Model:
    """Return a model of a whiteboard with writing on it."""
    d, w, h = 0.04, 1.52, 1.0
    parts = [
        Part((-d / 2, -w / 2, 0.0, d / 2, w / 2, h), (170, 174, 178)),
        Part((0.0, -w / 2 + 0.04, 0.04, d / 2, w / 2 - 0.04, h - 0.04), (246, 247, 247)),
    ]
    for z, far in ((0.78, 0.3), (0.66, 0.1), (0.54, 0.22), (0.30, -0.2)):
        parts.append(Part((0.0, -0.6, z, d / 2, far, z + 0.02), (60, 90, 150)))
    return Model("whiteboard", OBJS, (d, w, h), tuple(parts))


def printer() -> Model:
    """Return a model of a printer for a desk or a cabinet."""
    d, w, h = 0.40, 0.46, 0.28
    parts = (
        Part((-d / 2, -w / 2, 0.0, d / 2 - 0.08, w / 2, h), (72, 74, 80)),
        Part((d / 2 - 0.08, -w / 2 + 0.06, 0.06, d / 2, w / 2 - 0.06, 0.08), (240, 240, 238)),
        Part((-d / 2, -w / 2 + 0.04, h - 0.02, d / 2 - 0.14, w / 2 - 0.04, h), (200, 202, 206)),
    )
    return Model("printer", OBJS, (d, w, h), parts)

"""Models of chairs, sofas, tables and beds in real sizes."""

from itertools import pairwise

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

CHAIR, BED = int(SemanticClass.CHAIR), int(SemanticClass.BED)
SOFA, TABLE = int(SemanticClass.SOFA), int(SemanticClass.TABLE)


def chair(wood: Colour, cushion: Colour) -> Model:
    """Return a model of a dining chair with a padded seat and a back with slats."""
    d, w, h = 0.46, 0.44, 0.90
    posts = [
        Part((-d / 2, y, 0.48, -d / 2 + 0.04, y + 0.04, h), wood, "wood")
        for y in (-w / 2, w / 2 - 0.04)
    ]
    slats = [
        Part((-d / 2, -w / 2 + 0.04, z, -d / 2 + 0.04, w / 2 - 0.04, z + 0.10), wood, "wood")
        for z in (0.60, 0.80)
    ]
    seat = [
        Part((-d / 2, -w / 2, 0.42, d / 2, w / 2, 0.46), wood, "wood"),
        Part((-d / 2 + 0.02, -w / 2 + 0.02, 0.46, d / 2, w / 2 - 0.02, 0.48), cushion, "fabric"),
    ]
    return Model("chair", CHAIR, (d, w, h), (*legs(d, w, 0.42, 0.04, wood), *seat, *posts, *slats))


def office_chair(cushion: Colour) -> Model:
    """Return a model of an office chair with a crossed foot, a high back and armrests."""
    d, w, h = 0.60, 0.60, 1.04
    dark = (48, 50, 54)
    parts = (
        Part((-d / 2, -0.04, 0.0, d / 2, 0.04, 0.08), dark),
        Part((-0.04, -w / 2, 0.0, 0.04, w / 2, 0.08), dark),
        Part((-0.04, -0.04, 0.08, 0.04, 0.04, 0.42), dark),
        Part((-0.24, -0.24, 0.42, 0.26, 0.24, 0.50), cushion, "fabric"),
        Part((-0.30, -0.22, 0.50, -0.22, 0.22, h), cushion, "fabric"),
        Part((-0.22, -0.30, 0.62, 0.12, -0.24, 0.66), dark),
        Part((-0.22, 0.24, 0.62, 0.12, 0.30, 0.66), dark),
        Part((-0.20, -0.28, 0.46, -0.14, -0.24, 0.62), dark),
        Part((-0.20, 0.24, 0.46, -0.14, 0.28, 0.62), dark),
    )
    return Model("office_chair", CHAIR, (d, w, h), parts)


def armchair(fabric: Colour, wood: Colour) -> Model:
    """Return a model of an upholstered armchair, which has the class chair."""
    d, w, h = 0.84, 0.80, 0.86
    return Model("armchair", CHAIR, (d, w, h), tuple(_upholstery(d, w, h, 1, fabric, wood)))


def sofa(width: float, fabric: Colour, pillow: Colour, wood: Colour) -> Model:
    """Return a model of a sofa with arms, seat cushions and two loose pillows."""
    d, w, h = 0.92, round_to_step(width), 0.84
    parts = _upholstery(d, w, h, 3 if w > 2.0 else 2, fabric, wood)
    for y in (-w / 2 + 0.24, w / 2 - 0.62):
        parts.append(Part((-0.22, y, 0.46, -0.10, y + 0.38, 0.78), pillow, "fabric"))
    return Model("sofa", SOFA, (d, w, h), tuple(parts))


def _upholstery(d: float, w: float, h: float, seats: int, fabric: Colour, wood: Colour):
    """Return the feet, base, back, arms and seat cushions of an upholstered seat."""
    dark = shade(fabric, 0.88)
    parts = legs(d, w, 0.10, 0.06, wood)
    parts += [
        Part((-d / 2, -w / 2, 0.10, d / 2, w / 2, 0.30), dark, "fabric"),
        Part((-d / 2, -w / 2, 0.30, -d / 2 + 0.22, w / 2, h), fabric, "fabric"),
        Part((-d / 2, -w / 2, 0.30, d / 2, -w / 2 + 0.18, 0.62), dark, "fabric"),
        Part((-d / 2, w / 2 - 0.18, 0.30, d / 2, w / 2, 0.62), dark, "fabric"),
    ]
    edges = np.linspace(-w / 2 + 0.18, w / 2 - 0.18, seats + 1)
    for first, last in pairwise(edges.tolist()):
        gap = 0.01 if seats > 1 else 0.0
        box = (-d / 2 + 0.22, first + gap, 0.30, d / 2 - 0.02, last - gap, 0.46)
        parts.append(Part(box, shade(fabric, 1.06), "fabric"))
    return parts


def table(name: str, depth: float, width: float, height: float, wood: Colour) -> Model:
    """Return a model of a table with four legs, an apron and a top."""
    d, w, h = round_to_step(depth), round_to_step(width), round_to_step(height)
    under = shade(wood, 0.85)
    apron = Part(
        (-d / 2 + 0.04, -w / 2 + 0.04, h - 0.10, d / 2 - 0.04, w / 2 - 0.04, h - 0.04),
        under,
        "wood",
    )
    top = Part((-d / 2, -w / 2, h - 0.04, d / 2, w / 2, h), wood, "wood")
    side = 0.06 if h > 0.5 else 0.04
    return Model(name, TABLE, (d, w, h), (*legs(d, w, h - 0.04, side, under), apron, top))


def desk(width: float, wood: Colour, body: Colour) -> Model:
    """Return a model of a desk with a drawer block, whose front is the side of the chair."""
    d, w, h = 0.70, round_to_step(width), 0.74
    parts = [
        Part((-d / 2, -w / 2, h - 0.04, d / 2, w / 2, h), wood, "wood"),
        Part((-d / 2, -w / 2, 0, d / 2 - 0.04, -w / 2 + 0.04, h - 0.04), body),
        Part((-d / 2, w / 2 - 0.42, 0.04, d / 2 - 0.04, w / 2, h - 0.04), body),
        Part((-d / 2, -w / 2, 0.30, -d / 2 + 0.02, w / 2, h - 0.04), body),
    ]
    for z in (0.08, 0.28, 0.48):
        face = (d / 2 - 0.04, w / 2 - 0.40, z, d / 2 - 0.02, w / 2 - 0.02, z + 0.18)
        parts.append(Part(face, shade(body, 0.93)))
        handle = (d / 2 - 0.02, w / 2 - 0.26, z + 0.10, d / 2, w / 2 - 0.16, z + 0.12)
        parts.append(Part(handle, (70, 70, 72)))
    return Model("desk", TABLE, (d, w, h), tuple(parts))


def bed(width: float, wood: Colour, blanket: Colour) -> Model:
    """Return a model of a bed with pillows and a blanket. Its front is the foot end."""
    d, w, h = 2.10, round_to_step(width), 1.04
    head = -d / 2 + 0.06
    white = (238, 236, 230)
    parts = [
        *legs(d, w, 0.16, 0.08, wood),
        Part((-d / 2, -w / 2, 0.16, d / 2, w / 2, 0.32), wood, "wood"),
        Part((-d / 2, -w / 2, 0.0, head, w / 2, h), wood, "wood"),
        Part((head, -w / 2 + 0.02, 0.32, d / 2 - 0.02, w / 2 - 0.02, 0.52), white, "fabric"),
        Part((head + 0.62, -w / 2, 0.30, d / 2, w / 2, 0.56), blanket, "fabric"),
        Part((head + 0.52, -w / 2, 0.40, head + 0.70, w / 2, 0.58), shade(blanket, 1.18), "fabric"),
    ]
    count = 2 if w >= 1.3 else 1
    for n in range(count):
        middle = (n - (count - 1) / 2) * w / 2
        half = 0.30 if count == 2 else 0.34
        pillow = (head + 0.02, middle - half, 0.52, head + 0.44, middle + half, 0.66)
        parts.append(Part(pillow, (248, 247, 243), "fabric"))
    return Model("bed", BED, (d, w, h), tuple(parts))

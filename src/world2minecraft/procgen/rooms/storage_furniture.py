"""Models of cupboards, shelves and kitchen furniture, which have the class furniture."""

from itertools import pairwise

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.rooms.furniture_model import Colour, Model, Part, round_to_step, shade

FURN = int(SemanticClass.FURN)
STEEL: Colour = (176, 180, 184)
DARK: Colour = (40, 42, 46)
BOOKS: tuple[Colour, ...] = (
    (150, 52, 46), (44, 78, 120), (52, 104, 76), (204, 168, 84), (92, 60, 96), (222, 214, 196),
    (60, 62, 70), (186, 100, 56), (108, 140, 160), (128, 36, 58),
)  # fmt: skip


def bookshelf(width: float, height: float, wood: Colour, rng: np.random.Generator) -> Model:
    """Return a model of an open bookshelf with a row of books on each board."""
    d, w, h = 0.32, round_to_step(width), round_to_step(height)
    dark = shade(wood, 0.82)
    parts = [
        Part((-d / 2, -w / 2, 0, d / 2, -w / 2 + 0.04, h), wood, "wood"),
        Part((-d / 2, w / 2 - 0.04, 0, d / 2, w / 2, h), wood, "wood"),
        Part((-d / 2, -w / 2 + 0.04, 0, -d / 2 + 0.02, w / 2 - 0.04, h), dark, "wood"),
    ]
    boards = [0.06 + round_to_step(0.36) * n for n in range(int((h - 0.10) / 0.36) + 1)]
    for z in [*boards, h]:
        parts.append(Part((-d / 2, -w / 2, z - 0.04, d / 2, w / 2, z), wood, "wood"))
    for z in boards[:-1] if h - boards[-1] < 0.3 else boards:
        parts += _books(-w / 2 + 0.04, w / 2 - 0.04, z, d, rng)
    return Model("bookshelf", FURN, (d, w, h), tuple(parts))


def _books(first: float, last: float, z: float, d: float, rng: np.random.Generator) -> list[Part]:
    """Return books on a board, sometimes with a gap at the end."""
    books, y = [], first
    end = first + (last - first) * (0.62 + 0.38 * float(rng.random()))
    while y + 0.04 <= end:
        thick = float(rng.choice([0.02, 0.04, 0.04, 0.06]))
        tall = 0.20 + 0.02 * int(rng.integers(0, 5))
        deep = 0.16 + 0.02 * int(rng.integers(0, 3))
        colour = BOOKS[int(rng.integers(len(BOOKS)))]
        box = (-d / 2 + 0.02, y, z, -d / 2 + 0.02 + deep, min(y + thick, end), z + tall)
        books.append(Part(box, colour))
        y += thick
    return books


def cabinet(
    name: str, size: tuple[float, float, float], columns: int, rows: int, body: Colour, top: Colour
) -> Model:
    """Return a model of a cabinet with a grid of doors or drawers, such as a wardrobe."""
    d, w, h = (round_to_step(length) for length in size)
    parts = [
        Part((-d / 2, -w / 2, 0.06, d / 2 - 0.04, w / 2, h - 0.04), shade(body, 0.92), "wood"),
        Part((-d / 2, -w / 2 + 0.02, 0.0, d / 2 - 0.06, w / 2 - 0.02, 0.06), shade(body, 0.5)),
        Part((-d / 2, -w / 2, h - 0.04, d / 2 - 0.02, w / 2, h), top, "wood"),
    ]
    ys = np.linspace(-w / 2, w / 2, columns + 1)
    zs = np.linspace(0.08, h - 0.06, rows + 1)
    for a, b in pairwise(ys):
        for low, high in pairwise(zs):
            parts += _front(d / 2 - 0.02, float(a), float(b), float(low), float(high), body)
    return Model(name, FURN, (d, w, h), tuple(parts))


def _front(x: float, a: float, b: float, low: float, high: float, colour: Colour) -> list[Part]:
    """Return a door or drawer of 2 cm thickness, ending at ``x``, with a handle."""
    panel = Part((x - 0.02, a + 0.01, low + 0.01, x, b - 0.01, high - 0.01), colour, "wood")
    grip: Colour = (84, 84, 86)
    if high - low > 0.45:
        middle, edge = (low + high) / 2, round_to_step(b - 0.06)
        box = (x, edge - 0.02, middle - 0.10, x + 0.02, edge, middle + 0.10)
    else:
        middle, level = (a + b) / 2, round_to_step(high - 0.06)
        box = (x, middle - 0.08, level - 0.02, x + 0.02, middle + 0.08, level)
    return [panel, Part(box, grip)]


def counter(width: float, front: Colour, worktop: Colour, *, sink: bool = False) -> Model:
    """Return a model of a kitchen counter with doors, and optionally a sink with a tap."""
    d, w, h = 0.64, round_to_step(width), 0.90
    parts = [
        Part((-d / 2, -w / 2, 0, d / 2 - 0.10, w / 2, 0.10), DARK),
        Part((-d / 2, -w / 2, 0.10, d / 2 - 0.06, w / 2, 0.86), shade(front, 0.9)),
        Part((-d / 2, -w / 2, 0.86, d / 2, w / 2, h), worktop),
    ]
    doors = max(1, round(w / 0.5))
    edges = np.linspace(-w / 2, w / 2, doors + 1)
    for a, b in pairwise(edges):
        parts += _front(d / 2 - 0.04, float(a), float(b), 0.12, 0.64, front)
        parts += _front(d / 2 - 0.04, float(a), float(b), 0.64, 0.86, front)
    if not sink:
        return Model("counter", FURN, (d, w, h), tuple(parts))
    parts += [
        Part((-0.22, -0.30, h - 0.02, 0.20, 0.30, h), STEEL),
        Part((-0.18, -0.26, h - 0.02, 0.16, 0.26, h), shade(STEEL, 0.6)),
        Part((-0.28, -0.02, h, -0.24, 0.02, h + 0.24), STEEL),
        Part((-0.28, -0.02, h + 0.22, -0.08, 0.02, h + 0.26), STEEL),
    ]
    return Model("sink_counter", FURN, (d, w, h + 0.26), tuple(parts))


def oven(front: Colour, worktop: Colour) -> Model:
    """Return a model of a cooker with an oven door, knobs and four hotplates."""
    d, w, h = 0.64, 0.60, 0.92
    parts = [
        Part((-d / 2, -w / 2, 0, d / 2 - 0.10, w / 2, 0.10), DARK),
        Part((-d / 2, -w / 2, 0.10, d / 2 - 0.04, w / 2, 0.90), STEEL),
        Part((d / 2 - 0.04, -w / 2 + 0.02, 0.16, d / 2 - 0.02, w / 2 - 0.02, 0.68), DARK),
        Part((d / 2 - 0.04, -0.20, 0.28, d / 2 - 0.02, 0.20, 0.54), (78, 70, 64)),
        Part((d / 2 - 0.02, -0.24, 0.62, d / 2, 0.24, 0.64), shade(STEEL, 1.15)),
        Part((-d / 2, -w / 2, 0.88, d / 2 - 0.02, w / 2, 0.90), worktop),
        Part((-d / 2 + 0.06, -w / 2 + 0.04, 0.90, d / 2 - 0.08, w / 2 - 0.04, h), (28, 28, 30)),
    ]
    for x in (-0.22, 0.04):
        for y in (-0.22, 0.04):
            parts.append(Part((x, y, 0.90, x + 0.18, y + 0.18, h), (96, 60, 52)))
    for y in (-0.20, -0.08, 0.04, 0.16):
        parts.append(Part((d / 2 - 0.04, y, 0.76, d / 2 - 0.02, y + 0.04, 0.80), DARK))
    return Model("oven", FURN, (d, w, h), tuple(parts))


def wall_cabinet(width: float, front: Colour) -> Model:
    """Return a model of a kitchen wall cabinet."""
    d, w, h = 0.36, round_to_step(width), 0.70
    parts = [Part((-d / 2, -w / 2, 0, d / 2 - 0.04, w / 2, h), shade(front, 0.9))]
    doors = max(1, round(w / 0.5))
    edges = np.linspace(-w / 2, w / 2, doors + 1)
    for a, b in pairwise(edges):
        parts += _front(d / 2 - 0.02, float(a), float(b), 0.0, h, front)
    return Model("wall_cabinet", FURN, (d, w, h), tuple(parts))


def fridge(colour: Colour) -> Model:
    """Return a model of a fridge above a freezer."""
    d, w, h = 0.68, 0.62, 1.82
    parts = [
        Part((-d / 2, -w / 2, 0, d / 2 - 0.06, w / 2, h), shade(colour, 0.94)),
        Part((d / 2 - 0.06, -w / 2, 0.06, d / 2 - 0.04, w / 2, 0.62), colour),
        Part((d / 2 - 0.06, -w / 2, 0.64, d / 2 - 0.04, w / 2, h), colour),
        Part((d / 2 - 0.04, w / 2 - 0.08, 0.36, d / 2, w / 2 - 0.04, 0.58), shade(STEEL, 0.7)),
        Part((d / 2 - 0.04, w / 2 - 0.08, 0.70, d / 2, w / 2 - 0.04, 1.20), shade(STEEL, 0.7)),
    ]
    return Model("fridge", FURN, (d, w, h), tuple(parts))

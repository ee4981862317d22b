"""Models of screens, lamps, plants, doors and small decorative objects."""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.rooms.furniture_model import Colour, Model, Part, round_to_step, shade

TVS, OBJS = int(SemanticClass.TVS), int(SemanticClass.OBJS)
BLACK: Colour = (26, 27, 30)
LIGHT: Colour = (255, 240, 205)


def tv(width: float) -> Model:
    """Return a model of a flat television on a stand."""
    d, w = 0.24, round_to_step(width)
    h = round_to_step(w * 0.58) + 0.06
    parts = (
        Part((-d / 2, -0.28, 0, d / 2, 0.28, 0.02), BLACK),
        Part((-0.02, -0.06, 0.02, 0.02, 0.06, 0.08), BLACK),
        Part((-0.02, -w / 2, 0.06, 0.04, w / 2, h), BLACK),
        Part((0.02, -w / 2 + 0.02, 0.10, 0.04, w / 2 - 0.02, h - 0.02), (34, 42, 56)),
    )
    return Model("tv", TVS, (d, w, h), parts)


def monitor() -> Model:
    """Return a model of a computer monitor with a bright image."""
    d, w, h = 0.20, 0.60, 0.46
    parts = (
        Part((-d / 2, -0.14, 0, d / 2, 0.14, 0.02), BLACK),
        Part((-0.02, -0.04, 0.02, 0.02, 0.04, 0.12), BLACK),
        Part((-0.02, -w / 2, 0.10, 0.02, w / 2, h), BLACK),
        Part((0.0, -w / 2 + 0.02, 0.12, 0.02, w / 2 - 0.02, h - 0.02), (70, 110, 160)),
        Part((0.0, -w / 2 + 0.06, 0.22, 0.02, 0.06, h - 0.06), (214, 222, 230)),
    )
    return Model("monitor", TVS, (d, w, h), parts)


def floor_lamp(shade_colour: Colour) -> Model:
    """Return a model of a floor lamp, 1.6 m high."""
    d, h = 0.36, 1.60
    parts = (
        Part((-0.14, -0.14, 0, 0.14, 0.14, 0.02), BLACK),
        Part((-0.02, -0.02, 0.02, 0.02, 0.02, 1.28), BLACK),
        Part((-d / 2, -d / 2, 1.28, d / 2, d / 2, h), shade_colour, "glow"),
    )
    return Model("floor_lamp", OBJS, (d, d, h), parts)


def table_lamp(foot: Colour) -> Model:
    """Return a model of a small table lamp."""
    d, h = 0.24, 0.44
    parts = (
        Part((-0.08, -0.08, 0, 0.08, 0.08, 0.02), foot),
        Part((-0.02, -0.02, 0.02, 0.02, 0.02, 0.22), foot),
        Part((-d / 2, -d / 2, 0.22, d / 2, d / 2, h), LIGHT, "glow"),
    )
    return Model("table_lamp", OBJS, (d, d, h), parts)


def pendant(drop: float, colour: Colour) -> Model:
    """Return a model of a pendant lamp whose total length below the ceiling is ``drop`` metres."""
    d, h = 0.40, round_to_step(drop)
    parts = (
        Part((-0.02, -0.02, 0.20, 0.02, 0.02, h), BLACK),
        Part((-d / 2, -d / 2, 0.04, d / 2, d / 2, 0.22), colour),
        Part((-0.12, -0.12, 0, 0.12, 0.12, 0.04), LIGHT, "glow"),
    )
    return Model("pendant", OBJS, (d, d, h), parts)


def plant(height: float, rng: np.random.Generator) -> Model:
    """Return a model of a potted plant with leaves in several shades of green."""
    d, h = 0.52, round_to_step(height)
    pot = round_to_step(0.28)
    clay: Colour = (186, 108, 76) if rng.random() < 0.5 else (226, 222, 214)
    parts = [
        Part((-0.16, -0.16, 0, 0.16, 0.16, pot), clay),
        Part((-0.14, -0.14, pot - 0.02, 0.14, 0.14, pot), (70, 50, 38)),
        Part((-0.02, -0.02, pot, 0.02, 0.02, h - 0.1), (92, 74, 48)),
        Part((-d / 2, -0.10, h - 0.42, d / 2, 0.10, h - 0.26), (58, 112, 58), "fabric"),
        Part((-0.10, -d / 2, h - 0.40, 0.10, d / 2, h - 0.24), (70, 128, 62), "fabric"),
        Part((-0.14, -0.14, h - 0.24, 0.14, 0.14, h), (80, 142, 70), "fabric"),
    ]
    for _ in range(7):
        x, y = (round_to_step(float(value)) for value in rng.uniform(-0.18, 0.12, 2))
        z = round_to_step(pot + 0.08 + float(rng.random()) * (h - pot - 0.3))
        green: Colour = (50 + int(rng.integers(40)), 104 + int(rng.integers(44)), 56)
        parts.append(Part((x, y, z, x + 0.12, y + 0.12, z + 0.08), green, "fabric"))
    return Model("plant", OBJS, (d, d, h), tuple(parts))


def picture(width: float, height: float, rng: np.random.Generator) -> Model:
    """Return a model of a framed picture of a simple landscape."""
    d, w, h = 0.04, round_to_step(width), round_to_step(height)
    skies: tuple[Colour, ...] = ((150, 190, 214), (226, 196, 160), (190, 204, 196))
    lands: tuple[Colour, ...] = ((84, 116, 90), (176, 112, 74), (66, 92, 120))
    sky, land = skies[int(rng.integers(3))], lands[int(rng.integers(3))]
    frame: Colour = (60, 46, 38) if rng.random() < 0.6 else (232, 230, 224)
    parts = (
        Part((-d / 2, -w / 2, 0, d / 2, w / 2, h), frame),
        Part((0.0, -w / 2 + 0.04, 0.04, d / 2, w / 2 - 0.04, h - 0.04), (240, 238, 232)),
        Part((0.0, -w / 2 + 0.08, 0.08, d / 2, w / 2 - 0.08, h - 0.08), sky),
        Part((0.0, -w / 2 + 0.08, 0.08, d / 2, w / 2 - 0.08, round_to_step(h * 0.45)), land),
        Part((0.0, -w / 2 + 0.08, 0.08, d / 2, 0.0, round_to_step(h * 0.3)), shade(land, 0.8)),
        Part(
            (0.0, 0.04, round_to_step(h * 0.58), d / 2, 0.14, round_to_step(h * 0.58) + 0.1),
            (244, 214, 130),
        ),
    )
    return Model("picture", OBJS, (d, w, h), parts)


def curtain(width: float, height: float, colour: Colour) -> Model:
    """Return a model of a curtain with folds."""
    d, w, h = 0.10, round_to_step(width), round_to_step(height)
    parts = []
    for n, y in enumerate(np.arange(-w / 2, w / 2 - 0.01, 0.06)):
        back = -d / 2 + (0.04 if n % 2 else 0.0)
        last = min(float(y) + 0.06, w / 2)
        tone = shade(colour, 0.9 if n % 2 else 1.0)
        parts.append(Part((back, float(y), 0, back + 0.06, last, h), tone, "fabric"))
    return Model("curtain", OBJS, (d, w, h), tuple(parts))


def crate(size: tuple[float, float, float], colour: Colour) -> Model:
    """Return a model of a cardboard box with tape across its top."""
    d, w, h = (round_to_step(length) for length in size)
    parts = (
        Part((-d / 2, -w / 2, 0, d / 2, w / 2, h), colour),
        Part((-d / 2, -0.04, h - 0.02, d / 2, 0.04, h), shade(colour, 1.25)),
    )
    return Model("box", OBJS, (d, w, h), parts)


def book_pile(rng: np.random.Generator) -> Model:
    """Return a model of a pile of three books."""
    tones: tuple[Colour, ...] = ((150, 60, 52), (52, 88, 122), (208, 178, 96), (80, 110, 88))
    parts = []
    for n in range(3):
        inset = 0.02 * n
        box = (-0.10, -0.14 + inset, 0.04 * n, 0.10, 0.14 - inset, 0.04 * (n + 1))
        parts.append(Part(box, tones[int(rng.integers(4))]))
    return Model("books", OBJS, (0.20, 0.28, 0.12), tuple(parts))


def vase(colour: Colour) -> Model:
    """Return a model of a vase with flowers."""
    parts = (
        Part((-0.06, -0.06, 0, 0.06, 0.06, 0.18), colour),
        Part((-0.02, -0.02, 0.18, 0.02, 0.02, 0.28), (86, 130, 70)),
        Part((-0.08, -0.08, 0.26, 0.08, 0.08, 0.36), (226, 128, 120), "fabric"),
        Part((-0.04, -0.04, 0.34, 0.04, 0.04, 0.40), (240, 196, 120), "fabric"),
    )
    return Model("vase", OBJS, (0.16, 0.16, 0.40), parts)


def bowl() -> Model:
    """Return a model of a fruit bowl."""
    parts = (
        Part((-0.14, -0.14, 0, 0.14, 0.14, 0.06), (236, 232, 222)),
        Part((-0.10, -0.10, 0.06, 0.0, 0.02, 0.12), (206, 66, 50)),
        Part((0.0, -0.08, 0.06, 0.10, 0.04, 0.12), (236, 160, 54)),
        Part((-0.06, 0.02, 0.06, 0.06, 0.10, 0.12), (132, 168, 66)),
    )
    return Model("bowl", OBJS, (0.28, 0.28, 0.12), parts)


def microwave() -> Model:
    """Return a model of a microwave oven."""
    d, w, h = 0.36, 0.50, 0.30
    parts = (
        Part((-d / 2, -w / 2, 0, d / 2, w / 2, h), (200, 202, 204)),
        Part((d / 2 - 0.02, -w / 2 + 0.04, 0.04, d / 2, w / 2 - 0.16, h - 0.04), BLACK),
        Part((d / 2 - 0.02, w / 2 - 0.12, 0.18, d / 2, w / 2 - 0.04, h - 0.06), (90, 170, 120)),
    )
    return Model("microwave", OBJS, (d, w, h), parts)


def kettle(colour: Colour) -> Model:
    """Return a model of a kettle with a handle."""
    parts = (
        Part((-0.08, -0.04, 0, 0.08, 0.12, 0.20), colour),
        Part((-0.02, -0.12, 0.04, 0.02, -0.08, 0.20), BLACK),
        Part((-0.02, -0.12, 0.16, 0.02, -0.04, 0.20), BLACK),
        Part((-0.04, 0.0, 0.20, 0.04, 0.08, 0.24), BLACK),
    )
    return Model("kettle", OBJS, (0.16, 0.24, 0.24), parts)


def hood() -> Model:
    """Return a model of a steel extractor hood with a chimney."""
    d, w, h = 0.48, 0.60, 0.90
    steel: Colour = (184, 187, 190)
    parts = (
        Part((-d / 2, -w / 2, 0, d / 2, w / 2, 0.08), steel),
        Part((-d / 2, -w / 2 + 0.10, 0.08, d / 2 - 0.12, w / 2 - 0.10, 0.16), shade(steel, 0.94)),
        Part((-d / 2, -0.14, 0.16, -d / 2 + 0.28, 0.14, h), shade(steel, 0.97)),
    )
    return Model("hood", OBJS, (d, w, h), parts)


def door(width: float, height: float, colour: Colour) -> Model:
    """Return a model of a closed door leaf with panels and a handle."""
    d, w, h = 0.06, round_to_step(width), round_to_step(height)
    parts = [Part((-d / 2, -w / 2, 0, d / 2 - 0.02, w / 2, h), colour, "wood")]
    for low, high in ((0.16, h * 0.42), (h * 0.5, h - 0.16)):
        for a, b in ((-w / 2 + 0.1, -0.04), (0.04, w / 2 - 0.1)):
            box = (d / 2 - 0.04, a, round_to_step(low), d / 2 - 0.02, b, round_to_step(high))
            parts.append(Part(box, shade(colour, 0.86), "wood"))
    grip = (d / 2 - 0.02, w / 2 - 0.16, 1.02, d / 2, w / 2 - 0.04, 1.06)
    return Model("door", OBJS, (d, w, h), (*parts, Part(grip, (150, 150, 152))))


def waste_bin(colour: Colour) -> Model:
    """Return a model of a waste-paper bin."""
    parts = (
        Part((-0.14, -0.14, 0, 0.14, 0.14, 0.32), colour),
        Part((-0.10, -0.10, 0.28, 0.10, 0.10, 0.32), (230, 228, 222)),
    )
    return Model("bin", OBJS, (0.28, 0.28, 0.32), parts)


def keyboard() -> Model:
    """Return a model of a computer keyboard."""
    parts = (
        Part((-0.08, -0.22, 0, 0.08, 0.22, 0.02), (58, 60, 64)),
        Part((-0.06, -0.20, 0, 0.06, 0.20, 0.02), (84, 86, 90)),
    )
    return Model("keyboard", OBJS, (0.16, 0.44, 0.02), parts)

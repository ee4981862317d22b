"""Things of odd shape that no template of furniture knows, in the sizes they have in homes."""

from itertools import pairwise

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.rooms.furniture_model import Bar, Colour, Model, Part, shade
from world2minecraft.procgen.rooms.play_and_hall import bright
from world2minecraft.procgen.rooms.small import Maker
from world2minecraft.procgen.rooms.solid_voxels import modelled

CHAIR, FURN, OBJS = (int(c) for c in (SemanticClass.CHAIR, SemanticClass.FURN, SemanticClass.OBJS))
WOOD: Colour = (176, 128, 82)
METAL: Colour = (92, 96, 102)


def beanbag(rng: np.random.Generator) -> Model:
    """A beanbag: a sack to sit in, 0.9 m across, higher at its back."""
    cloth = bright(rng)
    parts = (
        Part((-0.45, -0.44, 0.0, 0.43, 0.44, 0.5), cloth, "fabric", form="ball"),
        Part((-0.40, -0.34, 0.0, 0.36, 0.34, 0.2), cloth, "fabric", form="drum"),
        Part((-0.46, -0.34, 0.2, 0.0, 0.34, 0.82), shade(cloth, 1.06), "fabric", form="ball"),
    )
    return modelled("beanbag", CHAIR, parts)


def rocking_horse(rng: np.random.Generator) -> Model:
    """A rocking horse of 0.9 m on two curved runners."""
    coat, mane = (214, 186, 142), bright(rng)
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
    return modelled("rocking_horse", OBJS, parts)


def easel(rng: np.random.Generator) -> Model:
    """A painter's easel with a canvas on it, 1.6 m high."""
    parts: list[Part | Bar] = [
        Bar((0.24, -0.34, 0.0), (0.0, -0.04, 1.6), 0.02, WOOD, "wood"),
        Bar((0.24, 0.34, 0.0), (0.0, 0.04, 1.6), 0.02, WOOD, "wood"),
        Bar((-0.42, 0.0, 0.0), (0.0, 0.0, 1.5), 0.02, WOOD, "wood"),
        Bar((0.16, -0.36, 0.66), (0.16, 0.36, 0.66), 0.025, WOOD, "wood"),
        Part((0.12, -0.30, 0.68, 0.15, 0.30, 1.28), (240, 238, 230)),
        Part((0.15, -0.2, 0.8, 0.17, 0.02, 1.04), bright(rng), form="ball"),
        Part((0.15, -0.02, 0.9, 0.17, 0.22, 1.16), bright(rng), form="ball"),
    ]
    return modelled("easel", OBJS, parts)


def guitar(rng: np.random.Generator) -> Model:
    """A guitar on its stand."""
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
    return modelled("guitar", OBJS, parts)


def bicycle(rng: np.random.Generator) -> Model:
    """A bicycle on its stand: wheels of 0.66 m, 1.7 m long."""
    paint, parts = bright(rng), []
    for middle in (-0.5, 0.5):
        corners = np.linspace(0, 2 * np.pi, 17)
        rim = [(middle + 0.31 * np.cos(a), 0.0, 0.335 + 0.31 * np.sin(a)) for a in corners]
        for a, b in pairwise(rim):
            parts.append(Bar(_at(a), _at(b), 0.022, (44, 44, 48)))
        for a in corners[:8:2]:
            off = (0.3 * np.cos(a), 0.0, 0.3 * np.sin(a))
            ends = [(middle + s * off[0], 0.0, 0.335 + s * off[2]) for s in (-1, 1)]
            parts.append(Bar(_at(ends[0]), _at(ends[1]), 0.008, (170, 172, 176)))
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
    return modelled("bicycle", OBJS, parts)


def _at(point: tuple[float, ...]) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in point)
    return x, y, z


def spiral_shelf(rng: np.random.Generator) -> Model:
    """Boards that wind up around a pole, 1.7 m high."""
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
            parts.append(Part(box, bright(rng), form="ball"))
    return modelled("spiral_shelf", FURN, parts)


def blob(rng: np.random.Generator) -> Model:
    """A sculpture of balls that grow into each other: no two are alike."""
    tone: Colour = (200, 196, 188) if rng.random() < 0.5 else bright(rng)
    parts, place = [], np.array([0.0, 0.0, 0.22])
    for _ in range(6):
        r = float(rng.uniform(0.12, 0.24))
        x, y, z = (float(value) for value in place)
        box = (x - r, y - r, max(0.0, z - r), x + r, y + r, z + r)
        parts.append(Part(box, tone, form="ball"))
        place = place + rng.uniform((-0.16, -0.16, 0.0), (0.16, 0.16, 0.2))
    return modelled("sculpture", OBJS, parts)


def cat_tree(rng: np.random.Generator) -> Model:
    """A cat's tree: posts, round boards at three heights and a cave."""
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
    return modelled("cat_tree", FURN, parts)


def gym_ball(rng: np.random.Generator) -> Model:
    """A big ball to sit on, 0.65 m across."""
    return modelled(
        "gym_ball", OBJS, (Part((-0.32, -0.32, 0, 0.32, 0.32, 0.65), bright(rng), form="ball"),)
    )


def floor_vase(rng: np.random.Generator) -> Model:
    """A big vase with dry twigs."""
    clay = bright(rng)
    parts: list[Part | Bar] = [
        Part((-0.16, -0.16, 0.0, 0.16, 0.16, 0.5), clay, form="ball"),
        Part((-0.07, -0.07, 0.4, 0.07, 0.07, 0.6), clay, form="drum"),
        Part((-0.10, -0.10, 0.0, 0.10, 0.10, 0.08), clay, form="drum"),
    ]
    for _ in range(6):
        x, y = (float(value) for value in rng.uniform(-0.24, 0.24, 2))
        parts.append(Bar((0, 0, 0.56), (x, y, float(rng.uniform(0.9, 1.3))), 0.011, (150, 120, 84)))
    return modelled("floor_vase", OBJS, parts)


ODD: tuple[Maker, ...] = (
    beanbag, rocking_horse, easel, guitar, bicycle, spiral_shelf, blob, cat_tree, gym_ball,
    floor_vase,
)  # fmt: skip

"""Models of bathroom fittings in common sizes."""

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.rooms.furniture_model import (
    Bar,
    Colour,
    Model,
    Part,
    round_to_step,
    shade,
)
from world2minecraft.procgen.rooms.supersampled_voxelization import make_model

FURN, OBJS = int(SemanticClass.FURN), int(SemanticClass.OBJS)
CERAMIC: Colour = (242, 243, 242)
STEEL: Colour = (182, 186, 190)
GLASS: Colour = (176, 206, 214)


def toilet() -> Model:
    """Return a model of a toilet with a cistern: 0.68 m deep, with the seat at 0.42 m."""
    d, w, h = 0.68, 0.40, 0.80
    parts = (
        Part((-d / 2, -w / 2, 0.40, -d / 2 + 0.18, w / 2, h), CERAMIC),
        Part((-d / 2 + 0.04, -0.10, 0.0, d / 2 - 0.20, 0.10, 0.24), CERAMIC),
        Part((-d / 2 + 0.12, -w / 2, 0.24, d / 2, w / 2, 0.40), CERAMIC, form="drum"),
        Part((-d / 2 + 0.12, -w / 2, 0.40, d / 2, w / 2, 0.42), shade(CERAMIC, 0.94), form="drum"),
        Part((-d / 2 + 0.08, -0.04, h - 0.02, -d / 2 + 0.14, 0.04, h), STEEL),
    )
    return Model("toilet", FURN, (d, w, h), parts)


def washstand(front: Colour) -> Model:
    """Return a model of a washbasin on a cupboard with two drawers. Its rim is at 0.86 m."""
    d, w, h = 0.52, 0.8, 1.02
    light = shade(front, 1.06)
    parts = (
        Part((-d / 2, -w / 2 + 0.04, 0.24, d / 2 - 0.04, w / 2 - 0.04, 0.74), front),
        Part((d / 2 - 0.04, -w / 2 + 0.06, 0.28, d / 2 - 0.02, w / 2 - 0.06, 0.48), light),
        Part((d / 2 - 0.04, -w / 2 + 0.06, 0.50, d / 2 - 0.02, w / 2 - 0.06, 0.72), light),
        Part((-d / 2, -w / 2, 0.74, d / 2, w / 2, 0.86), CERAMIC),
        Part((-0.12, -0.24, 0.84, d / 2 - 0.06, 0.24, 0.86), shade(CERAMIC, 0.8)),
        Part((-d / 2 + 0.04, -0.02, 0.86, -d / 2 + 0.08, 0.02, h), STEEL),
        Part((-d / 2 + 0.08, -0.02, h - 0.04, -d / 2 + 0.20, 0.02, h), STEEL),
        Part((-d / 2, -0.10, 0.0, -d / 2 + 0.2, 0.10, 0.24), shade(front, 0.8)),
    )  # fmt: skip
    return Model("washstand", FURN, (d, w, h), parts)


def mirror(width: float) -> Model:
    """Return a model of a wall mirror, 0.7 m high."""
    d, w, h = 0.04, round_to_step(width), 0.70
    parts = (
        Part((-d / 2, -w / 2, 0, d / 2, w / 2, h), STEEL),
        Part((0.0, -w / 2 + 0.02, 0.02, d / 2, w / 2 - 0.02, h - 0.02), (198, 214, 220)),
    )
    return Model("mirror", OBJS, (d, w, h), parts)


def bathtub(length: float) -> Model:
    """Return a model of a bathtub, 0.76 m wide and 0.58 m high, whose back is a long side."""
    d, w, h = 0.76, round_to_step(length), 0.58
    water = shade(CERAMIC, 0.86)
    parts = (
        Part((-d / 2, -w / 2, 0.0, d / 2, w / 2, 0.22), CERAMIC),
        Part((-d / 2, -w / 2, 0.22, -d / 2 + 0.08, w / 2, h), CERAMIC),
        Part((d / 2 - 0.08, -w / 2, 0.22, d / 2, w / 2, h), CERAMIC),
        Part((-d / 2 + 0.08, -w / 2, 0.22, d / 2 - 0.08, -w / 2 + 0.12, h), CERAMIC),
        Part((-d / 2 + 0.08, w / 2 - 0.10, 0.22, d / 2 - 0.08, w / 2, h), CERAMIC),
        Part((-d / 2 + 0.08, -w / 2 + 0.12, 0.20, d / 2 - 0.08, w / 2 - 0.10, 0.22), water),
        Part((-0.04, w / 2 - 0.08, h, 0.04, w / 2 - 0.04, h + 0.10), STEEL),
        Part((-0.02, w / 2 - 0.20, h + 0.06, 0.02, w / 2 - 0.04, h + 0.10), STEEL),
    )
    return Model("bathtub", FURN, (d, w, h + 0.10), parts)


def shower(side: float = 0.92) -> Model:
    """Return a model of a shower with two glass sides and the shower head at its back."""
    d, h = round_to_step(side), 2.0
    half = d / 2
    parts = (
        Part((-half, -half, 0.0, half, half, 0.06), CERAMIC),
        Part((half - 0.02, -half, 0.06, half, half, h), GLASS),
        Part((-half, half - 0.02, 0.06, half - 0.02, half, h), GLASS),
        Part((half - 0.02, -half, h - 0.04, half, half, h), STEEL),
        Part((-half, half - 0.02, h - 0.04, half, half, h), STEEL),
        Part((-half, -0.02, 1.0, -half + 0.04, 0.02, h - 0.02), STEEL),
        Part((-half, -0.02, h - 0.06, -half + 0.24, 0.02, h - 0.02), STEEL),
        Part((-half + 0.14, -0.10, h - 0.08, -half + 0.34, 0.10, h - 0.06), STEEL),
    )
    return Model("shower", FURN, (d, d, h), parts)


def washing_machine() -> Model:
    """Return a model of a front-loading washing machine: 0.60 x 0.60 x 0.86 m."""
    d, w, h = 0.60, 0.60, 0.86
    x = d / 2
    parts = (
        Part((-x, -w / 2, 0.0, x - 0.04, w / 2, h), (236, 237, 238)),
        Part((x - 0.04, -w / 2, 0.0, x - 0.02, w / 2, 0.70), (228, 229, 230)),
        Part((x - 0.04, -w / 2, 0.72, x - 0.02, w / 2, h), (206, 208, 210)),
        Part((x - 0.04, -0.20, 0.22, x, 0.20, 0.62), (120, 124, 130), form="drum", axis=0),
        Part((x - 0.02, -0.14, 0.28, x, 0.14, 0.56), (52, 60, 70), form="drum", axis=0),
        Part((x - 0.02, 0.12, 0.76, x, 0.20, 0.84), (70, 72, 76)),
    )
    return Model("washing_machine", FURN, (d, w, h), parts)


def towel(colour: Colour) -> Model:
    """Return a model of a towel on a wall rail."""
    parts = (
        Bar((0.0, -0.30, 0.62), (0.0, 0.30, 0.62), 0.011, STEEL),
        Part((-0.04, -0.24, 0.0, 0.04, 0.16, 0.64), colour, "fabric"),
    )
    return make_model("towel", OBJS, parts)

"""Primitives for furniture designs: common boxes, plates, legs and backs.

Parts are in metres in the template's frame. Blocks are placed on a ``Plan``.
"""

from collections.abc import Iterable

import numpy as np

from world2minecraft.furniture.block_plan import Numbers, Plan, Side
from world2minecraft.furniture.template import Part

# How high in its block the top of a shape lies that rests on the block below.
RISES = {"carpet": 1 / 16, "trapdoor": 3 / 16, "slab": 0.5, "full": 1.0}
LEG_SHAPES = ("fence", "wall", "bars", "chain", "full")


def part(role: str, x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Part:
    """Return the box between two positions along each axis."""
    return Part(np.array((x[0], y[0], z[0], x[1], y[1], z[1])), role)


def slab(role: str, depth: float, width: float, bottom: float, top: float) -> Part:
    """Return a box over the whole footprint."""
    return part(role, (-depth / 2, depth / 2), (-width / 2, width / 2), (bottom, top))


def legs(depth: float, width: float, height: float, thickness: float) -> list[Part]:
    """Return four legs under the corners of the footprint."""
    x, y = depth / 2, width / 2
    thin = min(thickness, x, y)
    return [
        part("leg", along, across, (0.0, height))
        for along in ((-x, thin - x), (x - thin, x))
        for across in ((-y, thin - y), (y - thin, y))
    ]


def backrest(depth: float, width: float, bottom: float, top: float, thickness: float) -> Part:
    """Return an upright panel at the back of the footprint (smallest x)."""
    x = -depth / 2
    return part("back", (x, x + min(thickness, depth)), (-width / 2, width / 2), (bottom, top))


def arms(depth: float, width: float, bottom: float, top: float, thickness: float) -> list[Part]:
    """Return an armrest at each side."""
    y, thin = width / 2, min(thickness, width / 3)
    along = (-depth / 2, depth / 2)
    return [
        part("arm", along, (-y, thin - y), (bottom, top)),
        part("arm", along, (y - thin, y), (bottom, top)),
    ]


def column(role: str, side: float, bottom: float, top: float) -> Part:
    """Return a square post in the centre of the footprint."""
    return slab(role, side, side, bottom, top)


def lay_plate(
    plan: Plan,
    role: str,
    i: Numbers,
    j: Numbers,
    height: float,
    shapes: Iterable[str] = ("trapdoor", "slab", "full"),
) -> int:
    """Place a level plate whose top is nearest to ``height`` blocks, and return its layer.

    The plate uses one of the shapes of the role's material, preferring the thinner of equally good
    shapes. A plate thinner than a slab needs a layer below it.
    """
    choices = [
        (round(abs(layer + RISES[shape] - height), 6), RISES[shape], layer, shape)
        for shape in shapes
        if plan.look.has(role, shape)
        for layer in range(max(int(height) - 1, 0), int(height) + 2)
        if layer or RISES[shape] >= 0.5
    ]
    _, _, layer, shape = min(choices)
    if shape == "trapdoor":
        plan.plate(role, i, j, layer, "bottom")
    elif shape == "slab":
        plan.slab(role, i, j, layer)
    else:
        plan.put(role, i, j, layer, shape)
    return layer


def lay_legs(plan: Plan, role: str, feet: Iterable[tuple[int, int]], top: int) -> None:
    """Place posts at the feet (i, j) up to the layer ``top`` (exclusive)."""
    shape = next(shape for shape in LEG_SHAPES if plan.look.has(role, shape))
    properties = {"axis": "y"} if shape == "chain" else {}
    for i, j in feet:
        plan.put(role, i, j, range(top), shape, **properties)


def lay_back(plan: Plan, role: str, j: Numbers, k: Numbers) -> None:
    """Place a back of panels, or of whole blocks if the material has no panels."""
    if plan.look.has(role, "trapdoor"):
        plan.panel(role, 0, j, k, "back")
    else:
        plan.put(role, 0, j, k)


def lay_sheet(plan: Plan, role: str, j: Numbers, k: Numbers) -> None:
    """Place a thin upright sheet of the panes or bars of a role's material.

    A single one would be a post, so a sheet one block wide consists of panels if the material has
    them.
    """
    joined = next((shape for shape in ("pane", "bars") if plan.look.has(role, shape)), None)
    if joined is None or (plan.size.width == 1 and plan.look.has(role, "trapdoor")):
        plan.panel(role, 0, j, k, "back")
    else:
        plan.put(role, 0, j, k, joined)


def lay_trestle(plan: Plan) -> None:
    """Place a table one block high: a top in the upper half, and a leg at either end.

    The top and the legs are upside-down stairs if the material of the top has stairs.
    """
    last = plan.size.width - 1
    if last == 0 or not plan.look.has("top", "stairs", "slab"):
        plan.put("top", plan.depth, plan.width, 0)
        return
    plan.slab("top", plan.depth, range(1, last), 0, "top")
    ends: tuple[tuple[int, Side], ...] = ((0, "right"), (last, "left"))
    for j, side in ends:
        plan.stairs("top", plan.depth, j, 0, side, "top")

"""Seats for one that people move: chairs, swivel chairs and stools.

At one block per metre a chair is a stair. At two and more it has legs, a seat at its height, and
a back of open trapdoors.
"""

from world2minecraft.furniture.family import Family
from world2minecraft.furniture.look import Look
from world2minecraft.furniture.plan import Plan, level
from world2minecraft.furniture.shapes import arms, backrest, column, legs, part, slab
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span

FINE = 3.0  # Blocks per metre from which a leg is a post of its own.


def _chair(depth: float, width: float, height: float, look: Look) -> list[Part]:
    seat = min(look["seat_height"], 0.8 * height)
    under = max(seat - 0.05, seat / 2)
    return [
        *legs(depth, width, under, 0.04),
        slab("seat", depth, width, under, seat),
        backrest(depth, width, seat, height, 0.06),
    ]


def _chair_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.per_metre < FINE:
        plan.stairs("seat", plan.depth, plan.width, 0, "back")
        plan.panel("back", 0, plan.width, range(1, size.height), "back")
        return plan.blocks
    layer = _seat(plan, look["seat_height"] * size.per_metre)
    for i, j in plan.corners:
        plan.put("leg", i, j, range(layer), "fence")
    plan.panel("back", 0, plan.width, range(layer + 1, size.height), "back")
    return plan.blocks


def _seat(plan: Plan, height: float) -> int:
    """Lay a seat whose top is near a height in blocks; return its layer."""
    layer, shape = level(height)
    layer = min(layer, plan.size.height - 1)
    if shape == "plate":
        plan.plate("seat", plan.depth, plan.width, layer, "bottom")
    elif shape == "slab":
        plan.put("seat", plan.depth, plan.width, layer, "slab", type="bottom")
    else:
        plan.put("seat", plan.depth, plan.width, layer, "slab", type="top")
    return layer


CHAIR = Family(
    build=_chair,
    design=_chair_blocks,
    roles=("leg", "seat", "back"),
    parameters={"seat_height": Span(0.36, 0.46, 0.56)},
)


def _office_chair(depth: float, width: float, height: float, look: Look) -> list[Part]:
    seat = min(look["seat_height"], 0.8 * height)
    rest = min(look["arm_height"], height)
    beam = 0.04
    return [
        part("foot", (-depth / 2, depth / 2), (-beam, beam), (0.0, 0.08)),
        part("foot", (-beam, beam), (-width / 2, width / 2), (0.0, 0.08)),
        column("post", 2 * beam, 0.08, seat - 0.08),
        slab("seat", depth, width, seat - 0.08, seat),
        backrest(depth, width, seat, height, 0.08),
        *arms(0.6 * depth, width, rest - 0.05, rest, 0.06),
        *arms(0.1, width, seat, rest - 0.05, 0.04),
    ]


def _office_chair_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    return _chair_blocks(size, look)


OFFICE_CHAIR = Family(
    build=_office_chair,
    design=_office_chair_blocks,
    roles=("foot", "leg", "post", "seat", "back", "arm"),
    parameters={"arm_height": Span(0.64, 0.68, 0.76), "seat_height": Span(0.4, 0.48, 0.56)},
)


def _stool(depth: float, width: float, height: float, look: Look) -> list[Part]:
    under = max(height - 0.06, height / 2)
    return [*legs(depth, width, under, 0.04), slab("seat", depth, width, under, height)]


def _stool_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    layer = _seat(plan, size.exact[2])
    for i, j in plan.corners:
        plan.put("leg", i, j, range(layer), "fence")
    return plan.blocks


STOOL = Family(build=_stool, design=_stool_blocks, roles=("leg", "seat"))

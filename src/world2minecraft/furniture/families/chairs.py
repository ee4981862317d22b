"""Chair families: movable seats for one person, such as chairs, swivel chairs and stools.

At one block per metre a chair is a stair. At two blocks per metre an open trapdoor is added as its
back. From three blocks per metre it has legs, a seat at the correct height and a back.
"""

from world2minecraft.furniture.block_plan import Plan
from world2minecraft.furniture.box_primitives import (
    arms,
    backrest,
    column,
    lay_back,
    lay_legs,
    lay_plate,
    legs,
    part,
    slab,
)
from world2minecraft.furniture.family import Family
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span
from world2minecraft.furniture.template_parameters import Look

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
    if _is_small(size, look):
        _stair_chair(plan)
        return plan.blocks
    layer = _seat(plan, whole=look.option("arms") == "wood")
    lay_legs(plan, "leg", plan.corners, layer)
    top = max(size.height, layer + 2)
    lay_back(plan, "back", plan.width, range(layer + 1, top))
    if look.option("arms") == "wood" and size.depth > 1:
        plan.panel("leg", range(1, size.depth), 0, layer + 1, "right")
        plan.panel("leg", range(1, size.depth), size.width - 1, layer + 1, "left")
    return plan.blocks


def _is_small(size: BlockSize, look: Look) -> bool:
    """Return whether a chair is too small for legs, so that a stair represents it."""
    return size.per_metre < FINE or (size.depth == 1 and look["seat_height"] * size.per_metre < 1.5)


def _seat(plan: Plan, *, whole: bool = False) -> int:
    """Lay a thin seat that rises at its back to meet the panels there; a soft one is whole."""
    height = plan.look["seat_height"] * plan.size.per_metre
    if whole or not plan.look.has("seat", "slab", "stairs"):
        return lay_plate(plan, "seat", plan.depth, plan.width, height, ("full",))
    layer = max(int(height), 1)
    plan.slab("seat", plan.depth, plan.width, layer)
    plan.stairs("seat", 0, plan.width, layer, "back")
    return layer


def _stair_chair(plan: Plan) -> None:
    """Lay a chair of one layer and its back: a stair, or a cushion before a panel."""
    roles = ("seat", "back", "arm", "leg")
    stairs = next((role for role in roles if plan.look.has(role, "stairs")), None)
    panel = next((role for role in roles[1:] if plan.look.has(role, "trapdoor")), "back")
    if stairs == "seat" or (stairs and plan.size.height == 1):
        plan.stairs(stairs, plan.depth, plan.width, 0, "back")
    else:
        plan.put("seat", plan.depth, plan.width, 0)
    lay_back(plan, panel, plan.width, range(1, plan.size.height))


CHAIR = Family(
    build=_chair,
    design=_chair_blocks,
    roles=("leg", "seat", "back"),
    parameters={"seat_height": Span(0.36, 0.46, 0.56)},
    options={"arms": ("none", "wood")},
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
    plan = Plan(size, look)
    if _is_small(size, look):
        _stair_chair(plan)
        return plan.blocks
    layer = _seat(plan)
    # Bars side by side join to a ring: one pedestal in the middle of four blocks.
    lay_legs(plan, "post", plan.middle, layer)
    lay_back(plan, "back", plan.width, range(layer + 1, max(size.height, layer + 2)))
    if size.depth > 1 and look.has("arm", "trapdoor"):
        plan.panel("arm", size.depth - 1, 0, layer + 1, "right")
        plan.panel("arm", size.depth - 1, size.width - 1, layer + 1, "left")
    return plan.blocks


OFFICE_CHAIR = Family(
    build=_office_chair,
    design=_office_chair_blocks,
    roles=("foot", "post", "seat", "back", "arm"),
    parameters={"arm_height": Span(0.64, 0.68, 0.76), "seat_height": Span(0.4, 0.48, 0.56)},
)


def _stool(depth: float, width: float, height: float, look: Look) -> list[Part]:
    under = max(height - 0.06, height / 2)
    return [*legs(depth, width, under, 0.04), slab("seat", depth, width, under, height)]


def _stool_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.exact[2] < 1.3:
        low = "seat" if look.has("seat", "slab") or size.exact[2] > 0.75 else "leg"
        _low_seat(plan, low)
        return plan.blocks
    layer = lay_plate(plan, "seat", plan.depth, plan.width, size.exact[2])
    lay_legs(plan, "leg", plan.corners, layer)
    return plan.blocks


def _low_seat(plan: Plan, role: str) -> None:
    if plan.look.has(role, "slab"):
        plan.slab(role, plan.depth, plan.width, 0)
    else:
        plan.put(role, plan.depth, plan.width, 0)


STOOL = Family(build=_stool, design=_stool_blocks, roles=("leg", "seat"))


def _pedestal_stool(depth: float, width: float, height: float, look: Look) -> list[Part]:
    under = max(height - 0.08, height / 2)
    return [
        slab("foot", depth, width, 0.0, 0.03),
        column("post", min(0.06, depth, width), 0.03, under),
        slab("seat", depth, width, under, height),
    ]


def _pedestal_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.exact[2] < 1.3 and look.has("seat", "slab"):
        plan.slab("seat", plan.depth, plan.width, 0)
        return plan.blocks
    thin = ("trapdoor", "carpet") if max(size[:2]) <= 2 else ("trapdoor",)  # A carpet needs a post.
    shapes = [shape for shape in (*thin, "slab") if look.has("seat", shape)] or ["full"]
    layer = lay_plate(plan, "seat", plan.depth, plan.width, max(size.exact[2], 1.06), shapes)
    lay_legs(plan, "post", plan.middle, layer)
    return plan.blocks


PEDESTAL_STOOL = Family(
    build=_pedestal_stool, design=_pedestal_blocks, roles=("foot", "post", "seat")
)

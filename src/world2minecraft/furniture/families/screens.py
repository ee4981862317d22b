"""Screen families: screens on a wall or on a foot.

A television is dark: trapdoors are thin, but none of them is darker than brown. So it is a slab of
whole blocks, or stairs, which leave out a part of its back, if it is one block high. A white screen
of few blocks per metre is a plate of trapdoors.
"""

from typing import Literal

from world2minecraft.furniture.block_plan import Plan
from world2minecraft.furniture.box_primitives import lay_legs, part, slab
from world2minecraft.furniture.family import Family
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span
from world2minecraft.furniture.template_parameters import Look

FINE = 3.0  # Blocks per metre from which a block is thin beside a screen.


def _wall_screen(depth: float, width: float, height: float, look: Look) -> list[Part]:
    return [slab("screen", depth, width, 0.0, height)]


def _wall_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size._replace(depth=1), look)
    _lay_screen(plan, 0, "top")
    return plan.blocks


def _lay_screen(plan: Plan, bottom: int, thick: Literal["bottom", "top"] = "bottom") -> None:
    """Place a screen whose ``thick`` half is a block deep if it is one block high."""
    above = range(bottom, max(plan.size.height, bottom + 1))
    if plan.size.per_metre < FINE and plan.look.has("screen", "trapdoor"):
        plan.panel("screen", 0, plan.width, above, "back")
    elif len(above) == 1 and plan.look.has("screen", "stairs"):
        plan.stairs("screen", 0, plan.width, above, "front", thick)
    else:
        plan.put("screen", 0, plan.width, above)


WALL_SCREEN = Family(build=_wall_screen, design=_wall_blocks, roles=("screen",))


def _standing_screen(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    rise = min(look["foot_height"], height / 2)
    back = max(-x, -0.04)
    return [
        slab("foot", depth, width / 3, 0.0, rise / 3),
        part("post", (back, back + min(0.04, x)), (-y / 6, y / 6), (rise / 3, rise)),
        part("screen", (back, min(back + 0.06, x)), (-y, y), (rise, height)),
    ]


def _standing_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size._replace(depth=1), look)
    raised = 1 if size.height > 2 else 0
    _lay_screen(plan, raised)
    if raised:
        lay_legs(plan, "post", plan.middle, 1)
    return plan.blocks


STANDING_SCREEN = Family(
    build=_standing_screen,
    design=_standing_blocks,
    roles=("foot", "post", "screen"),
    parameters={"foot_height": Span(0.04, 0.12, 0.2)},
)


def _box_screen(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, front = depth / 2, width / 2, min(0.1, depth / 3)
    return [
        part("body", (-x, x - front), (-0.8 * y, 0.8 * y), (0.0, 0.9 * height)),
        part("screen", (x - front, x), (-y, y), (0.0, height)),
    ]


def _box_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    plan.put("body", plan.depth, plan.width, plan.height)
    plan.put("screen", size.depth - 1, plan.width, plan.height)
    return plan.blocks


BOX_SCREEN = Family(build=_box_screen, design=_box_blocks, roles=("body", "screen"))

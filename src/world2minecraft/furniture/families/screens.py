"""Screens: on a wall, or on a foot."""

from world2minecraft.furniture.family import Family
from world2minecraft.furniture.look import Look
from world2minecraft.furniture.plan import Plan
from world2minecraft.furniture.shapes import part, slab
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span


def _wall_screen(depth: float, width: float, height: float, look: Look) -> list[Part]:
    return [slab("screen", depth, width, 0.0, height)]


def _wall_screen_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size._replace(depth=1), look)
    plan.put("screen", plan.depth, plan.width, plan.height)
    return plan.blocks


WALL_SCREEN = Family(build=_wall_screen, design=_wall_screen_blocks, roles=("screen",))


def _standing_screen(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    rise = min(look["foot_height"], height / 2)
    back = max(-x, -0.04)
    return [
        slab("foot", depth, width / 3, 0.0, rise / 3),
        part("post", (back, back + min(0.04, x)), (-y / 6, y / 6), (rise / 3, rise)),
        part("screen", (back, min(back + 0.06, x)), (-y, y), (rise, height)),
    ]


STANDING_SCREEN = Family(
    build=_standing_screen,
    design=_wall_screen_blocks,
    roles=("foot", "post", "screen"),
    parameters={"foot_height": Span(0.04, 0.12, 0.2)},
)

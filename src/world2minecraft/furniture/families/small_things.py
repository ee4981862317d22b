"""Lamps, plants and whatever fills a box."""

from world2minecraft.furniture.family import Family
from world2minecraft.furniture.look import Look
from world2minecraft.furniture.plan import Plan
from world2minecraft.furniture.shapes import column, slab
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span


def _lamp(depth: float, width: float, height: float, look: Look) -> list[Part]:
    shade = height * (1 - look["shade_share"])
    foot = min(0.04, shade / 4)
    return [
        slab("foot", 0.7 * depth, 0.7 * width, 0.0, foot),
        column("pole", min(0.05, depth, width), foot, shade),
        slab("shade", depth, width, shade, height),
    ]


def _lamp_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    top = size.height - 1
    plan.put("pole", 0, 0, range(top), "fence")
    plan.put_state("shade", "minecraft:lantern[hanging=false]", 0, 0, top)
    return plan.blocks


LAMP = Family(
    build=_lamp,
    design=_lamp_blocks,
    roles=("foot", "pole", "shade"),
    parameters={"shade_share": Span(0.15, 0.22, 0.5)},
)


def _plant(depth: float, width: float, height: float, look: Look) -> list[Part]:
    pot = height * look["pot_share"]
    crown = pot + 0.15 * height
    return [
        slab("pot", 0.6 * depth, 0.6 * width, 0.0, pot),
        column("stem", min(0.06, depth, width), pot, crown),
        slab("leaves", depth, width, crown, height),
    ]


def _plant_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.height == 1:
        plan.put_state("leaves", "minecraft:potted_fern", 0, 0, 0)
        return plan.blocks
    plan.put("pot", 0, 0, 0)
    leaves = "minecraft:azalea_leaves[distance=7,persistent=true,waterlogged=false]"
    plan.put_state("leaves", leaves, 0, 0, range(1, size.height))
    return plan.blocks


PLANT = Family(
    build=_plant,
    design=_plant_blocks,
    roles=("pot", "stem", "leaves"),
    parameters={"pot_share": Span(0.15, 0.3, 0.45)},
)


def _box(depth: float, width: float, height: float, look: Look) -> list[Part]:
    return [slab("body", depth, width, 0.0, height)]


def _box_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    plan.put("body", plan.depth, plan.width, plan.height)
    return plan.blocks


BOX = Family(build=_box, design=_box_blocks, roles=("body",))

"""Beds for one, for two, and one over another."""

from world2minecraft.furniture.family import Family
from world2minecraft.furniture.look import Look
from world2minecraft.furniture.plan import Plan
from world2minecraft.furniture.shapes import backrest, legs, part, slab
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span

MATTRESS = {"mattress_height": Span(0.3, 0.5, 0.7)}


def _bedstead(pillows: tuple[tuple[float, float], ...]):
    """Return the parts of a bed whose pillows lie at these shares of its width from its middle."""

    def build(depth: float, width: float, height: float, look: Look) -> list[Part]:
        top = min(look["mattress_height"], max(height - 0.1, height / 2))
        head = (0.08 - depth / 2, 0.45 - depth / 2)
        return [
            slab("mattress", depth, width, 0.0, top),
            backrest(depth, width, top, height, 0.08),
            *(
                part("pillow", head, (low * width, high * width), (top, top + 0.1))
                for low, high in pillows
            ),
        ]

    return build


def _bed_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.depth > 2:
        plan.put("mattress", plan.depth, plan.width, 0)
        plan.put("pillow", 0, plan.width, 0)
        return plan.blocks
    _beds(plan, 0)
    return plan.blocks


def _beds(plan: Plan, k: int) -> None:
    """Lay beds side by side, as the game has them, their heads at the back."""
    for i, half in enumerate(("head", "foot")):
        plan.put("mattress", i, plan.width, k, "bed", facing="west", occupied="false", part=half)


SINGLE_BED = Family(
    build=_bedstead(((-1 / 3, 1 / 3),)),
    design=_bed_blocks,
    roles=("mattress", "back", "pillow"),
    parameters=MATTRESS,
)
DOUBLE_BED = Family(
    build=_bedstead(((-0.45, -0.05), (0.05, 0.45))),
    design=_bed_blocks,
    roles=("mattress", "back", "pillow"),
    parameters=MATTRESS,
)


def _bunk_bed(depth: float, width: float, height: float, look: Look) -> list[Part]:
    upper = min(look["upper_height"], height)
    return [
        *legs(depth, width, height, 0.08),
        slab("mattress", depth, width, 0.2, 0.5),
        slab("mattress", depth, width, upper - 0.25, upper),
    ]


BUNK_BED = Family(
    build=_bunk_bed,
    design=_bed_blocks,
    roles=("leg", "mattress", "pillow"),
    parameters={"upper_height": Span(1.2, 1.45, 1.7)},
)

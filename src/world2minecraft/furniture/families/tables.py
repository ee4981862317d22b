"""Tables: on four legs, round ones on a post, low ones and desks."""

from world2minecraft.furniture.family import Family
from world2minecraft.furniture.look import Look
from world2minecraft.furniture.plan import Plan, level
from world2minecraft.furniture.shapes import arms, backrest, column, legs, part, slab
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span

CUT = 0.3  # 1 - 1/sqrt(2): where the sides of an octagon in a unit square begin.
THICK = {"top_thickness": Span(0.03, 0.04, 0.16)}


def _four_legged(depth: float, width: float, height: float, look: Look) -> list[Part]:
    under = max(height - look["top_thickness"], height / 2)
    return [*legs(depth, width, under, 0.06), slab("top", depth, width, under, height)]


def _table_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    layer, shape = level(size.exact[2])
    if shape == "plate":
        plan.plate("top", plan.depth, plan.width, layer, "bottom")
    else:
        half = "bottom" if shape == "slab" else "top"
        plan.put("top", plan.depth, plan.width, layer, "slab", type=half)
    for i, j in plan.corners:
        plan.put("leg", i, j, range(layer), "fence")
    return plan.blocks


TABLE = Family(build=_four_legged, design=_table_blocks, roles=("leg", "top"), parameters=THICK)
LOW_TABLE = Family(build=_four_legged, design=_table_blocks, roles=("leg", "top"), parameters=THICK)


def _round_table(depth: float, width: float, height: float, look: Look) -> list[Part]:
    under = max(height - look["top_thickness"], height / 2)
    x, y = depth / 2, width / 2
    cut_x, cut_y = x * (1 - CUT), y * (1 - CUT)
    tall, foot = (under, height), min(0.05, under / 4)
    middle_x, middle_y = (x + cut_x) / 2, (y + cut_y) / 2
    return [
        slab("foot", depth / 2, width / 2, 0.0, foot),
        column("post", min(0.12, depth, width), foot, under),
        part("top", (-x, x), (-cut_y / 2, cut_y / 2), tall),
        part("top", (-middle_x, middle_x), (-middle_y, middle_y), tall),
        part("top", (-cut_x / 2, cut_x / 2), (-y, y), tall),
    ]


ROUND_TABLE = Family(
    build=_round_table,
    design=_table_blocks,
    roles=("foot", "leg", "post", "top"),
    parameters=THICK,
)


def _desk(depth: float, width: float, height: float, look: Look) -> list[Part]:
    under = max(height - 0.05, height / 2)
    drawers = arms(depth, width, 0.0, under, look["side_width"])
    panel = backrest(depth, width, under / 2, under, 0.04)
    return [*drawers, panel._replace(role="panel"), slab("top", depth, width, under, height)]


DESK = Family(
    build=_desk,
    design=_table_blocks,
    roles=("arm", "leg", "panel", "top"),
    parameters={"side_width": Span(0.04, 0.08, 0.4)},
)

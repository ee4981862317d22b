"""Lamp families: standing, hanging and wall lamps.

A shade wider than a block is a luminous block with four plates. No block needs the support of a
wall, and hanging lamps are supported by their own chain.
"""

from world2minecraft.furniture.block_plan import Plan, Side
from world2minecraft.furniture.box_primitives import column, part, slab
from world2minecraft.furniture.family import Family
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span
from world2minecraft.furniture.template_parameters import Look

FINE = 3.0  # Blocks per metre from which a shade is wider than a block.
HANGING, STANDING = "minecraft:lantern[hanging=true]", "minecraft:lantern[hanging=false]"
AROUND: dict[Side, tuple[int, int]] = {
    "back": (1, 0),
    "front": (-1, 0),
    "right": (0, 1),
    "left": (0, -1),
}


def shade(plan: Plan, i: int, j: int, rows: range) -> None:
    """Place a luminous column with a plate at each of its sides."""
    plan.put("light", i, j, rows)
    for side, (di, dj) in AROUND.items():
        plan.panel("shade", i + di, j + dj, rows, side)


def _lamp(depth: float, width: float, height: float, look: Look) -> list[Part]:
    bottom = height * (1 - look["shade_share"])
    foot = min(0.04, bottom / 4)
    return [
        slab("foot", 0.7 * depth, 0.7 * width, 0.0, foot),
        column("pole", min(0.05, depth, width), foot, bottom),
        slab("shade", depth, width, bottom, height),
    ]


def _lamp_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    if size.per_metre < FINE:
        plan.put("pole", 0, 0, range(top), "fence")
        if top > 1:
            plan.put("light", 0, 0, top)
        else:
            plan.put_state("light", STANDING, 0, 0, top)
        return plan.blocks
    tall = max(1, min(round(look["shade_share"] * size.height), top))
    plan.put("pole", 1, 1, range(size.height - tall), "fence")
    shade(plan, 1, 1, range(size.height - tall, size.height))
    return plan.blocks


LAMP = Family(
    build=_lamp,
    design=_lamp_blocks,
    roles=("foot", "pole", "shade", "light"),
    parameters={"shade_share": Span(0.15, 0.22, 0.5)},
)


def _desk_lamp(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    return [
        part("foot", (-x, 0.0), (-y, y), (0.0, 0.03)),
        part("pole", (-x, 0.03 - x), (-0.015, 0.015), (0.03, height - 0.06)),
        part("shade", (-x, x), (-0.05, 0.05), (height - 0.06, height)),
    ]


def _desk_lamp_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    if top == 0:
        plan.put_state("shade", STANDING, 0, 0, 0)
        return plan.blocks
    plan.put("pole", 0, 0, range(top), "bars")
    plan.put_state("shade", "minecraft:end_rod[facing=east]", 0, 0, top)
    return plan.blocks


DESK_LAMP = Family(build=_desk_lamp, design=_desk_lamp_blocks, roles=("foot", "pole", "shade"))


def _arc_lamp(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, thin = depth / 2, width / 2, 0.02
    return [
        part("foot", (-x, 0.3 - x), (-y, y), (0.0, 0.05)),
        part("pole", (-x, 2 * thin - x), (-thin, thin), (0.05, height)),
        part("pole", (2 * thin - x, x), (-thin, thin), (height - 2 * thin, height)),
        part("shade", (x - 0.3, x), (-y, y), (0.72 * height, height - 2 * thin)),
    ]


def _arc_lamp_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    if size.depth == 1:
        plan.put("pole", 0, 0, range(top), "fence")
        plan.put_state("shade", STANDING, 0, 0, top)
        return plan.blocks
    out = size.depth - 1
    plan.put("pole", 0, 0, plan.height, "fence")
    plan.put("pole", range(1, size.depth), 0, top, "fence")
    plan.put_state("shade", HANGING, out, 0, top - 1)
    if size.per_metre >= FINE:
        plan.put("foot", 0, 0, 0)
        plan.put("foot", 1, 0, 0, "slab", type="bottom")
    return plan.blocks


ARC_LAMP = Family(build=_arc_lamp, design=_arc_lamp_blocks, roles=("foot", "pole", "shade"))


def _pendant(depth: float, width: float, height: float, look: Look) -> list[Part]:
    bottom = min(0.4, 0.6 * height)
    return [
        slab("shade", depth, width, 0.0, bottom),
        column("chain", 0.03, bottom, height),
    ]


def _pendant_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.height == 1:
        plan.put_state("light", HANGING, 0, 0, 0)
    elif look.option("shade") == "plates" and size.per_metre >= FINE:
        shade(plan, 1, 1, range(1))
        plan.put("chain", 1, 1, range(1, size.height), "chain", axis="y")
    else:
        if look.option("shade") == "globe":
            plan.put("light", 0, 0, 0)
        else:
            plan.put_state("light", HANGING, 0, 0, 0)
        plan.put("chain", 0, 0, range(1, size.height), "chain", axis="y")
    return plan.blocks


PENDANT = Family(
    build=_pendant,
    design=_pendant_blocks,
    roles=("shade", "light", "chain"),
    options={"shade": ("plates", "globe", "lantern")},
)


def _chandelier(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, arm = depth / 2, width / 2, 0.03
    level = min(0.25, 0.5 * height)
    beams = [
        part("arm", (-x, x), (-arm, arm), (level, level + 2 * arm)),
        part("arm", (-arm, arm), (-y, y), (level, level + 2 * arm)),
    ]
    ends = [(arm - x, 0.0), (x - arm, 0.0), (0.0, arm - y), (0.0, y - arm)]
    lights = [part("light", (i - arm, i + arm), (j - arm, j + arm), (0.0, level)) for i, j in ends]
    return [*beams, *lights, column("chain", 0.03, level + 2 * arm, height)]


def _chandelier_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.height == 1 or min(size.depth, size.width) < 2:
        plan.put_state("light", HANGING, 0, 0, 0)
        plan.put("chain", 0, 0, range(1, size.height), "chain", axis="y")
        return plan.blocks
    reach = 1 if size.per_metre < FINE else 2
    ends = [(0, reach), (2 * reach, reach), (reach, 0), (reach, 2 * reach)]
    for n in range(2 * reach + 1):
        plan.put("arm", n, reach, 1, "fence")
        plan.put("arm", reach, n, 1, "fence")
    for i, j in ends:
        plan.put_state("light", HANGING, i, j, 0)
        if size.per_metre >= FINE:
            plan.put("candle", i, j, 2, lit="true", candles="1")
    plan.put("chain", reach, reach, range(2, max(size.height, 3)), "chain", axis="y")
    return plan.blocks


CHANDELIER = Family(
    build=_chandelier, design=_chandelier_blocks, roles=("arm", "light", "chain", "candle")
)


def _wall_lamp(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    return [
        part("arm", (-x, 0.02 - x), (-y, y), (0.0, height)),
        part("arm", (0.02 - x, x), (-0.02, 0.02), (0.8 * height, 0.9 * height)),
        part("light", (0.0, x), (-0.8 * y, 0.8 * y), (0.2 * height, 0.8 * height)),
    ]


def _wall_lamp_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Place a tube of light at few blocks per metre, and a light behind a plate at many."""
    plan = Plan(size, look)
    if size.per_metre < FINE:
        plan.put_state("light", "minecraft:end_rod[facing=up]", 0, 0, 0)
        return plan.blocks
    plan.put("light", 0, 0, 0)
    plan.panel("arm", 1, 0, 0, "back")
    return plan.blocks


WALL_LAMP = Family(build=_wall_lamp, design=_wall_lamp_blocks, roles=("arm", "light"))


def _glow(depth: float, width: float, height: float, look: Look) -> list[Part]:
    rim = min(0.03, height / 4)
    if look.option("hangs") == "yes":
        return [
            slab("light", 0.9 * depth, 0.9 * width, 0.0, height - rim),
            slab("frame", depth, width, height - rim, height),
        ]
    return [
        slab("frame", depth, width, 0.0, rim),
        slab("light", 0.9 * depth, 0.9 * width, rim, height),
    ]


def _glow_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Place a body of light: a paper lamp on a foot, or a shade of plates under the ceiling."""
    plan = Plan(size, look)
    if look.option("hangs") == "yes":
        if size.per_metre < 1.5:
            plan.put_state("light", HANGING, 0, 0, 0)
        else:
            _ceiling_shade(plan)
        return plan.blocks
    if size.height == 1:
        plan.put_state("light", STANDING, 0, 0, 0)
        return plan.blocks
    foot = 1 if size.height > 2 else 0
    for i, j in plan.corners:
        plan.put("frame", i, j, range(foot), "fence")
    plan.put("light", plan.depth, plan.width, range(foot, size.height))
    if not foot:
        plan.put("frame", plan.depth, plan.width, 0, "fence")
    return plan.blocks


def _ceiling_shade(plan: Plan) -> None:
    """Place luminous blocks with plates on their four sides, open below."""
    depth, width = plan.size.depth, plan.size.width
    along, across = range(1, depth + 1), range(1, width + 1)
    plan.put("light", along, across, 0)
    plan.panel("frame", 0, across, 0, "front")
    plan.panel("frame", depth + 1, across, 0, "back")
    plan.panel("frame", along, 0, 0, "left")
    plan.panel("frame", along, width + 1, 0, "right")


GLOW = Family(
    build=_glow,
    design=_glow_blocks,
    roles=("frame", "light"),
    options={"hangs": ("no", "yes")},
)

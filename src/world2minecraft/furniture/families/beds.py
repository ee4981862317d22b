"""Bed families: single beds, double beds and bunk beds.

At one block per metre they are the game's own beds, side by side. At larger scales, at which those
are too short, they have a wool mattress on a frame, and a blanket in the bed's colour.
"""

from world2minecraft.furniture.block_plan import Plan
from world2minecraft.furniture.box_primitives import backrest, lay_back, legs, part, slab
from world2minecraft.furniture.family import Family
from world2minecraft.furniture.template import BlockSize, Build, LocalBlock, Part, Span
from world2minecraft.furniture.template_parameters import Look

MATTRESS = {"mattress_height": Span(0.3, 0.5, 0.7)}
FINE = 3.0  # Blocks per metre from which frame and mattress are layers of their own.
PILLOW_M = 0.45  # From the back.


def _bedstead(pillows: tuple[tuple[float, float], ...]) -> Build:
    """Return the parts of a bed whose pillows lie at these shares of its width from its middle."""

    def build(depth: float, width: float, height: float, look: Look) -> list[Part]:
        """Return the mattress, the headboard and the pillows."""
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
    if size.depth <= 2:
        _beds(plan, 0)
    elif size.per_metre < FINE:
        plan.put("mattress", plan.depth, plan.width, 0)
        plan.put("pillow", 0, plan.width, 0)
        lay_back(plan, "back", plan.width, range(1, size.height))
        _footboard(plan, 0)
    else:
        _framed(plan, 0, look["mattress_height"])
        lay_back(plan, "back", plan.width, range(_layers(plan) + 1, max(size.height, 3)))
        _pillows(plan, _layers(plan) + 1)
    return plan.blocks


def _layers(plan: Plan) -> int:
    """Return the layer of the mattress, over a frame one layer high at least."""
    return max(1, plan.layers(plan.look["mattress_height"]) - 1)


def _beds(plan: Plan, k: int) -> None:
    """Lay beds side by side, as the game has them, their heads at the back."""
    for i, half in enumerate(("head", "foot")):
        plan.put("mattress", i, plan.width, k, "bed", facing="west", occupied="false", part=half)


def _footboard(plan: Plan, k: int) -> None:
    """Stand a panel over the foot of a bed that has one."""
    if plan.look.option("foot") == "board" and plan.size.height > 1:
        plan.panel("back", plan.size.depth - 1, plan.width, k + 1, "front")


def _framed(plan: Plan, base: int, mattress_m: float) -> None:
    """Lay a frame of upper slabs on feet, and a mattress with a white head on it."""
    layer = base + max(1, plan.layers(mattress_m) - 1)
    head = max(1, plan.layers(PILLOW_M))
    if plan.look.option("frame") == "box":
        plan.put("frame", plan.depth, plan.width, range(base, layer))
    else:
        plan.slab("frame", plan.depth, plan.width, layer - 1, "top")
        for i, j in plan.corners:
            plan.put("frame", i, j, range(base, layer))
    plan.put("mattress", plan.depth, plan.width, layer)
    plan.put("pillow", range(head), plan.width, layer)
    _footboard(plan, layer)


def _pillows(plan: Plan, k: int) -> None:
    """Lay pillows before the headboard: one in the middle of a narrow bed, two on a wide one."""
    if plan.size.depth < 3 or not plan.look.has("pillow", "carpet"):
        return
    last = plan.size.width - 1
    across = range(1, last) if last < 5 else [j for j in plan.width if j not in (0, last)]
    gap = {last // 2, (last + 1) // 2} if last >= 5 else set()
    plan.put("pillow", 1, [j for j in across if j not in gap], k, "carpet")


BED_OPTIONS = {"foot": ("none", "board"), "frame": ("legs", "box")}
BED_ROLES = ("mattress", "back", "pillow", "frame")
SINGLE_BED = Family(
    build=_bedstead(((-1 / 3, 1 / 3),)),
    design=_bed_blocks,
    roles=BED_ROLES,
    parameters=MATTRESS,
    options=BED_OPTIONS,
)
DOUBLE_BED = Family(
    build=_bedstead(((-0.45, -0.05), (0.05, 0.45))),
    design=_bed_blocks,
    roles=BED_ROLES,
    parameters=MATTRESS,
    options=BED_OPTIONS,
)


def _bunk_bed(depth: float, width: float, height: float, look: Look) -> list[Part]:
    upper = min(look["upper_height"], height)
    return [
        *legs(depth, width, height, 0.08),
        slab("mattress", depth, width, 0.2, 0.5),
        slab("mattress", depth, width, upper - 0.25, upper),
    ]


def _bunk_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    upper = max(1, round(look["upper_height"] * size.per_metre) - 1)
    if size.depth <= 2:
        _beds(plan, 0)
        _beds(plan, max(1, size.height - 1))
        return plan.blocks
    fine = size.per_metre >= FINE
    lower = 1 if fine else 0
    for k in (lower, upper):
        plan.put("mattress", plan.depth, plan.width, k)
        plan.put("pillow", range(max(1, plan.layers(PILLOW_M))), plan.width, k)
        if fine:
            plan.slab("leg", plan.depth, plan.width, k - 1, "top")
    for i, j in plan.corners:  # The lower bed gives way to its posts.
        plan.put("leg", i, j, range(max(size.height, upper + 2) if fine else upper), "fence")
    for j in (0, size.width - 1) if fine else ():
        plan.put("leg", range(1, size.depth - 1), j, upper + 1, "fence")
    _ladder(plan, lower + 1, upper)
    return plan.blocks


def _ladder(plan: Plan, low: int, high: int) -> None:
    """Stand panels as a ladder at the front, between the posts."""
    if plan.size.per_metre >= FINE and plan.size.width > 2:
        plan.panel("leg", plan.size.depth - 1, plan.size.width // 2, range(low, high - 1), "front")


BUNK_BED = Family(
    build=_bunk_bed,
    design=_bunk_blocks,
    roles=("leg", "mattress", "pillow"),
    parameters={"upper_height": Span(1.2, 1.45, 1.7)},
)


def _poster_bed(depth: float, width: float, height: float, look: Look) -> list[Part]:
    top = min(look["mattress_height"], height / 2)
    posts = legs(depth, width, height - 0.08, 0.1)
    return [
        slab("mattress", depth, width, 0.0, top),
        *(post._replace(role="back") for post in posts),
        slab("canopy", depth, width, height - 0.08, height),
    ]


def _poster_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    top = max(size.height - 1, 1)
    if size.depth <= 2:
        _beds(plan, 0)
        for i, j in plan.corners:
            plan.put("back", i, j, 1, "fence")
        plan.put("canopy", plan.depth, plan.width, 2)
        return plan.blocks
    fine = size.per_metre >= FINE
    layer = _layers(plan) if fine else 0
    if fine:
        _framed(plan, 0, look["mattress_height"])
    else:
        plan.put("mattress", plan.depth, plan.width, 0)
        plan.put("pillow", 0, plan.width, 0)
    for i, j in plan.corners:
        plan.put("back", i, j, range(layer + 1, top), "fence")
    plan.slab("back", plan.depth, plan.width, top)
    plan.put("canopy", plan.depth, plan.width, top)
    plan.drop(range(1, size.depth - 1), range(1, size.width - 1), top)
    return plan.blocks


POSTER_BED = Family(
    build=_poster_bed,
    design=_poster_blocks,
    roles=("mattress", "back", "pillow", "frame", "canopy"),
    parameters=MATTRESS,
    options=BED_OPTIONS,
)


def _crib(depth: float, width: float, height: float, look: Look) -> list[Part]:
    base = min(look["mattress_height"], height / 2)
    thin = 0.04
    x, y = depth / 2, width / 2
    return [
        slab("mattress", depth, width, 0.0, base),
        part("rail", (-x, thin - x), (-y, y), (base, height)),
        part("rail", (x - thin, x), (-y, y), (base, height)),
        part("rail", (-x, x), (-y, thin - y), (base, height)),
        part("rail", (-x, x), (y - thin, y), (base, height)),
    ]


def _crib_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.depth <= 2 and size.per_metre < 1.5:
        _beds(plan, 0)
        return plan.blocks
    base = max(1, plan.layers(look["mattress_height"]))
    if min(size.depth, size.width) == 1 and look.has("rail", "trapdoor"):
        _rail_cot(plan, base)
        return plan.blocks
    plan.put("mattress", plan.depth, plan.width, range(base - 1, base))
    for i, j in plan.corners:
        plan.put("rail", i, j, range(base), "fence")
    top = range(base, max(size.height, base + 1))
    plan.put("rail", plan.depth, plan.width, top, "fence")
    inner = plan.width if size.width < 3 else range(1, size.width - 1)
    plan.drop(range(1, size.depth - 1), inner, top)
    return plan.blocks


def _rail_cot(plan: Plan, base: int) -> None:
    """Place a mattress one block wide between four rails of plates."""
    along, across = range(1, plan.size.depth + 1), range(1, plan.size.width + 1)
    plan.put("mattress", along, across, range(base - 1, base))
    rows = range(max(plan.size.height, base + 1))
    plan.panel("rail", 0, across, rows, "front")
    plan.panel("rail", plan.size.depth + 1, across, rows, "back")
    plan.panel("rail", along, 0, rows, "left")
    plan.panel("rail", along, plan.size.width + 1, rows, "right")


CRIB = Family(
    build=_crib,
    design=_crib_blocks,
    roles=("mattress", "rail"),
    parameters={"mattress_height": Span(0.2, 0.35, 0.6)},
)

"""Table families: tables on four legs, round pedestal tables, low tables and desks.

A top thinner than half a block consists of trapdoors, or of carpet on fences. A table no higher
than a block is a trestle of upside-down stairs.
"""

from world2minecraft.furniture.block_plan import Plan
from world2minecraft.furniture.box_primitives import (
    arms,
    backrest,
    column,
    lay_legs,
    lay_plate,
    lay_trestle,
    legs,
    part,
    slab,
)
from world2minecraft.furniture.family import Family
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span
from world2minecraft.furniture.template_parameters import Look

CUT = 0.3  # 1 - 1/sqrt(2): where the sides of an octagon in a unit square begin.
THICK = {"top_thickness": Span(0.03, 0.04, 0.16)}
LOW = 1.2  # Blocks: a table up to this height has one layer.
TOPS = ("trapdoor", "slab")


def _four_legged(depth: float, width: float, height: float, look: Look) -> list[Part]:
    under = max(height - look["top_thickness"], height / 2)
    return [*legs(depth, width, under, 0.06), slab("top", depth, width, under, height)]


def _table_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if _is_low(plan):
        return plan.blocks
    if _is_braced(plan):
        return plan.blocks
    layer = lay_plate(plan, "top", plan.depth, plan.width, size.exact[2], _tops(look))
    if look.option("legs") == "trestle" and size.width > 3:
        feet = [(i, j) for i in (0, size.depth - 1) for j in (1, size.width - 2)]
    else:
        feet = plan.corners
    if size.depth == size.width == 2 and look.has("leg", "trapdoor"):
        plan.panel("leg", plan.depth, 0, range(layer), "right")  # Four fences would be a lattice.
        plan.panel("leg", plan.depth, 1, range(layer), "left")
    else:
        lay_legs(plan, "leg", feet, layer)
    return plan.blocks


def _is_braced(plan: Plan) -> bool:
    """Lay a table whose top ends level with a block, with braces at its corners; whether it does.

    A plate in the lower half of a block would leave no room for what stands on the table, and one
    of trapdoors would be of another colour than the braces.
    """
    layer = round(plan.size.exact[2]) - 1
    fine = abs(plan.size.exact[2] - layer - 1) <= 0.3 and min(plan.size[:2]) > 2 and layer > 1
    if not fine or not plan.look.has("top", "slab", "stairs"):
        return False
    plan.slab("top", plan.depth, plan.width, layer, "top")
    last = plan.size.width - 1
    for i, j in plan.corners:
        plan.stairs("top", i, j, layer, "left" if j == last else "right", "top")
    lay_legs(plan, "leg", plan.corners, layer)
    return True


def _tops(look: Look) -> tuple[str, ...]:
    """Return the shapes that a top may have: a whole block where there is nothing thinner."""
    return tuple(shape for shape in TOPS if look.has("top", shape)) or ("full",)


def _is_low(plan: Plan) -> bool:
    """Place a table no higher or wider than a block, and return whether it is one."""
    look, height = plan.look, plan.size.exact[2]
    if height > LOW:
        return False
    if plan.size.width > 1 and look.has("top", "stairs", "slab") and height > 0.6:
        lay_trestle(plan)
    elif height <= 0.6 and look.has("top", "slab"):
        plan.slab("top", plan.depth, plan.width, 0)
    else:
        shapes = [shape for shape in ("plate", "carpet", "trapdoor") if look.has("top", shape)]
        lay_legs(plan, "leg", plan.corners, 1)
        if shapes[:1] == ["plate"] and plan.size.depth == plan.size.width == 1:
            plan.put("top", 0, 0, 1, "plate", powered="false")
        elif "trapdoor" in shapes:
            plan.plate("top", plan.depth, plan.width, 1, "bottom")
        elif shapes:
            plan.put("top", plan.depth, plan.width, 1, shapes[0])
        else:
            plan.put("top", plan.depth, plan.width, 0)
    return True


LEGS = {"legs": ("corners", "trestle")}
TABLE = Family(
    build=_four_legged,
    design=_table_blocks,
    roles=("leg", "top"),
    parameters=THICK,
    options=LEGS,
)
LOW_TABLE = Family(
    build=_four_legged,
    design=_table_blocks,
    roles=("leg", "top"),
    parameters=THICK,
    options=LEGS,
)


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


def _round_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.exact[2] <= LOW:
        lay_legs(plan, "post", plan.middle, 1)
        _disc(plan, 1.1)
        return plan.blocks
    layer = _disc(plan, size.exact[2])
    lay_legs(plan, "post", plan.middle, layer)
    return plan.blocks


def _disc(plan: Plan, height: float) -> int:
    """Lay a round top: the cells whose middles lie in its ellipse; return its layer."""
    deep, wide = plan.size.depth, plan.size.width
    layer = 0
    for i in plan.depth:
        x = (2 * i + 1 - deep) / deep
        row = [j for j in plan.width if x**2 + ((2 * j + 1 - wide) / wide) ** 2 <= 1.05]
        if row:
            layer = lay_plate(plan, "top", i, row, height, _tops(plan.look))
    return layer


ROUND_TABLE = Family(
    build=_round_table,
    design=_round_blocks,
    roles=("foot", "post", "top"),
    parameters=THICK,
)


def _desk(depth: float, width: float, height: float, look: Look) -> list[Part]:
    under = max(height - 0.05, height / 2)
    drawers = arms(depth, width, 0.0, under, look["side_width"])
    panel = backrest(depth, width, under / 2, under, 0.04)
    return [*drawers, panel._replace(role="panel"), slab("top", depth, width, under, height)]


def _desk_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.exact[2] <= LOW and look.has("top", "stairs", "slab"):
        lay_trestle(plan)
        if size.width == 1:
            plan.stairs("top", plan.depth, 0, 0, "back", "top")
        return plan.blocks
    tall = max(size.exact[2], 1.1)
    layer = lay_plate(plan, "top", plan.depth, plan.width, tall, _tops(look))
    last = size.width - 1
    if not last:
        lay_legs(plan, "arm", plan.corners, layer)
    elif not look.has("arm", "trapdoor"):
        plan.put("arm", plan.depth, (0, last), range(layer))
    else:
        plan.panel("arm", plan.depth, 0, range(layer), "right")
        plan.panel("arm", plan.depth, last, range(layer), "left")
    if last > 1 and look.has("panel", "trapdoor"):
        plan.panel("panel", 0, range(1, last), range(layer // 2, layer), "back")
    _drawers(plan, layer)
    return plan.blocks


def _drawers(plan: Plan, layer: int) -> None:
    """Stand drawers under one end or both, as wide as the sides of the desk or a quarter metre."""
    drawers = plan.look.option("drawers")
    wide = max(1, plan.layers(0.35))
    last = plan.size.width - 1
    if drawers != "none" and last > wide:
        ends = [range(last + 1 - wide, last + 1)]
        if drawers == "both" and last > 2 * wide:
            ends.append(range(wide))
        for across in ends:
            plan.put("arm", plan.depth, across, range(layer))
            front = "minecraft:barrel[facing=east,open=false]"
            plan.put_state("drawer", front, plan.size.depth - 1, across, range(layer))


DESK = Family(
    build=_desk,
    design=_desk_blocks,
    roles=("arm", "panel", "top", "drawer"),
    parameters={"side_width": Span(0.04, 0.08, 0.4)},
    options={"drawers": ("none", "left", "both")},
)


def _game_table(depth: float, width: float, height: float, look: Look) -> list[Part]:
    under = max(height - 0.2, height / 2)
    x, y, rim = depth / 2, width / 2, min(0.1, depth / 6)
    return [
        *legs(depth, width, under, 0.14),
        slab("cloth", depth, width, under, max(height - 0.06, under + 0.01)),
        part("rim", (-x, rim - x), (-y, y), (under, height)),
        part("rim", (x - rim, x), (-y, y), (under, height)),
        part("rim", (-x, x), (-y, rim - y), (under, height)),
        part("rim", (-x, x), (y - rim, y), (under, height)),
    ]


def _game_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    top = max(0, round(size.exact[2]) - 1)
    if size.depth > 2 and size.width > 2:
        plan.put("rim", plan.depth, plan.width, top)
        plan.put("cloth", range(1, size.depth - 1), range(1, size.width - 1), top)
    else:
        plan.put("rim", plan.depth, plan.width, top)
        plan.put("cloth", plan.depth, plan.width, top + 1, "carpet")
    lay_legs(plan, "leg", plan.corners, top)
    return plan.blocks


GAME_TABLE = Family(build=_game_table, design=_game_blocks, roles=("leg", "rim", "cloth"))


def _net_table(depth: float, width: float, height: float, look: Look) -> list[Part]:
    top = height - 0.15
    under = top - 0.04
    return [
        *legs(depth, width, under, 0.08),
        slab("top", depth, width, under, top),
        part("net", (-depth / 2, depth / 2), (-0.02, 0.02), (top, height)),
    ]


def _net_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    top = max(0, round(size.exact[2] - 0.15 * size.per_metre) - 1)
    plan.put("top", plan.depth, plan.width, top)
    middle = sorted({(size.width - 1) // 2, size.width // 2})
    plan.put("net", plan.depth, middle[0], top + 1, "pane")
    if size.width > 2:
        lay_legs(plan, "leg", plan.corners, top)
    return plan.blocks


NET_TABLE = Family(build=_net_table, design=_net_blocks, roles=("leg", "top", "net"))


def _picnic_table(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, bench = depth / 2, width / 2, min(0.28, depth / 4)
    seat, under = 0.6 * height, height - 0.05
    inner = (bench - x, x - bench)
    return [
        part("seat", (-x, bench - x), (-y, y), (seat - 0.05, seat)),
        part("seat", (x - bench, x), (-y, y), (seat - 0.05, seat)),
        part("top", (0.85 * inner[0], 0.85 * inner[1]), (-y, y), (under, height)),
        part("leg", (-x, x), (0.1 - y, 0.2 - y), (seat - 0.15, seat - 0.05)),
        part("leg", (-x, x), (y - 0.2, y - 0.1), (seat - 0.15, seat - 0.05)),
        part("leg", (0.5 * inner[0], 0.5 * inner[1]), (0.1 - y, 0.2 - y), (0.0, under)),
        part("leg", (0.5 * inner[0], 0.5 * inner[1]), (y - 0.2, y - 0.1), (0.0, under)),
    ]


def _picnic_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    last = size.depth - 1
    if last < 2:
        lay_trestle(plan)
        return plan.blocks
    bench = max(1, plan.layers(0.28))
    seats = (*range(bench), *range(size.depth - bench, size.depth))
    inner = [i for i in plan.depth if i not in seats]
    low = lay_plate(plan, "seat", seats, plan.width, 0.6 * size.exact[2], ("slab",))
    high = lay_plate(plan, "top", inner, plan.width, size.exact[2], ("slab", "trapdoor"))
    ends = sorted({0, size.width - 1})
    lay_legs(plan, "leg", [(i, j) for i in (0, last) for j in ends], low)
    lay_legs(plan, "leg", [(i, j) for i in (inner[0], inner[-1]) for j in ends], high)
    return plan.blocks


PICNIC_TABLE = Family(build=_picnic_table, design=_picnic_blocks, roles=("leg", "seat", "top"))

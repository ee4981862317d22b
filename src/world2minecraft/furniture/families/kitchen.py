"""Kitchen furniture families: counters, sinks, cookers, fridges, hoods.

A worktop consists of upside-down stairs: half a block of stone that overhangs the doors below it.
"""

from world2minecraft.furniture.block_plan import Numbers, Plan
from world2minecraft.furniture.box_primitives import part, slab
from world2minecraft.furniture.families.fronts import (
    Body,
    body_of,
    door_columns,
    faces,
    handles,
    panels,
)
from world2minecraft.furniture.family import Family
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span
from world2minecraft.furniture.template_parameters import Look

LIP_M, TOP_M = 0.03, 0.04
FINE = 3.0  # Blocks per metre from which a unit is two blocks wide.


def _counter(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    under = max(height - TOP_M, height / 2)
    return [
        part("body", (-x, max(x - LIP_M, 0.0)), (-y, y), (0.0, under)),
        slab("top", depth, width, under, height),
    ]


def _counter_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    _base(plan, size.height)
    return plan.blocks


def _base(plan: Plan, height: int) -> Body:
    """Lay base cupboards under a worktop, ``height`` blocks in all."""
    body = body_of(plan.size)
    if height == 1:
        faces(plan, "body", range(body.depth), plan.width, 0)
        return body
    plan.put("body", range(body.depth), plan.width, range(height - 1))
    plan.put("top", range(body.depth), plan.width, height - 1)
    if plan.look.has("top", "stairs"):
        plan.stairs("top", body.face, plan.width, height - 1, "back", "top")
    columns = door_columns(plan.size.width, plan.size.per_metre)
    handles(plan, body, "handle", columns, max(height - 2, 0))
    return body


COUNTER = Family(build=_counter, design=_counter_blocks, roles=("body", "top", "handle"))


def _sink(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    top = min(look["worktop"], 0.92 * height)
    basin = min(0.4 * depth, 0.3)
    half = min(0.25, 0.8 * y)
    rim = (top - TOP_M, top)
    return [
        part("body", (-x, max(x - LIP_M, 0.0)), (-y, y), (0.0, top - 0.2)),
        part("body", (-x, max(x - LIP_M, 0.0)), (-y, -half), (top - 0.2, rim[0])),
        part("body", (-x, max(x - LIP_M, 0.0)), (half, y), (top - 0.2, rim[0])),
        part("body", (basin / 2 + 0.02, max(x - LIP_M, basin / 2 + 0.03)), (-half, half),
             (top - 0.2, rim[0])),
        part("top", (-x, x), (-y, -half), rim),
        part("top", (-x, x), (half, y), rim),
        part("top", (-x, -basin / 2), (-half, half), rim),
        part("top", (basin / 2, x), (-half, half), rim),
        part("tap", (-x + 0.06, -x + 0.1), (-0.02, 0.02), (rim[1], height)),
        part("tap", (-x + 0.1, -basin / 4), (-0.02, 0.02), (height - 0.04, height)),
    ]  # fmt: skip


def _sink_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    layers = max(1, min(plan.layers(look["worktop"]), size.height))
    body = _base(plan, layers)
    middle = (size.width - 1) // 2
    wide = 2 if size.per_metre >= FINE and size.width >= 4 else 1
    basin = range(middle, middle + wide)
    plan.put("basin", body.face, basin, layers - 1, level="3")
    if body.depth > 1:
        plan.put("tap", body.face - 1, middle, layers)
    return plan.blocks


SINK = Family(
    build=_sink,
    design=_sink_blocks,
    roles=("body", "top", "handle", "basin", "tap"),
    parameters={"worktop": Span(0.8, 0.9, 0.95)},
)


def _stove(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    top, ring = height - 0.01, min(depth, width) / 6
    found = [
        part("body", (-x, x - LIP_M), (-y, y), (0.0, top - TOP_M)),
        part("door", (x - LIP_M, x - 0.01), (0.03 - y, y - 0.03), (0.15, 0.6 * height)),
        part("handle", (x - 0.01, x), (0.08 - y, y - 0.08), (0.55 * height, 0.6 * height)),
        slab("top", depth, width, top - TOP_M, top),
    ]
    rings = [(i * x / 2, j * y / 2) for i in (-1, 1) for j in (-1, 1)]
    return found + [
        part("ring", (i - ring, i + ring), (j - ring, j + ring), (top, height)) for i, j in rings
    ]


def _stove_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, body = Plan(size, look), body_of(size)
    solid, top = range(body.depth), size.height - 1
    if top == 0:
        faces(plan, "door", solid, plan.width, 0)
        return plan.blocks
    plan.put("body", solid, plan.width, range(top))
    plan.put("top", solid, plan.width, top)
    door = range(1, top) if top > 1 else range(top)
    faces(plan, "door", body.face, plan.width, door)
    if top > 2:
        handles(plan, body, "handle", plan.width, top)
    plan.put("ring", solid, plan.width, size.height, "plate")
    return plan.blocks


STOVE = Family(build=_stove, design=_stove_blocks, roles=("body", "door", "top", "ring", "handle"))


def _fridge(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    face, split = x - 0.06, height * look["split"]
    side = 0.06 - y
    double = look.option("doors") == "side"
    leaves = [((-y, -0.004), (0.0, height)), ((0.004, y), (0.0, height))]
    if not double:
        leaves = [((-y, y), (0.0, split - 0.005)), ((-y, y), (split + 0.005, height))]
    found = [part("body", (-x, face), (-y, y), (0.0, height))]
    found += [part("door", (face, x - 0.03), across, up) for across, up in leaves]
    bars = [((-0.06, -0.03), 0.55 * height), ((0.03, 0.06), 0.55 * height)]
    if not double:
        bars = [((side, side + 0.03), split + 0.1), ((side, side + 0.03), 0.5 * split)]
    return found + [
        part("handle", (x - 0.03, x), across, (z, min(z + 0.25 * split, height)))
        for across, z in bars
    ]


def _fridge_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, body = Plan(size, look), body_of(size)
    plan.put("body", range(body.depth), plan.width, plan.height)
    split = max(1, round(size.height * look["split"]))
    if body.front is None and size.height == 2:
        plan.put("door", range(body.depth), plan.width, 1)
        return plan.blocks
    plan.put("door", body.face, plan.width, plan.height)
    if look.option("doors") == "side":
        rows = range(size.height // 3, max(2 * size.height // 3, size.height // 3 + 1))
        _bars(plan, body, [(size.width - 1) // 2, size.width // 2], rows)
        return plan.blocks
    plan.put("seam", body.face, plan.width, split - 1)
    handles(plan, body, "handle", 0, [max(split - 2, 0), split])
    return plan.blocks


def _bars(plan: Plan, body: Body, j: Numbers, k: Numbers) -> None:
    """Place upright bars as handles before a body, if the size leaves space for them."""
    if body.front is not None:
        plan.put_state("handle", "minecraft:chain[axis=y]", body.front, j, k)


FRIDGE = Family(
    build=_fridge,
    design=_fridge_blocks,
    roles=("body", "door", "seam", "handle"),
    parameters={"split": Span(0.3, 0.4, 0.75)},
    options={"doors": ("stacked", "side")},
)


def _tower(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    z = (0.3 * height, 0.6 * height)
    return [
        part("body", (-x, x - LIP_M), (-y, y), (0.0, height)),
        part("body", (x - LIP_M, x - 0.01), (-y, y), (0.0, z[0])),
        part("door", (x - LIP_M, x), (-y, y), z),
        part("body", (x - LIP_M, x - 0.01), (-y, y), (z[1], height)),
    ]


def _tower_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Build an oven into a tall cupboard."""
    plan, body = Plan(size, look), body_of(size)
    plan.put("body", range(body.depth), plan.width, plan.height)
    low, high = round(0.3 * size.height), max(round(0.6 * size.height), 1)
    oven = range(low, max(high, low + 1)) if size.height > 2 else range(1)
    faces(plan, "door", body.face, plan.width, oven)
    rows = [k for k in (oven[0] - 1, oven[-1] + 2) if 0 <= k < size.height]
    handles(plan, body, "handle", door_columns(size.width, size.per_metre), rows)
    return plan.blocks


TOWER = Family(build=_tower, design=_tower_blocks, roles=("body", "door", "handle"))


def _hood(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, rise = depth / 2, height * 0.3
    pipe = min(0.28, depth, width)
    return [
        slab("body", depth, width, 0.0, rise),
        part("pipe", (-x, pipe - x), (-pipe / 2, pipe / 2), (rise, height)),
    ]


def _hood_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Slope the hood of stairs up to its pipe."""
    plan = Plan(size, look)
    if size.height == 1:
        plan.stairs("body", 0, plan.width, 0, "back")
        return plan.blocks
    plan.stairs("body", size.depth - 1, plan.width, 0, "back")
    plan.put("body", range(size.depth - 1), plan.width, 0)
    middle = [(size.width - 1) // 2, size.width // 2] if size.width > 2 else [0]
    plan.put("pipe", 0, middle, range(1, size.height), "wall")
    return plan.blocks


HOOD = Family(build=_hood, design=_hood_blocks, roles=("body", "pipe"))


def _island(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    under, bar = max(height - TOP_M, height / 2), min(0.3, depth / 3)
    return [
        part("body", (-x, x - bar), (0.02 - y, y - 0.02), (0.0, under)),
        slab("top", depth, width, under, height),
    ]


def _island_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Let the worktop stand out over the side where one sits."""
    plan, top = Plan(size, look), size.height - 1
    if top == 0:
        faces(plan, "body", plan.depth, plan.width, 0)
        return plan.blocks
    solid = max(1, size.depth - 1)
    plan.put("body", range(solid), plan.width, range(top))
    plan.put("top", range(solid - 1), plan.width, top)
    if size.depth > solid:
        plan.put("top", [solid - 1], plan.width, top)
        plan.put("top", solid, plan.width, top, "slab", type="top")
    else:
        plan.stairs("top", solid - 1, plan.width, top, "back", "top")
    return plan.blocks


ISLAND = Family(build=_island, design=_island_blocks, roles=("body", "top"))


def _appliance(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    count = 2 if look.option("door") == "double" else 1
    tall = height / count
    windows = [
        part(
            "window",
            (x - LIP_M / 2, x),
            (-0.6 * y, 0.6 * y),
            ((n + 0.25) * tall, (n + 0.75) * tall),
        )
        for n in range(count)
    ]
    return [
        part("body", (-x, x - LIP_M), (-y, y), (0.0, height)),
        part("door", (x - LIP_M, x - LIP_M / 2), (0.02 - y, y - 0.02), (0.05, 0.95 * height)),
        *windows,
    ]


def _appliance_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Lay a case with a door: a block that has a front, or from three blocks a metre a window."""
    plan, body = Plan(size, look), body_of(size)
    plan.put("body", range(body.depth), plan.width, plan.height)
    count = 2 if look.option("door") == "double" and size.height > 1 else 1
    tall = size.height // count
    for n in range(count):
        _appliance_door(plan, body, range(n * tall, (n + 1) * tall))
    return plan.blocks


def _appliance_door(plan: Plan, body: Body, rows: range) -> None:
    if len(rows) == 1:
        faces(plan, "door", body.face, plan.width, rows[0])
        return
    if plan.look.option("door") == "panel" and body.front is not None:
        panels(plan, body, "door", plan.width, rows[:-1])
    elif plan.size.per_metre < FINE:
        faces(plan, "door", body.face, plan.width, rows[0])
    else:
        plan.put("window", body.face, plan.width, rows[len(rows) // 3 : -1])
    handles(plan, body, "handle", plan.width[-1], rows[-1])


APPLIANCE = Family(
    build=_appliance,
    design=_appliance_blocks,
    roles=("body", "door", "window", "handle"),
    options={"door": ("block", "panel", "double")},
)


def _bin(depth: float, width: float, height: float, look: Look) -> list[Part]:
    return [
        slab("body", 0.9 * depth, 0.9 * width, 0.0, 0.85 * height),
        slab("lid", depth, width, 0.85 * height, height),
    ]


def _bin_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    plan.put("body", 0, 0, range(max(top, 1)))
    if top:
        plan.put("lid", 0, 0, top, "trapdoor", facing="east", half="bottom", open="false")
    return plan.blocks


BIN = Family(build=_bin, design=_bin_blocks, roles=("body", "lid"))

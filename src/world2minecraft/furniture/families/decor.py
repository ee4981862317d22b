"""Decoration families: fireplaces, clocks, aquariums, pianos, bicycles and small objects."""

from world2minecraft.furniture.block_plan import Plan
from world2minecraft.furniture.box_primitives import column, part, slab
from world2minecraft.furniture.families.fronts import body_of
from world2minecraft.furniture.family import Family
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span
from world2minecraft.furniture.template_parameters import Look

FINE = 3.0  # Blocks per metre from which small parts are blocks of their own.


def _fireplace(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, shelf = depth / 2, width / 2, 0.08
    post, open_z, back = 0.22 * width, 0.62 * height, 0.25 * depth
    inner, gap = (-x, 0.8 * x), 0.6 * (y - post)
    return [
        part("body", inner, (-y, post - y), (0.0, height - shelf)),
        part("body", inner, (y - post, y), (0.0, height - shelf)),
        part("body", inner, (post - y, y - post), (open_z, height - shelf)),
        part("hearth", (-x, back - x), (post - y, y - post), (0.0, open_z)),
        part("fire", (back - x, 0.5 * x), (-gap, gap), (0.0, 0.4 * open_z)),
        slab("mantel", depth, width, height - shelf, height),
    ]


def _fireplace_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, body = Plan(size, look), body_of(size)
    solid = range(body.depth)
    plan.put("body", solid, plan.width, plan.height)
    if size.width < 3 or size.height < 2:
        lit = "minecraft:furnace[facing=east,lit=true]"
        plan.put_state("fire", lit, body.face, size.width // 2, 0)
        return plan.blocks
    post = 1 if size.width < 6 else 2
    opening = range(post, size.width - post)
    high = max(1, round(0.55 * size.height))
    plan.drop(body.face, opening, range(high))
    plan.put("hearth", range(body.face), opening, range(high))
    plan.put("fire", body.face, opening, 0, facing="east", lit="true")
    if high > 1:
        plan.stairs("body", body.face, opening[0], high - 1, "right", "top")
        plan.stairs("body", body.face, opening[-1], high - 1, "left", "top")
    if size.exact[2] > size.height:
        plan.plate("mantel", solid, plan.width, size.height, "bottom")
    else:
        plan.put("mantel", solid, plan.width, size.height - 1, "slab", type="bottom")
        if body.front is not None:
            plan.plate("mantel", body.front, plan.width, size.height - 1, "bottom")
    return plan.blocks


FIREPLACE = Family(
    build=_fireplace, design=_fireplace_blocks, roles=("body", "hearth", "fire", "mantel")
)


def _tall_clock(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, face = depth / 2, width / 2, 0.9 * depth - depth / 2
    foot, head = 0.25 * height, 0.75 * height
    return [
        part("body", (-x, x), (-y, y), (0.0, foot)),
        part("body", (-x, 0.3 * x), (-0.8 * y, 0.8 * y), (foot, head)),
        part("glass", (0.3 * x, 0.6 * x), (-0.6 * y, 0.6 * y), (foot, head)),
        part("body", (-x, face), (-y, y), (head, height)),
        part("face", (face, x), (-0.7 * y, 0.7 * y), (head + 0.05, height - 0.05)),
    ]


def _tall_clock_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    plan.put("body", 0, plan.width, plan.height)
    if top < 3:
        plan.put("face", 0, plan.width, top)
        return plan.blocks
    foot, head = max(1, round(0.25 * size.height)), round(0.7 * size.height)
    plan.put("glass", 0, plan.width, range(foot, head))
    plan.put("face", 0, plan.width, range(head, top))
    plan.put("body", 0, plan.width, top, "slab", type="bottom")
    return plan.blocks


TALL_CLOCK = Family(build=_tall_clock, design=_tall_clock_blocks, roles=("body", "glass", "face"))


def _aquarium(depth: float, width: float, height: float, look: Look) -> list[Part]:
    low, sand = max(look["stand"], 0.05) * height, 0.05
    return [
        slab("stand", depth, width, 0.0, low),
        slab("sand", depth, width, low, low + sand),
        slab("water", depth, width, low + sand, height - 0.03),
        slab("lid", depth, width, height - 0.03, height),
    ]


def _aquarium_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    low = min(round(look["stand"] * size.height), top)
    plan.put("stand", plan.depth, plan.width, range(low))
    plan.put("water", plan.depth, plan.width, range(low, size.height))
    if size.per_metre >= FINE and top - low > 1:
        plan.put("sand", plan.depth, plan.width, low)
    if size.exact[2] - size.height > 0.05 or size.per_metre >= FINE:
        plan.plate("lid", plan.depth, plan.width, size.height, "bottom")
    return plan.blocks


AQUARIUM = Family(
    build=_aquarium,
    design=_aquarium_blocks,
    roles=("stand", "sand", "water", "lid"),
    parameters={"stand": Span(0.0, 0.55, 0.7)},
)


def _on_plinth(depth: float, width: float, height: float, look: Look) -> list[Part]:
    plinth = max(look["plinth"], 0.05) * height
    return [
        slab("plinth", depth, width, 0.0, plinth),
        slab("thing", 0.8 * depth, 0.8 * width, plinth, height),
    ]


def _on_plinth_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    post = "wall" if look.has("plinth", "wall") and size.per_metre >= FINE else "full"
    plan.put("plinth", 0, 0, range(top), post)
    plan.put("thing", 0, 0, top)
    return plan.blocks


ON_PLINTH = Family(
    build=_on_plinth,
    design=_on_plinth_blocks,
    roles=("plinth", "thing"),
    parameters={"plinth": Span(0.0, 0.5, 0.9)},
)


def _upright_piano(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, split = depth / 2, width / 2, -depth / 2 + 0.6 * depth
    keys = min(0.72, 0.6 * height)
    return [
        part("body", (-x, split), (-y, y), (0.0, height)),
        part("body", (split, x), (-y, y), (keys - 0.12, keys)),
        part("keys", (split, x - 0.03), (0.05 - y, y - 0.05), (keys, keys + 0.03)),
        part("leg", (x - 0.08, x), (-y, 0.08 - y), (0.0, keys - 0.12)),
        part("leg", (x - 0.08, x), (y - 0.08, y), (0.0, keys - 0.12)),
    ]


def _upright_piano_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.per_metre < 1.5:
        plan.stairs("body", 0, plan.width, 0, "back")
        return plan.blocks
    front = max(1, int(size.exact[0]))
    plan.put("body", range(front), plan.width, plan.height)
    keys = max(1, int(0.72 * size.per_metre))
    plan.put("keys", front, plan.width, keys, "slab", type="bottom")
    if size.width > 4:
        plan.put("body", front, [0, size.width - 1], keys)
    plan.put("leg", front, [0, size.width - 1], range(keys), "fence")
    return plan.blocks


UPRIGHT_PIANO = Family(
    build=_upright_piano, design=_upright_piano_blocks, roles=("body", "keys", "leg")
)


def _grand_piano(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, low, top = depth / 2, width / 2, 0.6 * height, 0.92 * height
    curve = -0.1 * width
    return [
        part("body", (0.35 * x, 0.75 * x), (-y, y), (low, height)),
        part("body", (-0.2 * x, 0.35 * x), (curve - 0.4 * y, y), (low, top)),
        part("body", (-x, -0.2 * x), (0.0, y), (low, top)),
        part("body", (0.75 * x, x), (-y, y), (low, low + 0.08)),
        part("keys", (0.75 * x, x), (0.06 - y, y - 0.06), (low + 0.08, low + 0.12)),
        part("leg", (0.5 * x, 0.6 * x), (-0.95 * y, 0.08 - 0.95 * y), (0.0, low)),
        part("leg", (0.5 * x, 0.6 * x), (0.95 * y - 0.08, 0.95 * y), (0.0, low)),
        part("leg", (-0.9 * x, -0.8 * x), (0.5 * y, 0.5 * y + 0.08), (0.0, low)),
    ]


def _grand_piano_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Lay a body that narrows to its tail, keys along the front, a raised lid."""
    plan = Plan(size, look)
    front, last = size.depth - 1, size.width - 1
    if size.per_metre < 1.5:
        plan.put("body", plan.depth, plan.width, 0, "slab", type="top")
        plan.stairs("keys", front, plan.width, 0, "back")
        return plan.blocks
    layer = max(1, size.height - 2) if size.height > 2 else 1
    for i in range(front):
        start = round((front - 1 - i) / max(front - 1, 1) * last / 2)
        plan.put("body", i, range(start, size.width), layer)
        if size.per_metre >= FINE:
            plan.panel("lid", i, last, layer + 1, "left")
    plan.put("keys", front, plan.width, layer, "slab", type="bottom")
    if size.width > 4:
        plan.put("body", front, [0, last], layer)
    for i, j in ((front, 0), (front, last), (0, last)):
        plan.put("leg", i, j, range(layer), "fence")
    return plan.blocks


GRAND_PIANO = Family(
    build=_grand_piano, design=_grand_piano_blocks, roles=("body", "keys", "leg", "lid")
)


def _bicycle(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, hub = depth / 2, width / 2, 0.33 * height
    wheel = 0.3 * depth
    return [
        part("wheel", (-x, wheel - x), (-0.03, 0.03), (0.0, 2 * hub)),
        part("wheel", (x - wheel, x), (-0.03, 0.03), (0.0, 2 * hub)),
        part("frame", (wheel / 2 - x, x - wheel / 2), (-0.02, 0.02), (hub, hub + 0.05)),
        part("frame", (-0.25 * x, -0.2 * x), (-0.02, 0.02), (hub, 0.9 * height)),
        part("frame", (-0.25 * x, 0.5 * x), (-0.02, 0.02), (0.7 * height, 0.75 * height)),
        part("frame", (0.48 * x, 0.55 * x), (-0.02, 0.02), (hub, height)),
        part("saddle", (-0.35 * x, -0.1 * x), (-0.08, 0.08), (0.9 * height, 0.96 * height)),
        part("frame", (0.48 * x, 0.55 * x), (-y, y), (0.95 * height, height)),
    ]


def _bicycle_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Join a frame of fences between two wheels, with a bar across to steer by."""
    plan, last = Plan(size, look), max(size.depth - 1, 1)
    if size.per_metre < FINE:
        plan.panel("wheel", [0, last], 0, 0, "right")
        plan.put("frame", range(1, last), 0, 0, "fence")
        if size.height > 1 and last > 1:
            plan.plate("saddle", 1, 0, 1, "bottom")
            plan.put("frame", last - 1, 0, 1, "fence")
        return plan.blocks
    plan.put("wheel", [0, 1, last - 1, last], 1, [0, 1], "bars")
    plan.put("frame", range(2, last - 1), 1, 1, "fence")
    plan.put("frame", [2, last - 2], 1, 2, "fence")
    plan.plate("saddle", [1, 2], 1, 3, "bottom")
    plan.put("frame", last - 2, [0, 1, 2], 3, "fence")
    return plan.blocks


BICYCLE = Family(build=_bicycle, design=_bicycle_blocks, roles=("wheel", "frame", "saddle"))


def _coat_stand(depth: float, width: float, height: float, look: Look) -> list[Part]:
    arm = 0.9 * height
    return [
        slab("foot", depth, width, 0.0, 0.04),
        column("pole", 0.05, 0.04, height),
        slab("arm", depth, 0.04, arm, arm + 0.04),
        slab("arm", 0.04, width, arm, arm + 0.04),
    ]


def _coat_stand_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    if size.per_metre < FINE:
        plan.put("pole", 0, 0, plan.height, "fence")
        plan.panel("coat", 1, 0, range(1, top), "back")
        return plan.blocks
    plan.plate("foot", [0, 2], 1, 0, "bottom")
    plan.plate("foot", 1, [0, 2], 0, "bottom")
    plan.put("pole", 1, 1, range(size.height), "fence")
    for i, j in ((0, 1), (2, 1), (1, 0), (1, 2)):
        plan.put("arm", i, j, top - 1, "fence")
    plan.panel("coat", 2, 1, range(max(top - 4, 1), top - 1), "back")
    return plan.blocks


COAT_STAND = Family(
    build=_coat_stand, design=_coat_stand_blocks, roles=("foot", "pole", "arm", "coat")
)


def _stack(depth: float, width: float, height: float, look: Look) -> list[Part]:
    rim = min(0.04, height / 4)
    return [
        slab("body", depth, width, 0.0, height - rim),
        slab("lid", depth, width, height - rim, height),
    ]


def _stack_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Lay crates, the topmost with a lid."""
    plan = Plan(size, look)
    plan.put("body", plan.depth, plan.width, plan.height)
    if size.height > 1:
        plan.put("lid", plan.depth, plan.width, size.height - 1)
    return plan.blocks


STACK = Family(build=_stack, design=_stack_blocks, roles=("body", "lid"))


def _candles(depth: float, width: float, height: float, look: Look) -> list[Part]:
    dish = min(0.03, height / 3)
    return [
        slab("dish", depth, width, 0.0, dish),
        slab("candle", 0.6 * depth, 0.6 * width, dish, height),
    ]


def _candles_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    plan.put("candle", 0, plan.width, 0, "candle", candles="1", lit="true")
    return plan.blocks


CANDLES = Family(build=_candles, design=_candles_blocks, roles=("dish", "candle"))


def _box(depth: float, width: float, height: float, look: Look) -> list[Part]:
    return [slab("body", depth, width, 0.0, height)]


def _box_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Lay a box: a pot for what is tiny, a slab for what is flat, panes for what is thin.

    Whole blocks would be half a metre thick and hide what such things lie on or hang at.
    """
    plan = Plan(size, look)
    thin, wide, tall = *sorted(size.exact[:2]), size.exact[2]
    if max(wide, tall) < TINY:
        plan.put_state("body", "minecraft:flower_pot", 0, 0, 0)
    elif tall < FLAT:
        plan.put_state("body", "minecraft:birch_slab[type=bottom]", plan.depth, plan.width, 0)
    elif thin < THIN and wide > 1.5:
        pane = "minecraft:white_stained_glass_pane"
        plan.put_state("body", pane, plan.depth, plan.width, plan.height)
    else:
        plan.put("body", plan.depth, plan.width, plan.height)
    return plan.blocks


TINY, FLAT, THIN = 0.45, 0.6, 0.25  # Blocks.


BOX = Family(build=_box, design=_box_blocks, roles=("body",))

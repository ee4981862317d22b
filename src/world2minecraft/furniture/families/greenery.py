"""Plant families: plants in pots, in boxes and below the ceiling.

Leaves are persistent, so that they do not decay without a tree. Nothing grows: saplings, vines and
bamboo are only used in flower pots.
"""

from world2minecraft.furniture.block_plan import Plan
from world2minecraft.furniture.box_primitives import column, part, slab
from world2minecraft.furniture.family import Family
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span
from world2minecraft.furniture.template_parameters import Look

FINE = 3.0  # Blocks per metre from which a crown has a shape.
KEPT = {"distance": "7", "persistent": "true"}


def _plant(depth: float, width: float, height: float, look: Look) -> list[Part]:
    pot = height * look["pot_share"]
    crown = pot + 0.15 * height
    return [
        slab("pot", 0.6 * depth, 0.6 * width, 0.0, pot),
        column("stem", min(0.06, depth, width), pot, crown),
        slab("leaves", depth, width, crown, height),
    ]


def _plant_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    if top == 0:
        plan.put("potted", 0, 0, 0)
        return plan.blocks
    if size.per_metre < FINE or min(size.depth, size.width) < 2:
        plan.put("pot", 0, 0, 0)
        plan.put("leaves", 0, 0, range(1, size.height), **KEPT)
        return plan.blocks
    _crowned(plan, max(1, round(look["pot_share"] * size.height)))
    return plan.blocks


def _crowned(plan: Plan, pot: int) -> None:
    """Lay a pot, a stem and a round crown about the middle of three by three cells."""
    top = plan.size.height - 1
    plan.put("pot", 1, 1, range(pot))
    crown = range(min(pot + 1, top), plan.size.height) if top > pot else range(top, top + 1)
    plan.put("stem", 1, 1, range(pot, crown[0]), "fence")
    for k in crown:
        plan.put("leaves", 1, 1, k, **KEPT)
        if k == crown[-1] and len(crown) > 1:
            continue
        plan.put("leaves", [0, 2], 1, k, **KEPT)
        plan.put("leaves", 1, [0, 2], k, **KEPT)
        if len(crown) > 3 and k == crown[len(crown) // 2]:
            plan.put("leaves", range(3), range(3), k, **KEPT)


PLANT = Family(
    build=_plant,
    design=_plant_blocks,
    roles=("pot", "stem", "leaves", "potted"),
    parameters={"pot_share": Span(0.15, 0.3, 0.45)},
)


def _tree(depth: float, width: float, height: float, look: Look) -> list[Part]:
    pot, crown = 0.18 * height, height * (1 - look["crown_share"])
    return [
        slab("pot", 0.45 * depth, 0.45 * width, 0.0, pot),
        column("stem", min(0.08, depth, width), pot, crown),
        slab("leaves", depth, width, crown, height),
    ]


def _tree_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    if top == 0:
        plan.put("potted", 0, 0, 0)
        return plan.blocks
    if size.per_metre < 1.5:
        plan.put("stem", 0, 0, range(top), "fence")
        plan.put("leaves", 0, 0, top, **KEPT)
        return plan.blocks
    reach = 1 if size.per_metre < FINE or size.width < 4 else 2
    crown = max(2, round(look["crown_share"] * size.height))
    low = max(size.height - crown, 2)
    wide = reach if min(size.width, size.depth) > 1 else 0
    plan.put("pot", wide, wide, 0)
    plan.put("stem", wide, wide, range(1, low), "fence")
    _CROWNS[look.option("crown")](plan, wide, range(low, size.height))
    return plan.blocks


def _round(plan: Plan, reach: int, rows: range) -> None:
    """Lay a ball of leaves: wide in the middle, narrow at its top and bottom."""
    middle, half = (rows[0] + rows[-1]) / 2, max(len(rows) / 2, 1.0)
    for k in rows:
        for i in range(2 * reach + 1):
            for j in range(2 * reach + 1):
                flat = (i - reach) ** 2 + (j - reach) ** 2
                if flat / (reach + 0.6) ** 2 + ((k - middle) / half) ** 2 <= 1.15:
                    plan.put("leaves", i, j, k, **KEPT)
    plan.put("leaves", reach, reach, rows, **KEPT)


def _fan(plan: Plan, reach: int, rows: range) -> None:
    """Lay the fronds of a palm: four arms from the top that hang at their ends."""
    top = rows[-1]
    plan.put("stem", reach, reach, range(rows[0], top), "fence")
    plan.put("leaves", reach, reach, top, **KEPT)
    for n in range(1, reach + 1):
        k = top if n < max(reach, 2) else top - 1
        for i, j in (
            (reach + n, reach),
            (reach - n, reach),
            (reach, reach + n),
            (reach, reach - n),
        ):
            plan.put("leaves", i, j, k, **KEPT)


def _cone(plan: Plan, reach: int, rows: range) -> None:
    """Lay a crown that narrows to its top."""
    for index, k in enumerate(rows):
        wide = round(reach * (1 - index / len(rows)) + 0.2)
        for i in range(2 * reach + 1):
            for j in range(2 * reach + 1):
                if abs(i - reach) + abs(j - reach) <= wide:
                    plan.put("leaves", i, j, k, **KEPT)


_CROWNS = {"round": _round, "fan": _fan, "cone": _cone}
TREE = Family(
    build=_tree,
    design=_tree_blocks,
    roles=("pot", "stem", "leaves", "potted"),
    parameters={"crown_share": Span(0.3, 0.55, 0.8)},
    options={"crown": tuple(_CROWNS)},
)


def _cactus(depth: float, width: float, height: float, look: Look) -> list[Part]:
    pot, y = 0.25 * height, width / 2
    body = min(0.5 * depth, 0.4 * width)
    return [
        slab("pot", depth, 0.8 * width, 0.0, pot),
        column("leaves", body, pot, height),
        part("leaves", (-body / 2, body / 2), (-y, -body / 2), (0.5 * height, 0.62 * height)),
        part("leaves", (-body / 2, body / 2), (body / 2, y), (0.6 * height, 0.72 * height)),
    ]


def _cactus_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    if top < 2 or size.per_metre < FINE:
        plan.put("potted", 0, 0, 0)
        return plan.blocks
    plan.put("pot", 0, 1, 0)
    plan.put("leaves", 0, 1, range(1, size.height))
    plan.put("leaves", 0, 2, top // 2 + 1)
    return plan.blocks


CACTUS = Family(build=_cactus, design=_cactus_blocks, roles=("pot", "leaves", "potted"))


def _potted(depth: float, width: float, height: float, look: Look) -> list[Part]:
    return [
        slab("pot", 0.6 * depth, 0.6 * width, 0.0, 0.4 * height),
        slab("potted", depth, width, 0.4 * height, height),
    ]


def _potted_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    plan.put("potted", 0, plan.width, 0)
    return plan.blocks


POTTED = Family(build=_potted, design=_potted_blocks, roles=("pot", "potted"))


def _planter(depth: float, width: float, height: float, look: Look) -> list[Part]:
    box = 0.5 * height
    return [
        slab("pot", depth, width, 0.0, box),
        slab("plants", 0.9 * depth, 0.94 * width, box, height),
    ]


def _planter_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Lay earth behind plates, and plants on it."""
    plan = Plan(size, look)
    if size.height == 1 and size.per_metre < 1.5:
        plan.put("potted", 0, plan.width, 0)
        return plan.blocks
    plan.put("earth", 0, plan.width, 0)
    plan.panel("pot", 1, plan.width, 0, "back")
    plan.put("plants", 0, plan.width[::2], 1)
    plan.put("blooms", 0, plan.width[1::2], 1)
    return plan.blocks


PLANTER = Family(
    build=_planter, design=_planter_blocks, roles=("pot", "earth", "plants", "blooms", "potted")
)


def _hanging(depth: float, width: float, height: float, look: Look) -> list[Part]:
    pot = (0.35 * height, 0.6 * height)
    return [
        slab("leaves", depth, width, 0.0, pot[0]),
        slab("pot", 0.6 * depth, 0.6 * width, *pot),
        column("chain", 0.03, pot[1], height),
    ]


def _hanging_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.per_metre >= FINE and size.height > 3:
        plan.put("leaves", 1, 1, 1, **KEPT)
        plan.put("leaves", [0, 2], 1, 1, **KEPT)
        plan.put("leaves", 1, [0, 2], 1, **KEPT)
        plan.put("leaves", 0, 1, 0, **KEPT)
        plan.put("leaves", 1, 2, 0, **KEPT)
        plan.put("chain", 1, 1, range(2, size.height), "chain", axis="y")
        return plan.blocks
    plan.put("potted", 0, 0, 0)
    plan.put("chain", 0, 0, range(1, size.height), "chain", axis="y")
    return plan.blocks


HANGING = Family(build=_hanging, design=_hanging_blocks, roles=("leaves", "pot", "chain", "potted"))


def _bonsai(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, dish = depth / 2, width / 2, 0.2 * height
    return [
        slab("pot", depth, width, 0.0, dish),
        part("stem", (-0.03, 0.03), (-0.3 * y, 0.1 * y), (dish, 0.6 * height)),
        part("leaves", (-x, x), (-y, 0.5 * y), (0.6 * height, height)),
        part("leaves", (-x, x), (0.5 * y, y), (0.75 * height, 0.95 * height)),
    ]


def _bonsai_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.per_metre < FINE or size.width < 2:
        plan.put("potted", 0, 0, 0)
        return plan.blocks
    plan.put("pot", 0, range(3), 0, "slab", type="top")
    plan.put("stem", 0, 1, 1, "fence")
    plan.put("leaves", 0, range(3), 2, **KEPT)
    return plan.blocks


BONSAI = Family(build=_bonsai, design=_bonsai_blocks, roles=("pot", "stem", "leaves", "potted"))

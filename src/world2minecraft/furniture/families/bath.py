"""Bathroom furniture families: toilets, tubs, basins, showers."""

from typing import Literal

from world2minecraft.furniture.block_plan import Cell, Plan, Side
from world2minecraft.furniture.box_primitives import part, slab
from world2minecraft.furniture.family import Family
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span
from world2minecraft.furniture.template_parameters import Look

FINE = 3.0  # Blocks per metre from which a bowl and its tank are blocks of their own.


def _toilet(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    seat, tank = min(look["seat_height"], 0.7 * height), -x + 0.28 * depth
    return [
        part("body", (-x, tank), (-y, y), (0.0, height)),
        part("body", (tank, 0.6 * x), (-0.6 * y, 0.6 * y), (0.0, 0.6 * seat)),
        part("body", (tank, x), (-0.9 * y, 0.9 * y), (0.6 * seat, seat - 0.03)),
        part("seat", (tank, x), (-0.95 * y, 0.95 * y), (seat - 0.03, seat)),
    ]


def _toilet_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.per_metre < FINE:
        plan.stairs("body", 0, 0, 0, "back")
        if size.height > 1:
            plan.panel("seat", 0, 0, 1, "back")
        return plan.blocks
    bowl = range(1, max(size.depth, 2))
    plan.put("body", 0, plan.width, plan.height)
    plan.put("body", bowl[:-1], plan.width, 0)
    plan.stairs("body", bowl[-1], plan.width, 0, "back", "top")
    plan.put("body", bowl, plan.width, 1, "slab", type="bottom")
    if size.height > 2:
        plan.panel("seat", 1, plan.width, 2, "back")
        flush = "minecraft:stone_button[face=floor,facing=east]"
        plan.put_state("body", flush, 0, size.width // 2, size.height)
    return plan.blocks


TOILET = Family(
    build=_toilet,
    design=_toilet_blocks,
    roles=("body", "seat"),
    parameters={"seat_height": Span(0.38, 0.42, 0.48)},
)


def _tub(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, wall = depth / 2, width / 2, 0.06
    feet = 0.12 if look.option("feet") == "claws" else 0.0
    floor = (feet, feet + 0.1)
    high = (floor[1], height)
    found = [
        part("body", (-x, x), (-y, y), floor),
        part("body", (-x, wall - x), (-y, y), high),
        part("body", (x - wall, x), (-y, y), high),
        part("body", (wall - x, x - wall), (-y, wall - y), high),
        part("body", (wall - x, x - wall), (y - wall, y), high),
        part("water", (wall - x, x - wall), (wall - y, y - wall), (floor[1], 0.6 * height)),
    ]
    if not feet:
        return found
    ends = [
        ((-x + 0.1, -x + 0.16), (-y + 0.2, -y + 0.26)),
        ((x - 0.16, x - 0.1), (-y + 0.2, -y + 0.26)),
    ]
    ends += [(along, (y - 0.26, y - 0.2)) for along, _ in ends]
    return found + [part("foot", along, across, (0.0, feet)) for along, across in ends]


def _tub_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if size.depth == 1:
        if size.width == 1:
            plan.put("basin", 0, 0, 0, level="3")
            return plan.blocks
        plan.put("body", 0, plan.width, 0, "slab", type="bottom")
        plan.stairs("body", 0, 0, 0, "right")
        plan.stairs("body", 0, size.width - 1, 0, "left")
        return plan.blocks
    top = size.height - 1
    if look.option("feet") == "claws" and top > 0:
        _ring(plan, 0, "top", inward=True)
        plan.put("body", plan.depth, plan.width, range(1, top))
        plan.put("body", range(1, size.depth - 1), range(1, size.width - 1), 0)
    else:
        plan.put("body", plan.depth, plan.width, range(top))
    _ring(plan, top, "bottom", inward=False)
    inside = (range(1, size.depth - 1), range(1, size.width - 1))
    if top:
        plan.put("water", *inside, top, "carpet")
        plan.put("tap", size.depth // 2, 0, size.height)
    return plan.blocks


def _ring(plan: Plan, layer: int, half: Literal["bottom", "top"], inward: bool) -> None:
    """Lay stairs around, their high sides outward or inward; the game turns the corners in."""
    last_i, last_j = plan.size.depth - 1, plan.size.width - 1
    sides: dict[Side, list[Cell]] = {
        "back": [(0, j, layer) for j in range(last_j)],
        "right": [(i, 0, layer) for i in range(1, last_i + 1)],
        "front": [(last_i, j, layer) for j in range(1, last_j + 1)],
        "left": [(i, last_j, layer) for i in range(last_i)],
    }
    across: dict[Side, Side] = {"back": "front", "right": "left", "front": "back", "left": "right"}
    for side, cells in sides.items():
        for cell in cells:
            plan.stairs("body", *cell, across[side] if inward else side, half)


TUB = Family(
    build=_tub,
    design=_tub_blocks,
    roles=("body", "water", "basin", "tap", "foot"),
    options={"feet": ("none", "claws")},
)


def _basin(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    bowl = height - 0.16
    return [
        part("post", (-x, 0.1 - x), (-0.3 * y, 0.3 * y), (0.0, bowl)),
        part("post", (0.1 - x, 0.1), (-0.3 * y, 0.3 * y), (0.0, bowl)),
        slab("body", depth, width, bowl, height),
    ]


def _basin_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    if top == 0:
        plan.stairs("body", 0, plan.width, 0, "back", "top")
        return plan.blocks
    middle = range((size.width - 1) // 2, size.width // 2 + 1)
    plan.put("post", 0, middle, range(top), "wall")
    if size.per_metre < FINE:
        plan.put("body", plan.depth, plan.width, top, "slab", type="bottom")
        return plan.blocks
    plan.put("body", range(size.depth - 1), plan.width, top)
    plan.stairs("body", size.depth - 1, plan.width, top, "back", "top")
    plan.put("tap", 0, middle[0], size.height)
    return plan.blocks


BASIN = Family(build=_basin, design=_basin_blocks, roles=("body", "post", "tap"))


def _shower(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, tray, thin = depth / 2, width / 2, 0.08, 0.02
    return [
        slab("tray", depth, width, 0.0, tray),
        part("glass", (x - thin, x), (-y, y), (tray, height)),
        part("glass", (-x, x - thin), (-y, thin - y), (tray, height)),
        part("pipe", (-x, 0.05 - x), (-0.02, 0.02), (tray, height - 0.05)),
        part("pipe", (-x, 0.0), (-0.02, 0.02), (height - 0.05, height)),
        part("head", (-0.1, 0.1), (-0.1, 0.1), (height - 0.09, height - 0.05)),
    ]


def _shower_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Stand glass at the front and at the right, a pipe with a head in the far corner."""
    plan, front = Plan(size, look), size.depth - 1
    if front == 0:
        plan.put("glass", 0, plan.width, plan.height)
        return plan.blocks
    plan.put("tray", plan.depth, plan.width, 0, "slab", type="bottom")
    rows = range(1, size.height)
    plan.put("glass", front, plan.width, rows, "pane")
    plan.put("glass", range(front), 0, rows, "pane")
    corner = size.width - 1
    plan.put("pipe", 0, corner, range(max(1, size.height // 3), size.height), "chain", axis="y")
    if size.per_metre >= FINE:
        plan.put("pipe", 0, corner, size.height - 1, "bars")
        plan.put("head", 1, corner, size.height - 1, facing="down")
    else:
        plan.put("head", 0, corner, size.height - 1, facing="down")
    return plan.blocks


SHOWER = Family(build=_shower, design=_shower_blocks, roles=("tray", "glass", "pipe", "head"))

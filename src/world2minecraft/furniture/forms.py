"""Whole pieces that several templates are: the same parts at other sizes and in other blocks."""

from world2minecraft.furniture.designs import bed
from world2minecraft.furniture.shapes import arms, backrest, legs, part, slab
from world2minecraft.furniture.template import BlockSize, LocalBlock, Parameters, Part

DOOR_M = 0.02


def cupboard(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    """Return a closed body with a door at its front."""
    x, y = depth / 2, width / 2
    door = min(DOOR_M, x)
    return [
        part("body", (-x, x - door), (-y, y), (0.0, height)),
        part("door", (x - door, x), (-y, y), (0.0, height)),
    ]


def four_legged(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    """Return a plate, ``top_thickness`` thick, on four legs."""
    under = max(height - p["top_thickness"], height / 2)
    return [*legs(depth, width, under, 0.06), slab("top", depth, width, under, height)]


def upholstered(
    depth: float, width: float, height: float, p: Parameters, back_m: float, arm_m: float
) -> list[Part]:
    """Return a block to sit on, a back and two arms of some thickness."""
    seat = min(p["seat_height"], 0.7 * height)
    return [
        slab("seat", depth, width, 0.0, seat),
        backrest(depth, width, seat, height, back_m),
        *arms(depth, width, seat, min(p["arm_height"], height), arm_m),
    ]


def bedstead(
    depth: float, width: float, height: float, p: Parameters, pillows: list[tuple[float, float]]
) -> list[Part]:
    """Return a mattress, a headboard and pillows, each from one place across to another."""
    top = min(p["mattress_height"], max(height - 0.1, height / 2))
    head = (0.08 - depth / 2, 0.45 - depth / 2)
    return [
        slab("mattress", depth, width, 0.0, top),
        backrest(depth, width, top, height, 0.08),
        *(part("pillow", head, across, (top, top + 0.1)) for across in pillows),
    ]


def bed_with_headboard(size: BlockSize, colour: str) -> list[LocalBlock]:
    """Return beds of a colour, with panels behind the pillows where there is room for them."""
    panel = "minecraft:spruce_trapdoor[facing=east,half=bottom,open=true]"
    blocks = bed(size, colour)
    if size.depth > 2:
        rows = range(size.width)
        blocks += [
            LocalBlock((0, j, k), panel, "back") for k in range(1, size.height) for j in rows
        ]
    return blocks

"""Vanilla block designs that many templates share, all looking east: +x is the front.

A cell is (front-to-back, side, up); side grows to the room's +y, which is north. Stairs face
their high side, so a seat that looks east has stairs that face west; an open trapdoor's panel
lies on the side opposite to its facing. Inner stair shapes are those that the game computes.
"""

from collections.abc import Callable

from world2minecraft.furniture.template import BlockSize, LocalBlock, Parameters

SLAB_LIMIT = 0.6  # A rest above this is nearer to a whole block, half a block allowed for.
PLATE_LIMIT = 0.25  # A rest under a quarter of a block reads as a plate.


def fill(size: BlockSize, state: str, role: str, front: str | None = None) -> list[LocalBlock]:
    """Fill the whole box with one block, its front face with another."""
    return [
        LocalBlock((i, j, k), front if front and i == size.depth - 1 else state, role)
        for i in range(size.depth)
        for j in range(size.width)
        for k in range(size.height)
    ]


def filled(state: str, role: str, front: str | None = None) -> "Callable":
    """Return a design that fills the box."""

    def design(size: BlockSize, parameters: Parameters) -> list[LocalBlock]:
        return fill(size, state, role, front)

    return design


def level(height: float) -> tuple[int, str]:
    """Return the layer of a surface at ``height`` blocks, and ``plate``, ``slab`` or ``block``."""
    layer = int(height)
    rest = height - layer
    if rest < PLATE_LIMIT and layer:
        return layer, "plate"
    return layer, "slab" if rest <= SLAB_LIMIT else "block"


def seat_row(size: BlockSize, wood: str, arms: bool) -> list[LocalBlock]:
    """Return a seat with a back: stairs behind, slabs before them, stairs turned in as arms."""
    blocks = []
    last = size.width - 1
    armed = arms and size.width > 2 and size.depth > 1
    for i in range(size.depth):
        for j in range(size.width):
            blocks.append(LocalBlock((i, j, 0), _seat_state(i, j, last, wood, armed), "seat"))
    back = f"minecraft:{wood}_trapdoor[facing=east,half=bottom,open=true]"
    for k in range(1, size.height):
        blocks += [LocalBlock((0, j, k), back, "back") for j in range(size.width)]
    return blocks


def _seat_state(i: int, j: int, last: int, wood: str, armed: bool) -> str:
    if i == 0:
        turn = {0: "inner_left", last: "inner_right"}.get(j, "straight") if armed else "straight"
        return f"minecraft:{wood}_stairs[facing=west,half=bottom,shape={turn}]"
    if armed and j in (0, last):
        side = "south" if j == 0 else "north"
        return f"minecraft:{wood}_stairs[facing={side},half=bottom]"
    return f"minecraft:{wood}_slab[type=bottom]"


def table(size: BlockSize, wood: str) -> list[LocalBlock]:
    """Return a top at its true height on fences under the corners.

    A plate needs a fence under it, so a wider thin top is of trapdoors, which hold themselves.
    """
    layer, kind = level(size.exact[2])
    alone = size.depth == size.width == 1
    state = {
        "plate": f"minecraft:{wood}_pressure_plate[powered=false]"
        if alone
        else f"minecraft:{wood}_trapdoor[facing=east,half=bottom,open=false]",
        "slab": f"minecraft:{wood}_slab[type=bottom]",
        "block": f"minecraft:{wood}_slab[type=top]",
    }[kind]
    plan = [(i, j) for i in range(size.depth) for j in range(size.width)]
    corners = sorted({(i, j) for i in (0, size.depth - 1) for j in (0, size.width - 1)})
    fence = f"minecraft:{wood}_fence"
    legs = [LocalBlock((i, j, k), fence, "leg") for i, j in corners for k in range(layer)]
    return [*legs, *(LocalBlock((i, j, layer), state, "top") for i, j in plan)]


def bed(size: BlockSize, colour: str, layer: int = 0) -> list[LocalBlock]:
    """Return beds side by side, or a mattress of wool where beds are too short."""
    if size.depth <= 2:
        state = f"minecraft:{colour}_bed[facing=west,occupied=false,part="
        return [
            LocalBlock((i, j, layer), f"{state}{'foot' if i else 'head'}]", "mattress")
            for j in range(size.width)
            for i in range(2)
        ]
    return [
        LocalBlock(
            (i, j, layer),
            f"minecraft:{colour if i else 'white'}_wool",
            "mattress" if i else "pillow",
        )
        for i in range(size.depth)
        for j in range(size.width)
    ]

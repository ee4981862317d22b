"""Open storage families: bookcases, cube shelves, wall shelves, racks.

A row of objects and the board above it are one and a half blocks high, so boards are upper slabs:
books stand on a board with air between them and the next board.
"""

from collections.abc import Sequence

from world2minecraft.furniture.block_plan import Plan
from world2minecraft.furniture.box_primitives import arms, backrest, part, slab
from world2minecraft.furniture.family import Family
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span
from world2minecraft.furniture.template_parameters import Look

BOARD_M, POST_M = 0.03, 0.04
FINE = 3.0  # Blocks per metre from which a side is a board of its own.
SHELVES = {
    "filled": Span(0.3, 0.6, 1.0),  # The share of the depth that books take.
    "shelves": Span(3.0, 5.0, 7.0),
    "stock": Span(0.3, 0.7, 1.0),  # That of a bay's height.
}


def _bookcase(depth: float, width: float, height: float, look: Look) -> list[Part]:
    count = max(2, round(look["shelves"]))
    bay = (height - BOARD_M) / (count - 1)
    boards = [index * bay for index in range(count)]
    deep = max(0.04, depth * look["filled"])
    tall = BOARD_M + (bay - BOARD_M) * look["stock"]
    return [
        backrest(depth, width, 0.0, height, 0.02),
        *(side._replace(role="side") for side in arms(depth, width, 0.0, height, BOARD_M)),
        *(slab("shelf", depth, width, z, z + BOARD_M) for z in boards),
        *(
            backrest(depth, width, z + BOARD_M, z + tall, deep)._replace(role="books")
            for z in boards[:-1]
        ),
    ]


def _bookcase_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    if size.per_metre < FINE or size.height < 3:
        plan.put("books", plan.depth, plan.width, plan.height)
        if size.height > 2 and look.has("shelf", "slab"):
            plan.put("shelf", plan.depth, plan.width, top, "slab", type="bottom")
        return plan.blocks
    framed = size.width > 4
    inner = range(1, size.width - 1) if framed else plan.width
    for k in plan.height:
        if k % 2 == 0 and k < top:
            plan.put("books", plan.depth, inner, k)
        else:
            _board(plan, inner, k)
    if framed:
        sides = [0, size.width - 1]
        plan.put("side", plan.depth, sides, range(size.height - size.height % 2))
        if size.height % 2:
            _board(plan, sides, top)
    return plan.blocks


def _board(plan: Plan, columns: Sequence[int], layer: int) -> None:
    """Lay a board: the lid of the case, or one with a back under it and a gap over the books."""
    if layer % 2 == 0:
        plan.put("shelf", plan.depth, columns, layer, "slab", type="bottom")
        return
    plan.put("shelf", range(plan.size.depth - 1), columns, layer)
    plan.stairs("shelf", plan.size.depth - 1, columns, layer, "back", "top")


BOOKCASE = Family(
    build=_bookcase,
    design=_bookcase_blocks,
    roles=("back", "side", "shelf", "books"),
    parameters=SHELVES,
)


def _cubes(depth: float, width: float, height: float, look: Look) -> list[Part]:
    rows, columns = (max(1, round(side / look["cube"])) for side in (height, width))
    tall, wide = (height - BOARD_M) / rows, (width - BOARD_M) / columns
    x, y = depth / 2, width / 2
    boards = [slab("frame", depth, width, n * tall, n * tall + BOARD_M) for n in range(rows + 1)]
    uprights = [
        part("frame", (-x, x), (n * wide - y, n * wide - y + BOARD_M), (0.0, height))
        for n in range(columns + 1)
    ]
    chosen = [(row, column) for row in range(rows) for column in range(columns)]
    boxes = [
        part(
            "box",
            (-x, 0.8 * x),
            (column * wide - y + BOARD_M, (column + 1) * wide - y),
            (row * tall + BOARD_M, (row + 0.85) * tall),
        )
        for row, column in chosen
        if (row + column) % 2 == 0
    ]
    return [*boards, *uprights, *boxes]


def _cubes_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Put boxes and books into the cubes in turn; between the rows of fine ones are boards."""
    plan = Plan(size, look)
    fine = size.per_metre >= FINE and size.height > 2
    for k in plan.height:
        if fine and (k % 2 or k == size.height - 1):
            half = "top" if k % 2 else "bottom"
            plan.put("frame", plan.depth, plan.width, k, "slab", type=half)
            continue
        row = k // 2 if fine else k
        for j in plan.width:
            if fine and (j + row) % 3 == 2:
                continue
            plan.put("books" if (j + row) % (3 if fine else 2) else "box", plan.depth, j, k)
    return plan.blocks


CUBES = Family(
    build=_cubes,
    design=_cubes_blocks,
    roles=("frame", "box", "books"),
    parameters={"cube": Span(0.3, 0.38, 0.5)},
)


def _boards(depth: float, width: float, height: float, look: Look) -> list[Part]:
    """Boards between two posts at the back, things on each."""
    count = max(1, round(look["boards"]))
    step = (height - BOARD_M) / max(count - 1, 1)
    levels = [n * step for n in range(count)] if count > 1 else [height - BOARD_M]
    x, y = depth / 2, width / 2
    back = (-x, min(POST_M - x, x))
    posts = [
        part("post", back, (-y, min(POST_M - y, 0.0)), (0.0, height)),
        part("post", back, (max(y - POST_M, 0.0), y), (0.0, height)),
    ]
    return [*posts, *(slab("board", depth, width, z, z + BOARD_M) for z in levels)]


def _boards_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    if round(look["boards"]) == 1 or top == 0:
        plan.plate("board", plan.depth, plan.width, top, "top" if top else "bottom")
        if top:
            plan.panel("post", 0, [0, size.width - 1], range(top), "back")
        _things(plan, top + 1)
        return plan.blocks
    if size.per_metre < 1.5:
        plan.put("thing", plan.depth, plan.width, range(top))
        plan.plate("board", plan.depth, plan.width, top, "bottom")
        return plan.blocks
    for k in plan.height:
        if (top - k) % 2:
            for i, j in plan.corners:
                plan.put("post", i, j, k, "fence")
            middle = range(1, size.width - 1, 2)
            if k and size.per_metre >= FINE:
                plan.put("thing", 0, middle, k)
        else:
            plan.plate("board", plan.depth, plan.width, k, "bottom")
    return plan.blocks


def _things(plan: Plan, layer: int) -> None:
    """Stand what lies in pots on a board of trapdoors."""
    if plan.look.option("things") == "pots" and plan.size.per_metre >= FINE:
        plan.put("thing", 0, range(0, plan.size.width, 2), layer)


BOARDS = Family(
    build=_boards,
    design=_boards_blocks,
    roles=("board", "post", "thing"),
    parameters={"boards": Span(1.0, 3.0, 6.0)},
    options={"things": ("none", "pots")},
)

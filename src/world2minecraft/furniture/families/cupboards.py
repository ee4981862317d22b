"""What holds things: closed cupboards, counters and open cases of shelves."""

from world2minecraft.furniture.family import Family
from world2minecraft.furniture.look import Look
from world2minecraft.furniture.plan import Plan
from world2minecraft.furniture.shapes import arms, backrest, part, slab
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span

BOARD_M, DOOR_M, LIP_M = 0.03, 0.02, 0.03


def _cupboard(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    door = min(DOOR_M, x)
    return [
        part("body", (-x, x - door), (-y, y), (0.0, height)),
        part("door", (x - door, x), (-y, y), (0.0, height)),
    ]


def _cupboard_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    plan.put("body", plan.depth, plan.width, plan.height)
    front = "minecraft:barrel[facing=east,open=false]"
    plan.put_state("door", front, size.depth - 1, plan.width, plan.height)
    return plan.blocks


CUPBOARD = Family(build=_cupboard, design=_cupboard_blocks, roles=("body", "door"))


def _counter(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    under = max(height - 0.04, height / 2)
    return [
        part("body", (-x, max(x - LIP_M, 0.0)), (-y, y), (0.0, under)),
        slab("top", depth, width, under, height),
    ]


def _counter_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    plan.put("body", plan.depth, plan.width, plan.height)
    if size.height > 1:
        plan.put("top", plan.depth, plan.width, size.height - 1)
    return plan.blocks


COUNTER = Family(build=_counter, design=_counter_blocks, roles=("body", "top"))


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
    plan = Plan(size, look)
    plan.put_state("books", "minecraft:bookshelf", plan.depth, plan.width, plan.height)
    return plan.blocks


BOOKCASE = Family(
    build=_bookcase,
    design=_bookcase_blocks,
    roles=("back", "side", "shelf", "books"),
    parameters={
        "filled": Span(0.3, 0.6, 1.0),  # The share of the depth that books take.
        "shelves": Span(3.0, 5.0, 7.0),
        "stock": Span(0.3, 0.7, 1.0),  # That of a bay's height.
    },
)

"""An open case of shelves: a back, two sides and boards."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import filled
from world2minecraft.furniture.shapes import arms, backrest, slab
from world2minecraft.furniture.template import Parameters, Part, Span, Template

BOARD_M = 0.03


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    count = max(2, round(p["shelves"]))
    boards = [index * (height - BOARD_M) / (count - 1) for index in range(count)]
    sides = arms(depth, width, 0.0, height, BOARD_M)
    return [
        backrest(depth, width, 0.0, height, 0.02),
        *(side._replace(role="side") for side in sides),
        *(slab("shelf", depth, width, z, z + BOARD_M) for z in boards),
        *(_books(depth * p["filled"], depth, width, z + BOARD_M, height) for z in boards[:-1]),
    ]


def _books(deep: float, depth: float, width: float, bottom: float, height: float) -> Part:
    row = backrest(depth, width, bottom, min(bottom + 0.22, height), max(0.04, deep))
    return row._replace(role="books")


TEMPLATE = Template(
    name="bookcase",
    class_id=SemanticClass.FURN,
    size_m=(Span(0.2, 0.32, 0.5), Span(0.4, 0.9, 3.0), Span(0.9, 1.8, 2.5)),
    build=_build,
    design=filled("minecraft:bookshelf", "books"),
    parameters={"filled": Span(0.3, 0.6, 1.0), "shelves": Span(3.0, 5.0, 7.0)},
)

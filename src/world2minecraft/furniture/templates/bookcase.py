"""An open case of shelves: a back, two sides, boards and what stands on them.

``filled`` is the share of the depth that books take, ``stock`` that of a bay's height.
"""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import filled
from world2minecraft.furniture.shapes import arms, backrest, slab
from world2minecraft.furniture.template import Parameters, Part, Span, Template

BOARD_M = 0.03


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    count = max(2, round(p["shelves"]))
    bay = (height - BOARD_M) / (count - 1)
    boards = [index * bay for index in range(count)]
    sides = arms(depth, width, 0.0, height, BOARD_M)
    deep, tall = max(0.04, depth * p["filled"]), BOARD_M + (bay - BOARD_M) * p["stock"]
    return [
        backrest(depth, width, 0.0, height, 0.02),
        *(side._replace(role="side") for side in sides),
        *(slab("shelf", depth, width, z, z + BOARD_M) for z in boards),
        *(
            backrest(depth, width, z + BOARD_M, z + tall, deep)._replace(role="books")
            for z in boards[:-1]
        ),
    ]


TEMPLATE = Template(
    name="bookcase",
    class_id=SemanticClass.FURN,
    size_m=(Span(0.24, 0.32, 0.45), Span(0.4, 0.9, 3.0), Span(0.9, 1.8, 2.5)),
    build=_build,
    design=filled("minecraft:bookshelf", "books"),
    parameters={
        "filled": Span(0.3, 0.6, 1.0),
        "shelves": Span(3.0, 5.0, 7.0),
        "stock": Span(0.3, 0.7, 1.0),
    },
)

"""A sofa that runs on along one side: ``side`` above 0 is its left (+y), under 0 its right."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.shapes import backrest, part
from world2minecraft.furniture.template import (
    BlockSize,
    LocalBlock,
    Parameters,
    Part,
    Span,
    Template,
)


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    seat = min(p["seat_height"], 0.7 * height)
    run, wing = min(p["run_depth"], depth), min(p["run_depth"], width)
    y = width / 2
    across, rim = (
        ((y - wing, y), (y - 0.2, y)) if p["side"] > 0 else ((-y, wing - y), (-y, 0.2 - y))
    )
    along = (-depth / 2, depth / 2)
    return [
        part("seat", (-depth / 2, run - depth / 2), (-y, y), (0.0, seat)),
        part("seat", along, across, (0.0, seat)),
        backrest(depth, width, seat, height, 0.2),
        part("back", along, rim, (seat, height)),
    ]


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    scale = size.exact[1] / size.width
    run = max(1, round(0.9 / scale)) if size.depth < 3 else max(1, size.depth // 2)
    left = p["side"] > 0
    corner = size.width - 1 if left else 0
    blocks = []
    for i in range(size.depth):
        for j in range(size.width):
            away = size.width - 1 - j if left else j
            if i < run or away < run:
                blocks.append(LocalBlock((i, j, 0), _state(i, j, corner, left), "seat"))
    return blocks


def _state(i: int, j: int, corner: int, left: bool) -> str:
    if i and j != corner:
        return "minecraft:spruce_slab[type=bottom]"
    if i:
        return f"minecraft:spruce_stairs[facing={'north' if left else 'south'},half=bottom]"
    shape = ("inner_right" if left else "inner_left") if j == corner else "straight"
    return f"minecraft:spruce_stairs[facing=west,half=bottom,shape={shape}]"


TEMPLATE = Template(
    name="corner_sofa",
    class_id=SemanticClass.SOFA,
    size_m=(Span(1.3, 1.7, 2.8), Span(1.8, 2.5, 3.4), Span(0.6, 0.85, 1.1)),
    build=_build,
    design=_design,
    parameters={
        "run_depth": Span(0.75, 0.92, 1.1),
        "seat_height": Span(0.34, 0.43, 0.52),
        "side": Span(-1.0, 1.0, 1.0),
    },
)

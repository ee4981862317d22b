"""A round table on one post; its top is three boxes, an octagon seen from above."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import level, table
from world2minecraft.furniture.shapes import column, part, slab
from world2minecraft.furniture.template import (
    BlockSize,
    LocalBlock,
    Parameters,
    Part,
    Span,
    Template,
)

CUT = 0.3  # 1 - 1/sqrt(2): where the sides of an octagon in a unit square begin.


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    under = max(height - p["top_thickness"], height / 2)
    x, y = depth / 2, width / 2
    cut_x, cut_y = x * (1 - CUT), y * (1 - CUT)
    tall, foot = (under, height), min(0.05, under / 4)
    middle_x, middle_y = (x + cut_x) / 2, (y + cut_y) / 2
    return [
        slab("foot", depth / 2, width / 2, 0.0, foot),
        column("post", min(0.12, depth, width), foot, under),
        part("top", (-x, x), (-cut_y / 2, cut_y / 2), tall),
        part("top", (-middle_x, middle_x), (-middle_y, middle_y), tall),
        part("top", (-cut_x / 2, cut_x / 2), (-y, y), tall),
    ]


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    if size.depth < 3 or size.width < 3:
        return table(size, "birch")
    layer, _ = level(size.exact[2])
    corners = {(i, j) for i in (0, size.depth - 1) for j in (0, size.width - 1)}
    top = [block for block in table(size, "birch") if block.cell[:2] not in corners]
    middle = (size.depth // 2, size.width // 2)
    post = [LocalBlock((*middle, k), "minecraft:birch_fence", "post") for k in range(layer)]
    return post + top


TEMPLATE = Template(
    name="round_table",
    class_id=SemanticClass.TABLE,
    size_m=(Span(0.5, 1.0, 1.6), Span(0.5, 1.0, 1.6), Span(0.45, 0.75, 1.1)),
    build=_build,
    design=_design,
    parameters={"top_thickness": Span(0.03, 0.04, 0.16)},
    turns=1,
)

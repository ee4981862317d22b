"""A run of base cabinets under a worktop that stands out to the front."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import fill
from world2minecraft.furniture.shapes import part, slab
from world2minecraft.furniture.template import (
    BlockSize,
    LocalBlock,
    Parameters,
    Part,
    Span,
    Template,
)

LIP_M = 0.03


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    x, y = depth / 2, width / 2
    under = max(height - 0.04, height / 2)
    return [
        part("body", (-x, max(x - LIP_M, 0.0)), (-y, y), (0.0, under)),
        slab("top", depth, width, under, height),
    ]


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    front = "minecraft:barrel[facing=east,open=false]"
    blocks = fill(size, "minecraft:spruce_planks", "body", front)
    if size.height == 1:
        return blocks
    top = size.height - 1
    return [
        LocalBlock(block.cell, "minecraft:smooth_stone", "top") if block.cell[2] == top else block
        for block in blocks
    ]


TEMPLATE = Template(
    name="counter",
    class_id=SemanticClass.FURN,
    size_m=(Span(0.45, 0.62, 1.0), Span(0.4, 1.8, 5.0), Span(0.8, 0.9, 1.05)),
    build=_build,
    design=_design,
)

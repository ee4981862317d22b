"""A seat on four legs, without a back."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.shapes import legs, slab
from world2minecraft.furniture.template import (
    BlockSize,
    LocalBlock,
    Parameters,
    Part,
    Span,
    Template,
)


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    under = max(height - 0.06, height / 2)
    return [*legs(depth, width, under, 0.04), slab("seat", depth, width, under, height)]


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    top = size.height - 1
    state = (
        "minecraft:oak_slab[type=bottom]"
        if size.exact[2] - top <= 0.75
        else "minecraft:barrel[facing=up,open=false]"
    )
    blocks = []
    for i in range(size.depth):
        for j in range(size.width):
            blocks += [LocalBlock((i, j, k), "minecraft:oak_fence", "leg") for k in range(top)]
            blocks.append(LocalBlock((i, j, top), state, "seat"))
    return blocks


TEMPLATE = Template(
    name="stool",
    class_id=SemanticClass.CHAIR,
    size_m=(Span(0.28, 0.38, 0.55), Span(0.28, 0.38, 0.55), Span(0.35, 0.48, 0.8)),
    build=_build,
    design=_design,
    turns=1,
)

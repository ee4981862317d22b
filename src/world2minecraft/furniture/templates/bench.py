"""A bench or ottoman: a low block without a back."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import fill
from world2minecraft.furniture.shapes import slab
from world2minecraft.furniture.template import (
    BlockSize,
    LocalBlock,
    Parameters,
    Part,
    Span,
    Template,
)


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    return [slab("seat", depth, width, 0.0, height)]


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    low = size.height == 1 and size.exact[2] <= 0.75
    return fill(
        size, "minecraft:spruce_slab[type=bottom]" if low else "minecraft:spruce_planks", "seat"
    )


TEMPLATE = Template(
    name="bench",
    class_id=SemanticClass.SOFA,
    size_m=(Span(0.35, 0.5, 1.0), Span(0.6, 1.3, 2.2), Span(0.32, 0.44, 0.55)),
    build=_build,
    design=_design,
    turns=2,
)

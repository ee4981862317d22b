"""Two beds, one above the other, between four posts."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import bed
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
    upper = min(p["upper_height"], height)
    return [
        *legs(depth, width, height, 0.08),
        slab("mattress", depth, width, 0.2, 0.5),
        slab("mattress", depth, width, upper - 0.25, upper),
    ]


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    top = max(1, size.height - 1)
    return [*bed(size, "blue"), *bed(size, "blue", top), *_posts(size, top)]


def _posts(size: BlockSize, top: int) -> list[LocalBlock]:
    corners = sorted({(i, j) for i in (0, size.depth - 1) for j in (0, size.width - 1)})
    return [
        LocalBlock((i, j, k), "minecraft:spruce_fence", "leg")
        for i, j in corners
        for k in range(1, top)
    ]


TEMPLATE = Template(
    name="bunk_bed",
    class_id=SemanticClass.BED,
    size_m=(Span(1.7, 2.05, 2.3), Span(0.8, 1.0, 1.4), Span(1.4, 1.7, 2.1)),
    build=_build,
    design=_design,
    parameters={"upper_height": Span(1.2, 1.45, 1.7)},
    turns=2,
)

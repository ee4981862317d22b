"""A standing or table lamp: a foot, a pole and a shade."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.shapes import column, slab
from world2minecraft.furniture.template import (
    BlockSize,
    LocalBlock,
    Parameters,
    Part,
    Span,
    Template,
)


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    shade = height * (1 - p["shade_share"])
    foot = min(0.04, shade / 4)
    return [
        slab("foot", 0.7 * depth, 0.7 * width, 0.0, foot),
        column("pole", min(0.05, depth, width), foot, shade),
        slab("shade", depth, width, shade, height),
    ]


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    top = size.height - 1
    poles = [LocalBlock((0, 0, k), "minecraft:dark_oak_fence", "pole") for k in range(top)]
    return [*poles, LocalBlock((0, 0, top), "minecraft:lantern[hanging=false]", "shade")]


TEMPLATE = Template(
    name="lamp",
    class_id=SemanticClass.OBJS,
    size_m=(Span(0.24, 0.38, 0.6), Span(0.24, 0.38, 0.6), Span(0.5, 1.5, 2.0)),
    build=_build,
    design=_design,
    parameters={"shade_share": Span(0.15, 0.22, 0.5)},
    turns=1,
    mount="any",
)

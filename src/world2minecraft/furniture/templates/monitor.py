"""A screen on a foot, on a desk or a cabinet."""

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


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    x, y = depth / 2, width / 2
    rise = min(p["foot_height"], height / 2)
    back = max(-x, -0.04)
    return [
        slab("foot", depth, width / 3, 0.0, rise / 3),
        part("post", (back, back + min(0.04, x)), (-y / 6, y / 6), (rise / 3, rise)),
        part("screen", (back, min(back + 0.06, x)), (-y, y), (rise, height)),
    ]


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    return fill(size._replace(depth=1), "minecraft:black_concrete", "screen")


TEMPLATE = Template(
    name="monitor",
    class_id=SemanticClass.TVS,
    size_m=(Span(0.08, 0.22, 0.6), Span(0.3, 0.6, 1.6), Span(0.25, 0.48, 1.1)),
    build=_build,
    design=_design,
    parameters={"foot_height": Span(0.04, 0.12, 0.2)},
    mount="any",
)

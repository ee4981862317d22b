"""A desk: a top, side panels, a modesty panel at the back; one sits at its front."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import table
from world2minecraft.furniture.shapes import arms, backrest, slab
from world2minecraft.furniture.template import (
    BlockSize,
    LocalBlock,
    Parameters,
    Part,
    Span,
    Template,
)


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    under = max(height - 0.05, height / 2)
    drawers = arms(depth, width, 0.0, under, p["side_width"])
    panel = backrest(depth, width, under / 2, under, 0.04)
    return [*drawers, panel._replace(role="panel"), slab("top", depth, width, under, height)]


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    return table(size, "dark_oak")


TEMPLATE = Template(
    name="desk",
    class_id=SemanticClass.TABLE,
    size_m=(Span(0.45, 0.7, 0.9), Span(0.8, 1.35, 2.0), Span(0.66, 0.74, 0.85)),
    build=_build,
    design=_design,
    parameters={"side_width": Span(0.04, 0.08, 0.4)},
)

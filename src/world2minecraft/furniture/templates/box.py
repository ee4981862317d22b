"""Anything that fills a box: a carton, a bin, a microwave, a fridge."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import filled
from world2minecraft.furniture.shapes import slab
from world2minecraft.furniture.template import Parameters, Part, Span, Template


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    return [slab("body", depth, width, 0.0, height)]


TEMPLATE = Template(
    name="box",
    class_id=SemanticClass.OBJS,
    size_m=(Span(0.08, 0.4, 2.0), Span(0.08, 0.4, 2.0), Span(0.08, 0.4, 2.0)),
    build=_build,
    design=filled("minecraft:barrel[facing=up,open=false]", "body"),
    turns=1,
    mount="any",
)

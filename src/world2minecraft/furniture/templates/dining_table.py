"""A table on four legs."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import table
from world2minecraft.furniture.forms import four_legged
from world2minecraft.furniture.template import BlockSize, LocalBlock, Parameters, Span, Template


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    return table(size, "oak")


TEMPLATE = Template(
    name="dining_table",
    class_id=SemanticClass.TABLE,
    size_m=(Span(0.6, 0.85, 1.2), Span(0.7, 1.5, 3.0), Span(0.66, 0.75, 0.9)),
    build=four_legged,
    design=_design,
    parameters={"top_thickness": Span(0.03, 0.04, 0.16)},
    turns=2,
)

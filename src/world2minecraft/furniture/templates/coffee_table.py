"""A low table on four legs."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import table
from world2minecraft.furniture.forms import four_legged
from world2minecraft.furniture.template import BlockSize, LocalBlock, Parameters, Span, Template


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    return table(size, "spruce")


TEMPLATE = Template(
    name="coffee_table",
    class_id=SemanticClass.TABLE,
    size_m=(Span(0.35, 0.6, 1.1), Span(0.4, 1.0, 1.6), Span(0.25, 0.43, 0.62)),
    build=four_legged,
    design=_design,
    parameters={"top_thickness": Span(0.03, 0.04, 0.16)},
    turns=2,
)

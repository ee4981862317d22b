"""A sofa with a back and two arms."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import seat_row
from world2minecraft.furniture.forms import upholstered
from world2minecraft.furniture.template import (
    BlockSize,
    LocalBlock,
    Parameters,
    Part,
    Span,
    Template,
)


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    return upholstered(depth, width, height, p, back_m=0.22, arm_m=0.18)


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    return seat_row(size, "spruce", arms=True)


TEMPLATE = Template(
    name="sofa",
    class_id=SemanticClass.SOFA,
    size_m=(Span(0.7, 0.92, 1.15), Span(1.15, 2.0, 3.2), Span(0.6, 0.85, 1.1)),
    build=_build,
    design=_design,
    parameters={"arm_height": Span(0.55, 0.62, 0.75), "seat_height": Span(0.34, 0.43, 0.52)},
)

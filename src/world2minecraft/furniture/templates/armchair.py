"""An upholstered chair: a block to sit on, a back and two arms."""

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
    return upholstered(depth, width, height, p, back_m=0.2, arm_m=0.14)


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    return seat_row(size, "spruce", arms=True)


TEMPLATE = Template(
    name="armchair",
    class_id=SemanticClass.CHAIR,
    size_m=(Span(0.6, 0.8, 1.0), Span(0.58, 0.8, 1.05), Span(0.68, 0.9, 1.15)),
    build=_build,
    design=_design,
    parameters={"arm_height": Span(0.54, 0.6, 0.72), "seat_height": Span(0.34, 0.42, 0.5)},
)

"""A bed for two, with a wider headboard and two pillows."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.forms import bed_with_headboard, bedstead
from world2minecraft.furniture.template import (
    BlockSize,
    LocalBlock,
    Parameters,
    Part,
    Span,
    Template,
)


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    pillows = [(-0.45 * width, -0.05 * width), (0.05 * width, 0.45 * width)]
    return bedstead(depth, width, height, p, pillows)


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    return bed_with_headboard(size, "red")


TEMPLATE = Template(
    name="double_bed",
    class_id=SemanticClass.BED,
    size_m=(Span(1.7, 2.05, 2.35), Span(1.25, 1.65, 2.2), Span(0.4, 0.95, 1.4)),
    build=_build,
    design=_design,
    parameters={"mattress_height": Span(0.3, 0.5, 0.7)},
)

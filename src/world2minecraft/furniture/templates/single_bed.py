"""A bed for one."""

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
    pillows = [(-width / 3, width / 3)]
    return bedstead(depth, width, height, p, pillows)


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    return bed_with_headboard(size, "blue")


TEMPLATE = Template(
    name="single_bed",
    class_id=SemanticClass.BED,
    size_m=(Span(1.7, 2.05, 2.35), Span(0.75, 0.95, 1.25), Span(0.4, 0.8, 1.3)),
    build=_build,
    design=_design,
    parameters={"mattress_height": Span(0.3, 0.5, 0.7)},
)

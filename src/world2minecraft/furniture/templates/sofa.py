"""A sofa with a back and two arms."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import seat_row
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
    seat = min(p["seat_height"], 0.7 * height)
    return [
        slab("seat", depth, width, 0.0, seat),
        backrest(depth, width, seat, height, 0.22),
        *arms(depth, width, seat, min(p["arm_height"], height), 0.18),
    ]


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

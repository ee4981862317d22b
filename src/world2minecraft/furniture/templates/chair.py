"""A chair with four legs and a back."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import seat_row
from world2minecraft.furniture.shapes import backrest, legs, slab
from world2minecraft.furniture.template import (
    BlockSize,
    LocalBlock,
    Parameters,
    Part,
    Span,
    Template,
)


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    seat = min(p["seat_height"], 0.8 * height)
    under = max(seat - 0.05, seat / 2)
    return [
        *legs(depth, width, under, 0.04),
        slab("seat", depth, width, under, seat),
        backrest(depth, width, seat, height, 0.06),
    ]


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    return seat_row(size, "oak", arms=False)


TEMPLATE = Template(
    name="chair",
    class_id=SemanticClass.CHAIR,
    size_m=(Span(0.36, 0.48, 0.66), Span(0.34, 0.45, 0.6), Span(0.7, 0.88, 1.15)),
    build=_build,
    design=_design,
    parameters={"seat_height": Span(0.36, 0.46, 0.56)},
)

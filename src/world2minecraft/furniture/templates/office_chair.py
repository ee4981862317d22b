"""A swivel chair: a star foot, a post, a seat, a back and armrests."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import seat_row
from world2minecraft.furniture.shapes import arms, backrest, column, part, slab
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
    rest = min(p["arm_height"], height)
    beam = 0.04
    return [
        part("foot", (-depth / 2, depth / 2), (-beam, beam), (0.0, 0.08)),
        part("foot", (-beam, beam), (-width / 2, width / 2), (0.0, 0.08)),
        column("post", 2 * beam, 0.08, seat - 0.08),
        slab("seat", depth, width, seat - 0.08, seat),
        backrest(depth, width, seat, height, 0.08),
        *arms(0.6 * depth, width, rest - 0.05, rest, 0.06),
        *arms(0.1, width, seat, rest - 0.05, 0.04),
    ]


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    return seat_row(size, "dark_oak", arms=False)


TEMPLATE = Template(
    name="office_chair",
    class_id=SemanticClass.CHAIR,
    size_m=(Span(0.5, 0.6, 0.75), Span(0.5, 0.62, 0.75), Span(0.8, 1.02, 1.35)),
    build=_build,
    design=_design,
    parameters={"arm_height": Span(0.64, 0.68, 0.76), "seat_height": Span(0.4, 0.48, 0.56)},
)

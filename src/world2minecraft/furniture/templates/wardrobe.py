"""A tall closed cabinet, as high as a person or higher."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import filled
from world2minecraft.furniture.shapes import part
from world2minecraft.furniture.template import Parameters, Part, Span, Template

DOOR_M = 0.02


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    x, y = depth / 2, width / 2
    door = min(DOOR_M, x)
    return [
        part("body", (-x, x - door), (-y, y), (0.0, height)),
        part("door", (x - door, x), (-y, y), (0.0, height)),
    ]


TEMPLATE = Template(
    name="wardrobe",
    class_id=SemanticClass.FURN,
    size_m=(Span(0.45, 0.6, 0.8), Span(0.5, 1.2, 3.0), Span(1.5, 2.0, 2.6)),
    build=_build,
    design=filled(
        "minecraft:dark_oak_planks", "body", front="minecraft:stripped_dark_oak_log[axis=y]"
    ),
    mount="floor",
)

"""A closed cabinet that hangs on a wall."""

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
    name="wall_cabinet",
    class_id=SemanticClass.FURN,
    size_m=(Span(0.2, 0.35, 0.5), Span(0.3, 0.9, 3.6), Span(0.3, 0.7, 1.1)),
    build=_build,
    design=filled(
        "minecraft:spruce_planks", "body", front="minecraft:barrel[facing=east,open=false]"
    ),
    mount="wall",
)

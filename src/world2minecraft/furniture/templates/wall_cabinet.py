"""A closed cabinet that hangs on a wall."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import filled
from world2minecraft.furniture.forms import cupboard
from world2minecraft.furniture.template import Span, Template

TEMPLATE = Template(
    name="wall_cabinet",
    class_id=SemanticClass.FURN,
    size_m=(Span(0.2, 0.35, 0.5), Span(0.3, 0.9, 3.6), Span(0.3, 0.7, 1.1)),
    build=cupboard,
    design=filled(
        "minecraft:spruce_planks", "body", front="minecraft:barrel[facing=east,open=false]"
    ),
    mount="wall",
)

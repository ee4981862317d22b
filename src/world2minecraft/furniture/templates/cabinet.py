"""A closed cabinet, chest of drawers or nightstand that stands on the floor."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import filled
from world2minecraft.furniture.forms import cupboard
from world2minecraft.furniture.template import Span, Template

TEMPLATE = Template(
    name="cabinet",
    class_id=SemanticClass.FURN,
    size_m=(Span(0.3, 0.5, 0.8), Span(0.35, 0.9, 2.4), Span(0.4, 0.85, 1.5)),
    build=cupboard,
    design=filled(
        "minecraft:spruce_planks", "body", front="minecraft:barrel[facing=east,open=false]"
    ),
    mount="floor",
)

"""A tall closed cabinet, as high as a person or higher."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import filled
from world2minecraft.furniture.forms import cupboard
from world2minecraft.furniture.template import Span, Template

TEMPLATE = Template(
    name="wardrobe",
    class_id=SemanticClass.FURN,
    size_m=(Span(0.45, 0.6, 0.8), Span(0.5, 1.2, 3.0), Span(1.5, 2.0, 2.6)),
    build=cupboard,
    design=filled(
        "minecraft:dark_oak_planks", "body", front="minecraft:stripped_dark_oak_log[axis=y]"
    ),
    mount="floor",
)

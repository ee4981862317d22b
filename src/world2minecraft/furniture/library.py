"""The furniture library L of the paper: names to templates, one line each.

A package outside adds its own through the entry point group ``world2minecraft.template``; the
entry point names a ``Template``.
"""

from functools import cache

from world2minecraft.furniture.template import Template
from world2minecraft.registry import Registry

_FOLDER = "world2minecraft.furniture.templates"

TEMPLATES = Registry(
    "template",
    {
        "chair": f"{_FOLDER}.chair:TEMPLATE",
        "armchair": f"{_FOLDER}.armchair:TEMPLATE",
        "office_chair": f"{_FOLDER}.office_chair:TEMPLATE",
        "stool": f"{_FOLDER}.stool:TEMPLATE",
        "single_bed": f"{_FOLDER}.single_bed:TEMPLATE",
        "double_bed": f"{_FOLDER}.double_bed:TEMPLATE",
        "bunk_bed": f"{_FOLDER}.bunk_bed:TEMPLATE",
        "sofa": f"{_FOLDER}.sofa:TEMPLATE",
        "corner_sofa": f"{_FOLDER}.corner_sofa:TEMPLATE",
        "bench": f"{_FOLDER}.bench:TEMPLATE",
        "dining_table": f"{_FOLDER}.dining_table:TEMPLATE",
        "round_table": f"{_FOLDER}.round_table:TEMPLATE",
        "desk": f"{_FOLDER}.desk:TEMPLATE",
        "coffee_table": f"{_FOLDER}.coffee_table:TEMPLATE",
        "wall_tv": f"{_FOLDER}.wall_tv:TEMPLATE",
        "monitor": f"{_FOLDER}.monitor:TEMPLATE",
        "cabinet": f"{_FOLDER}.cabinet:TEMPLATE",
        "wall_cabinet": f"{_FOLDER}.wall_cabinet:TEMPLATE",
        "counter": f"{_FOLDER}.counter:TEMPLATE",
        "bookcase": f"{_FOLDER}.bookcase:TEMPLATE",
        "wardrobe": f"{_FOLDER}.wardrobe:TEMPLATE",
        "lamp": f"{_FOLDER}.lamp:TEMPLATE",
        "plant": f"{_FOLDER}.plant:TEMPLATE",
        "box": f"{_FOLDER}.box:TEMPLATE",
    },
)


@cache
def template(name: str) -> Template:
    """Return the template of this name.

    Raises:
        UnknownNameError: the library has none; the message suggests the nearest.
    """
    return TEMPLATES.load(name)


@cache
def templates_of(class_id: int) -> tuple[Template, ...]:
    """Return the templates of an object class, in the library's order."""
    every = (template(name) for name in TEMPLATES.names())
    return tuple(one for one in every if one.class_id == class_id)

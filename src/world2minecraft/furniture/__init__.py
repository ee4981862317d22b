"""The furniture library: parametric templates with a defined front, as parts, cells and blocks.

Custom designs can be added as data files in ``designs/``, or through the entry point group
``world2minecraft.template``; see docs/reference/furniture.md.
"""

from world2minecraft.furniture.block_designs import BlockDesign, DesignBlock, block_design
from world2minecraft.furniture.front_estimation import Facing, estimate_facing, read_surroundings
from world2minecraft.furniture.library import TEMPLATES, template, templates_of_class, variants_of
from world2minecraft.furniture.materials import Material
from world2minecraft.furniture.rasterization import (
    rasterize,
    size_in_cells,
    surface_cells,
    template_cells,
)
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span, Template
from world2minecraft.furniture.template_parameters import Look
from world2minecraft.furniture.template_validation import check_template

__all__ = [
    "TEMPLATES",
    "BlockDesign",
    "BlockSize",
    "DesignBlock",
    "Facing",
    "LocalBlock",
    "Look",
    "Material",
    "Part",
    "Span",
    "Template",
    "block_design",
    "check_template",
    "estimate_facing",
    "rasterize",
    "read_surroundings",
    "size_in_cells",
    "surface_cells",
    "template",
    "template_cells",
    "templates_of_class",
    "variants_of",
]

"""The furniture library: parametric templates with a named front, as parts, cells and blocks.

A design of your own is one data file in ``designs/``, or an entry point of the group
``world2minecraft.template``; see docs/furniture.md.
"""

from world2minecraft.furniture.appearance import Look
from world2minecraft.furniture.block_designs import Idiom, IdiomBlock, idiom
from world2minecraft.furniture.facing import Facing, facing, surroundings
from world2minecraft.furniture.library import TEMPLATES, template, templates_of, variants_of
from world2minecraft.furniture.materials import Material
from world2minecraft.furniture.rasterization import cells_of, raster, size_in_cells, surface
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span, Template
from world2minecraft.furniture.template_validation import check_template

__all__ = [
    "TEMPLATES",
    "BlockSize",
    "Facing",
    "Idiom",
    "IdiomBlock",
    "LocalBlock",
    "Look",
    "Material",
    "Part",
    "Span",
    "Template",
    "cells_of",
    "check_template",
    "facing",
    "idiom",
    "raster",
    "size_in_cells",
    "surface",
    "surroundings",
    "template",
    "templates_of",
    "variants_of",
]

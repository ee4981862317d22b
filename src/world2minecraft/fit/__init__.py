"""Shape fitting: fine occupancy to block states, object by object.

``fit_solid`` fits a target of sub-cells, ``fit_parts`` furniture that is given as boxes; both
choose from a ``ShapeSet`` and give numbers of its shapes.
"""

from world2minecraft.fit.coverage import covered
from world2minecraft.fit.objects import Fit, Target, fit_solid, solve, without_loose
from world2minecraft.fit.parts import PartsFit, fit_parts
from world2minecraft.fit.shapes import CALM, Shape, ShapeSet, shape_set

__all__ = [
    "CALM",
    "Fit",
    "PartsFit",
    "Shape",
    "ShapeSet",
    "Target",
    "covered",
    "fit_parts",
    "fit_solid",
    "shape_set",
    "solve",
    "without_loose",
]

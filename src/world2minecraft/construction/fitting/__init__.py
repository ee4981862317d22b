"""Shape fitting: fine occupancy to block states, object by object.

``fit_solid`` fits a target of sub-cells, ``fit_parts`` furniture that is given as boxes; both
choose from a ``ShapeSet`` and give numbers of its shapes.
"""

from world2minecraft.construction.fitting.coverage import covered, covered_blocks, thin_cells
from world2minecraft.construction.fitting.finish import finished, without_loose
from world2minecraft.construction.fitting.objects import Fit, even_of, fit_of, fit_solid, solve
from world2minecraft.construction.fitting.parts import PartsFit, fit_parts
from world2minecraft.construction.fitting.problem import Problem, Rules, Target, problem_of
from world2minecraft.construction.fitting.shapes import CALM, Shape, ShapeSet, shape_set

__all__ = [
    "CALM",
    "Fit",
    "PartsFit",
    "Problem",
    "Rules",
    "Shape",
    "ShapeSet",
    "Target",
    "covered",
    "covered_blocks",
    "even_of",
    "finished",
    "fit_of",
    "fit_parts",
    "fit_solid",
    "problem_of",
    "shape_set",
    "solve",
    "thin_cells",
    "without_loose",
]

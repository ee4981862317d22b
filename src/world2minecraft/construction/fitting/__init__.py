"""Shape fitting: convert the fine occupancy of an object to block states.

``fit_solid`` fits a target of sub-cells, ``fit_parts`` furniture given as boxes. Both choose shapes
from a ``ShapeSet`` and return their numbers.
"""

from world2minecraft.construction.fitting.object_fitting import (
    Fit,
    PartsFit,
    evaluate_fit,
    find_symmetry,
    fit_once,
    fit_parts,
    fit_solid,
    solve,
)
from world2minecraft.construction.fitting.problem import (
    Problem,
    Rules,
    Target,
    cover_blocks,
    cover_cells,
    problem_of,
    thin_cells,
)
from world2minecraft.construction.fitting.shapes import CALM, Shape, ShapeSet, shape_set
from world2minecraft.construction.fitting.stabilization import remove_loose_blocks, stabilize

__all__ = [
    "CALM",
    "Fit",
    "PartsFit",
    "Problem",
    "Rules",
    "Shape",
    "ShapeSet",
    "Target",
    "cover_blocks",
    "cover_cells",
    "evaluate_fit",
    "find_symmetry",
    "fit_once",
    "fit_parts",
    "fit_solid",
    "problem_of",
    "remove_loose_blocks",
    "shape_set",
    "solve",
    "stabilize",
    "thin_cells",
]

"""Which objects are shown well by their own cells, and what their cells are fitted to."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from world2minecraft.construction.celled import (
    CellsDesign,
    Solid,
    design_of_cells,
    inner_cells,
    kinds_of_sheet,
    shared_solids,
    solid_of,
)
from world2minecraft.construction.colour_sources import Coats
from world2minecraft.construction.fitted import LAID_ON
from world2minecraft.construction.lattice import Lattice
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import Placement
from world2minecraft.furniture.solids import OWN_CELLS

# What of these does not stand on a floor may hang on a wall.
HUNG = (SemanticClass.FURN, SemanticClass.TVS, SemanticClass.OBJS)
BULKY = {"slab", "stairs"}  # Without them a fit is of cubes, and those are better laid by parts.
# Below these a fit is worse than the library's design. reference/fit.md has 0.3 for cells that
# count whole; here what is one cell thick counts half.
LEAST_IOU, LEAST_THIN = 0.25, 0.5


def solids_of(
    placements: Sequence[Placement], held: Mapping[int, np.ndarray], coats: Coats
) -> dict[int, Solid]:
    """Return what placements are fitted to, copies alike, by the id of each."""
    solids: dict[int, Solid] = {}
    for one in placements:
        if len(held[id(one)]):
            cells, _ = coats.with_tops(held[id(one)])
            inner = inner_cells(cells, coats.grid, one.class_id)
            solids[id(one)] = solid_of(cells, inner, one.quarter_turns)
    return shared_solids(solids, {id(one): one.class_id for one in placements})


def well_fitted(
    placements: Sequence[Placement],
    held: Mapping[int, np.ndarray],
    solids: Mapping[int, Solid],
    coats: Coats,
    lattice: Lattice,
    kinds_of: Callable[[np.ndarray, Placement], frozenset[str]],
) -> dict[int, CellsDesign]:
    """Return the fits of what has a template, by the id of the placement, where they are good.

    The guard of reference/fit.md: an object that loses over half of its thin parts, or is
    missed by more than the least IoU, goes to the library instead; so do all chairs of a kind
    where one does, for they are to be equal.
    """
    side = coats.grid.voxel_m * lattice.blocks_per_metre
    made: dict[int, CellsDesign] = {}
    lost: set[str] = set()
    for one in (one for one in placements if one.template != OWN_CELLS and id(one) in solids):
        cells, hues = coats.with_tops(held[id(one)])
        kinds = kinds_of_sheet(kinds_of(hues, one), solids[id(one)], side)
        flush = one.class_id in LAID_ON
        of_cells = (
            cells,
            solids[id(one)],
            coats.grid,
            lattice,
            kinds,
            True,
            flush,
            one.class_id in HUNG,
        )
        fit = design_of_cells(*of_cells) if kinds & BULKY else None
        if fit and fit.fit.iou >= LEAST_IOU and fit.fit.thin_recall >= LEAST_THIN:
            made[id(one)] = fit
        elif one.class_id == SemanticClass.CHAIR:
            lost.add(one.template)
    kept = {id(one) for one in placements if one.template not in lost}
    return {number: fit for number, fit in made.items() if number in kept}

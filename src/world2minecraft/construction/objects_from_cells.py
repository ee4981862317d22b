"""Objects built from their own cells: as solids for shape fitting, or resampled to full blocks.

Closed objects are filled, and copies of an object share one solid. If no finer shape exists in the
colours of an object, it is resampled to full blocks in a way that preserves thin parts.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.block_lattice import Lattice, face_shares
from world2minecraft.construction.colour_sources import ColourSource
from world2minecraft.construction.fitted_objects import (
    LAID_ON,
    TIE,
    Design,
    base_layer,
    halves_from_layers,
    rotate_middle,
)
from world2minecraft.construction.fitting import (
    Fit,
    Rules,
    Target,
    cover_cells,
    find_symmetry,
    fit_once,
    shape_set,
    thin_cells,
)
from world2minecraft.construction.fitting.shapes import SUB
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import turn_grid
from world2minecraft.core.types import OWN_CELLS, UNSEEN, OccupancyGrid, Placement

PHASES = 4  # Shifts of a quarter block along x and y; finer ones changed nothing in reference/fit.
# What is closed: nobody sees into it, so what lies unseen under its skin belongs to it.
CLOSED = (SemanticClass.FURN, SemanticClass.SOFA, SemanticClass.BED)
NOISY = 4.0  # The factor on prices for cells of a scan: stairs where noise is, look like rubble.
SIZE_CELLS = 2  # Copies differ by at most so many cells along each axis,
COPY_IOU = 0.5  # and meet in so much of what either fills.
SLIM = 0.5  # What is a cell thick is thinner: a cell is on where an eighth of it is filled.
SHEET = 0.75  # Blocks: curtains, radiators, pictures, screens.
FRINGE = 0.25  # A layer with less than this share of the fullest one's cells is noise.
MIN_STRETCH, MAX_STRETCH = 0.8, 1.25  # By so much a side may be stretched to end with a block.
FLUSH = 0.35  # Blocks by which a table may be made higher, so that its top ends a block.
MAJORITY = 0.5  # A cell belongs to copies where so many of them have it.
# What of these does not stand on a floor may hang on a wall.
WALL_MOUNTED = (SemanticClass.FURN, SemanticClass.TVS, SemanticClass.OBJS)
BULKY = {"slab", "stairs"}  # Without them a fit is of cubes, and those are better laid by parts.
# Below these a fit is worse than the library's design. reference/fit.md has 0.3 for cells that
# count whole; here what is one cell thick counts half.
MIN_IOU, MIN_THIN = 0.25, 0.5


class HalfBlockShape(NamedTuple):
    """Half blocks in a box of the lattice, and the block of each cell."""

    low: np.ndarray  # int [3], the lattice index of the box's first block
    halves: np.ndarray  # uint8 [X, Y, Z]
    blocks: np.ndarray  # int [N, 3], lattice indices, one for each cell


def resample_cells(
    cells: np.ndarray, grid: OccupancyGrid, lattice: Lattice, share: float, shift: bool
) -> HalfBlockShape:
    """Resample the cells of an object to half blocks.

    Args:
        cells: Indices of at least one cell of the grid, int [N, 3].
        grid: Grid of the cells.
        lattice: Block lattice of the room.
        share: Minimum share of a block's face that the cells must cover.
        shift: Whether the object may move by up to half a block sideways and a quarter block up or
            down, to align with the lattice.
    """
    low_cell, high_cell = cells.min(0), cells.max(0) + 1
    mask = np.zeros(high_cell - low_cell, bool)
    mask[tuple((cells - low_cell).T)] = True
    edges = [
        lattice.edges_of(grid, axis)[low_cell[axis] : high_cell[axis] + 1] for axis in range(3)
    ]
    if shift:
        edges = _best_phase(mask, edges)
        # Its bottom goes to a half block, as a template's does: so a book lies on its table.
        edges[2] = edges[2] + np.floor(2 * edges[2][0] + 0.5) / 2 - edges[2][0]
    edges[2] = np.maximum(
        edges[2], lattice.ground_under(float(edges[2][0]))
    )  # What dips into the floor stands on it.
    low = np.array([int(np.floor(axis[0])) for axis in edges])
    high = np.array([int(np.ceil(axis[-1])) for axis in edges])
    high = np.maximum(high, low + 1)
    local = [edge - start for edge, start in zip(edges, low, strict=True)]
    halves = _halves(mask, local, high - low, share)
    middles = [np.floor((edge[:-1] + edge[1:]) / 2).astype(int) for edge in edges]
    blocks = np.stack([middles[axis][cells[:, axis] - low_cell[axis]] for axis in range(3)], 1)
    return HalfBlockShape(low, halves, blocks)


def _halves(mask: np.ndarray, edges: list[np.ndarray], size: np.ndarray, share: float):
    """Return the half blocks whose faces are covered; upright sheets are judged as a whole."""
    shape = tuple(size.tolist())
    doubled = [edges[0], edges[1], edges[2] * 2]
    shares = face_shares(mask, edges, shape)
    share = min(share, float(shares.max()))  # Nothing vanishes for being small.
    fine = face_shares(mask, doubled, (shape[0], shape[1], 2 * shape[2])) >= share
    whole = shares >= share
    halves = halves_from_layers(fine)
    halves[~whole] = 0
    halves[whole & (halves == 0)] = 3
    return halves


def _best_phase(mask: np.ndarray, edges: list[np.ndarray]) -> list[np.ndarray]:
    """Return the edges shifted along x and y so that few blocks are half covered."""
    best = list(edges)
    for axis in (0, 1):
        profile = mask.sum(tuple({0, 1, 2} - {axis})).astype(np.float64)
        scores = []
        for phase in range(-PHASES // 2, PHASES // 2 + 1):
            shifted = edges[axis] + phase / PHASES
            scores.append((_blur(profile, shifted), abs(phase), phase))
        best[axis] = edges[axis] + min(scores)[2] / PHASES
    return best


def _blur(profile: np.ndarray, edges: np.ndarray) -> float:
    """Return how far a profile of cells is from filling whole blocks; 0 is exact."""
    start = int(np.floor(edges[0]))
    count = int(np.ceil(edges[-1])) - start
    blocks = np.arange(start, start + count)[:, None]
    share = np.clip(
        np.minimum(edges[None, 1:], blocks + 1) - np.maximum(edges[None, :-1], blocks), 0, None
    )
    filled = share @ profile
    # The sum of squares is greatest when the mass stands in few blocks.
    return -round(float((filled**2).sum()), 6)


class Solid(NamedTuple):
    """The fitting target of an object: cells in its own frame, with its quarter turns undone."""

    mask: np.ndarray  # bool [X, Y, Z]
    turns: int


class CellsDesign(NamedTuple):
    """A design fitted to cells, the block of each cell, int [N, 3], and the scores of the fit."""

    design: Design
    blocks: np.ndarray
    fit: Fit


def enclosed_cells(cells: np.ndarray, grid: OccupancyGrid, class_id: int) -> np.ndarray:
    """Return the unseen cells inside a closed object, int [N, 3].

    Args:
        cells: Cells of the object, int [M, 3].
        grid: Grid of the cells.
        class_id: Class of the object.
    """
    if class_id not in CLOSED:
        return np.zeros((0, 3), int)
    low, high = cells.min(0), cells.max(0) + 1
    box = tuple(map(slice, low, high))
    mask = np.zeros(high - low, bool)
    mask[tuple((cells - low).T)] = True
    above = np.flip(np.logical_or.accumulate(np.flip(mask, 2), axis=2), 2)
    before = [np.logical_or.accumulate(mask, axis=axis) for axis in (0, 1)]
    behind = [np.flip(np.logical_or.accumulate(np.flip(mask, a), axis=a), a) for a in (0, 1)]
    beside = before[0] | behind[0] | before[1] | behind[1]
    unseen = (grid.source[box] == UNSEEN) & (grid.instance[box] == 0)
    return np.argwhere(above & beside & unseen & ~mask) + low


def make_solid(cells: np.ndarray, inner: np.ndarray, turns: int) -> Solid:
    """Combine the cells of an object, int [N, 3], and its inner cells, int [M, 3], to a solid."""
    low = cells.min(0)
    mask = np.zeros(cells.max(0) + 1 - low, bool)
    mask[tuple((cells - low).T)] = True
    mask[tuple((inner - low).T)] = True
    return Solid(np.ascontiguousarray(turn_grid(mask, -turns)), turns % 4)


def share_solids(solids: Mapping[int, Solid], classes: Mapping[int, int]) -> dict[int, Solid]:
    """Replace the solids of copies by the majority shape of all copies.

    Two objects of the same class are copies if their sizes differ by at most two cells and most of
    their cells coincide. Four similar chairs become four equal chairs.
    """
    groups: list[list[int]] = []
    for number in solids:
        for group in groups:
            if classes[group[0]] == classes[number] and _is_copy(
                solids[group[0]].mask, solids[number].mask
            ):
                group.append(number)
                break
        else:
            groups.append([number])
    result = dict(solids)
    for group in (one for one in groups if len(one) > 1):
        mask = _majority([solids[number].mask for number in group])
        result |= {number: Solid(mask, solids[number].turns) for number in group}
    return result


def _is_copy(one: np.ndarray, other: np.ndarray) -> bool:
    if max(abs(a - b) for a, b in zip(one.shape, other.shape, strict=True)) > SIZE_CELLS:
        return False
    first, second = _center_masks([one, other])
    shared, whole = np.count_nonzero(first & second), np.count_nonzero(first | second)
    return bool(shared >= COPY_IOU * whole)


def _center_masks(masks: Sequence[np.ndarray]) -> np.ndarray:
    """Return masks in a common frame, bool [N, X, Y, Z], with aligned centres and bottoms."""
    shape = np.max([mask.shape for mask in masks], axis=0)
    result = np.zeros((len(masks), *shape), bool)
    for index, mask in enumerate(masks):
        low = (shape - mask.shape) // 2 * [1, 1, 0]
        box = tuple(slice(a, a + n) for a, n in zip(low, mask.shape, strict=True))
        result[(index, *box)] = mask
    return result


def _majority(masks: Sequence[np.ndarray]) -> np.ndarray:
    """Return the bool mask of cells set in most of the masks, cropped to its box."""
    mean = _center_masks(masks).mean(0) >= MAJORITY
    at = np.argwhere(mean)
    return mean[tuple(map(slice, at.min(0), at.max(0) + 1))]


def fit_cells(
    cells: np.ndarray,
    solid: Solid,
    grid: OccupancyGrid,
    lattice: Lattice,
    kinds: frozenset[str],
    shift: bool,
    flush: bool = False,
    hangs: bool = False,
) -> CellsDesign:
    """Fit block shapes to an object's cells and place them.

    Args:
        cells: Indices of at least one cell of the grid, int [N, 3]; they define the position.
        solid: Fitting target, from ``make_solid`` or ``share_solids``.
        grid: Grid of the cells.
        lattice: Block lattice of the room.
        kinds: Kinds of shape that may be used.
        shift: Whether the object may move by up to half a block sideways and a quarter block up or
            down, to align with the lattice.
        flush: Whether the top must end at a block boundary if it nearly does, so that objects can
            rest on it.
        hangs: Whether the object hangs on a wall if it does not begin at a floor.
    """
    low, high = cells.min(0), cells.max(0) + 1
    ends = np.array([[lattice.edges_of(grid, a)[at[a]] for a in range(3)] for at in (low, high)])
    side = grid.voxel_m * lattice.blocks_per_metre
    base, bottom = base_layer(float(ends[0, 2]), lattice)
    stands = not hangs or base == lattice.ground_under(float(base))
    body = _body_of(solid.mask, side, bottom, shift, flush)
    target = _target(solid.mask, body, grid.voxel_m, bottom)
    shapes, turns = shape_set(kinds), solid.turns
    centre = ends[:, :2].mean(0) + _rotate_offset(body.middle, turns) * side
    rules = Rules(calm=NOISY, flush=body.flush, legs=True, phase=body.phase, stands=stands)
    if shift:
        fit = fit_once(target, kinds, replace(rules, even=_even(target, body)))
    else:
        at = np.round(centre * SUB).astype(int) % SUB
        fit = fit_once(target, kinds, rules, (int(at[0]), int(at[1])))
    middle = rotate_middle(fit, turns)
    xy = np.floor(centre - middle + 0.5 - TIE).astype(int)
    numbers = shapes.turns[turns][np.rot90(fit.numbers, turns)]
    design = Design(np.array([*xy, base]), numbers, (numbers > 0).astype(np.int16), shapes)
    moved = np.array([*(xy + middle - centre), base + bottom / SUB - ends[0, 2]])
    blocks = np.floor(ends[0] + (cells - low + 0.5) * side + moved).astype(int)
    last = design.low + numbers.shape - 1
    return CellsDesign(design, np.where(shift, np.clip(blocks, design.low, last), blocks), fit)


def kinds_for_sheet(kinds: frozenset[str], solid: Solid, side: float) -> frozenset[str]:
    """Return the kinds of shape that suit an object; upright sheets exclude stairs.

    Without a panel in its colour, a sheet is built of full blocks. ``side`` is the cell size in
    blocks.
    """
    thick = min(np.ptp(_bulk(solid.mask, axis)) for axis in (0, 1)) * side
    if thick > SHEET:
        return kinds
    return kinds - {"stairs"} if "trapdoor" in kinds else kinds - {"stairs", "slab"}


class Body(NamedTuple):
    """The main volume of an object in its own frame, and how it is stretched to whole blocks."""

    sides: np.ndarray  # float64 [3], the sides of a cell in blocks, stretched
    middle: np.ndarray  # float64 [2], the middle of the bulk off that of the box, in cells
    phase: tuple[int | None, int | None]  # where that middle must lie; None where it is free
    flush: bool


def _body_of(mask: np.ndarray, side: float, bottom: int, shift: bool, flush: bool) -> Body:
    """Return the main volume of cells, without a fringe of noise.

    A side that nearly ends at a block boundary is stretched to it: a rim of slabs and stairs around
    a bed would not be recognizable.
    """
    sides, middle = np.full(3, side), np.zeros(2)
    phase: list[int | None] = [None, None]
    if not shift:
        return Body(sides, middle, (None, None), False)
    for axis in (0, 1):
        first, last = _bulk(mask, axis)
        middle[axis] = (first + last - mask.shape[axis]) / 2
        blocks, factor = _whole(side * (last - first))
        if blocks:
            sides[axis], phase[axis] = side * factor, int(blocks * SUB / 2) % SUB
    first, last = _bulk(mask, 2)
    tall = side * last + bottom / SUB
    ends = flush and _ends_flush(tall)
    goal = np.ceil(tall - TIE) if ends else max(np.floor(2 * tall + 0.5) / 2, 0.5)
    factor = (goal - bottom / SUB) / (side * last)
    if MIN_STRETCH <= factor <= MAX_STRETCH:
        sides[2] = side * factor
    return Body(sides, middle, (phase[0], phase[1]), ends)


def _bulk(mask: np.ndarray, axis: int) -> tuple[int, int]:
    """Return the first layer along an axis that is not fringe, and the exclusive end."""
    areas = mask.sum(tuple({0, 1, 2} - {axis}))
    layers = np.flatnonzero(areas >= FRINGE * areas.max())
    return int(layers[0]), int(layers[-1]) + 1


def _whole(size: float) -> tuple[float, float]:
    """Return the number of blocks a size is stretched to and the factor; 0 if none is close."""
    for blocks in (np.floor(size + 0.5), np.floor(2 * size + 0.5) / 2):
        if blocks and MIN_STRETCH <= blocks / size <= MAX_STRETCH:
            return float(blocks), float(blocks / size)
    return 0.0, 1.0


def _rotate_offset(way: np.ndarray, turns: int) -> np.ndarray:
    """Rotate a vector in plan, float64 [2], by quarter turns counter-clockwise."""
    x, y = way.tolist()
    for _ in range(turns % 4):
        x, y = -y, x
    return np.array([x, y])


def _even(target: Target, body: Body) -> tuple[bool, bool]:
    """Return the axes along which a fit may be mirror-symmetric, as far as the phase allows."""
    along = [fixed is None or fixed % (SUB // 2) == 0 for fixed in body.phase]
    even = find_symmetry(target)
    return even[0] and along[0], even[1] and along[1]


def _ends_flush(tall: float) -> bool:
    """Return whether a height in blocks ends just below a block boundary and is raised to it."""
    rest = tall % 1
    return rest > 1 - FLUSH or rest < TIE


def _target(mask: np.ndarray, body: Body, voxel_m: float, bottom: int) -> Target:
    """Return cells as a target around the centre of their main volume."""
    shape = np.array(mask.shape)
    low = -(shape[:2] / 2 + body.middle) * body.sides[:2]
    high = low + shape[:2] * body.sides[:2]
    half = np.ceil(np.maximum(-low, high) * SUB - TIE).astype(int)
    tall = max(1, int(np.ceil(shape[2] * body.sides[2] * SUB - TIE)))
    starts = (*(half / SUB + low), 0.0)
    edges = [starts[a] + np.arange(shape[a] + 1) * body.sides[a] for a in range(3)]
    counts = [-(-int(n) // SUB) for n in (2 * half[0], 2 * half[1], tall)]
    inside = (slice(0, 2 * half[0]), slice(0, 2 * half[1]), slice(0, tall))
    thin = thin_cells(mask, voxel_m)
    wanted, slight = (cover_cells(values, edges, counts)[inside] for values in (mask, thin))
    return Target(wanted - SLIM * slight, (1 - SLIM) * slight, bottom)


def make_solids(
    placements: Sequence[Placement], held: Mapping[int, np.ndarray], colour_source: ColourSource
) -> dict[int, Solid]:
    """Return the fitting target of each placement by its id, equal for copies."""
    solids: dict[int, Solid] = {}
    for one in placements:
        if len(held[id(one)]):
            cells, _ = colour_source.with_tops(held[id(one)])
            inner = enclosed_cells(cells, colour_source.grid, one.class_id)
            solids[id(one)] = make_solid(cells, inner, one.quarter_turns)
    return share_solids(solids, {id(one): one.class_id for one in placements})


def good_fits(
    placements: Sequence[Placement],
    held: Mapping[int, np.ndarray],
    solids: Mapping[int, Solid],
    colour_source: ColourSource,
    lattice: Lattice,
    kinds_of: Callable[[np.ndarray, Placement], frozenset[str]],
) -> dict[int, CellsDesign]:
    """Fit the placements that have a template and return the good fits by placement id.

    A fit is rejected, and the library design used instead, if the object loses more than half of
    its thin parts or misses the minimum IoU (see reference/fit.md). If one chair of a kind is
    rejected, all chairs of that kind are, so that they look the same.
    """
    side = colour_source.grid.voxel_m * lattice.blocks_per_metre
    made: dict[int, CellsDesign] = {}
    lost: set[str] = set()
    for one in (one for one in placements if one.template != OWN_CELLS and id(one) in solids):
        cells, samples = colour_source.with_tops(held[id(one)])
        kinds = kinds_for_sheet(kinds_of(samples, one), solids[id(one)], side)
        if not kinds & BULKY:
            fit = None
        else:
            fit = fit_cells(
                cells,
                solids[id(one)],
                colour_source.grid,
                lattice,
                kinds,
                shift=True,
                flush=one.class_id in LAID_ON,
                hangs=one.class_id in WALL_MOUNTED,
            )
        if fit and fit.fit.iou >= MIN_IOU and fit.fit.thin_recall >= MIN_THIN:
            made[id(one)] = fit
        elif one.class_id == SemanticClass.CHAIR:
            lost.add(one.template)
    kept = {id(one) for one in placements if one.template not in lost}
    return {number: fit for number, fit in made.items() if number in kept}

"""Objects as blocks: templates by their parts or idioms, all else from its own cells."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from world2minecraft.build.canvas import Canvas
from world2minecraft.build.celled import (
    Solid,
    design_of_cells,
    inner_cells,
    shared_solids,
    solid_of,
)
from world2minecraft.build.cells import shape_of_cells
from world2minecraft.build.fitted import LAID_ON, Design, design_of_parts, of_halves, one_block
from world2minecraft.build.fitting import best_place, best_step
from world2minecraft.build.halves import FULL
from world2minecraft.build.hues import default_colour, spread
from world2minecraft.build.idioms import Thing, filled_by, idiom_box, put_idiom
from world2minecraft.build.lattice import volume_shares
from world2minecraft.build.materials import WEIGHTS, materials_of
from world2minecraft.build.morphology import beside
from world2minecraft.build.palettes import Palette
from world2minecraft.build.parameters import BuildParameters
from world2minecraft.build.parts import design_of
from world2minecraft.build.places import LAST, in_order, within_storeys
from world2minecraft.build.seats import chair_paints
from world2minecraft.build.surfaces import block_colours, painted
from world2minecraft.build.tinting import Hue
from world2minecraft.build.tops import top_cells
from world2minecraft.build.worktops import Worktop, find_worktop, joined
from world2minecraft.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.fit import without_loose
from world2minecraft.furniture import Idiom, idiom, template
from world2minecraft.geometry.colour import oklab_of_srgb
from world2minecraft.metrics.solids import own_cells
from world2minecraft.minecraft.colours import colours_of
from world2minecraft.types import UNSEEN, OccupancyGrid, Placement

CELLS = "cells"
PAINTS = {int(SemanticClass.TABLE): 1}  # A table is of one wood; shade and glare are not.
OPEN = 0.6  # A block of which more than this was seen free holds nothing but a thin part.
MOST_GIVEN_UP = 0.06  # Oklab distance that a colour may lose for the sake of a shape.
BULKY = {"slab", "stairs"}  # Without them a fit is of cubes, and those are better laid by parts.
LEAST_IOU, LEAST_THIN = 0.3, 0.5  # Below these a fit is worse than the library's design.
MOST_COLOURS = 400  # Of an object, looked at to see which shapes exist in them.
SURE_IOU = 0.5  # What matched as well as this is no guess; a block of a thin part is mostly free.
FINE_SCALE = 3.0  # Blocks per metre from which a design is held against what was seen free.
FACES = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))


class ObjectBuilder:
    """Sets the objects of one room on a canvas whose shell stands."""

    def __init__(
        self,
        canvas: Canvas,
        grid: OccupancyGrid,
        colours: np.ndarray,
        coloured: np.ndarray,
        palette: Palette,
        parameters: BuildParameters,
        footprints: Sequence[np.ndarray],
    ):
        free = (grid.labels == 0) & (grid.source != UNSEEN)
        self.exposed = beside(free)  # What lies inside an object says nothing of how it looks.
        self.open_share = volume_shares(free, grid, canvas.lattice)
        self.within = within_storeys(canvas, footprints)
        self.canvas, self.grid, self.palette = canvas, grid, palette
        self.colours, self.coloured = colours, coloured
        self.parameters = parameters
        self.lattice = canvas.lattice
        self.materials = materials_of(palette)
        self.worktops: dict[int, Worktop] = {}
        self.paints = chair_paints(
            grid, colours, coloured & self.exposed, parameters.lightness_weight
        )

    def put_all(self, placements: Sequence[Placement]) -> None:
        """Set every placement, then the object cells that no block near them shows."""
        self.put_worktops()
        voxels = self.parameters.style == "voxels"
        held = {id(one): self._cells_of(one) for one in placements}
        own = [one for one in placements if one.template == CELLS or voxels]
        solids = self._solids_of(own, held)
        for placement in sorted(placements, key=in_order):
            cells = held[id(placement)]
            known = placement.template != CELLS
            solid = solids.get(id(placement))
            if voxels and known and solid and self.put_well(placement, cells, solid):
                continue
            if not known or not self.put_template(placement, cells, forced=not len(cells)):
                self.put_cells(cells, placement.class_id, placement.object_id, solid)
        rest = np.isin(self.grid.labels, OBJECT_CLASSES)
        rest &= ~self._shown()
        keys = (self.grid.labels.astype(np.int32) << 16) + self.grid.instance
        for key in np.unique(keys[rest]).tolist():
            self.put_cells(np.argwhere(rest & (keys == key)), key >> 16, key & 0xFFFF)
        classes = {one.object_id: one.class_id for one in placements}
        for number in sorted(set(classes) - set(np.unique(self.canvas.instance).tolist())):
            self._put_one(classes[number], number)

    def _put_one(self, class_id: int, number: int) -> None:
        """Set the one free block that stands best for an object all of whose places are taken."""
        cells = np.argwhere(self.grid.instance == number)
        if not len(cells):
            return
        blocks, counts = np.unique(self._blocks_of(cells), axis=0, return_counts=True)
        free = (self.canvas.states == 0) & self.within
        place = best_place(blocks, counts, free)
        if place is not None:
            hues = Hues(cells, np.broadcast_to(place, cells.shape))
            self._put_shapes(one_block(place), hues, Thing(class_id, number))

    def put_worktops(self) -> None:
        """Set the glossy worktops; what else their objects are made of comes under and on them."""
        if not self.parameters.close_tops:
            return
        for number in np.unique(self.grid.instance[self.grid.labels == SemanticClass.FURN]):
            cells = np.argwhere(
                (self.grid.instance == number) & (self.grid.labels == SemanticClass.FURN)
            )
            top = find_worktop(self.grid, cells, self.colours, self.coloured, self.lattice)
            if number and top is not None:
                self.worktops[int(number)] = top
        self.worktops = joined(self.worktops)
        for number, top in self.worktops.items():
            self._put_plate(top, top.columns, number)

    def _put_plate(self, top: Worktop, columns: np.ndarray, number: int) -> None:
        """Set the plate of a worktop over columns, bool [X, Y], where nothing stands."""
        mask = np.zeros(self.lattice.shape, bool)
        mask[1:-1, 1:-1, top.layer] = columns[1:-1, 1:-1]
        mask &= self.canvas.states == 0
        choices = (
            list(self.palette.slabs)
            if top.half != FULL
            else list(self.palette.blocks[SemanticClass.FURN])
        )
        apart = np.linalg.norm(oklab_of_srgb(colours_of(choices)) - top.colour, axis=1)
        block = choices[int(apart.argmin())]
        state = f"{self.palette.slabs[block]}[type=bottom]" if top.half != FULL else block
        self.canvas.put(mask, self.canvas.id_of(state), SemanticClass.FURN, number)

    def _shown(self) -> np.ndarray:
        """Return the cells, bool [X, Y, Z], that lie in or beside a block of their own object."""
        cells = np.argwhere(np.isin(self.grid.labels, OBJECT_CLASSES))
        numbers = self.grid.instance[tuple(cells.T)]
        blocks = self._blocks_of(cells)
        shape = np.array(self.lattice.shape)
        shown = np.zeros(len(cells), bool)
        for step in ((0, 0, 0), *FACES):
            at = tuple(np.clip(blocks + step, 0, shape - 1).T)
            shown |= (self.canvas.instance[at] == numbers) & (numbers > 0)
        result = np.zeros(self.grid.shape, bool)
        result[tuple(cells[shown].T)] = True
        return result

    def _cells_of(self, placement: Placement) -> np.ndarray:
        """Return the cells, int [N, 3], of a placement's object that lie in its box or by it."""
        reach = 2 * self.grid.voxel_m
        return own_cells(replace(placement, size_m=placement.size_m + reach), self.grid)

    def _solids_of(
        self, placements: Sequence[Placement], held: Mapping[int, np.ndarray]
    ) -> dict[int, Solid]:
        """Return what placements are fitted to, copies alike, by the id of each."""
        solids: dict[int, Solid] = {}
        for one in placements:
            if len(held[id(one)]):
                cells, _ = self._with_tops(held[id(one)])
                inner = inner_cells(cells, self.grid, one.class_id)
                solids[id(one)] = solid_of(cells, inner, one.quarter_turns)
        return shared_solids(solids, {id(one): one.class_id for one in placements})

    def put_well(self, placement: Placement, cells: np.ndarray, solid: Solid) -> bool:
        """Set an object of a template from its own cells; False, and nothing, where they fit badly.

        The guard of reference/fit.md: an object that loses over half of its thin parts, or is
        missed by more than the least IoU, goes to the library instead.
        """
        thing = Thing(placement.class_id, placement.object_id)
        cells, hues = self._with_tops(cells)
        kinds = self._kinds(hues, thing)
        if not kinds & BULKY:
            return False
        made = design_of_cells(
            cells, solid, self.grid, self.lattice, kinds, True, placement.class_id in LAID_ON
        )
        if made.fit.iou < LEAST_IOU or made.fit.thin_recall < LEAST_THIN:
            return False
        self._put_design(made.design, Hues(hues, made.blocks), thing)
        return True

    def put_cells(
        self, cells: np.ndarray, class_id: int, number: int, solid: Solid | None = None
    ) -> None:
        """Set an object from its own cells; ``solid`` is what they are fitted to, where known."""
        if not len(cells):
            return
        cells, hues = self._with_tops(cells)
        thing = Thing(class_id, number)
        kinds = self._kinds(hues, thing)
        if kinds & BULKY:
            solid = solid or solid_of(cells, inner_cells(cells, self.grid, class_id), 0)
            made = design_of_cells(
                cells, solid, self.grid, self.lattice, kinds, number > 0, class_id in LAID_ON
            )
            design, blocks = made.design, made.blocks
        else:
            share = self.parameters.object_share
            shape = shape_of_cells(cells, self.grid, self.lattice, share, shift=number > 0)
            design, blocks = of_halves(shape.low, shape.halves), shape.blocks
        self._put_design(design, Hues(hues, blocks), thing)

    def _put_design(self, design: Design, hues: "Hues", thing: Thing) -> None:
        """Set a design of own cells; one that hangs flush on a wall takes wall blocks."""
        window = self._window(design.low, design.numbers.shape)
        filled = design.filled[window.box]
        if _is_flush(filled, window):
            numbers = np.where(filled & window.wall, 1, design.numbers[window.box] * window.free)
        else:
            if (
                thing.instance and thing.class_id in LAST
            ):  # Crumbs of furniture stay where they are.
                step = self._step(design.filled, design.low)
                design, hues = design.moved(step), hues._replace(blocks=hues.blocks + step)
                window = self._window(design.low, design.numbers.shape)
            numbers = design.numbers[window.box] * window.free
            numbers = without_loose(numbers, design.shapes, window.held)
        self._put_shapes(design.cut(window.low, window.box, numbers), hues, thing)

    def put_template(self, placement: Placement, cells: np.ndarray, *, forced: bool) -> bool:
        """Set a template by its vanilla design at small scales, else by its parts.

        Returns:
            False where its parts would stand in space that was seen free: nothing is set then,
            unless it is ``forced``.
        """
        thing = Thing(placement.class_id, placement.object_id)
        found = idiom(placement, self.lattice.blocks_per_metre)
        if found is not None:
            return self._put_idiom(found, placement, cells, thing, forced)
        parts = template(placement.template).parts(placement.size_m, placement.parameters)
        kinds = self._kinds(cells, thing)
        if kinds & BULKY:
            design = design_of_parts(placement, parts, self.lattice, kinds)
        else:
            coarse = design_of(placement, parts, self.lattice)
            design = of_halves(coarse.low, coarse.halves, coarse.part)
        window = self._window(design.low, design.numbers.shape)
        if not forced and self._contradicted(design, window) > self._limit(placement):
            return False
        design = design.moved(self._step(design.filled, design.low))
        self._plate_over(design, thing.instance)
        window = self._window(design.low, design.numbers.shape)
        hues = self._stretched(cells, placement, design.low, design.numbers.shape)
        numbers = design.numbers[window.box] * window.free
        self._put_shapes(design.cut(window.low, window.box, numbers), hues, thing)
        return True

    def _put_idiom(
        self, found: Idiom, placement: Placement, cells: np.ndarray, thing: Thing, forced: bool
    ) -> bool:
        """Set a vanilla design; at fine scales a guessed one not where it was seen free."""
        low, size = idiom_box(found, placement, self.lattice)
        if self.lattice.blocks_per_metre >= FINE_SCALE:
            filled = filled_by(found)
            guessed = not forced and placement.iou < SURE_IOU
            if guessed and self._open_in(filled, low) > self._limit(placement):
                return False
            low = low + self._step(filled, low)
        hues = self._stretched(cells, placement, low, size.tolist())
        seen = block_colours(tuple(size.tolist()), hues.blocks - low, *self._coloured(hues))
        hue = Hue(*seen, self.paints.get(thing.instance))
        put_idiom(self.canvas, found, low, thing, hue, self.palette, self.within, self.parameters)
        return True

    def _limit(self, placement: Placement) -> float:
        """Return how much of a design may stand in space that was seen free."""
        if placement.class_id == SemanticClass.CHAIR:
            return self.parameters.chair_contradicted
        return self.parameters.most_contradicted

    def _open_in(self, filled: np.ndarray, low: np.ndarray) -> float:
        """Return the share of blocks, bool [X, Y, Z] at ``low``, that were seen free."""
        at = np.argwhere(filled) + low
        inside = ((at >= 0) & (at < self.open_share.shape)).all(axis=1)
        return float((self.open_share[tuple(at[inside].T)] > OPEN).mean()) if inside.any() else 0.0

    def _kinds(self, cells: np.ndarray, thing: Thing) -> frozenset[str]:
        """Return the kinds of shape that exist in the colours of an object with cells [N, 3]."""
        if self.parameters.shapes == "cubes":
            return frozenset(("full",))
        paint = self.paints.get(thing.instance)
        if paint is not None:
            colours = np.reshape(paint, (-1, 3))
        else:
            colours, usable = self._coloured(Hues(cells, cells))
            colours = colours[usable]
        few = colours[:: 1 + len(colours) // MOST_COLOURS]
        full = self.palette.blocks[thing.class_id]
        preferred = self.palette.preferred[thing.class_id] or full
        handicaps = np.array([self.parameters.preference * (one not in preferred) for one in full])
        weight = self.parameters.lightness_weight
        return self.materials.kinds_for(few, full, handicaps, thing.class_id, weight)

    def _plate_over(self, design: Design, number: int) -> None:
        """Let an object's worktop cover one of its designs that reaches up to it."""
        top = self.worktops.get(number)
        if top is None:
            return
        level = top.layer - int(design.low[2])
        if level == design.numbers.shape[2] - 1:
            columns = np.zeros(self.lattice.shape[:2], bool)
            for x, y in np.argwhere(design.filled[:, :, level]) + design.low[:2]:
                columns[x, y] = True
            self._put_plate(top, columns, number)

    def _step(self, filled: np.ndarray, low: np.ndarray) -> np.ndarray:
        """Return the step of at most a block, int64 [3], that keeps most of a thing whole."""
        free = (self.canvas.states == 0) & self.within
        stands = int(low[2]) == self.lattice.ground_under(float(low[2]))
        return best_step(filled, low, free, self.open_share > OPEN, stands)

    def _contradicted(self, design: Design, window: "Window") -> float:
        """Return the share of a design's blocks that were seen free and nearly nothing else."""
        filled = np.argwhere(design.filled[window.box]) + window.low
        return float((self.open_share[tuple(filled.T)] > OPEN).mean()) if len(filled) else 0.0

    def _with_tops(self, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return an object's cells with its top closed, and the cells that colour them.

        A chair has none: what is unseen beside its back lies under the table before it.
        """
        if not (self.parameters.close_tops and len(cells)):
            return cells, cells
        if np.bincount(self.grid.labels[tuple(cells.T)]).argmax() == SemanticClass.CHAIR:
            return cells, cells
        added, alike = top_cells(self.grid, cells)
        return np.concatenate([cells, added]), np.concatenate([cells, alike])

    def _stretched(
        self, cells: np.ndarray, placement: Placement, low: np.ndarray, shape: Sequence[int]
    ) -> "Hues":
        """Return what colours a design when the placement's box is stretched over it.

        The snapped design stands up to half a block off the object; its front must take the
        colours of the object's front all the same.
        """
        cells, hues = self._with_tops(cells)
        size = placement.size_m[[1, 0, 2]] if placement.quarter_turns % 2 else placement.size_m
        centres = self.grid.origin_m + (cells + 0.5) * self.grid.voxel_m
        share = (centres - placement.center_m) / size + 0.5
        near = (np.abs(share - 0.5) <= 0.5 + self.grid.voxel_m / size).all(1)
        blocks = np.floor(share[near] * np.array(shape)).astype(int)
        return Hues(hues[near], np.clip(blocks, 0, np.array(shape) - 1) + low)

    def _blocks_of(self, cells: np.ndarray) -> np.ndarray:
        """Return the block, int [N, 3], in which each cell's centre lies, above the floor."""
        centres = self.grid.origin_m + (cells + 0.5) * self.grid.voxel_m
        blocks = np.floor(self.lattice.coordinates_of(centres)).astype(int)
        blocks[:, 2] = np.maximum(blocks[:, 2], self.lattice.ground)
        return blocks

    def _window(self, low: np.ndarray, shape: tuple[int, ...]) -> "Window":
        high = np.minimum(low + shape, np.array(self.lattice.shape) - 1)
        start = np.maximum(low, [1, 1, self.lattice.ground])
        stop = np.maximum(high, start)
        box = tuple(slice(int(a), int(b)) for a, b in zip(start - low, stop - low, strict=True))
        inside = tuple(slice(int(a), int(b)) for a, b in zip(start, stop, strict=True))
        around = tuple(slice(int(a) - 1, int(b) + 1) for a, b in zip(start, stop, strict=True))
        stands = self.canvas.states[around] > 0
        free = ~stands[1:-1, 1:-1, 1:-1] & self.within[inside]
        wall = self.canvas.semantic[inside] == SemanticClass.WALL
        return Window(box, start, free, wall, beside(stands)[1:-1, 1:-1, 1:-1])

    def _coloured(self, hues: "Hues") -> tuple[np.ndarray, np.ndarray]:
        """Return the colours, float32 [N, 3], of cells and which of them are one, bool [N]."""
        at = tuple(hues.cells.T)
        usable = self.coloured[at] & self.exposed[at]
        return self.colours[at], usable if usable.any() else self.coloured[at]

    def _put_shapes(self, design: Design, hues: "Hues", thing: "Thing") -> None:
        """Paint a design and set it.

        A block without a colour of its own takes that of its part: a seat's that of the seat.
        """
        filled, low = design.filled, design.low
        if not filled.any():
            return
        tinted, known = block_colours(filled.shape, hues.blocks - low, *self._coloured(hues))
        default = default_colour(self.palette.defaults[thing.class_id])
        colours = tinted.copy()
        for group in np.unique(design.part[filled]):
            mask = filled & (design.part == group)
            usable = known & (mask if (known & mask).any() else filled)
            colours[mask] = spread(tinted, usable, mask, default)
        paint = self.paints.get(thing.instance)
        if paint is not None:
            colours[filled], known = paint, filled
        states = self._states(design, colours, filled & known.any(), thing.class_id)
        at = tuple(np.argwhere(filled).T[axis] + low[axis] for axis in range(3))
        names, index = np.unique(states.astype(str), return_inverse=True)
        ids = self.canvas.ids_of(names.tolist())[index]
        self.canvas.put(at, ids, thing.class_id, thing.instance)

    def _states(
        self, design: Design, colours: np.ndarray, known: np.ndarray, class_id: int
    ) -> np.ndarray:
        """Return the states, object [N], of a design's N blocks: its shapes in its colours.

        Each kind of shape is painted with what exists in it. Where that would miss the colour, it
        is a full block of the right one.
        """
        most = PAINTS.get(class_id, self.parameters.object_colours)
        choice = (class_id, self.palette, self.parameters, most)
        full = self.palette.blocks[class_id]
        kinds = design.shapes.kinds[design.numbers]
        used = sorted(set(kinds[design.filled].tolist()) - {"full"})
        shaped = design.filled & (kinds != "full")
        plain = np.empty(design.numbers.shape, object)
        own, able = plain.copy(), self.materials.in_all(used, full)
        if able and shaped.any():
            own[shaped] = painted(shaped, colours, known & shaped, *choice, only=able)
        alike = frozenset(own[shaped].tolist()) if able else frozenset()
        plain[design.filled] = painted(design.filled, colours, known, *choice, used=alike)
        if not able:
            own = plain
        result = plain.copy()
        for at in zip(*np.nonzero(shaped), strict=True):
            shape = design.shapes.shapes[int(design.numbers[at]) - 1]
            near = self._is_near(own[at], plain[at], colours[at])
            state = self.materials.dressed(shape, own[at] if near else plain[at])
            result[at] = state or plain[at]
        return result[design.filled]

    def _is_near(self, block: str, other: str, colour: np.ndarray) -> bool:
        """Whether a block shows a colour nearly as well as another does."""
        offered = oklab_of_srgb(colours_of([block, other]))
        light = np.sqrt(self.parameters.lightness_weight)
        apart = np.linalg.norm((offered - colour) * [light, *WEIGHTS[1:]], axis=1)
        return bool(apart[0] - apart[1] <= MOST_GIVEN_UP)


class Window(NamedTuple):
    """The part of a design that lies on the canvas, and what stands there."""

    box: tuple[slice, ...]  # of the design
    low: np.ndarray  # int [3], its first block on the canvas
    free: np.ndarray  # bool [X, Y, Z], nothing stands there
    wall: np.ndarray  # bool [X, Y, Z]
    held: np.ndarray  # bool [X, Y, Z], something stands there or beside it


class Hues(NamedTuple):
    """The cells that colour a thing, and the block that each of them colours."""

    cells: np.ndarray  # int [N, 3]
    blocks: np.ndarray  # int [N, 3], of the lattice


def _is_flush(filled: np.ndarray, window: Window) -> bool:
    """Whether most of a thing's blocks lie in a wall: a picture, a screen, a socket."""
    return bool((filled & window.wall).sum() > 0.5 * filled.sum())

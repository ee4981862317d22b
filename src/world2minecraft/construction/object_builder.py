"""Build objects as blocks, from template parts or designs, or from their own cells."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.construction.block_lattice import volume_shares
from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.cell_colours import block_colour, fill_colours
from world2minecraft.construction.colour_sets import CURTAIN
from world2minecraft.construction.colour_sources import BuildSource, ColourSamples, ColourSource
from world2minecraft.construction.design_placement import (
    CanvasWindow,
    ObjectColours,
    ObjectLabel,
    body_box,
    canvas_window,
    design_box,
    filled_blocks,
    place_design,
)
from world2minecraft.construction.fitted_objects import (
    LAID_ON,
    Design,
    design_of_halves,
    design_of_parts,
    single_block_design,
)
from world2minecraft.construction.fitting import remove_loose_blocks
from world2minecraft.construction.fitting.shapes import SUB
from world2minecraft.construction.objects_from_cells import (
    BULKY,
    CLOSED,
    WALL_MOUNTED,
    CellsDesign,
    Solid,
    enclosed_cells,
    fit_cells,
    good_fits,
    kinds_for_sheet,
    make_solid,
    make_solids,
    resample_cells,
)
from world2minecraft.construction.overlap_avoidance import best_place, best_step
from world2minecraft.construction.plants import is_plant, leafy_states
from world2minecraft.construction.simple_volumes import fill_boxes, simple_boxes
from world2minecraft.construction.surface_painting import (
    LIGHTER_SHARE,
    block_colours,
    chair_paints,
    lit_colour,
)
from world2minecraft.construction.template_blocks import (
    LATE_RANKS,
    ShapePainter,
    cells_near,
    half_block_design,
    max_free_share,
    placement_order,
    within_storeys,
)
from world2minecraft.construction.template_substitution import substitute_templates
from world2minecraft.construction.wall_screens import let_into_wall
from world2minecraft.construction.worktops import PlateBuilder
from world2minecraft.core.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.core.types import OWN_CELLS, UNSEEN, ObjectInstance, Placement
from world2minecraft.furniture import BlockDesign, block_design, template

UPHOLSTERED = (SemanticClass.SOFA, SemanticClass.BED)
OPEN = 0.6  # A block of which more than this was seen free holds nothing but a thin part.
PLAIN = {"full", "slab"}  # Of so few blocks a bed or cupboard with stairs and panels is rubble.
SURE_IOU = 0.5  # What matched as well as this is no guess; a block of a thin part is mostly free.
MAX_FREE = 0.5  # Share of a simple volume seen as free; above it, the volume is not the object.
FINE_SCALE = 3.0  # Blocks per metre from which a design is held against what was seen free.
MIN_ALONE = 0.25  # Blocks: a chair at one block a metre is less, and at two it is more.
FACES = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))


class ObjectBuilder:
    """Places the objects of a room on a canvas with a finished shell."""

    def __init__(
        self,
        canvas: Canvas,
        source: BuildSource,
        footprints: Sequence[np.ndarray],
        instances: Sequence[ObjectInstance] = (),
    ):
        grid, colours, coloured, palette, parameters = source
        free = (grid.labels == 0) & (grid.source != UNSEEN)
        self.colour_source = ColourSource(grid, colours, coloured, parameters.close_tops)
        self.open_share = volume_shares(free, grid, canvas.lattice)
        self.within = within_storeys(canvas, footprints)
        self.canvas, self.grid, self.palette = canvas, grid, palette
        self.colours, self.coloured = colours, coloured
        self.parameters = parameters
        self.lattice = canvas.lattice
        self.cell_blocks = grid.voxel_m * self.lattice.blocks_per_metre
        self.shape_painter = ShapePainter(palette, parameters)
        self.fitted = np.zeros(grid.shape, bool)  # Cells that some fit has shown or left out.
        self.plates = PlateBuilder(canvas, palette)
        self.paints = chair_paints(
            grid, colours, coloured & self.colour_source.exposed, parameters.lightness_weight
        )
        self.curtains = frozenset(one.id for one in instances if one.name == CURTAIN)
        self.plants = frozenset(one.id for one in instances if self._is_plant(one))
        self.uncertain = frozenset(
            one.id for one in instances if one.confidence < parameters.simple_below
        )

    def _is_plant(self, instance: ObjectInstance) -> bool:
        at = tuple(instance.cells.T)
        return is_plant(instance, self.colours[at][self.coloured[at]])

    def put_all(self, placements: Sequence[Placement]) -> None:
        """Place all templates, then the object cells that no nearby block represents."""
        if self.parameters.close_tops:
            self.plates.put_worktops(self.grid, self.colours, self.coloured)
        voxels = self.parameters.style == "voxels"
        if not voxels and self.lattice.blocks_per_metre < FINE_SCALE:
            placements = substitute_templates(placements, self._cells_of, self.colour_source)
        self.paints |= self._upholstery(placements)
        held = {id(one): self._cells_of(one) for one in placements}
        own = [one for one in placements if one.template == OWN_CELLS or voxels]
        simple = set() if voxels else {id(one) for one in own if one.object_id in self.uncertain}
        own = [one for one in own if id(one) not in simple]
        solids = make_solids(own, held, self.colour_source)
        well = {}
        if voxels:
            kinds = self._kinds_of_placement
            well = good_fits(placements, held, solids, self.colour_source, self.lattice, kinds)
        for placement in sorted(placements, key=placement_order):
            cells = held[id(placement)]
            known = placement.template != OWN_CELLS
            if id(placement) in simple:
                self.put_simple(placement.class_id, placement.object_id)
            elif id(placement) in well:
                self._put_fit(placement, cells, well[id(placement)])
            elif not known or not self.put_template(placement, cells, forced=not len(cells)):
                solid = solids.get(id(placement))
                self.put_cells(cells, placement.class_id, placement.object_id, solid)
        rest = np.isin(self.grid.labels, OBJECT_CLASSES)
        rest &= ~self._shown_cells() & ~self._represented_cells(placements) & ~self.fitted
        keys = (self.grid.labels.astype(np.int32) << 16) + self.grid.instance
        for key in np.unique(keys[rest]).tolist():
            cells, number = np.argwhere(rest & (keys == key)), key & 0xFFFF
            missing = number and not (self.canvas.instance == number).any()
            if missing or self._is_large(cells):
                self.put_cells(cells, key >> 16, number)
        self.plates.put_carpets()
        classes = {one.object_id: one.class_id for one in placements}
        for number in sorted(set(classes) - set(np.unique(self.canvas.instance).tolist())):
            if self._is_large(np.argwhere(self.grid.instance == number)):
                self._put_one(classes[number], number)

    def _upholstery(self, placements: Sequence[Placement]) -> dict[int, np.ndarray]:
        """Return the Oklab colour of each sofa and bed that has several placements, by number."""
        covered = [
            one.object_id
            for one in placements
            if one.template != OWN_CELLS and one.class_id in UPHOLSTERED
        ]
        result = {}
        for number in sorted({one for one in covered if covered.count(one) > 1}):
            cells = np.argwhere(self.grid.instance == number)
            colours, usable = self.colour_source.colours_of(ColourSamples(cells, cells))
            if usable.any():
                result[number] = lit_colour(colours[usable])
        return result

    def _is_large(self, cells: np.ndarray) -> bool:
        """Return whether cells, int [N, 3], are enough for a block.

        A cup as a cube would hide its table.
        """
        if self.lattice.blocks_per_metre >= FINE_SCALE or not len(cells):
            return True
        size = (np.ptp(cells, axis=0) + 1) * self.cell_blocks
        return float(np.prod(size)) >= MIN_ALONE

    def _put_one(self, class_id: int, number: int) -> None:
        """Set the best single free block for an object whose blocks are all occupied."""
        cells = np.argwhere(self.grid.instance == number)
        if not len(cells):
            return
        blocks, counts = np.unique(self._blocks_of(cells), axis=0, return_counts=True)
        free = (self.canvas.states == 0) & self.within
        place = best_place(blocks, counts, free)
        if place is not None:
            samples = ColourSamples(cells, np.broadcast_to(place, cells.shape))
            self._put_shapes(single_block_design(place), samples, ObjectLabel(class_id, number))

    def _represented_cells(self, placements: Sequence[Placement]) -> np.ndarray:
        """Return the mask of cells that a design of few blocks represents, bool [X, Y, Z].

        The remaining cells of a chair of one or two blocks would be a lump beside it.
        """
        if self.lattice.blocks_per_metre >= FINE_SCALE or self.parameters.style == "voxels":
            return np.zeros(self.grid.shape, bool)
        own = {one.object_id for one in placements if one.template == OWN_CELLS}
        designed = {one.object_id for one in placements} - own
        return np.isin(self.grid.instance, sorted(designed & set(np.unique(self.canvas.instance))))

    def _shown_cells(self) -> np.ndarray:
        """Return the mask of cells in or next to a block of their object, bool [X, Y, Z]."""
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
        return cells_near(placement, self.grid)

    def _kinds_of_placement(self, cells: np.ndarray, placement: Placement) -> frozenset[str]:
        return self._kinds(cells, ObjectLabel(placement.class_id, placement.object_id))

    def _put_fit(self, placement: Placement, cells: np.ndarray, made: CellsDesign) -> None:
        """Place a fit of an object's own cells."""
        cells, samples = self.colour_source.with_tops(cells)
        self.fitted[tuple(cells.T)] = True
        thing = ObjectLabel(placement.class_id, placement.object_id)
        self._put_design(made.design, ColourSamples(samples, made.blocks), thing)

    def put_cells(
        self, cells: np.ndarray, class_id: int, number: int, solid: Solid | None = None
    ) -> None:
        """Place an object from its cells, fitted to ``solid`` if given."""
        if not len(cells):
            return
        cells, samples = self.colour_source.with_tops(cells)
        thing = ObjectLabel(class_id, number)
        solid = solid or make_solid(cells, enclosed_cells(cells, self.grid, class_id), 0)
        kinds = kinds_for_sheet(self._kinds(samples, thing), solid, self.cell_blocks)
        if kinds & BULKY:
            made = fit_cells(
                cells,
                solid,
                self.grid,
                self.lattice,
                kinds,
                shift=number > 0,
                flush=class_id in LAID_ON,
                hangs=self._hangs(cells, class_id),
            )
            design, blocks = made.design, made.blocks
        else:
            share = self.parameters.object_share
            shape = resample_cells(cells, self.grid, self.lattice, share, shift=number > 0)
            design, blocks = design_of_halves(shape.low, shape.halves), shape.blocks
        self.fitted[tuple(cells.T)] = True
        self._put_design(design, ColourSamples(samples, blocks), thing)

    def put_simple(self, class_id: int, number: int) -> None:
        """Place an object as a few boxes of one material in its colour."""
        cells = np.argwhere(self.grid.instance == number)
        if not len(cells) or self.fitted[tuple(cells.T)].all():
            return
        thing = ObjectLabel(class_id, number)
        colours, usable = self.colour_source.colours_of(ColourSamples(cells, cells))
        if usable.any():
            share = 1.0 if class_id in UPHOLSTERED else LIGHTER_SHARE
            self.paints[number] = lit_colour(colours[usable], share)
        boxes = simple_boxes(cells, self.grid, self._floor_layer(cells))
        filled = fill_boxes(boxes, self.grid.shape)
        at = tuple(filled.T)
        free = (self.grid.labels[at] == 0) & (self.grid.source[at] != UNSEEN)
        if free.mean() > MAX_FREE:
            self.put_cells(cells, class_id, number)
            return
        kinds = self._kinds(cells, thing) & PLAIN
        made = fit_cells(
            filled,
            make_solid(filled, filled[:0], 0),
            self.grid,
            self.lattice,
            kinds,
            shift=True,
            flush=True,
            hangs=self._hangs(filled, class_id),
        )
        self.fitted[tuple(cells.T)] = True
        self._put_design(made.design, ColourSamples(filled, made.blocks), thing)

    def _floor_layer(self, cells: np.ndarray) -> int:
        """Return the first layer of the grid above the floor below an object."""
        bottom = self.lattice.coordinates_of(
            self.grid.origin_m + cells.min(axis=0) * self.grid.voxel_m
        )[2]
        ground = self.lattice.ground_under(float(bottom)) - self.lattice.offset[2]
        floor_m = ground / self.lattice.blocks_per_metre
        return round((floor_m - self.grid.origin_m[2]) / self.grid.voxel_m)

    def _hangs(self, cells: np.ndarray, class_id: int) -> bool:
        """Return whether an object that may hang on a wall has no block below it."""
        blocks = np.unique(self._blocks_of(cells), axis=0)
        lowest = blocks[blocks[:, 2] == blocks[:, 2].min()]
        under = self.canvas.states[tuple((lowest - [0, 0, 1]).T)] > 0
        return class_id in WALL_MOUNTED and not under.any()

    def _put_design(self, design: Design, samples: ColourSamples, thing: ObjectLabel) -> None:
        """Place a design made from cells; one that is flush with a wall replaces wall blocks.

        Wall cells with the label of an object that already stands elsewhere are not placed.
        """
        window = self._window(design)
        filled = design.filled[window.box]
        if window.is_flush(filled):
            if thing.instance and (self.canvas.instance == thing.instance).any():
                return
            numbers = np.where(filled & window.wall, 1, design.numbers[window.box] * window.free)
        else:
            # Crumbs of furniture stay where they are.
            if thing.instance and thing.class_id in LATE_RANKS:
                step = self._step(design.filled, design.low)
                design, samples = design.moved(step), samples._replace(blocks=samples.blocks + step)
                window = self._window(design)
            numbers = design.numbers[window.box] * window.free
            numbers = remove_loose_blocks(numbers, design.shapes, window.held)
        self._put_shapes(design.cut(window.low, window.box, numbers), samples, thing)

    def put_template(self, placement: Placement, cells: np.ndarray, *, forced: bool) -> bool:
        """Place a template: as its vanilla design at small scales, otherwise by its parts.

        Returns:
            False, without placing anything, if the parts would be in space seen as free and
            ``forced`` is False; otherwise True.
        """
        thing = ObjectLabel(placement.class_id, placement.object_id)
        found = block_design(placement, self.lattice.blocks_per_metre)
        if found is not None:
            return self._put_idiom(found, placement, cells, thing, forced)
        parts = template(placement.template).parts(placement.size_m, placement.parameters)
        kinds = self._kinds(cells, thing)
        if kinds & BULKY:
            design = design_of_parts(placement, parts, self.lattice, kinds)
        else:
            coarse = half_block_design(placement, parts, self.lattice)
            design = design_of_halves(coarse.low, coarse.halves, coarse.part)
        window = self._window(design)
        guessed = not forced and placement.iou < SURE_IOU
        if guessed and self._free_share(design, window) > max_free_share(
            placement, self.parameters
        ):
            return False
        design = design.moved(self._step(design.filled, design.low))
        self.plates.plate_over(design.filled, design.low, thing.instance)
        window = self._window(design)
        samples = self.colour_source.stretched(cells, placement, design.low, design.numbers.shape)
        numbers = design.numbers[window.box] * window.free
        self._put_shapes(design.cut(window.low, window.box, numbers), samples, thing)
        return True

    def _put_idiom(
        self,
        found: BlockDesign,
        placement: Placement,
        cells: np.ndarray,
        thing: ObjectLabel,
        forced: bool,
    ) -> bool:
        """Place a vanilla design; at fine scales, guessed designs are not placed in free space."""
        low, size = design_box(found, placement, self.lattice)
        within = self.within
        if self.lattice.blocks_per_metre < FINE_SCALE:
            found, low, within = let_into_wall(found, low, placement, self.canvas, within)
        else:
            filled = filled_blocks(found)
            guessed = not forced and placement.iou < SURE_IOU
            if guessed and self._open_in(filled, low) > max_free_share(placement, self.parameters):
                return False
            low = low + self._step(filled, low, held=placement.iou >= SURE_IOU)
        self.plates.plate_over(filled_blocks(found), low, thing.instance)
        start, solid = body_box(found, placement, self.lattice, low, size)
        samples = self.colour_source.stretched(cells, placement, start, solid.tolist())
        seen = block_colours(
            tuple(size.tolist()), samples.blocks - low, *self.colour_source.colours_of(samples)
        )
        own_colours = ObjectColours(*seen, self.paints.get(thing.instance))
        place_design(
            self.canvas, found, low, thing, own_colours, self.palette, within, self.parameters
        )
        self.fitted[tuple(cells.T)] = True
        return True

    def _open_in(self, filled: np.ndarray, low: np.ndarray) -> float:
        """Return the share of blocks, bool [X, Y, Z] at ``low``, that were seen as free."""
        at = np.argwhere(filled) + low
        inside = ((at >= 0) & (at < self.open_share.shape)).all(axis=1)
        return float((self.open_share[tuple(at[inside].T)] > OPEN).mean()) if inside.any() else 0.0

    def _window(self, design: Design) -> CanvasWindow:
        return canvas_window(self.canvas, self.within, design.low, design.numbers.shape)

    def _kinds(self, cells: np.ndarray, thing: ObjectLabel) -> frozenset[str]:
        """Return the kinds of shape that exist in the colours of an object of cells [N, 3]."""
        if thing.instance in self.curtains:
            return frozenset(("full",))
        paint = self.paints.get(thing.instance)
        if paint is not None:
            return self.shape_painter.kinds(np.reshape(paint, (-1, 3)), thing.class_id)
        colours, usable = self.colour_source.colours_of(ColourSamples(cells, cells))
        kinds = self.shape_painter.kinds(colours[usable], thing.class_id)
        coarse = self.lattice.blocks_per_metre < FINE_SCALE
        return kinds & PLAIN if coarse and thing.class_id in CLOSED else kinds

    def _step(self, filled: np.ndarray, low: np.ndarray, *, held: bool = False) -> np.ndarray:
        """Return the shift by at most one block, int64 [3], that keeps most of an object.

        An object ``held`` in place by a good match is moved only away from other objects, since the
        blocks of thin parts are mostly free anyway.
        """
        free = (self.canvas.states == 0) & self.within
        stands = int(low[2]) == self.lattice.ground_under(float(low[2]))
        opened = np.zeros_like(free) if held else self.open_share > OPEN
        return best_step(filled, low, free, opened, stands)

    def _free_share(self, design: Design, window: CanvasWindow) -> float:
        """Return the share of a design's blocks seen as free, except blocks that its cells fill.

        A thin panel leaves most of its block free.
        """
        filled = np.argwhere(design.filled[window.box])
        if not len(filled):
            return 0.0
        numbers = design.numbers[window.box][tuple(filled.T)]
        most = np.maximum(OPEN, 1 - design.shapes.volumes[numbers] / (2 * SUB**3))
        return float((self.open_share[tuple((filled + window.low).T)] > most).mean())

    def _blocks_of(self, cells: np.ndarray) -> np.ndarray:
        """Return the block of each cell's centre, int [N, 3], above the floor."""
        centres = self.grid.origin_m + (cells + 0.5) * self.grid.voxel_m
        blocks = np.floor(self.lattice.coordinates_of(centres)).astype(int)
        blocks[:, 2] = np.maximum(blocks[:, 2], self.lattice.ground)
        return blocks

    def _put_shapes(self, design: Design, samples: ColourSamples, thing: ObjectLabel) -> None:
        """Paint a design and place it.

        Blocks without a colour take the colour of their part.
        """
        filled, low = design.filled, design.low
        if not filled.any():
            return
        tinted, known = block_colours(
            filled.shape, samples.blocks - low, *self.colour_source.colours_of(samples)
        )
        default = block_colour(self.palette.defaults[thing.class_id])
        colours = tinted.copy()
        for group in np.unique(design.part[filled]):
            mask = filled & (design.part == group)
            usable = known & (mask if (known & mask).any() else filled)
            colours[mask] = fill_colours(tinted, usable, mask, default)
        paint = self.paints.get(thing.instance)
        if paint is not None:
            colours[filled], known = paint, filled
        cloth = thing.instance in self.curtains
        made_as = int(SemanticClass.SOFA) if cloth else thing.class_id
        states = self.shape_painter.states(design, colours, filled & known.any(), made_as)
        at = tuple(np.argwhere(filled).T[axis] + low[axis] for axis in range(3))
        if thing.instance in self.plants:
            states = leafy_states(states, at[2], colours[filled])
        names, index = np.unique(states.astype(str), return_inverse=True)
        ids = self.canvas.ids_of(names.tolist())[index]
        self.canvas.put(at, ids, thing.class_id, thing.instance)

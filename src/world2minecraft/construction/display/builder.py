"""Build the objects of a room as display entities, from template parts or from their cells."""

from collections import Counter
from collections.abc import Sequence

import numpy as np

from world2minecraft.construction.canvas import UNSEEN_BLOCKS, Canvas
from world2minecraft.construction.colour_sources import BuildSource
from world2minecraft.construction.display.block_alignment import BlockAligner
from world2minecraft.construction.display.boxes import (
    DisplayBox,
    Frame,
    display_entities,
    template_boxes,
    voxel_boxes,
)
from world2minecraft.construction.display.colliders import put_colliders
from world2minecraft.construction.display.part_materials import (
    nearest_state,
    role_colours,
    states_of_parts,
)
from world2minecraft.construction.display.worktops import (
    COUNTER,
    as_counter,
    deepened,
    plate_pieces,
)
from world2minecraft.construction.surface_painting import BlockChoice, chair_paints, paint_surface
from world2minecraft.construction.template_blocks import (
    LATE_RANKS,
    cells_near,
    max_free_share,
    placement_order,
)
from world2minecraft.construction.worktops import (
    Worktop,
    find_worktop,
    join_worktops,
    missing_top_cells,
)
from world2minecraft.core.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.core.coordinates import apply, cell_centers_m, invert
from world2minecraft.core.types import (
    OWN_CELLS,
    UNSEEN,
    ObjectInstance,
    OccupancyGrid,
    Placement,
)
from world2minecraft.furniture import Part, Template, template
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.geometry.morphology import dilate_faces
from world2minecraft.minecraft.entities import VIEW_BLOCKS
from world2minecraft.minecraft.visual_shapes import is_luminous

MAX_COLOURS = 3  # Each further one costs boxes; an object of four paints is rare.
# Numbers of pieces above which an object is simplified.
MAX_PIECES = {int(SemanticClass.FURN): 15, int(SemanticClass.OBJS): 24}
MAX_PIECES_ELSE, MAX_PIECES_ROUND = 8, 24
ASKEW_DEG = 5.0  # A smaller turn off the walls is noise of 8 cm cells.
LEFT_CELLS = 4  # Cells of an object that no template shows: fewer are noise.
FREE_SHARE = 0.5  # Cells: how finely a template is checked for free space.
FULL_LIGHT = 15
APART_BLOCKS, APART_STEPS = 0.0006, 12  # A display shows it across a room; 2 mm at most.


def frame_of_cells(cells: np.ndarray, grid: OccupancyGrid) -> Frame:
    """Return the upright, axis-aligned frame of at least one cell, int [N, 3]."""
    low = grid.origin_m + cells.min(axis=0) * grid.voxel_m
    size = (np.ptp(cells, axis=0) + 1) * grid.voxel_m
    return Frame(low + size * [0.5, 0.5, 0.0], size, 0.0)


def boxes_of_cells(
    cells: np.ndarray,
    colours: np.ndarray,
    known: np.ndarray,
    grid: OccupancyGrid,
    choice: BlockChoice,
) -> list[DisplayBox]:
    """Return the boxes of an object's cells in the frame of ``frame_of_cells``.

    Args:
        cells: Indices of at least one cell of the grid, int [N, 3].
        colours: Oklab colours of the cells, float32 [N, 3].
        known: Bool [N] mask of the cells with a valid colour.
        grid: Grid of the cells; unseen cells inside the object may be filled.
        choice: Blocks that may be used.
    """
    low, high = cells.min(axis=0), cells.max(axis=0) + 1
    at = tuple((cells - low).T)
    mask = np.zeros(high - low, bool)
    mask[at] = True
    tinted = np.zeros((*mask.shape, 3), np.float32)
    tinted[at] = colours
    has_colour = np.zeros(mask.shape, bool)
    has_colour[at] = known
    states = paint_surface(mask, tinted, has_colour, choice).astype(str)
    names, index = np.unique(states, return_inverse=True)
    labels = np.zeros(mask.shape, np.int32)
    labels[mask] = index + 1
    box = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
    unseen = np.asarray(grid.source[box] == UNSEEN) & ~mask
    size = (high - low) * grid.voxel_m
    low_m = np.array([-size[0] / 2, -size[1] / 2, 0.0])
    return voxel_boxes(labels, unseen & _between(mask), names.tolist(), low_m, grid.voxel_m)


def _between(mask: np.ndarray) -> np.ndarray:
    """Return the bool mask of cells with mask cells on both sides along at least two axes."""
    count = np.zeros(mask.shape, np.int8)
    for axis in range(3):
        before = np.logical_or.accumulate(mask, axis=axis)
        after = np.flip(np.logical_or.accumulate(np.flip(mask, axis), axis=axis), axis)
        count += before & after
    return np.asarray(count >= 2)


def remove_small_parts(cells: np.ndarray, least: int) -> np.ndarray:
    """Remove connected parts with fewer than ``least`` cells from cells int [N, 3]."""
    if not len(cells):
        return cells
    low = cells.min(axis=0)
    mask = np.zeros(cells.max(axis=0) - low + 1, bool)
    mask[tuple((cells - low).T)] = True
    parts, _ = label_components(mask)
    sizes = np.bincount(parts.ravel())
    numbers = parts[tuple((cells - low).T)]
    kept: np.ndarray = cells[sizes[numbers] >= least]
    return kept if len(kept) else cells


def max_boxes(found: Template) -> int:
    """Return the number of boxes above which a template is simplified."""
    if "round" in f"{found.name} {found.family}":
        return MAX_PIECES_ROUND
    return MAX_PIECES.get(found.class_id, MAX_PIECES_ELSE)


class DisplayBuilder:
    """Places the objects of a room with a finished shell as display entities and colliders."""

    def __init__(
        self,
        canvas: Canvas,
        source: BuildSource,
        instances: Sequence[ObjectInstance],
    ):
        grid, colours, coloured, palette, parameters = source
        free = (grid.labels == 0) & (grid.source != UNSEEN)
        self.free = free
        self.canvas, self.grid, self.palette, self.parameters = canvas, grid, palette, parameters
        self.colours, self.coloured = colours, coloured
        self.exposed = coloured & dilate_faces(free)
        self.paints = chair_paints(grid, colours, self.exposed, parameters.lightness_weight)
        self.instances = {one.id: one for one in instances}
        self.settler = BlockAligner(canvas, grid)
        self.shown = np.zeros(grid.shape, bool)
        self.plated = np.zeros(grid.shape[:2], bool)  # Columns under a counter's own plate.
        self.tops = self._worktops() if parameters.close_tops else {}
        self.set_count = 0
        reach = float(np.linalg.norm(canvas.lattice.shape))
        self.view_range = max(1.0, float(np.ceil(2 * reach / VIEW_BLOCKS) / 2))

    def put_all(self, placements: Sequence[Placement]) -> None:
        """Place all objects: first those with a template, then the remaining object cells."""
        counts = Counter(one.object_id for one in placements)
        placements = [deepened(as_counter(one, self.tops), self.grid) for one in placements]
        for placement in sorted(placements, key=placement_order):
            cells = cells_near(placement, self.grid)
            if placement.template == OWN_CELLS:
                self.put_cells(cells, placement.class_id, placement.object_id)
                continue
            found, frame = template(placement.template), self._frame_of(placement, counts)
            parts = found.parts(frame.size_m, placement.parameters)
            if len(cells) and self._free_share(parts, frame, placement) > max_free_share(
                placement, self.parameters
            ):
                self.put_cells(cells, placement.class_id, placement.object_id)
            else:
                self.put_template(found, parts, frame, cells, placement)
        self._put_rest()
        for number, top in self.tops.items():
            choices = self.palette.blocks[SemanticClass.FURN]
            state = nearest_state(top.colour, choices, self.parameters)[0]
            plate = plate_pieces(top, self.plated, self.grid, state)
            if plate is not None:
                self._put(*plate, int(SemanticClass.FURN), number, "any")

    def _worktops(self) -> dict[int, Worktop]:
        """Return the glossy worktops of the room by object number."""
        found = {}
        furn = self.grid.labels == SemanticClass.FURN
        for number in np.unique(self.grid.instance[furn & (self.grid.instance > 0)]).tolist():
            cells = np.argwhere(furn & (self.grid.instance == number))
            lattice = self.canvas.lattice
            top = find_worktop(self.grid, cells, self.colours, self.coloured, lattice)
            if top is not None:
                found[number] = top
        return join_worktops(found)

    def put_template(
        self,
        found: Template,
        parts: Sequence[Part],
        frame: Frame,
        cells: np.ndarray,
        placement: Placement,
    ) -> None:
        """Place a template by its parts, with each role of its material in the object's colours."""
        self.shown[tuple(cells.T)] = True
        colours = self._role_colours(found, parts, frame, cells, placement.object_id)
        if found.name == COUNTER and placement.object_id in self.tops:
            colours["top"] = self.tops[placement.object_id].colour
            low, high = (frame.bounds_m[:, :2] - self.grid.origin_m[:2]) / self.grid.voxel_m
            first, last = np.maximum(np.floor(low + 0.5), 0).astype(int), np.floor(high + 0.5)
            self.plated[first[0] : int(last[0]), first[1] : int(last[1])] = True
        states = states_of_parts(found, parts, colours, self.palette, self.parameters)
        scale = self.canvas.lattice.blocks_per_metre
        pieces = template_boxes(parts, states, max_boxes(found), scale)
        self._put(pieces, frame, placement.class_id, placement.object_id, found.mount)

    def put_cells(self, cells: np.ndarray, class_id: int, number: int) -> None:
        """Place an object from its cells, int [N, 3], with its unseen top closed."""
        cells = cells[~self.shown[tuple(cells.T)]]
        if not len(cells):
            return
        self.shown[tuple(cells.T)] = True
        cells = remove_small_parts(cells, LEFT_CELLS)
        tinted = cells
        if self.parameters.close_tops and class_id != SemanticClass.CHAIR:
            added, alike = missing_top_cells(self.grid, cells)
            cells, tinted = np.concatenate([cells, added]), np.concatenate([cells, alike])
        at = tuple(tinted.T)
        usable = self.exposed[at] if self.exposed[at].any() else self.coloured[at]
        limit = min(MAX_COLOURS, self.parameters.object_colours)
        choice = BlockChoice(class_id, self.palette, self.parameters, limit)
        pieces = boxes_of_cells(cells, self.colours[at], usable, self.grid, choice)
        self._put(pieces, frame_of_cells(cells, self.grid), class_id, number, "any")

    def _put(
        self, pieces: list[DisplayBox], frame: Frame, class_id: int, number: int, mount: str
    ) -> None:
        lattice = self.canvas.lattice
        moved = self.settler.settle(frame, mount, class_id in LATE_RANKS and mount != "floor")
        # Faces of two objects that lie in one plane would flicker.
        step = APART_BLOCKS * (self.set_count % APART_STEPS) / lattice.blocks_per_metre
        moved, self.set_count = moved.moved(np.full(3, step)), self.set_count + 1
        put_colliders(self.canvas, pieces, moved, class_id, number)
        dark = self._is_within_blocks(moved)
        self.canvas.entities += display_entities(
            pieces,
            moved,
            lattice.corner_m,
            lattice.blocks_per_metre,
            class_id,
            number,
            view_range=self.view_range,
            lights=[FULL_LIGHT if dark or is_luminous(one.state) else None for one in pieces],
        )

    def _is_within_blocks(self, frame: Frame) -> bool:
        """Return whether an object's entities are inside a block that blocks light."""
        middle = frame.base_m + np.array([0.0, 0.0, frame.size_m[2] / 2])
        at = np.floor(self.canvas.lattice.coordinates_of(middle)).astype(int)
        at = tuple(np.clip(at, 0, np.array(self.canvas.lattice.shape) - 1).tolist())
        return bool(self.canvas.states[at]) and not self.canvas.mask_of(*UNSEEN_BLOCKS)[at]

    def _put_rest(self) -> None:
        """Place the object cells that are in no placement and not next to one of their object."""
        rest = np.isin(self.grid.labels, OBJECT_CLASSES) & ~self.shown
        keys = (self.grid.labels.astype(np.int32) << 16) + self.grid.instance
        for key in np.unique(keys[rest]).tolist():
            own = self.shown & (self.grid.instance == key & 0xFFFF) & (self.grid.instance > 0)
            cells = np.argwhere(rest & (keys == key) & ~dilate_faces(own))
            if len(cells) >= LEFT_CELLS:
                self.put_cells(cells, key >> 16, key & 0xFFFF)

    def _frame_of(self, placement: Placement, counts: Counter[int]) -> Frame:
        """Return the frame of a placement: as matched, or as observed for an oblique object."""
        base = placement.center_m - [0.0, 0.0, placement.size_m[2] / 2]
        yaw = 90.0 * placement.quarter_turns
        frame = Frame(base, placement.size_m, yaw)
        one = self.instances.get(placement.object_id)
        if one is None or counts[placement.object_id] != 1:
            return frame
        off = (one.yaw_deg - yaw + 45.0) % 90.0 - 45.0
        if abs(off) < ASKEW_DEG:
            return frame
        swapped = round((one.yaw_deg - off - yaw) / 90.0) % 2
        size = one.size_m[[1, 0, 2]] if swapped else one.size_m
        spans = template(placement.template).size_m
        size = np.array([span.clip(float(side)) for span, side in zip(spans, size, strict=True)])
        size[2] = placement.size_m[2]
        return Frame(np.array([*one.center_m[:2], base[2]]), size, yaw + off)

    def _free_share(self, parts: Sequence[Part], frame: Frame, placement: Placement) -> float:
        """Return the share of a template's volume seen as free, well away from its own cells."""
        own = self.grid.instance == placement.object_id
        free = self.free & ~dilate_faces(dilate_faces(own))
        step = FREE_SHARE * self.grid.voxel_m
        inside = total = 0.0
        for part in parts:
            low, high = part.box_m[:3], part.box_m[3:]
            counts = np.clip(np.ceil((high - low) / step), 1, 64).astype(int)
            axes = [
                low[n] + (np.arange(counts[n]) + 0.5) * (high[n] - low[n]) / counts[n]
                for n in range(3)
            ]
            points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
            room = apply(frame.object_to_room, points)
            cells = np.floor((room - self.grid.origin_m) / self.grid.voxel_m).astype(int)
            known = ((cells >= 0) & (cells < self.grid.shape)).all(axis=1)
            volume = float(np.prod(high - low))
            inside += volume * float(free[tuple(cells[known].T)].sum()) / len(points)
            total += volume
        return inside / max(total, 1e-12)

    def _role_colours(
        self,
        found: Template,
        parts: Sequence[Part],
        frame: Frame,
        cells: np.ndarray,
        number: int,
    ) -> dict[str, np.ndarray]:
        if number in self.paints:
            return {"": self.paints[number]}
        at = tuple(cells.T)
        usable = self.exposed[at] if self.exposed[at].any() else self.coloured[at]
        centres = cell_centers_m(cells[usable], self.grid.origin_m, self.grid.voxel_m)
        kinds = {role: material.kind for role, material in found.materials.items()}
        centres = centres + self._outward(cells[usable]) * self.grid.voxel_m / 2
        stretched = _clamp_to_box(centres, frame)
        colours = self.colours[at][usable]
        return role_colours(parts, frame, stretched, colours, self.grid.voxel_m, kinds)

    def _outward(self, cells: np.ndarray) -> np.ndarray:
        """Return the direction in which each cell borders free space, float64 [N, 3] of -1 to 1."""
        result = np.zeros((len(cells), 3))
        limit = np.array(self.grid.shape) - 1
        for axis in range(3):
            for side in (-1, 1):
                near = cells.copy()
                near[:, axis] = np.clip(near[:, axis] + side, 0, limit[axis])
                result[:, axis] += side * self.free[tuple(near.T)]
        return result


def _clamp_to_box(centres_m: np.ndarray, frame: Frame) -> np.ndarray:
    """Clip the centres of cells, float64 [N, 3], to the box that represents them."""
    local = apply(invert(frame.object_to_room), centres_m)
    half = frame.size_m / 2
    local[:, :2] = np.clip(local[:, :2], -half[:2], half[:2])
    local[:, 2] = np.clip(local[:, 2], 0, frame.size_m[2])
    return apply(frame.object_to_room, local)

"""Templates as blocks: half blocks from metric parts, and block states of fitted designs.

The box of a placement is first snapped to whole blocks and its parts are stretched accordingly, in
the frame of the template. The quarter turn is applied last, so symmetric chairs stay symmetric and
equal chairs stay equal.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.block_lattice import Lattice
from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.fitted_objects import (
    Design,
    halves_from_layers,
    size_at_wall,
)
from world2minecraft.construction.palettes import Palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.shape_materials import (
    UPHOLSTERED,
    WEIGHTS,
    Materials,
    materials_of,
)
from world2minecraft.construction.surface_painting import BlockChoice, paint_surface
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import turn_grid
from world2minecraft.core.types import OWN_CELLS, OccupancyGrid, Placement
from world2minecraft.furniture import Part
from world2minecraft.furniture.solid_parts import own_cells
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.geometry.morphology import dilate
from world2minecraft.minecraft.block_colours import colours_of

LATE_RANKS = {int(SemanticClass.CHAIR): 1, int(SemanticClass.TVS): 2, int(SemanticClass.OBJS): 3}
PAINTS = {int(SemanticClass.TABLE): 1}  # A table is of one wood; shade and glare are not.
MAX_COLOUR_LOSS = 0.06  # Oklab distance that a colour may lose for the sake of a shape.
MAX_COLOURS = 400  # Maximum number of an object's colours to search for shapes.
THIN = 0.75  # Blocks: a part thinner than this along an axis is one layer.
POST = 0.5  # Blocks: an upright part thinner than this both ways is a post.


def within_storeys(canvas: Canvas, footprints: Sequence[np.ndarray]) -> np.ndarray:
    """Return the bool [X, Y, Z] mask of the blocks above the floor of a storey or in its walls."""
    within = np.zeros(canvas.states.shape, bool)
    walls = canvas.semantic == SemanticClass.WALL
    for (ground, top), footprint in zip(canvas.lattice.storeys, footprints, strict=True):
        columns = dilate(footprint, (1, 1)) | walls[:, :, ground:top].any(axis=2)
        within[:, :, ground:top] = columns[:, :, None]
    return within


def cells_near(placement: Placement, grid: OccupancyGrid) -> np.ndarray:
    """Return the cells of a placement's object in or next to its box, int64 [N, 3]."""
    return own_cells(replace(placement, size_m=placement.size_m + 2 * grid.voxel_m), grid)


def max_free_share(placement: Placement, parameters: BuildParameters) -> float:
    """Return the maximum share of a template's blocks in space seen as free."""
    if placement.class_id == SemanticClass.CHAIR:
        return parameters.chair_contradicted
    return parameters.most_contradicted


def placement_order(placement: Placement) -> tuple:
    """Return the sort key of a placement: large furniture, chairs, then objects on other objects.

    Templates are placed before objects built from their cells.
    """
    rank = LATE_RANKS.get(placement.class_id, 0)
    own = placement.template == OWN_CELLS
    return rank, own, placement.object_id, placement.center_m.tolist(), placement.template


class ShapePainter:
    """Chooses the blocks of shapes from a palette."""

    def __init__(self, palette: Palette, parameters: BuildParameters):
        self.palette, self.parameters = palette, parameters
        self.wooden, self.soft = materials_of(palette), materials_of(palette, wood=False)

    def _materials(self, class_id: int) -> Materials:
        """Return the shapes that an object of a class may be made of."""
        return self.soft if class_id in UPHOLSTERED else self.wooden

    def kinds(self, colours: np.ndarray, class_id: int) -> frozenset[str]:
        """Return the kinds of shape that exist in an object's Oklab colours [N, 3]."""
        if self.parameters.shapes == "cubes":
            return frozenset(("full",))
        few = colours[:: 1 + len(colours) // MAX_COLOURS]
        full = self.palette.blocks[class_id]
        preferred = self.palette.preferred[class_id] or full
        handicaps = np.array([self.parameters.preference * (one not in preferred) for one in full])
        weight = self.parameters.lightness_weight
        return self._materials(class_id).kinds_for(few, full, handicaps, class_id, weight)

    def states(
        self, design: Design, colours: np.ndarray, known: np.ndarray, class_id: int
    ) -> np.ndarray:
        """Return the block states, object [N], of a design's N blocks in the object's colours.

        Each kind of shape is painted with the blocks available in it. If none matches the colour, a
        full block of the right colour is used instead.
        """
        limit = PAINTS.get(class_id, self.parameters.object_colours)
        materials = self._materials(class_id)
        choice = BlockChoice(class_id, self.palette, self.parameters, limit)
        full = self.palette.blocks[class_id]
        kinds = design.shapes.kinds[design.numbers]
        used = sorted(set(kinds[design.filled].tolist()) - {"full"})
        shaped = design.filled & (kinds != "full")
        plain = np.empty(design.numbers.shape, object)
        own, able = plain.copy(), materials.in_all(used, full)
        if able and shaped.any():
            own[shaped] = paint_surface(shaped, colours, known & shaped, choice, only=able)
        alike = frozenset(own[shaped].tolist()) if able else frozenset()
        plain[design.filled] = paint_surface(design.filled, colours, known, choice, used=alike)
        if not able:
            own = plain
        result = plain.copy()
        for at in zip(*np.nonzero(shaped), strict=True):
            shape = design.shapes.shapes[int(design.numbers[at]) - 1]
            first, second = str(own[at]), str(plain[at])
            near = self._is_near(first, second, colours[at])
            state = materials.shaped_state(shape, first if near else second)
            result[at] = state or plain[at]
        return result[design.filled]

    def _is_near(self, block: str, other: str, colour: np.ndarray) -> bool:
        """Return whether a block matches a colour nearly as well as another block."""
        offered = srgb_to_oklab(colours_of([block, other]))
        light = np.sqrt(self.parameters.lightness_weight)
        distances = np.linalg.norm((offered - colour) * [light, *WEIGHTS[1:]], axis=1)
        return bool(distances[0] - distances[1] <= MAX_COLOUR_LOSS)


class HalfBlockDesign(NamedTuple):
    """A template on the lattice: the part that fills each half block (from 1; 0 is empty)."""

    low: np.ndarray  # int [3], the lattice index of the first block
    halves: np.ndarray  # uint8 [X, Y, Z]
    part: np.ndarray  # int16 [X, Y, Z], index into the parts + 1


def half_block_design(
    placement: Placement, parts: Sequence[Part], lattice: Lattice
) -> HalfBlockDesign:
    """Return the half blocks of a placement's parts, rotated and in place."""
    sizes = placement.size_m * lattice.blocks_per_metre
    middle = lattice.coordinates_of(placement.center_m)
    count, start = _plan(placement, sizes, middle)
    bottom = _half(middle[2] - sizes[2] / 2)
    ground = float(lattice.ground_under(bottom))
    bottom = ground if bottom < ground + 1 else bottom
    top = max(_half(middle[2] + sizes[2] / 2), bottom + 0.5)
    base = int(np.floor(bottom))
    height = int(np.ceil(top)) - base
    owner = np.zeros((count[0], count[1], 2 * height), np.int16)
    posts = np.zeros(owner.shape, bool)
    # Posts first: a leg that is rounded up to the plate it carries must not pierce its corner.
    thin = [_is_post(one.box_m * lattice.blocks_per_metre) for one in parts]
    order = sorted(range(len(parts)), key=lambda i: (not thin[i], -_volume(parts[i].box_m)))
    scale = np.array([*(count / sizes[:2]), (top - bottom) / sizes[2]])
    for index in order:
        box = parts[index].box_m.reshape(2, 3) * lattice.blocks_per_metre
        box[:, :2] += sizes[:2] / 2
        box *= scale
        spans = [_span(box[0, axis], box[1, axis], int(count[axis])) for axis in (0, 1)]
        lower = 2 * (bottom - base)
        spans.append(_span(2 * box[0, 2] + lower, 2 * box[1, 2] + lower, 2 * height))
        where = tuple(slice(*span) for span in spans)
        owner[where] = index + 1
        posts[where] = _is_post(box.ravel())
    for index in order:
        if parts[index].role == "seat":
            _rest_on_posts(index + 1, owner, posts)
    owner = turn_grid(owner, placement.quarter_turns)
    upper, lower = owner[:, :, 1::2], owner[:, :, 0::2]
    part = np.where(upper > 0, upper, lower)
    return HalfBlockDesign(np.array([*start, base]), halves_from_layers(owner > 0), part)


def _plan(
    placement: Placement, sizes: np.ndarray, middle: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the size of a placement in blocks, int [2], along its own axes, and its first block.

    Sizes are rounded, so equal objects stay equal. For objects along walls, the sides are rounded
    to block boundaries instead, so that the front keeps its position.
    """
    if placement.class_id == SemanticClass.FURN:
        return size_at_wall(placement, sizes, middle)
    count = np.maximum(np.floor(sizes[:2] + 0.5), 1).astype(int)
    size = count[::-1] if placement.quarter_turns % 2 else count
    return count, np.floor(middle[:2] - size / 2 + 0.5).astype(int)


def _is_post(box: np.ndarray) -> bool:
    """Return whether a box, float64 [6] in blocks, is upright and thinner than a post."""
    wide = box[3:] - box[:3]
    return bool((wide[:2] < POST).all() and wide[2] > 1)


def _rest_on_posts(seat: int, owner: np.ndarray, posts: np.ndarray) -> None:
    """Lower a thin seat from the upper to the lower half of its blocks, in place.

    Half a post cannot be built: under a plate in the upper half it would be a whole block, and a
    chair would become a cube. Parts on the seat are lowered with it.
    """
    layers = np.unique(np.argwhere(owner == seat)[:, 2])
    if len(layers) != 1 or layers[0] % 2 == 0 or layers[0] < 3:
        return
    level = int(layers[0])
    mask = owner[:, :, level] == seat
    if not posts[:, :, level - 1][mask].any():
        return
    above = owner[:, :, level + 1] if level + 1 < owner.shape[2] else np.zeros_like(mask, np.int16)
    owner[:, :, level - 1][mask] = seat
    posts[:, :, level - 1][mask] = False
    owner[:, :, level][mask] = above[mask]


def _half(value: float) -> float:
    return float(np.floor(2 * value + 0.5) / 2)


def _volume(box: np.ndarray) -> float:
    return float(np.prod(box[3:] - box[:3]))


def _span(low: float, high: float, count: int) -> tuple[int, int]:
    """Return the layers [start, stop) of a part, symmetric for its mirror image."""
    if high - low < THIN:
        start = int(np.clip(np.floor((low + high) / 2), 0, count - 1))
        return start, start + 1
    start = int(np.clip(np.floor(low + 0.5), 0, count - 1))
    return start, int(np.clip(np.ceil(high - 0.5), start + 1, count))

"""Placement of furniture designs made of vanilla blocks, in the real colours of their objects.

The materials of a design state which roles take the object's colour. All roles of one material
share one colour, the median of their cells, so the legs and the seat of a chair get the same wood.
Each role becomes the block of its kind closest in colour that has all required shapes. If wood or
stone is clearly wrong (red cupboards), any block with these shapes may be used. Full blocks are
painted individually. A template of another package without materials is recoloured by its block
names: wood and dye are chosen from the room, and a full block of a very different colour is
replaced by a plain one.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.block_lattice import Lattice
from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.palettes import Palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.shape_materials import is_wooden
from world2minecraft.construction.surface_painting import (
    FADED,
    BlockChoice,
    colour_costs,
    paint_surface,
)
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import cells_to_block_axes
from world2minecraft.core.types import Placement
from world2minecraft.furniture import BlockDesign, DesignBlock, Material
from world2minecraft.furniture.block_designs import block_size
from world2minecraft.furniture.materials import (
    FIXED,
    PLAIN,
    Swatch,
    list_swatches,
    shape_of,
    with_swatch,
    without_holes,
)
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.geometry.morphology import dilate_faces
from world2minecraft.minecraft.block_colours import (
    DYES,
    WOODS,
    colour_of,
    colours_of,
    nearest_oklab,
)
from world2minecraft.minecraft.collision_shapes import is_full_cube

OTHER_CLOTH = 0.03  # Oklab: what another full block must be nearer by than wool. A guess.
OTHER_KIND = 0.1  # Oklab: what another kind of material must come nearer by. A guess.
# Oklab: up to this far off a fixed block keeps its own look; lightness counts less. Guesses.
OWN_LOOK, OWN_LIGHT = 0.1, 0.63
CLEAR_CHROMA, CLEAR_SHARE = 0.06, 0.3
SOLID_SHAPES = ("full", "slab", "stairs")
PLAIN_PAINTS = 3  # Blocks of one plain role: a front, its trim and one object in it.
_KEPT_DYES = ("white",)  # A design's own white is meant: a pillow, a sheet.
# Blocks per metre below which an object this high above the floor keeps air below.
LIFTED_UNDER, HIGH_M = 1.5, 1.2
TIE = 1e-6
OWN_COLOUR = 0.1  # Oklab distance up to which a design's full block keeps its own look. A guess.


class CanvasWindow(NamedTuple):
    """The part of a design that is inside the canvas, and the blocks already set there."""

    box: tuple[slice, ...]  # of the design
    low: np.ndarray  # int [3], its first block on the canvas
    free: np.ndarray  # bool [X, Y, Z], nothing stands there
    wall: np.ndarray  # bool [X, Y, Z]
    held: np.ndarray  # bool [X, Y, Z], something stands there or beside it

    def is_flush(self, filled: np.ndarray) -> bool:
        """Return whether most blocks of an object, bool [X, Y, Z], are inside a wall."""
        return bool((filled & self.wall).sum() > 0.5 * filled.sum())


def canvas_window(
    canvas: Canvas, within: np.ndarray, low: np.ndarray, shape: tuple[int, ...]
) -> CanvasWindow:
    """Return the part of the canvas that a design would cover.

    Args:
        canvas: The blocks built so far.
        within: Bool [X, Y, Z] mask of the blocks where objects are allowed.
        low: First block of the design, int [3].
        shape: Number of blocks of the design along each axis.
    """
    high = np.minimum(low + shape, np.array(canvas.lattice.shape) - 1)
    start = np.maximum(low, [1, 1, canvas.lattice.ground])
    stop = np.maximum(high, start)
    box = tuple(slice(int(a), int(b)) for a, b in zip(start - low, stop - low, strict=True))
    inside = tuple(slice(int(a), int(b)) for a, b in zip(start, stop, strict=True))
    around = tuple(slice(int(a) - 1, int(b) + 1) for a, b in zip(start, stop, strict=True))
    stands = canvas.states[around] > 0
    free = ~stands[1:-1, 1:-1, 1:-1] & within[inside]
    wall = canvas.semantic[inside] == SemanticClass.WALL
    return CanvasWindow(box, start, free, wall, dilate_faces(stands)[1:-1, 1:-1, 1:-1])


class ObjectColours(NamedTuple):
    """The known colours of an object, in its own box of blocks."""

    colours: np.ndarray  # float32 [X, Y, Z, 3], Oklab
    known: np.ndarray  # bool [X, Y, Z]
    paint: np.ndarray | None  # float32 [3], where all of it has one colour


def recolour_design(
    blocks: Sequence[DesignBlock],
    cells: np.ndarray,
    materials: Mapping[str, Material],
    own_colours: ObjectColours,
    class_id: int,
    palette: Palette,
    parameters: BuildParameters,
) -> list[str]:
    """Return the block states of a design in the colours of an object.

    Args:
        blocks: The N blocks of the design.
        cells: Position of each block in the box of ``own_colours``, int [N, 3].
        materials: Material of each role; blocks of other roles are not changed.
        own_colours: Colours of the object.
        class_id: Class of the object.
        palette: Blocks that full-block roles may use.
        parameters: Weights of the colour comparison.
    """
    states = [block.state for block in blocks]
    if own_colours.paint is None and not own_colours.known.any():
        return states
    groups: dict[Material, list[int]] = {}
    for index, block in enumerate(blocks):
        material = materials.get(block.role)
        if material is not None and material.takes_colour:
            groups.setdefault(material, []).append(index)
    for material, indices in groups.items():
        own, at = [states[index] for index in indices], cells[indices]
        colour = _colour(at, own_colours)
        if material.kind == "cloth" and all(map(is_full_cube, own)):
            soft = palette.blocks[int(SemanticClass.SOFA)]  # A curtain of stone is a pillar.
            cubes = [one for one in palette.blocks[class_id] if one in soft and not is_wooden(one)]
            renewed = [_cube_of(colour, own[0], cubes, parameters)] * len(own)
        elif material.kind not in (PLAIN, FIXED):
            renewed = _change_material(own, material.kind, colour, parameters)
            armchair = class_id == SemanticClass.CHAIR and material.kind == "stone"
            if class_id == SemanticClass.SOFA or armchair:
                renewed = _upholster(renewed, material.kind, colour, parameters)
            if class_id != SemanticClass.CHAIR:  # Tops and arms would look like grilles.
                renewed = [without_holes(state) for state in renewed]
        elif material.kind == FIXED and not _is_far(material, colour):
            renewed = own
        elif own_colours.paint is None and all(map(is_full_cube, own)):
            renewed = _paint_blocks(at, own_colours, class_id, palette, parameters)
        else:
            renewed = (
                own if material.kind == FIXED else _change_material(own, PLAIN, colour, parameters)
            )
        for index, state in zip(indices, renewed, strict=True):
            states[index] = state
    return states


def _cube_of(
    colour: np.ndarray, wool: str, choices: Sequence[str], parameters: BuildParameters
) -> str:
    """Return the full block closest to a fabric's colour: wool, or a clearly closer block.

    Wool has only sixteen colours, and no other block looks like fabric.
    """
    own = _change_material([wool], "cloth", colour, parameters)
    offered = [*own, *choices]
    handicaps = np.array([0.0] + [OTHER_CLOTH] * len(choices))
    costs = colour_costs(colour[None], offered, parameters.lightness_weight, handicaps, FADED)
    return offered[int(costs[0].argmin())]


def _is_far(material: Material, colour: np.ndarray) -> bool:
    """Return whether a fixed material differs clearly from an object's colour."""
    own = srgb_to_oklab(np.array(colour_of(material.block("full") or ""), np.uint8))
    return float(np.linalg.norm((own - colour) * [OWN_LIGHT, 1, 1])) > OWN_LOOK


def _colour(cells: np.ndarray, own_colours: ObjectColours) -> np.ndarray:
    """Return the median colour of cells, float32 [3], or of the whole object without colours."""
    if own_colours.paint is not None:
        return own_colours.paint
    at = tuple(cells.T)
    usable = own_colours.known[at]
    chosen = (
        own_colours.colours[at][usable] if usable.any() else own_colours.colours[own_colours.known]
    )
    clear = np.hypot(chosen[:, 1], chosen[:, 2]) >= CLEAR_CHROMA
    if clear.mean() >= CLEAR_SHARE:  # Shade and what shines through take a colour's hue away.
        chosen = chosen[clear]
    return np.median(chosen, axis=0).astype(np.float32)


def _paint_blocks(
    cells: np.ndarray,
    own_colours: ObjectColours,
    class_id: int,
    palette: Palette,
    parameters: BuildParameters,
) -> list[str]:
    """Return full blocks of the palette for cells, by their own colours with smoothing."""
    mask = np.zeros(own_colours.known.shape, bool)
    mask[tuple(cells.T)] = True
    known = own_colours.known & mask if (own_colours.known & mask).any() else own_colours.known
    limit = min(PLAIN_PAINTS, parameters.object_colours)
    choice = BlockChoice(class_id, palette, parameters, limit)
    renewed = np.empty(mask.shape, object)
    within = mask | known
    renewed[within] = paint_surface(within, own_colours.colours, known, choice)
    return renewed[tuple(cells.T)].tolist()


def _change_material(
    states: list[str], kind: str, colour: np.ndarray, parameters: BuildParameters
) -> list[str]:
    """Return states in the material closest to a colour; unknown kinds are not changed."""
    found = {state: shape_of(state, kind) for state in states}
    own = frozenset(shape for shape in found.values() if shape)
    swatch = _nearest(kind, own, colour, parameters) if own else None
    plain = {state: shape_of(state, PLAIN) for state, shape in found.items() if not shape}
    shapes = frozenset(shape for shape in plain.values() if shape)
    other = _nearest(PLAIN, shapes, colour, parameters) if shapes else None
    renewed = []
    for state in states:
        shape, strange = found[state], plain.get(state)
        if shape and swatch:
            renewed.append(with_swatch(state, shape, swatch))
        elif strange and other:
            renewed.append(with_swatch(state, strange, other))
        else:
            renewed.append(state)
    return renewed


def _upholster(
    states: list[str], kind: str, colour: np.ndarray, parameters: BuildParameters
) -> list[str]:
    """Return states of wood or stone, or of wool if that is closer to the colour.

    White leather is built of stone and brown leather of wood. Neither has a green or a blue.
    """
    solid = [shape_of(state, PLAIN) in SOLID_SHAPES for state in states]
    if kind not in ("wood", "stone") or not any(solid):
        return states
    wool = _change_material(["minecraft:white_wool"], "cloth", colour, parameters)[0]
    offered, none = [states[solid.index(True)], wool], np.zeros(2)
    costs = colour_costs(colour[None], offered, parameters.lightness_weight, none, FADED)[0]
    if costs[0] <= costs[1]:
        return states
    return [wool if one else state for state, one in zip(states, solid, strict=True)]


def _nearest(
    kind: str, shapes: frozenset[str], colour: np.ndarray, parameters: BuildParameters
) -> Swatch | None:
    """Return the material closest to a colour that has all shapes, preferring its own kind."""
    own = list_swatches(kind, shapes)
    others = list_swatches(PLAIN, shapes) if kind in ("wood", "stone") else ()
    offered = [*own, *(one for one in others if one not in own)]
    if not offered:
        return None
    handicaps = np.array([0.0] * len(own) + [OTHER_KIND] * (len(offered) - len(own)))
    samples = [one.sample for one in offered]
    costs = colour_costs(colour[None], samples, parameters.lightness_weight, handicaps, FADED)
    return offered[int(costs[0].argmin())]


class ObjectLabel(NamedTuple):
    """The class and the instance number of the blocks of an object."""

    class_id: int
    instance: int


def design_box(
    design: BlockDesign, placement: Placement, lattice: Lattice
) -> tuple[np.ndarray, np.ndarray]:
    """Return the first block and the size, int [3] each in room axes, of a placed design.

    Parts that protrude at the front, such as handles, do not push the rest into the wall behind.
    """
    along, up, across = design.size
    size = np.array([along, across, up])
    middle = lattice.coordinates_of(placement.center_m)
    bottom = middle[2] - placement.size_m[2] * lattice.blocks_per_metre / 2
    axis, out = placement.quarter_turns % 2, _protrusion(design, placement, lattice)
    solid = size - np.where(np.arange(3) == axis, out, 0)
    low = np.floor(np.array([*(middle[:2] - solid[:2] / 2), bottom]) + 0.5).astype(int)
    if placement.quarter_turns >= 2:  # The front looks to where coordinates fall.
        low[axis] -= out
    ground = lattice.ground_under(float(bottom))
    if (
        lattice.blocks_per_metre < LIFTED_UNDER
        and (bottom - ground) / lattice.blocks_per_metre >= HIGH_M
    ):
        low[2] = int(np.ceil(bottom - TIE))  # Else a wall unit would stand on the counter below.
    most = np.maximum(np.array(lattice.shape) - size, 0)
    least = [0, 0, ground]
    return np.clip(low, least, np.maximum(most, least)), size


def body_box(
    design: BlockDesign, placement: Placement, lattice: Lattice, low: np.ndarray, size: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the first block and the size, int [3] each, of a design without its protruding parts.

    The front of an object colours the front of the body, not the handles before it.
    """
    axis, out = placement.quarter_turns % 2, _protrusion(design, placement, lattice)
    along = np.arange(3) == axis
    start = low + np.where(along & (placement.quarter_turns >= 2), out, 0)
    return start, size - np.where(along, out, 0)


def _protrusion(design: BlockDesign, placement: Placement, lattice: Lattice) -> int:
    """Return the number of blocks by which a design protrudes at its front only."""
    own = block_size(placement.size_m, lattice.blocks_per_metre)
    along, _, across = design.size
    depth, width = (across, along) if placement.quarter_turns % 2 else (along, across)
    return max(depth - own.depth, 0) if width <= own.width else 0


def filled_blocks(design: BlockDesign) -> np.ndarray:
    """Return the bool [X, Y, Z] mask, in room axes, of the blocks that a design fills."""
    along, up, across = design.size
    filled = np.zeros((along, across, up), bool)
    filled[tuple(design_cells(design).T)] = True
    return filled


def design_cells(design: BlockDesign) -> np.ndarray:
    """Return the positions of a design's blocks in its box, int [N, 3] in room axes."""
    offsets = np.array([block.offset for block in design.blocks]).reshape(-1, 3)
    # Offsets are in block axes already: their inverse map is the map itself.
    return cells_to_block_axes(offsets[:, [0, 2, 1]], design.size[2])[:, [0, 2, 1]]


def place_design(
    canvas: Canvas,
    design: BlockDesign,
    low: np.ndarray,
    thing: ObjectLabel,
    own_colours: ObjectColours,
    palette: Palette,
    within: np.ndarray,
    parameters: BuildParameters,
) -> None:
    """Set the blocks of a design in the colours of its object, without overwriting other blocks.

    Args:
        canvas: Canvas to modify.
        design: Blocks with offsets in block axes.
        low: First block of the design on the canvas, int [3] in room axes.
        thing: Class and instance of the object.
        own_colours: Colours of the object in its box of blocks.
        palette: Blocks that may replace the full blocks of the design.
        within: Bool [X, Y, Z] mask of the blocks where objects are allowed.
        parameters: Weights of the colour comparison.
    """
    shape = canvas.states.shape
    local = design_cells(design)
    states = _states(design, local, thing, own_colours, palette, parameters)
    for cell, state in zip(local.tolist(), states, strict=True):
        at = tuple((low + cell).tolist())
        if any(i >= side for i, side in zip(at, shape, strict=True)) or canvas.states[at]:
            continue
        if within[at]:
            canvas.put(at, canvas.id_of(state), thing.class_id, thing.instance)


def _states(
    design: BlockDesign,
    cells: np.ndarray,
    thing: ObjectLabel,
    own_colours: ObjectColours,
    palette: Palette,
    parameters: BuildParameters,
) -> list[str]:
    if design.materials:
        blocks, materials = design.blocks, design.materials
        return recolour_design(
            blocks, cells, materials, own_colours, thing.class_id, palette, parameters
        )
    median = (
        np.median(own_colours.colours[own_colours.known], axis=0)
        if own_colours.known.any()
        else own_colours.paint
    )
    states = []
    for cell, block in zip(cells.tolist(), design.blocks, strict=True):
        colour = own_colours.colours[tuple(cell)] if own_colours.known[tuple(cell)] else median
        states.append(
            block.state if colour is None else _in_colour(block.state, colour, thing, palette)
        )
    return states


def _in_colour(state: str, colour: np.ndarray, thing: ObjectLabel, palette: Palette) -> str:
    own = recolour_state(state, colour)
    distance = np.linalg.norm(srgb_to_oklab(np.array(colour_of(own), np.uint8)) - colour)
    if distance <= OWN_COLOUR or not is_full_cube(own):
        return own
    choices = palette.blocks[thing.class_id]
    return choices[int(nearest_oklab(colour[None], srgb_to_oklab(colours_of(choices)))[0])]


def recolour_state(state: str, colour: np.ndarray) -> str:
    """Return the state of the same kind of block in the wood or dye closest to an Oklab colour."""
    namespace, _, rest = state.partition(":")
    name, bracket, properties = rest.partition("[")
    for kinds, sample in ((WOODS, "_planks"), (DYES, "_wool")):
        kind = _kind_of(name, kinds)
        if kind is None or kind in _KEPT_DYES:
            continue
        best = nearest_kind(kinds, sample, colour)
        return f"{namespace}:{best}{name.removeprefix(kind)}{bracket}{properties}"
    return state


def nearest_kind(kinds: Sequence[str], sample: str, colour: np.ndarray) -> str:
    """Return the wood or dye closest to an Oklab colour, float32 [3].

    Args:
        kinds: Names of woods or dyes.
        sample: Ending of the block that shows the colour of a kind, such as ``_planks``.
        colour: The colour.
    """
    offered = srgb_to_oklab(colours_of([kind + sample for kind in kinds]))
    return kinds[int(nearest_oklab(colour[None], offered)[0])]


def _kind_of(name: str, kinds: tuple[str, ...]) -> str | None:
    fitting = [kind for kind in kinds if name.startswith(kind + "_")]
    return max(fitting, key=len, default=None)

"""Furniture blocks of a mod, used instead of a template of about the same size.

Mods provide furniture of one or a few blocks for worlds of one or two blocks per metre. A mod piece
is therefore used only if the object covers about as many blocks; otherwise the built-in design is
used. The palette file states the orientation of each block and how it connects to its neighbours.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.design_placement import design_box, design_cells, nearest_kind
from world2minecraft.construction.palettes import FACINGS, FurniturePiece
from world2minecraft.core.types import OWN_CELLS, OccupancyGrid, Placement
from world2minecraft.furniture import BlockDesign, template
from world2minecraft.furniture.block_designs import block_size, lay_template
from world2minecraft.furniture.solid_parts import own_cells
from world2minecraft.furniture.template import BlockSize, LocalBlock, Span, Template
from world2minecraft.minecraft.block_colours import DYES, WOODS
from world2minecraft.minecraft.block_states import BlockState, parse_state

SLACK = 0.7  # Blocks by which an object may be larger than a piece of a fixed size.
HIGHEST = 1.7  # Blocks: furniture of one layer stands for nothing higher.


def mod_furniture(
    pieces: Sequence[FurniturePiece],
    placement: Placement,
    blocks_per_metre: float,
    colour: np.ndarray | None,
) -> BlockDesign | None:
    """Return the mod blocks for a placement, rotated, or None if no piece has a matching size.

    Args:
        pieces: Furniture pieces of the palette.
        placement: Placement of the object.
        blocks_per_metre: Scale of the build.
        colour: Oklab colour of the object, float32 [3], or None if unknown.
    """
    if not pieces or placement.template == OWN_CELLS:
        return None
    found = template(placement.template)
    size = block_size(placement.size_m, blocks_per_metre)
    fitting = (
        piece
        for piece in pieces
        if {found.name, found.family} & set(piece.designs) and _fits(piece, size)
    )
    piece = next(fitting, None)
    if piece is None:
        return None
    blocks = _join_neighbours(piece, _lay_out(piece, size, colour))
    spans = (Span(1, 1, 1), Span(1, 1, 1), Span(1, 1, 1))
    whole = Template(found.name, found.class_id, spans, lambda *_: [], lambda *_: blocks)
    return lay_template(whole, size, None, placement.quarter_turns)


def place_mod_furniture(
    canvas: Canvas,
    pieces: Sequence[FurniturePiece],
    placements: Sequence[Placement],
    colours: np.ndarray,
    grid: OccupancyGrid,
    within: np.ndarray,
) -> list[Placement]:
    """Place the mod furniture of a palette and return the placements that remain.

    Args:
        canvas: Canvas with the finished shell.
        pieces: Furniture pieces of the palette.
        placements: Placements of all furniture.
        colours: Oklab colours of the grid's cells, float32 [X, Y, Z, 3]; 0 is no colour.
        grid: Grid of the room.
        within: Bool [X, Y, Z] mask of the blocks where objects are allowed.
    """
    left = []
    for placement in placements if pieces else ():
        cells = own_cells(placement, grid)
        known = colours[tuple(cells.T)]
        known = known[known.any(axis=1)]
        colour = np.median(known, axis=0) if len(known) else None
        scale = canvas.lattice.blocks_per_metre
        found = mod_furniture(pieces, placement, scale, colour)
        if found is None or not _put(canvas, found, placement, within):
            left.append(placement)
    return left if pieces else list(placements)


def _put(canvas: Canvas, found: BlockDesign, placement: Placement, within: np.ndarray) -> bool:
    """Set a piece if all of its blocks are free, and return whether it was set."""
    low, _ = design_box(found, placement, canvas.lattice)
    at = design_cells(found) + low
    inside = ((at >= 0) & (at < canvas.states.shape)).all(axis=1)
    if not inside.all() or canvas.states[tuple(at.T)].any() or not within[tuple(at.T)].all():
        return False  # Half a piece of a mod is worse than the whole of another design.
    for cell, block in zip(at.tolist(), found.blocks, strict=True):
        number = canvas.id_of(block.state)
        canvas.put(tuple(cell), number, placement.class_id, placement.object_id)
    return True


def _fits(piece: FurniturePiece, size: BlockSize) -> bool:
    depth, width, height = size.exact
    if piece.fill == "box":
        return True
    if piece.fill == "floor":
        return height <= HIGHEST
    sides = [1 + max(cell.at[axis] for cell in piece.cells) for axis in range(3)]
    limits = [depth <= sides[0] + SLACK, width <= sides[1] + SLACK, height <= sides[2] + SLACK]
    return limits[0] and (piece.fill == "row" or limits[1]) and limits[2]


def _lay_out(piece: FurniturePiece, size: BlockSize, colour: np.ndarray | None) -> list[LocalBlock]:
    """Return the blocks of a piece that faces east, in the colour of the object."""
    deep, wide, high = {
        "one": (1, 1, 1),
        "row": (1, size.width, 1),
        "floor": (size.depth, size.width, 1),
        "box": (size.depth, size.width, size.height),
    }[piece.fill]
    blocks = []
    for cell in piece.cells:
        properties = dict(cell.properties)
        if piece.facing is not None:
            properties["facing"] = FACINGS[piece.facing]
        state = str(BlockState(_choose_material(cell.id, colour), properties))
        i0, j0, k0 = cell.at
        blocks += [
            LocalBlock((i0 + i, j0 + j, k0 + k), state, "body")
            for i in range(deep)
            for j in range(wide)
            for k in range(high)
        ]
    return blocks


def _choose_material(name: str, colour: np.ndarray | None) -> str:
    """Return a block name with the wood or dye closest to a colour."""
    for word, kinds, sample in (("{wood}", WOODS, "_planks"), ("{dye}", DYES, "_wool")):
        if word not in name:
            continue
        best = kinds[0] if colour is None else nearest_kind(kinds, sample, colour)
        name = name.replace(word, best)
    return name


def _join_neighbours(piece: FurniturePiece, blocks: list[LocalBlock]) -> list[LocalBlock]:
    """Return east-facing blocks with the properties that connect them to their neighbours.

    The game computes these properties only at block updates, which a written world does not get.
    """
    if piece.joins is None:
        return blocks
    held = {block.cell for block in blocks}
    result = []
    for block in blocks:
        i, j, k = block.cell
        # The piece looks east: north is its left (j + 1), south its right.
        beside = {
            "east": (i + 1, j, k) in held,
            "west": (i - 1, j, k) in held,
            "north": (i, j + 1, k) in held,
            "south": (i, j - 1, k) in held,
        }
        state = parse_state(block.state)
        result.append(block._replace(state=str(state.having(**_joins(piece, beside)))))
    return result


def _joins(piece: FurniturePiece, beside: Mapping[str, bool]) -> dict[str, str]:
    if piece.joins == "sides":
        return {side: str(there).lower() for side, there in beside.items()}
    # Seen along its facing, which is to its back: the clockwise side of west is north.
    clockwise, counter = (
        (beside["north"], beside["south"])
        if piece.facing == "back"
        else (beside["south"], beside["north"])
    )
    if piece.joins == "flags":
        return {"left": str(clockwise).lower(), "right": str(counter).lower()}
    if clockwise and counter:
        return {"shape": "middle"}
    return {"shape": "right" if counter else "left" if clockwise else "default"}

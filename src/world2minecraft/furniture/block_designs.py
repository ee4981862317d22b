"""Furniture as vanilla blocks, as players build it: a chair is a stair, table legs are fences.

At few blocks per metre, legs, seats and backs are thinner than any block. From six blocks per
metre, the parts themselves are fitted block by block, and no manual design is needed.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from world2minecraft.core.types import OWN_CELLS, Placement
from world2minecraft.furniture.library import template
from world2minecraft.furniture.materials import Material
from world2minecraft.furniture.template import BlockSize, LocalBlock, Parameters, Template

PARTS_FROM = 6.0  # Blocks per metre from which parts of 8 cm are half a block thick and fit well.


class DesignBlock(NamedTuple):
    """A block of a design: its offset in block axes (x east, y up, z south), state and role."""

    offset: tuple[int, int, int]
    state: str
    role: str


@dataclass(frozen=True)
class BlockDesign:
    """A design in vanilla blocks, with offsets from the minimum corner of its box of ``size``."""

    blocks: tuple[DesignBlock, ...]
    size: tuple[int, int, int]  # blocks along x, y, z in block axes
    materials: Mapping[str, Material] = field(default_factory=dict)  # of the roles


def block_design(placement: Placement, blocks_per_metre: float) -> BlockDesign | None:
    """Return the vanilla block design of a placement, with the rotation of the placement.

    Returns:
        The design, or None if parts are built instead: at six or more blocks per metre, if the
            template has no design for the scale, or for an object that is built from its own cells.

    Raises:
        UnknownNameError: If the template is unknown.
    """
    if blocks_per_metre >= PARTS_FROM or placement.template == OWN_CELLS:
        return None
    found = template(placement.template)
    size = block_size(placement.size_m, blocks_per_metre)
    return lay_template(found, size, placement.parameters, placement.quarter_turns)


def lay_template(
    template: Template, size: BlockSize, parameters: Parameters | None, quarter_turns: int
) -> BlockDesign | None:
    """Return a template's vanilla design for a size in blocks, or None if it has none.

    Raises:
        ParameterError: If the template rejects a parameter.
    """
    local = template.blocks(size, parameters)
    if not local:
        return None
    return replace(_turn_design(local, quarter_turns), materials=template.materials)


def block_size(size_m: np.ndarray, blocks_per_metre: float) -> BlockSize:
    """Convert a template's size, float64 [3] in metres, to whole blocks, at least one per axis."""
    depth, width, height = (float(side) * blocks_per_metre for side in size_m)
    whole = (max(1, int(side + 0.5)) for side in (depth, width, height))
    return BlockSize(*whole, exact=(depth, width, height), per_metre=float(blocks_per_metre))


def _turn_design(local: list[LocalBlock], quarter_turns: int) -> BlockDesign:
    # Imported late: the block tables cost time that scales above three never need.
    from world2minecraft.minecraft.block_states import complete, parse_state  # noqa: PLC0415
    from world2minecraft.minecraft.turn_and_mirror import turn_state  # noqa: PLC0415

    depth, width, height = (1 + max(block.cell[axis] for block in local) for axis in range(3))
    blocks = []
    for (i, j, k), state, role in local:
        along, across, deep, wide = i, j, depth, width
        for _ in range(quarter_turns % 4):
            along, across, deep, wide = wide - 1 - across, along, wide, deep
        whole = str(complete(parse_state(state)))
        offset = (along, k, wide - 1 - across)
        blocks.append(DesignBlock(offset, turn_state(whole, quarter_turns), role))
    turned = (width, height, depth) if quarter_turns % 2 else (depth, height, width)
    return BlockDesign(tuple(sorted(_connect_blocks(blocks, turned))), turned)


def _connect_blocks(blocks: list[DesignBlock], size: tuple[int, int, int]) -> list[DesignBlock]:
    """Set the connections of fences and panes and the stair shapes that the game would compute."""
    from world2minecraft.minecraft.rules.connections import update_connections  # noqa: PLC0415

    palette = ["minecraft:air", *sorted({block.state for block in blocks})]
    number = {state: index for index, state in enumerate(palette)}
    states = np.zeros(size, np.uint16)
    for block in blocks:
        states[block.offset] = number[block.state]
    states, states_of = update_connections(states, palette)
    return [block._replace(state=states_of[states[block.offset]]) for block in blocks]

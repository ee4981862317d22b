"""Screens that are let into the wall on which they hang.

At few blocks per metre a dark block before the wall is a chest, and no thin block is dark. In the
wall, such a block shows its face alone.
"""

from dataclasses import replace

import numpy as np

from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.design_placement import filled_blocks
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import Placement
from world2minecraft.furniture import BlockDesign, template

BACKWARD = ((-1, 0, 0), (0, -1, 0), (1, 0, 0), (0, 1, 0))  # By quarter turns.


def let_into_wall(
    design: BlockDesign, low: np.ndarray, placement: Placement, canvas: Canvas, within: np.ndarray
) -> tuple[BlockDesign, np.ndarray, np.ndarray]:
    """Open the wall behind a screen for it, if it hangs on an outer wall.

    Args:
        design: Blocks of the screen.
        low: Its first block on the canvas, int [3] in room axes.
        placement: Its placement.
        canvas: Canvas, from which the wall blocks are removed.
        within: Bool [X, Y, Z] mask of the blocks where objects are allowed.

    Returns:
        The design, its first block and the mask of allowed blocks, in the wall if it was opened.
    """
    is_screen = placement.class_id == SemanticClass.TVS
    if not is_screen or template(placement.template).mount != "wall":
        return design, low, within
    back = np.array(BACKWARD[placement.quarter_turns % 4])
    cells = np.argwhere(filled_blocks(design)) + low + back
    beyond = cells + back
    if (beyond < 0).any() or (np.maximum(cells, beyond) >= canvas.states.shape).any():
        return design, low, within
    at = tuple(cells.T)
    whole = (canvas.semantic[at] == SemanticClass.WALL).all()
    if not whole or within[tuple(beyond.T)].any():
        return design, low, within
    canvas.put(at, 0, 0)
    within = within.copy()
    within[at] = True
    faces = tuple(
        block._replace(state=(design.materials[block.role].block("full") or block.state))
        for block in design.blocks
    )
    return replace(design, blocks=faces), low + back, within

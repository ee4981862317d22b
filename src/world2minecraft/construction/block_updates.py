"""Block updates of a canvas: connections and supports as the game would have them.

A world file gets no block updates, so a pane that does not state its connections stands alone, and
a torch without its wall hangs there until somebody builds next to it.
"""

import numpy as np

from world2minecraft.construction.canvas import Canvas
from world2minecraft.core.coordinates import block_axes_to_grid, grid_to_block_axes
from world2minecraft.minecraft.rules.connections import update_connections
from world2minecraft.minecraft.rules.stability import find_unmet_cells

ROUNDS = 8  # A lantern at a chain at a fence: what falls seldom carries more than a few others.
_LEAVES = ("falls", "pops off", "breaks", "flows")


def connect_neighbours(canvas: Canvas) -> None:
    """Give all that joins its neighbours its connections and shape, in place."""
    states, palette = update_connections(grid_to_block_axes(canvas.states), canvas.palette)
    known = len(canvas.palette)
    numbers = np.concatenate([np.arange(known, dtype=np.uint16), canvas.ids_of([*palette[known:]])])
    canvas.states[:] = block_axes_to_grid(numbers[states])


def apply_block_updates(canvas: Canvas) -> int:
    """Connect a canvas and take away, in place, what would fall, pop off, break or flow.

    Returns:
        How many blocks were taken away.
    """
    taken = 0
    for _ in range(ROUNDS):
        connect_neighbours(canvas)
        blocks = grid_to_block_axes(canvas.states)
        loose = [
            cell
            for cell, _, reason in find_unmet_cells(blocks, canvas.palette)
            if reason.startswith(_LEAVES)
        ]
        if not loose:
            break
        stays = np.ones(blocks.shape, bool)
        stays[tuple(np.array(loose).T)] = False
        canvas.put(~block_axes_to_grid(stays), 0, 0)
        taken += int((~stays).sum())
    return taken

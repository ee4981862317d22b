"""Block updates of a build: connections and supports as the game would compute them.

A world file receives no block updates on loading. A glass pane without stated connections stays
unconnected, and a torch without its wall stays in the air until a neighbouring block changes.
"""

import numpy as np

from world2minecraft.construction.canvas import Canvas
from world2minecraft.core.coordinates import block_axes_to_grid, grid_to_block_axes
from world2minecraft.minecraft.rules.connections import update_connections
from world2minecraft.minecraft.rules.stability import find_unmet_cells

ROUNDS = 8  # A lantern at a chain at a fence: what falls seldom carries more than a few others.
_LEAVES = ("falls", "pops off", "breaks", "flows")


def connect_neighbours(canvas: Canvas) -> None:
    """Set, in place, the connections and shapes of blocks such as panes, fences and stairs."""
    states, palette = update_connections(grid_to_block_axes(canvas.states), canvas.palette)
    known = len(canvas.palette)
    numbers = np.concatenate([np.arange(known, dtype=np.uint16), canvas.ids_of([*palette[known:]])])
    canvas.states[:] = block_axes_to_grid(numbers[states])


def apply_block_updates(canvas: Canvas) -> int:
    """Connect the blocks of a canvas and remove, in place, blocks that would fall, pop off or flow.

    Returns:
        The number of removed blocks.
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

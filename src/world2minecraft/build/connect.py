"""Connections of panes and fences, as the game computes them from the neighbours.

A world file gets no block updates, so a pane that does not state its connections stands alone.
"""

import numpy as np

from world2minecraft.build.canvas import Canvas
from world2minecraft.coordinates import facing_of_quarter_turns
from world2minecraft.minecraft.shapes import is_full_cube
from world2minecraft.minecraft.states import parse_state

_STEPS = ((1, 0), (0, 1), (-1, 0), (0, -1))  # Room axes; the facing of 0 to 3 quarter turns.
# Kinds that join among themselves; a nether brick fence and a wooden one do not.
_KINDS: tuple[tuple[str, ...], ...] = (("_pane", "iron_bars"), ("nether_brick_fence",), ("_fence",))
_NOT: dict[tuple[str, ...], tuple[str, ...]] = {("_fence",): ("minecraft:nether_brick",)}


def connect(canvas: Canvas) -> None:
    """Give every pane and fence of a canvas its connections, in place."""
    for kind in _KINDS:
        names = [state.partition("[")[0] for state in canvas.palette]
        alike = np.array(
            [name.endswith(kind) and not name.startswith(_NOT.get(kind, ())) for name in names]
        )
        solid = np.array([_is_sturdy(state) for state in canvas.palette])
        _connect_kind(canvas, alike, solid)


def _is_sturdy(state: str) -> bool:
    name = state.partition("[")[0]
    return name not in ("minecraft:barrier", "minecraft:light") and is_full_cube(state)


def _connect_kind(canvas: Canvas, alike: np.ndarray, solid: np.ndarray) -> None:
    if not alike.any():
        return
    before = canvas.states
    cells = np.argwhere(alike[before])
    joined = np.pad((alike | solid)[before], ((1, 1), (1, 1), (0, 0)))
    sides = np.stack(
        [joined[cells[:, 0] + 1 + x, cells[:, 1] + 1 + y, cells[:, 2]] for x, y in _STEPS], axis=1
    )
    own = before[tuple(cells.T)]
    keys, index = np.unique(np.column_stack([own, sides]), axis=0, return_inverse=True)
    palette = canvas.palette
    renewed = []
    for key in keys.tolist():
        changed = {
            facing_of_quarter_turns(turns): "true" if key[1 + turns] else "false"
            for turns in range(4)
        }
        renewed.append(str(parse_state(palette[key[0]]).having(**changed)))
    canvas.states[tuple(cells.T)] = canvas.ids_of(renewed)[index.ravel()]

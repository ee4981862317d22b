"""What a block state looks like: its boxes, its colour, and whether it gives light.

The boxes are the collision boxes of the public table. A state that one sees but walks through
(a torch, a flower, a sign) has none there; ``MARKER_BOXES`` stands in, so that nothing that was
placed vanishes. These stand-ins are ours, not the game's models.
"""

from functools import lru_cache

import numpy as np

from world2minecraft.minecraft.colours import colour_of
from world2minecraft.minecraft.shapes import boxes_of

INVISIBLE = frozenset(
    f"minecraft:{name}"
    for name in ("air", "cave_air", "void_air", "barrier", "light", "structure_void")
)
# Parts of names, tried in this order, to a stand-in box in sixteenths of a block.
MARKER_BOXES: tuple[tuple[str, tuple[int, int, int, int, int, int]], ...] = (
    ("carpet", (0, 0, 0, 16, 1, 16)),
    ("torch", (7, 0, 7, 9, 10, 9)),
    ("pressure_plate", (1, 0, 1, 15, 1, 15)),
    ("rail", (0, 0, 0, 16, 1, 16)),
    ("redstone_wire", (0, 0, 0, 16, 1, 16)),
    ("water", (0, 0, 0, 16, 14, 16)),
    ("lava", (0, 0, 0, 16, 14, 16)),
    ("vine", (0, 0, 0, 16, 16, 16)),
)
_FACING_WALL_BOX = {  # A sign, banner or button on a wall: a thin plate at the wall behind it.
    "north": (2, 4, 14, 14, 12, 16),
    "south": (2, 4, 0, 14, 12, 2),
    "west": (14, 4, 2, 16, 12, 14),
    "east": (0, 4, 2, 2, 12, 14),
}
_SMALL_BOX = (5, 0, 5, 11, 10, 11)
_LUMINOUS = (
    "sea_lantern", "glowstone", "shroomlight", "froglight", "lantern", "torch", "end_rod",
    "redstone_lamp[lit=true", "beacon", "candle",
)  # fmt: skip


@lru_cache(maxsize=4096)
def visible_boxes(state: str) -> np.ndarray:
    """Return the boxes that are drawn for a state, float32 [N, 6] within the unit cell."""
    name = state.partition("[")[0]
    if name in INVISIBLE:
        return np.empty((0, 6), np.float32)
    boxes = np.clip(np.asarray(boxes_of(state), np.float32).reshape(-1, 6), 0, 1)
    boxes = boxes[(boxes[:, 3:] > boxes[:, :3]).all(axis=1)]
    return boxes if len(boxes) else _marker(name, state)


def _marker(name: str, state: str) -> np.ndarray:
    """Return the stand-in box of a state that has no collision box."""
    facing = state.partition("facing=")[2].partition(",")[0].rstrip("]")
    on_wall = "wall_" in name or "face=wall" in state
    usual = _FACING_WALL_BOX.get(facing, _SMALL_BOX) if on_wall else _SMALL_BOX
    sixteenths = next((box for part, box in MARKER_BOXES if part in name), usual)
    return np.array([sixteenths], np.float32) / 16


def is_luminous(state: str) -> bool:
    """Tell whether a state is drawn at full brightness."""
    return any(part in state for part in _LUMINOUS)


def palette_colours(palette: tuple[str, ...]) -> np.ndarray:
    """Return float32 [P, 4]: the sRGB colour of each state, 0 to 255, and 1 where it glows."""
    rows = np.zeros((len(palette), 4), np.float32)
    for row, state in zip(rows, palette, strict=True):
        if state.partition("[")[0] not in INVISIBLE:
            row[:3] = colour_of(state)
            row[3] = is_luminous(state)
    return rows

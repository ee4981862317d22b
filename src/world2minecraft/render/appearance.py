"""What a block state looks like: its boxes, its colour, and whether it gives light."""

from functools import lru_cache

import numpy as np

from world2minecraft.minecraft.colours import colour_of
from world2minecraft.minecraft.glow import is_luminous
from world2minecraft.minecraft.visual import visual_boxes_of

INVISIBLE = frozenset(
    f"minecraft:{name}"
    for name in ("air", "cave_air", "void_air", "barrier", "light", "structure_void")
)


@lru_cache(maxsize=4096)
def visible_boxes(state: str) -> np.ndarray:
    """Return the boxes that are drawn for a state, float32 [N, 6] within the unit cell."""
    if state.partition("[")[0] in INVISIBLE:
        return np.empty((0, 6), np.float32)
    return visual_boxes_of(state)


def palette_colours(palette: tuple[str, ...]) -> np.ndarray:
    """Return float32 [P, 4]: the sRGB colour of each state, 0 to 255, and 1 where it glows."""
    rows = np.zeros((len(palette), 4), np.float32)
    for row, state in zip(rows, palette, strict=True):
        if state.partition("[")[0] not in INVISIBLE:
            row[:3] = colour_of(state)
            row[3] = is_luminous(state)
    return rows

"""The plainest source of looks: every state as its visible boxes in its one colour.

Texture names are ``plain:#rrggbb``. It knows every state, so that it may stand last in a stack.
"""

from functools import lru_cache

import numpy as np

from world2minecraft.minecraft.block_colours import colour_of
from world2minecraft.minecraft.visual_shapes import is_luminous, visual_boxes
from world2minecraft.rendering.block_elements import BlockModel, Element, ElementFace
from world2minecraft.rendering.texture import Texture

INVISIBLE = frozenset(
    f"minecraft:{name}"
    for name in ("air", "cave_air", "void_air", "barrier", "light", "structure_void")
)
_UV = np.zeros((2, 4))


@lru_cache(maxsize=4096)
def visible_boxes(state: str) -> np.ndarray:
    """Return the boxes that are drawn for a state, float32 [N, 6] within the unit cell."""
    if state.partition("[")[0] in INVISIBLE:
        return np.empty((0, 6), np.float32)
    return visual_boxes(state)


class PlainModels:
    """Boxes and flat colours."""

    def model(self, state: str) -> BlockModel:
        """Return the boxes of a state, all faces in its colour."""
        red, green, blue = (int(value) for value in colour_of(state))
        face = ElementFace(f"plain:#{red:02x}{green:02x}{blue:02x}", _UV)
        emission = 15 if is_luminous(state) else 0
        return BlockModel(
            tuple(
                Element(tuple(low), tuple(high), (face,) * 6, emission=emission)
                for low, high in visible_boxes(state).reshape(-1, 2, 3).tolist()
            )
        )

    def texture(self, name: str) -> Texture | None:
        """Return the texture of one colour, or None for a name of another source."""
        kind, _, colour = name.partition(":#")
        if kind != "plain" or len(colour) != 6:
            return None
        values = (*bytes.fromhex(colour), 255)
        return Texture(np.full((1, 1, 4), values, np.uint8))

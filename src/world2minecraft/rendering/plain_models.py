"""The simplest source of models: the visible boxes of every state in a single colour.

Texture names have the form ``plain:#rrggbb``. Every state has a model, so this source can be the
last of a stack.
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
    """Return the visible boxes of a state within the unit cell, float32 [N, 6]."""
    if state.partition("[")[0] in INVISIBLE:
        return np.empty((0, 6), np.float32)
    return visual_boxes(state)


class PlainModels:
    """A model source with plain boxes in flat colours."""

    def model(self, state: str) -> BlockModel:
        """Return the boxes of a state with all faces in its colour."""
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
        """Return a texture of one colour, or None for a name from another source."""
        kind, _, colour = name.partition(":#")
        if kind != "plain" or len(colour) != 6:
            return None
        values = (*bytes.fromhex(colour), 255)
        return Texture(np.full((1, 1, 4), values, np.uint8))

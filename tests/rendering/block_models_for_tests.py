"""A source of looks for tests: some states of ``scenes.PALETTE`` as glass, plates and the like."""

import numpy as np
from scenes import PALETTE

from world2minecraft.rendering.block_elements import BlockModel, Element, ElementFace, face_uv
from world2minecraft.rendering.plain_models import PlainModels
from world2minecraft.rendering.texture import Texture

WHOLE = ((0, 0, 0), (1, 1, 1))


def faces(texture: str, low=(0, 0, 0), high=(1, 1, 1)) -> tuple[ElementFace, ...]:
    return tuple(ElementFace(texture, face_uv(side, low, high)) for side in range(6))


def diagonal() -> np.ndarray:
    """A turn by 45 degrees about the block's upright middle."""
    there, back = np.eye(4), np.eye(4)
    there[:3, 3], back[:3, 3] = 0.5, -0.5
    turn, half = np.eye(4), np.sqrt(0.5)
    turn[:3, :3] = [[half, 0, half], [0, 1, 0], [-half, 0, half]]
    return there @ turn @ back


MODELS = {
    "glass": BlockModel((Element(*WHOLE, faces("glass")),)),
    "holes": BlockModel((Element(*WHOLE, faces("holes")),)),
    "no west": BlockModel((Element(*WHOLE, (None, *faces("wall")[1:])),)),
    "diagonal": BlockModel((Element((0, 0, 0.5), (1, 1, 0.5), faces("wall"), turn=diagonal()),)),
    "tall": BlockModel((Element((0, 0, 0), (1, 4, 1), faces("wall")),)),
}


def texture_of(name: str) -> Texture:
    colour = np.full((4, 4, 4), (200, 40, 40, 255), np.uint8)
    if name == "glass":
        colour[:] = (40, 40, 250, 100)
    if name == "holes":
        colour[1:3, 1:3, 3] = 0
    return Texture(colour, translucent=name == "glass")


class FewLooks:
    """Models by the palette's index; all else as ``PlainModels``."""

    def __init__(self, kinds: dict[int, str]):
        self._kinds = {PALETTE[index]: kind for index, kind in kinds.items()}
        self._rest = PlainModels()

    def model(self, state: str) -> BlockModel:
        return MODELS[self._kinds[state]] if state in self._kinds else self._rest.model(state)

    def texture(self, name: str) -> Texture | None:
        return self._rest.texture(name) or texture_of(name)

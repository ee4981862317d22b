"""The built-in source of models and textures for every block, without files of the game."""

from collections.abc import Iterable
from dataclasses import dataclass, field

from world2minecraft.rendering.block_elements import BlockModel
from world2minecraft.rendering.block_models.face_pictures import PICTURE, picture_of
from world2minecraft.rendering.block_models.models import model_of
from world2minecraft.rendering.block_models.texture_recipes import PREFIX, split_recipe
from world2minecraft.rendering.texture import Texture
from world2minecraft.rendering.textures import texture_of

VANILLA_PX = 16  # Texture width of the game, in pixels per block.


@dataclass(frozen=True, eq=False)
class BuiltinModels:
    """The built-in model source, with models from rules and textures from recipes.

    Args:
        size_px: Pixels per block, 16 to 128.
    """

    size_px: int = VANILLA_PX
    _textures: dict[str, Texture] = field(default_factory=dict, init=False, repr=False)

    def model(self, state: str) -> BlockModel:
        """Return the model of a block state, marked as ``stand_in`` if no rule matches the block.

        Raises:
            UsageError: If the text is not a valid block state.
        """
        return model_of(state)

    def texture(self, name: str) -> Texture | None:
        """Return the texture of a recipe, or None for a name from another source."""
        if not name.startswith(PREFIX):
            return None
        if name not in self._textures:
            self._textures[name] = _made(name, self.size_px)
        return self._textures[name]


def stand_ins(states: Iterable[str]) -> list[str]:
    """Return the states without a known appearance, sorted and without duplicates.

    Raises:
        UsageError: If a text is not a valid block state.
    """
    return sorted({state for state in states if model_of(state).stand_in})


def stand_in_share(states: Iterable[str]) -> float:
    """Return the fraction of the given states without a known appearance, 0 to 1.

    Raises:
        UsageError: If a text is not a valid block state.
    """
    every = set(states)
    return len(stand_ins(every)) / len(every) if every else 0.0


def _made(name: str, size_px: int) -> Texture:
    if split_recipe(name)[0] == PICTURE:
        return picture_of(name, size_px)
    return texture_of(name, size_px)

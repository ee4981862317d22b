"""Built-in models and textures for every block, which need no files of the game."""

from world2minecraft.rendering.block_models.builtin import BuiltinModels, stand_in_share, stand_ins

__all__ = ["BuiltinModels", "stand_in_share", "stand_ins"]

"""Our own looks of every block: models and textures without a file of the game."""

from world2minecraft.rendering.block_models.builtin import BuiltinModels, stand_in_share, stand_ins

__all__ = ["BuiltinModels", "stand_in_share", "stand_ins"]

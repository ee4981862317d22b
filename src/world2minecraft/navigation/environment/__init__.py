"""The Gymnasium environment ``world2minecraft/MinecraftVLN-v0`` for navigation in any world.

After ``import world2minecraft``, create it with::

    gymnasium.make("world2minecraft/MinecraftVLN-v0", scene=PATH)

The ID ``"world2minecraft:world2minecraft/MinecraftVLN-v0"`` works without the import.
"""

from world2minecraft.navigation.gymnasium_plugin import ENV_ID, SERVER_ENV_ID, register_environments

register_environments()

__all__ = ["ENV_ID", "SERVER_ENV_ID", "register_environments"]

"""The Gymnasium environment ``world2minecraft/MinecraftVLN-v0``: one line makes it over any world.

``gymnasium.make("world2minecraft/MinecraftVLN-v0", scene=PATH)`` makes it after
``import world2minecraft``; ``"world2minecraft:world2minecraft/MinecraftVLN-v0"`` needs no import.
"""

from world2minecraft.navigation.gymnasium_plugin import ENV_ID, SERVER_ENV_ID, register_environments

register_environments()

__all__ = ["ENV_ID", "SERVER_ENV_ID", "register_environments"]

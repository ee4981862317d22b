"""The environment ``World2Minecraft-VLN-v0`` of gymnasium: one line makes it over any world.

``gymnasium.make("world2minecraft.navigation.environment:World2Minecraft-VLN-v0", scene=PATH)``
imports this package, which registers it; so does ``import world2minecraft.navigation.environment``.
"""

from world2minecraft.navigation.environment.registration import ENV_ID, register_environments

register_environments()

__all__ = ["ENV_ID", "register_environments"]

"""Tells gymnasium of the environment; the environment itself is imported when one is made."""

from world2minecraft.core.errors import MissingExtraError

ENV_ID = "World2Minecraft-VLN-v0"
SERVER_ENV_ID = "World2Minecraft-VLN-Server-v0"


def register_environments() -> None:
    """Register the environments, once; older gymnasiums call this through its entry point.

    Raises:
        MissingExtraError: gymnasium is not installed.
    """
    try:
        import gymnasium  # noqa: PLC0415  # An extra.
    except ImportError as error:
        raise MissingExtraError("the environment", "vln") from error
    if ENV_ID not in gymnasium.registry:
        gymnasium.register(ENV_ID, "world2minecraft.navigation.environment.env:VlnEnv")
        gymnasium.register(SERVER_ENV_ID, "world2minecraft.navigation.server.env:ServerEnv")

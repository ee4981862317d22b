"""The environment ``world2minecraft/MinecraftVLN-Server-v0``, with a player on a game server."""

from pathlib import Path
from typing import Any

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.environment.action_spaces import ActionController
from world2minecraft.navigation.environment.env import VlnEnv, warn_of_former_id
from world2minecraft.navigation.environment.observations import FORMER_SENSORS
from world2minecraft.navigation.gymnasium_plugin import SERVER_ENV_ID
from world2minecraft.navigation.server.actions import ServerContinuousActions, ServerDiscreteActions
from world2minecraft.navigation.server.player import DEFAULT_NAME, ServerPlayer, join
from world2minecraft.navigation.server.streamed_blocks import Box
from world2minecraft.navigation.server.streamed_scene import open_server_scene
from world2minecraft.navigation.types import MoveSet


class ServerEnv(VlnEnv):
    """A Gymnasium environment whose agent plays on a game server.

    Args:
        server: HOST or HOST:PORT, or a player that has already joined.
        labels: The labels of the blocks, as accepted by ``open_server_scene``.
        box: The block range, as accepted by ``open_server_scene``.
        blocks_per_metre: The scale, as accepted by ``open_server_scene``.
        name: The player name. The player must be an operator in order to use /tp.
        version: The game version. If empty, the server is queried.
        options: Options of ``VlnEnv`` except ``scene``, ``body`` and ``sliding``.

    Raises:
        UsageError: If an option is invalid, or mineflayer is not installed.
        ServerError: If the server does not admit the player.
        InputError: If there is no floor to stand on.
    """

    def __init__(
        self,
        server: str | ServerPlayer,
        *,
        labels: str | Path | None = None,
        box: Box | None = None,
        blocks_per_metre: float | None = None,
        name: str = DEFAULT_NAME,
        version: str = "",
        **options: Any,
    ):
        for option in ("scene", "body", "sliding"):
            if option in options:
                raise UsageError(f"the option {option!r} is not available on a server; omit it")
        owned = not isinstance(server, ServerPlayer)
        self.server = join(server, name=name, version=version) if owned else server
        self._is_owned = owned
        try:
            scene = open_server_scene(
                self.server, labels=labels, box=box, blocks_per_metre=blocks_per_metre
            )
            super().__init__(scene, **options)
        except BaseException:
            self._leave()
            raise

    def close(self) -> None:
        """Close the browser page, and leave the server."""
        super().close()
        self._leave()

    def _leave(self) -> None:
        if self._is_owned:
            self.server.close()

    def _make_controller(self, by_keys: bool, move_set: MoveSet, sliding: bool) -> ActionController:
        if by_keys:
            return ServerContinuousActions(self.scene, self.server)
        return ServerDiscreteActions(self.scene, move_set, self.server)


class FormerIdServerEnv(ServerEnv):
    """The environment under its former id, with the default observations of that version."""

    def __init__(self, *args: Any, **options: Any):
        warn_of_former_id("World2Minecraft-VLN-Server-v0", SERVER_ENV_ID)
        super().__init__(*args, **{"observations": FORMER_SENSORS, **options})

"""A scene on a server as the ground of episodes: moves are made by its player."""

from world2minecraft.core.types import Camera
from world2minecraft.navigation.running.ground import Ground
from world2minecraft.navigation.running.scene_ground import SceneGround
from world2minecraft.navigation.server.acting import MovesOnServer
from world2minecraft.navigation.server.scene import ServerScene
from world2minecraft.navigation.values import Move, MoveSet, Stance


class ServerGround(SceneGround):
    """A scene whose player stands on a server; see ``imagined`` for moves that it does not make."""

    def __init__(
        self, scene: ServerScene, move_set: str | MoveSet = "vlnce", camera: Camera | None = None
    ):
        super().__init__(scene, move_set, camera)
        self._acting = MovesOnServer(scene, self.move_set, scene.server)

    def after(self, stance: Stance, move: Move) -> tuple[Stance, bool]:
        """Make a move; the player is put where it begins, if it stands elsewhere."""
        if stance != self._acting.stance:
            self._acting.begin(stance)
        if move == Move.STOP:
            return stance, False
        self._acting.stance, collided = self._acting.made(move)
        return self._acting.stance, collided

    @property
    def imagined(self) -> Ground:
        """The scene alone: what the oracle thinks of moves no player."""
        return SceneGround(self.scene, self.move_set, self.camera)

"""How an agent acts by a body on a server: moves made by keys, or the keys themselves."""

from world2minecraft.minecraft.physics import Body, Keys
from world2minecraft.navigation.environment.action_spaces import Continuous, Discrete
from world2minecraft.navigation.moves import forward_blocks, heading, wrapped_yaw
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.server.body import ServerBody
from world2minecraft.navigation.server.pace import forward_keys
from world2minecraft.navigation.values import Move, MoveSet, Stance

SHORT = 0.9  # Of a step: who came less far met something.


class MovesOnServer(Discrete):
    """One move an action. The game knows no whole steps: one goes as far as the way is free."""

    def __init__(self, scene: VlnScene, move_set: MoveSet, server: ServerBody):
        super().__init__(scene, move_set, sliding=True)
        self.server = server

    def begin(self, stance: Stance) -> None:
        """Stand somewhere."""
        body = self.server.place(stance.feet, stance.yaw_deg)
        self.stance = Stance(*body.position, stance.yaw_deg, stance.pitch_deg)

    def made(self, move: Move) -> tuple[Stance, bool]:
        """Turn in a tick, or walk by holding keys until the step is done."""
        here, turn = self.stance, self.move_set.turn_deg
        if move == Move.FORWARD:
            length = forward_blocks(self.scene, self.move_set)
            self.server.hold(forward_keys(length, here.yaw_deg), here.pitch_deg)
            body = self.server.settle(here.yaw_deg)
            x, z = heading(here.yaw_deg)
            gone = (body.position[0] - here.x) * x + (body.position[2] - here.z) * z
            stance = Stance(*body.position, here.yaw_deg, here.pitch_deg)
            return stance, gone < SHORT * length
        yaw_deg = wrapped_yaw(here.yaw_deg + (turn if move == Move.RIGHT else -turn))
        body = self.server.hold([Keys(yaw_deg=yaw_deg)], here.pitch_deg)[-1]
        return Stance(*body.position, yaw_deg, here.pitch_deg), False


class KeysOnServer(Continuous):
    """A tick of the game an action: keys held and the mouse moved, or STOP said."""

    def __init__(self, scene: VlnScene, server: ServerBody):
        super().__init__(scene)
        self.server = server

    def begin(self, stance: Stance) -> None:
        """Stand somewhere, at rest."""
        self.body = self.server.place(stance.feet, stance.yaw_deg)
        self.stance = Stance(*self.body.position, stance.yaw_deg, stance.pitch_deg)

    def ticked(self, keys: Keys, pitch_deg: float) -> Body:
        """Return the player after a tick of keys."""
        return self.server.hold([keys], pitch_deg)[-1]

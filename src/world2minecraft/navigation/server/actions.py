"""Actions of a player on a server: discrete moves by timed key presses, or keys directly.

A tick of walking covers 0.216 blocks and a tick of sneaking 0.065, including coasting. Combined,
they approximate any length of at least one sneaking tick to within 0.03 blocks.
"""

from functools import lru_cache

from world2minecraft.minecraft.physics import Body, BoxWorld, Keys, step
from world2minecraft.navigation.environment.action_spaces import ContinuousActions, DiscreteActions
from world2minecraft.navigation.moves import forward_blocks, heading_vector, wrap_yaw
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.server.player import ServerPlayer
from world2minecraft.navigation.types import Move, MoveSet, Stance

MAX_SNEAKING_TICKS = 9  # Enough to match most lengths to within 0.01 blocks.
MAX_BLOCKS = 16.0
_FLAT = BoxWorld([[-99, -1, -99, 99, 0, 99]])
_WALK = Keys(forward=True)
_SNEAK = Keys(forward=True, sneak=True)
_REST = 12  # Maximum number of ticks until a player without keys stands still.
MIN_STEP_SHARE = 0.9  # A step that covers less has collided.


def forward_keys(length: float, yaw_deg: float) -> list[Keys]:
    """Return the keys for each tick that move the player a number of blocks ahead and to rest.

    Example:
        >>> keys = forward_keys(1.0, 90.0)
        >>> len(keys), sum(one.sneak for one in keys), keys[-1].forward
        (17, 9, False)
    """
    walking, sneaking = _ticks(min(max(length, 0.0), MAX_BLOCKS))
    held = [_WALK] * walking + [_SNEAK] * sneaking
    rest = _way(walking, sneaking)[1]
    return [one._replace(yaw_deg=yaw_deg) for one in [*held, *[Keys()] * rest]]


@lru_cache(maxsize=256)
def _ticks(length: float) -> tuple[int, int]:
    """Return the numbers of walking and sneaking ticks that best match a length."""
    best, error = (0, 0), length
    for sneaking in range(MAX_SNEAKING_TICKS + 1):
        walking = 0
        while _way(walking + 1, sneaking)[0] <= length:
            walking += 1
        for count in (walking, walking + 1):
            away = abs(_way(count, sneaking)[0] - length)
            if away < error - 1e-3:
                best, error = (count, sneaking), away
    return best


@lru_cache(maxsize=4096)
def _way(walking: int, sneaking: int) -> tuple[float, int]:
    """Return the distance in blocks of walking and sneaking ticks, and the ticks until rest."""
    body = Body((0.0, 0.0, 0.0), on_ground=True)
    for keys in [_WALK] * walking + [_SNEAK] * sneaking:
        body = step(_FLAT, body, keys)
    for tick in range(_REST):
        before = body.position
        body = step(_FLAT, body, Keys())
        if body.position == before:
            return body.position[2], tick + 1
    return body.position[2], _REST


class ServerDiscreteActions(DiscreteActions):
    """A controller for discrete moves on a server.

    The game has no fixed steps, so a blocked step ends at the obstacle instead of failing.
    """

    def __init__(self, scene: VlnScene, move_set: MoveSet, server: ServerPlayer):
        super().__init__(scene, move_set, sliding=True)
        self.server = server

    def begin(self, stance: Stance) -> None:
        """Place the player at a stance."""
        body = self.server.place(stance.feet, stance.yaw_deg)
        self.stance = Stance(*body.position, stance.yaw_deg, stance.pitch_deg)

    def apply(self, move: Move) -> tuple[Stance, bool]:
        """Turn in one tick, or walk a step by holding keys."""
        here, turn = self.stance, self.move_set.turn_deg
        if move == Move.FORWARD:
            length = forward_blocks(self.scene, self.move_set)
            self.server.hold(forward_keys(length, here.yaw_deg), here.pitch_deg)
            body = self.server.settle(here.yaw_deg)
            x, z = heading_vector(here.yaw_deg)
            gone = (body.position[0] - here.x) * x + (body.position[2] - here.z) * z
            stance = Stance(*body.position, here.yaw_deg, here.pitch_deg)
            return stance, gone < MIN_STEP_SHARE * length
        yaw_deg = wrap_yaw(here.yaw_deg + (turn if move == Move.RIGHT else -turn))
        body = self.server.hold([Keys(yaw_deg=yaw_deg)], here.pitch_deg)[-1]
        return Stance(*body.position, yaw_deg, here.pitch_deg), False


class ServerContinuousActions(ContinuousActions):
    """A controller for game input on a server, with one tick of keys and mouse per action."""

    def __init__(self, scene: VlnScene, server: ServerPlayer):
        super().__init__(scene)
        self.server = server

    def begin(self, stance: Stance) -> None:
        """Place the player at rest at a stance."""
        self.body = self.server.place(stance.feet, stance.yaw_deg)
        self.stance = Stance(*self.body.position, stance.yaw_deg, stance.pitch_deg)

    def tick(self, keys: Keys, pitch_deg: float) -> Body:
        """Return the player's body after one tick of key input."""
        return self.server.hold([keys], pitch_deg)[-1]

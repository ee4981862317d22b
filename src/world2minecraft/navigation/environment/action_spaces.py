"""The action spaces: discrete moves, runs of moves, or the keyboard and mouse input of the game."""

from typing import Any, Protocol

import numpy as np
from gymnasium import spaces

from world2minecraft.core.errors import UsageError
from world2minecraft.minecraft.physics import BlockWorld, Body, Keys, step
from world2minecraft.navigation.moves import apply_move, wrap_yaw
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.types import Move, MoveSet, Stance

KEYS = ("forward", "back", "left", "right", "jump", "sneak", "sprint")
MAX_RUN = 12  # Moves of one run: 3 m, or half a turn.
MAX_TURN_DEG = 45.0  # By the mouse in one tick.


class ActionController(Protocol):
    """The interface of controllers that apply actions and track the agent's stance."""

    stance: Stance

    @property
    def space(self) -> spaces.Space:
        """The Gymnasium space of the actions."""
        ...

    def begin(self, stance: Stance) -> None:
        """Place the agent at a stance."""
        ...

    def act(self, action: Any) -> tuple[bool, list[Stance], bool]:
        """Apply an action.

        Returns:
            Whether the action was STOP, the stances reached, and whether the agent collided.
        """
        ...


class DiscreteActions:
    """A controller for single moves, or for runs of equal moves with a macro move set.

    The moves have Habitat's numbers.
    """

    def __init__(self, scene: VlnScene, move_set: MoveSet, sliding: bool):
        self.scene, self.move_set, self.sliding = scene, move_set, sliding
        runs = spaces.MultiDiscrete([len(Move), MAX_RUN])
        self.space = runs if move_set.is_macro else spaces.Discrete(len(Move))
        self.stance = Stance(0.0, 0.0, 0.0)

    def begin(self, stance: Stance) -> None:
        """Place the agent at a stance."""
        self.stance = stance

    def act(self, action: Any) -> tuple[bool, list[Stance], bool]:
        """Make a move, or a run of moves ``(move, count - 1)`` that ends at the first collision.

        Raises:
            UsageError: If the action is not in the space.
        """
        if not self.space.contains(action):
            moves = ", ".join(f"{int(move)} {move.name.lower()}" for move in Move)
            runs = f", then 0 to {MAX_RUN - 1} for moves beyond the first"
            more = runs if self.move_set.is_macro else ""
            raise UsageError(f"action must be in {self.space}, got {action!r}: {moves}{more}")
        values = np.atleast_1d(np.asarray(action, np.int64)).tolist()
        move, count = Move(values[0]), values[1] + 1 if len(values) > 1 else 1
        if move == Move.STOP:
            return True, [], False
        gone: list[Stance] = []
        for _ in range(count):
            self.stance, collided = self.apply(move)
            gone.append(self.stance)
            if collided:
                return False, gone, True
        return False, gone, False

    def apply(self, move: Move) -> tuple[Stance, bool]:
        """Return the stance after a move other than STOP, and whether the move collides."""
        return apply_move(self.scene, self.stance, move, self.move_set, sliding=self.sliding)


class ContinuousActions:
    """A controller for game input: each action is one tick (1/20 s) of keys and mouse, or STOP."""

    def __init__(self, scene: VlnScene):
        self.scene = scene
        self.world = BlockWorld.of_volume(scene.volume)
        self.space = spaces.Dict(
            {
                "keys": spaces.MultiBinary(len(KEYS)),
                "camera": spaces.Box(-1.0, 1.0, (2,), np.float32),
                "stop": spaces.Discrete(2),
            }
        )
        self.stance = Stance(0.0, 0.0, 0.0)
        self.body = Body((0.0, 0.0, 0.0))

    def begin(self, stance: Stance) -> None:
        """Place the agent at rest at a stance."""
        self.stance, self.body = stance, Body(stance.feet, on_ground=True)

    def act(self, action: Any) -> tuple[bool, list[Stance], bool]:
        """Turn by the mouse input, then hold the keys for one tick.

        Raises:
            UsageError: If the action is not in the space.
        """
        if not self.space.contains(action):
            raise UsageError(
                f"an action must have the keys {', '.join(KEYS)} (0 or 1), camera (yaw and "
                f"pitch as float32 from -1 to 1, in units of {MAX_TURN_DEG:g} degrees) and "
                f"stop (0 or 1), got {action!r}"
            )
        if action["stop"]:
            return True, [], False
        yaw_by, pitch_by = (MAX_TURN_DEG * float(share) for share in action["camera"])
        yaw_deg = wrap_yaw(self.stance.yaw_deg + yaw_by)
        pitch_deg = min(max(self.stance.pitch_deg + pitch_by, -90.0), 90.0)
        keys = Keys(*(bool(key) for key in action["keys"]), yaw_deg=yaw_deg)
        self.body = self.tick(keys, pitch_deg)
        x, y, z = self.body.position
        self.stance = Stance(x, y, z, yaw_deg, pitch_deg)
        return False, [self.stance], self.body.hit_wall

    def tick(self, keys: Keys, pitch_deg: float) -> Body:
        """Return the body after one tick of key input. The pitch does not affect the body."""
        return step(self.world, self.body, keys, self.scene.scale)

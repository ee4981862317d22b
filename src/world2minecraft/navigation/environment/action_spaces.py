"""How an agent acts: discrete moves, runs of moves, or the keys and the mouse of the game."""

from typing import Any, Protocol

import numpy as np
from gymnasium import spaces

from world2minecraft.core.errors import UsageError
from world2minecraft.minecraft.physics import BlockWorld, Body, Keys, step
from world2minecraft.navigation.moves import apply_move, wrap_yaw
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.types import Move, MoveSet, Stance

KEYS = ("forward", "back", "left", "right", "jump", "sneak", "sprint")
MAX_RUN = 12  # Moves of one run: 3 m of steps, or half a turn.
MAX_TURN_DEG = 45.0  # Of the mouse in a tick.


class ActionController(Protocol):
    """Takes actions of a space and keeps where the agent stands."""

    stance: Stance

    @property
    def space(self) -> spaces.Space:
        """The space of the actions."""
        ...

    def begin(self, stance: Stance) -> None:
        """Stand somewhere."""
        ...

    def act(self, action: Any) -> tuple[bool, list[Stance], bool]:
        """Return whether it was STOP, where it went, and whether something was in the way."""
        ...


class DiscreteActions:
    """One move an action, by Habitat's numbers; a run of equal moves where the set is a macro."""

    def __init__(self, scene: VlnScene, move_set: MoveSet, sliding: bool):
        self.scene, self.move_set, self.sliding = scene, move_set, sliding
        runs = spaces.MultiDiscrete([len(Move), MAX_RUN])
        self.space = runs if move_set.is_macro else spaces.Discrete(len(Move))
        self.stance = Stance(0.0, 0.0, 0.0)

    def begin(self, stance: Stance) -> None:
        """Stand somewhere."""
        self.stance = stance

    def act(self, action: Any) -> tuple[bool, list[Stance], bool]:
        """Make a move; of a run ``(move, count - 1)``, moves until one meets something."""
        if not self.space.contains(action):
            moves = ", ".join(f"{int(move)} {move.name.lower()}" for move in Move)
            runs = f", then 0 to {MAX_RUN - 1} for moves beyond the first"
            more = runs if self.move_set.is_macro else ""
            raise UsageError(f"an action is one of {self.space}, not {action!r}: {moves}{more}")
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
        """Return where a move that is no STOP leads, and whether something was in the way."""
        return apply_move(self.scene, self.stance, move, self.move_set, sliding=self.sliding)


class ContinuousActions:
    """A twentieth of a second of the game an action: keys held, the mouse moved, or STOP said."""

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
        """Stand somewhere, at rest."""
        self.stance, self.body = stance, Body(stance.feet, on_ground=True)

    def act(self, action: Any) -> tuple[bool, list[Stance], bool]:
        """Turn by the mouse, yaw and pitch, then hold the keys for a tick."""
        if not self.space.contains(action):
            raise UsageError(
                f"an action has keys (0 or 1 of {', '.join(KEYS)}), camera (yaw and pitch, float32 "
                f"from -1 to 1, times {MAX_TURN_DEG:g} degrees) and stop (0 or 1), not {action!r}"
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
        """Return the body after a tick of keys; where it looks up or down does not matter to it."""
        return step(self.world, self.body, keys, self.scene.scale)

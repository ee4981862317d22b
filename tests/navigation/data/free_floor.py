"""The physics of an endless empty floor, for walks without a world."""

import numpy as np

from world2minecraft.navigation.types import Move, MoveSet, Stance
from world2minecraft.navigation.walk_discretization import StepFunction
from world2minecraft.navigation.walk_stream import wrap_deg


def free_walker(move_set: MoveSet, blocks_per_metre: float) -> StepFunction:
    """Return where moves lead on a floor without end, in a world of so many blocks a metre."""
    step = (move_set.forward_m or 1 / blocks_per_metre) * blocks_per_metre

    def walk(stance: Stance, move: Move) -> tuple[Stance, bool]:
        yaw = stance.yaw_deg + move_set.turn_deg * ((move == Move.RIGHT) - (move == Move.LEFT))
        yaw = float(wrap_deg(yaw))
        ahead = step if move == Move.FORWARD else 0.0
        x = stance.x - ahead * float(np.sin(np.radians(yaw)))
        z = stance.z + ahead * float(np.cos(np.radians(yaw)))
        return Stance(x, stance.y, z, yaw, stance.pitch_deg), False

    return walk

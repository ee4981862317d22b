"""Discrete moves: a turn on the spot, or a step forward that is made whole or not at all.

The body is the game's, times the scene's scale: it steps up 0.6 of its size and drops 3, and walks
on no furniture, as the walkable graph. One who slides goes on along what stops him, as in the game.
"""

import math

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.minecraft.physics.body import HEIGHT, STEP_HEIGHT, WIDTH
from world2minecraft.minecraft.physics.graph import DROP
from world2minecraft.navigation.motion import BodySize, walked
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.values import MOVE_SETS, Move, MoveSet, Stance

_DIGITS = 6  # Of a yaw in degrees: turns there and back give the same number.


def moved(
    scene: VlnScene,
    stance: Stance,
    move: Move,
    move_set: str | MoveSet = "vlnce",
    *,
    sliding: bool = False,
) -> tuple[Stance, bool]:
    """Return where one stands after a move, and whether something was in the way.

    Args:
        scene: where one walks.
        stance: where one stands.
        move: STOP leaves all as it is.
        move_set: how far a move goes, or its name.
        sliding: go on along what is in the way, rather than stay.

    Raises:
        UnknownNameError: no set of moves has this name.

    Example:
        >>> moved(scene, Stance(3.0, 65.0, 3.0), Move.LEFT)               # doctest: +SKIP
        (Stance(x=3.0, y=65.0, z=3.0, yaw_deg=-15.0, pitch_deg=0.0), False)
    """
    how = named_set(move_set)
    if move == Move.FORWARD:
        return _forward(scene, stance, forward_blocks(scene, how), sliding)
    if move == Move.STOP:
        return stance, False
    turn = how.turn_deg if move == Move.RIGHT else -how.turn_deg
    yaw_deg = wrapped_yaw(stance.yaw_deg + turn)
    return Stance(stance.x, stance.y, stance.z, yaw_deg, stance.pitch_deg), False


def named_set(move_set: str | MoveSet) -> MoveSet:
    """Return a set of moves by its name. Raises UnknownNameError: none has it."""
    if isinstance(move_set, MoveSet):
        return move_set
    if move_set not in MOVE_SETS:
        raise UnknownNameError("set of moves", move_set, MOVE_SETS)
    return MOVE_SETS[move_set]


def forward_blocks(scene: VlnScene, move_set: MoveSet) -> float:
    """Return how many blocks a step forward goes; one where the set names no length."""
    return move_set.forward_m * scene.blocks_per_metre or 1.0


def wrapped_yaw(yaw_deg: float) -> float:
    """Return an angle from -180 up to 180, rounded so that turns there and back are exact."""
    return round((yaw_deg + 180.0) % 360.0 - 180.0, _DIGITS)


def heading(yaw_deg: float) -> tuple[float, float]:
    """Return where one looks along the ground: x and z, of length 1."""
    return -math.sin(math.radians(yaw_deg)), math.cos(math.radians(yaw_deg))


def body_size(scene: VlnScene) -> BodySize:
    """Return the lengths of the scene's walker, in blocks."""
    scale = scene.scale
    return BodySize(WIDTH * scale / 2, HEIGHT * scale, STEP_HEIGHT * scale, DROP * scale)


def _forward(scene: VlnScene, stance: Stance, length: float, sliding: bool) -> tuple[Stance, bool]:
    x, z = heading(stance.yaw_deg)
    at_x, at_y, at_z, collided = walked(
        scene.solid, scene.corner, stance.x, stance.y, stance.z,
        x * length, z * length, body_size(scene), sliding,
    )  # fmt: skip
    return Stance(at_x, at_y, at_z, stance.yaw_deg, stance.pitch_deg), collided

"""The player's body and the constants of the game's physics.

Coordinates are those of blocks: x east, y up, z south. Lengths are in blocks for a player of the
game's size; ``scale`` makes the player and all speeds as many times larger, so that at 4 blocks a
metre and scale 4 a person has a person's size in the room.
"""

from typing import NamedTuple

import numpy as np

TICKS_PER_S = 20
WIDTH, HEIGHT, CROUCHED_HEIGHT = 0.6, 1.8, 1.5
EYE, CROUCHED_EYE = 1.62, 1.27
STEP_HEIGHT = 0.6  # What one walks up without a jump.
GRAVITY, FALL_DRAG = 0.08, 0.98  # Blocks a tick a tick; of the falling speed, each tick.
JUMP_SPEED, JUMP_WAIT = 0.42, 10  # Blocks a tick; ticks until a key held down jumps again.
SPRINT_JUMP = 0.2  # Blocks a tick, forward.
GROUND_ACCELERATION, AIR_ACCELERATION = 0.1, 0.02
SPRINT, SNEAK = 1.3, 0.3  # Times the acceleration; times what the keys ask for.
KEY_INPUT = 0.98  # What a key that is held asks for.
AIR_INERTIA = 0.91  # Of the speed along the ground, each tick.
GROUND_INERTIA = 0.6 * AIR_INERTIA  # On every block but ice, slime and their like.
NEGLIGIBLE = 0.003  # Blocks a tick: slower is at rest.
TOUCH = 1e-7  # Blocks: boxes that lie over each other by less than this only touch.
EDGE_STEP = 0.05  # Blocks by which one who sneaks draws back from an edge.


class Keys(NamedTuple):
    """What is held down during a tick, and where the player looks: the game's yaw."""

    forward: bool = False
    back: bool = False
    left: bool = False
    right: bool = False
    jump: bool = False
    sneak: bool = False
    sprint: bool = False
    yaw_deg: float = 0.0  # 0 looks to +z and grows clockwise from above.


class Body(NamedTuple):
    """A player between two ticks."""

    position: tuple[float, float, float]  # blocks, the middle of the feet
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)  # blocks a tick
    on_ground: bool = False
    crouched: bool = False
    jump_wait: int = 0  # ticks
    hit_wall: bool = False  # in the last tick


def body_box(
    position: tuple[float, float, float], scale: float = 1.0, *, crouched: bool = False
) -> np.ndarray:
    """Return the box, float64 [6] in blocks, of a body whose feet are at a position."""
    half = WIDTH * scale / 2
    height = (CROUCHED_HEIGHT if crouched else HEIGHT) * scale
    x, y, z = position
    return np.array([x - half, y, z - half, x + half, y + height, z + half])


def eye_height(body: Body, scale: float = 1.0) -> float:
    """Return how far the eyes are above the feet, in blocks."""
    return (CROUCHED_EYE if body.crouched else EYE) * scale

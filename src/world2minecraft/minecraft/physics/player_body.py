"""The player's body and the constants of the game's physics.

Coordinates are block coordinates: x is east, y is up, z is south. Lengths are in blocks for a
player of the game's size. ``scale`` multiplies the player's size and all speeds, so that at 4
blocks per metre and scale 4 the player is as large as a real person in the room.
"""

from typing import NamedTuple

import numpy as np

TICKS_PER_S = 20
WIDTH, HEIGHT, CROUCHED_HEIGHT = 0.6, 1.8, 1.5
EYE, CROUCHED_EYE = 1.62, 1.27
STEP_HEIGHT = 0.6  # The height of a step that needs no jump.
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
    """The keys held down during a tick, and the yaw of the view."""

    forward: bool = False
    back: bool = False
    left: bool = False
    right: bool = False
    jump: bool = False
    sneak: bool = False
    sprint: bool = False
    yaw_deg: float = 0.0  # 0 faces +z; increases clockwise seen from above.


class Body(NamedTuple):
    """The state of a player between two ticks."""

    position: tuple[float, float, float]  # The middle of the feet, in blocks.
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)  # Blocks per tick.
    on_ground: bool = False
    crouched: bool = False
    jump_wait: int = 0  # Ticks until the next jump.
    hit_wall: bool = False  # Whether the last tick ended at a wall.


def body_box(
    position: tuple[float, float, float], scale: float = 1.0, *, crouched: bool = False
) -> np.ndarray:
    """Return the box of a body as float64 [6] in blocks, given the position of its feet."""
    half = WIDTH * scale / 2
    height = (CROUCHED_HEIGHT if crouched else HEIGHT) * scale
    x, y, z = position
    return np.array([x - half, y, z - half, x + half, y + height, z + half])


def eye_height(body: Body, scale: float = 1.0) -> float:
    """Return the height of the eyes above the feet, in blocks."""
    return (CROUCHED_EYE if body.crouched else EYE) * scale

"""Movement of a walking player by one tick (1/20 s)."""

import math

import numpy as np

from world2minecraft.minecraft.physics.collisions import (
    World,
    find_overlaps,
    sweep_box,
    sweep_with_step,
)
from world2minecraft.minecraft.physics.player_body import (
    AIR_ACCELERATION,
    AIR_INERTIA,
    EDGE_STEP,
    FALL_DRAG,
    GRAVITY,
    GROUND_ACCELERATION,
    GROUND_INERTIA,
    JUMP_SPEED,
    JUMP_WAIT,
    KEY_INPUT,
    NEGLIGIBLE,
    SNEAK,
    SPRINT,
    SPRINT_JUMP,
    STEP_HEIGHT,
    TOUCH,
    Body,
    Keys,
    body_box,
)

_MARGIN = 1.0  # Blocks around what a tick can reach.


def step(world: World, body: Body, keys: Keys, scale: float = 1.0) -> Body:
    """Return the player's state after one tick.

    Args:
        world: The boxes that stop the player, in blocks.
        body: The player's current state.
        keys: The keys held down during the tick.
        scale: The player's size relative to the game's player. Speeds scale with it.

    Example:
        >>> from world2minecraft.minecraft.physics.collisions import BoxWorld
        >>> floor = BoxWorld([[-9, -1, -9, 9, 0, 9]])
        >>> step(floor, Body((0, 0, 0), on_ground=True), Keys(forward=True)).position
        (0.0, 0.0, 0.098)
    """
    boxes = _around(world, body, scale)
    crouched = keys.sneak or (body.crouched and not _fits(boxes, body, scale))
    sprints = keys.sprint and keys.forward and not keys.back and not crouched
    velocity = [v if abs(v) >= NEGLIGIBLE * scale else 0.0 for v in body.velocity]
    if body.on_ground:  # A standing player is pressed to the ground, also in the first tick.
        velocity[1] = -GRAVITY * FALL_DRAG * scale
    wait = max(body.jump_wait - 1, 0) if keys.jump else 0
    if keys.jump and body.on_ground and wait == 0:
        velocity[1], wait = JUMP_SPEED * scale, JUMP_WAIT
        _push(velocity, 0.0, SPRINT_JUMP * scale * sprints, keys.yaw_deg)
    _accelerate(velocity, body.on_ground, keys, crouched, sprints, scale)
    way = np.array(velocity)
    if crouched and body.on_ground and velocity[1] <= 0:
        way = _stop_at_edges(boxes, body, way, scale)
    gone = _move(boxes, body, way, crouched, scale)
    stopped = [bool(abs(g - w) > TOUCH * scale) for g, w in zip(gone, way, strict=True)]
    inertia = GROUND_INERTIA if body.on_ground else AIR_INERTIA
    fall = 0.0 if stopped[1] else velocity[1]
    return Body(
        position=_add(body.position, gone),
        velocity=(
            0.0 if stopped[0] else velocity[0] * inertia,
            (fall - GRAVITY * scale) * FALL_DRAG,
            0.0 if stopped[2] else velocity[2] * inertia,
        ),
        on_ground=stopped[1] and velocity[1] < 0,
        crouched=crouched,
        jump_wait=wait,
        hit_wall=stopped[0] or stopped[2],
    )


def _around(world: World, body: Body, scale: float) -> np.ndarray:
    """Return the boxes that the player can touch in this tick."""
    box = body_box(body.position, scale)
    reach = np.abs(np.array(body.velocity)) + _MARGIN * scale
    return world.near(box[:3] - reach, box[3:] + reach)


def _fits(boxes: np.ndarray, body: Body, scale: float) -> bool:
    """Return whether the player can stand upright."""
    return not find_overlaps(boxes, body_box(body.position, scale), TOUCH * scale).any()


def _accelerate(
    velocity: list[float], on_ground: bool, keys: Keys, crouched: bool, sprints: bool, scale: float
) -> None:
    slow = KEY_INPUT * (SNEAK if crouched else 1.0)
    ahead = (keys.forward - keys.back) * slow
    aside = (keys.left - keys.right) * slow
    length = math.hypot(ahead, aside)
    if length < 0.01:
        return
    speed = GROUND_ACCELERATION if on_ground else AIR_ACCELERATION
    speed *= scale * (SPRINT if sprints else 1.0) / max(length, 1.0)
    _push(velocity, aside * speed, ahead * speed, keys.yaw_deg)


def _push(velocity: list[float], left: float, ahead: float, yaw_deg: float) -> None:
    """Add to a velocity in place, relative to the direction of view."""
    sine, cosine = math.sin(math.radians(yaw_deg)), math.cos(math.radians(yaw_deg))
    velocity[0] += left * cosine - ahead * sine
    velocity[2] += ahead * cosine + left * sine


def _move(
    boxes: np.ndarray, body: Body, way: np.ndarray, crouched: bool, scale: float
) -> tuple[float, float, float]:
    """Return the distance that a body moves, including steps up."""
    box = body_box(body.position, scale, crouched=crouched)
    touch = TOUCH * scale
    gone = sweep_box(boxes, box, way, touch)
    landed = way[1] < 0 and gone[1] - way[1] > touch
    blocked = abs(gone[0] - way[0]) > touch or abs(gone[2] - way[2]) > touch
    if not blocked or not (body.on_ground or landed):
        return gone
    up = sweep_with_step(boxes, box, way, STEP_HEIGHT * scale, touch)
    farther = up[0] ** 2 + up[2] ** 2 > gone[0] ** 2 + gone[2] ** 2 + touch**2
    return up if farther else gone


def _stop_at_edges(boxes: np.ndarray, body: Body, way: np.ndarray, scale: float) -> np.ndarray:
    """Shorten a movement on the ground so that there is always ground below the feet."""
    box = body_box(body.position, scale, crouched=True)
    back = EDGE_STEP * scale

    def over_nothing(x: float, z: float) -> bool:
        moved = box + np.tile([x, -STEP_HEIGHT * scale, z], 2)
        return not find_overlaps(boxes, moved, TOUCH * scale).any()

    x, y, z = way.tolist()
    while x and over_nothing(x, 0.0):
        x = _towards_zero(x, back)
    while z and over_nothing(0.0, z):
        z = _towards_zero(z, back)
    while x and z and over_nothing(x, z):
        x, z = _towards_zero(x, back), _towards_zero(z, back)
    return np.array([x, y, z])


def _towards_zero(value: float, by: float) -> float:
    """Return a value moved towards 0."""
    return 0.0 if abs(value) <= by else value - math.copysign(by, value)


def _add(
    one: tuple[float, float, float], two: tuple[float, float, float]
) -> tuple[float, float, float]:
    return one[0] + two[0], one[1] + two[1], one[2] + two[2]

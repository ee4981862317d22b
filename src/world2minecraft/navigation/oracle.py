"""The oracle: from where one stands to a goal by discrete moves, as short as they allow.

Its moves are searched with the very steps that the walker makes, so what it says can be walked:
``expert`` walks it once more before it answers. Files that hold its moves name ``ORACLE_VERSION``.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.navigation.moves import (
    body_size,
    forward_blocks,
    heading,
    moved,
    named_set,
    wrapped_yaw,
)
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.search import searched
from world2minecraft.navigation.values import Move, MoveSet, Stance

ORACLE_VERSION = "w2m-oracle-2"
GOAL_M = 0.25  # It stops so near to a goal: half of the least radius of success,
GOAL_STEPS = 0.75  # or so many steps, where steps are long.
TURN_M = 0.01  # What a turn counts: of ways of one length the straighter is taken.
FINENESS = (3.0, 12.0)  # Places told apart along a step; the second where the first finds none.
MOST_NODES = 400_000


@dataclass(frozen=True)
class Way:
    """The oracle's way: moves, STOP last, and where each but STOP comes to, the start first."""

    moves: tuple[Move, ...]
    stances: tuple[Stance, ...]
    length_m: float


def expert(
    scene: VlnScene,
    stance: Stance,
    goals: Sequence[tuple[float, float, float]],
    move_set: str | MoveSet = "vlnce",
    *,
    facing: tuple[float, float, float] | None = None,
) -> Way | None:
    """Return the oracle's way to the nearest goal; None where moves of this set do not lead there.

    Args:
        scene: where one walks.
        stance: where one stands, on the floor.
        goals: feet in world blocks.
        move_set: the moves, or their name.
        facing: a place in world blocks to look at in the end, as nearly as turns allow.

    Raises:
        UnknownNameError: no set of moves has this name.

    Example:
        >>> way = expert(scene, scene.start, scene.goals_at(scene.landmark("piano")))
        ... # doctest: +SKIP
        >>> way.moves[-1]                                                 # doctest: +SKIP
        <Move.STOP: 0>
    """
    how = named_set(move_set)
    field = scene.way_field_m(goals)
    if not np.isfinite(scene.distance_m(stance.feet, goals)):
        return None
    step = forward_blocks(scene, how)
    count = max(1, round(360 / how.turn_deg))
    turned = [wrapped_yaw(stance.yaw_deg + n * how.turn_deg) for n in range(1, count)]
    ways = np.array([heading(yaw) for yaw in (stance.yaw_deg, *turned)]) * step
    step_m = step * scene.metres_per_block
    near_m = max(GOAL_M, GOAL_STEPS * step_m)
    for fine in FINENESS:
        headings, found = searched(
            scene.solid, scene.corner, scene.floor, field, np.array(stance.feet), ways,
            body_size(scene), step_m, near_m, TURN_M, fine, MOST_NODES,
        )  # fmt: skip
        if found:
            way = _walked(scene, stance, _moves(headings.tolist(), count), how)
            return _faced(scene, way, facing, how) if way and facing else way
    return None


def _moves(headings: list[int], count: int) -> list[Move]:
    """Return the moves of steps along headings, of which 0 is where one looks."""
    moves, now = [], 0
    for way in headings:
        right = (way - now) % count
        left = count - right
        moves += [Move.RIGHT] * right if right <= left else [Move.LEFT] * left
        moves.append(Move.FORWARD)
        now = way
    return [*moves, Move.STOP]


def _walked(scene: VlnScene, stance: Stance, moves: list[Move], how: MoveSet) -> Way | None:
    """Return the way of moves; None where something is in the way after all."""
    stances, length = [stance], 0.0
    for move in moves[:-1]:
        stance, collided = moved(scene, stance, move, how)
        if collided:
            return None
        length += float(np.linalg.norm(np.subtract(stance.feet, stances[-1].feet)))
        stances.append(stance)
    return Way(tuple(moves), tuple(stances), length * scene.metres_per_block)


def _faced(scene: VlnScene, way: Way, facing: tuple[float, float, float], how: MoveSet) -> Way:
    """Return a way with turns at its end towards a place."""
    last, moves, stances = way.stances[-1], list(way.moves[:-1]), list(way.stances)
    x, z = facing[0] - last.x, facing[2] - last.z
    off_deg = wrapped_yaw(math.degrees(math.atan2(-x, z)) - last.yaw_deg)
    turn = Move.RIGHT if off_deg > 0 else Move.LEFT
    for _ in range(round(abs(off_deg) / how.turn_deg)):
        moves.append(turn)
        stances.append(moved(scene, stances[-1], turn, how)[0])
    return Way((*moves, Move.STOP), tuple(stances), way.length_m)

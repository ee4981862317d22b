"""The oracle, which plans the shortest path to a goal in discrete moves.

A* searches over the same steps as the walker makes, so its paths can be walked, and
``plan_expert_path`` verifies each path by walking it. A search node has exact coordinates without
rounding, and among nodes at nearly the same position only the cheapest is expanded. The heuristic
is the walking distance to the goal times a factor, because the paths of the walk graph have
corners. Files with expert moves record ``ORACLE_VERSION``.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.navigation.moves import (
    apply_move,
    body_size,
    forward_blocks,
    get_move_set,
    heading_vector,
    move_body,
    wrap_yaw,
)
from world2minecraft.navigation.scene import VlnScene, distance_from_field
from world2minecraft.navigation.types import Move, MoveSet, Stance

HEURISTIC_FACTOR = 0.98  # Distances between nodes are overestimated by at most two percent.
ORACLE_VERSION = "w2m-oracle-2"
GOAL_M = 0.25  # Distance to a goal at which a path ends, half of the smallest success radius.
GOAL_STEPS = 0.75  # The same distance in steps, for long steps.
TURN_M = 0.01  # Cost of a turn, so that the straightest of several shortest paths is chosen.
FINENESS = (3.0, 12.0)  # Positions along a step; the second value if the first finds no path.
MAX_NODES = 400_000


class SearchRules(NamedTuple):
    """The lengths and limits of a search.

    Attributes:
        step_m: The length of a step in metres.
        goal_m: The distance to the goal at which the search ends, in metres.
        turn_m: The cost of a turn by one heading, in metres.
        fineness: The number of positions that are distinguished along a step.
        max_nodes: The maximum number of search nodes.
    """

    step_m: float
    goal_m: float
    turn_m: float
    fineness: float
    max_nodes: int


@njit
def search_path(solid, corner, floor, field, start, steps, size, rules):
    """Search for a path to a goal with A*.

    Args:
        solid: The blocks.
        corner: The world position of the first block cell.
        floor: The ``FloorTable`` of the walk graph.
        field: The distance from each position to the goal in metres.
        start: The feet at the start as float64 [3].
        steps: The step along each heading in blocks as float64 [K, 2], first heading first.
        size: The ``BodySize``.
        rules: The ``SearchRules``.

    Returns:
        The headings of the steps as int64 [T], and whether a path was found.
    """
    count, limit = len(steps), rules.max_nodes
    feet = np.empty((limit, 3))
    cost, parent = np.empty(limit), np.empty(limit, np.int32)
    headings, keys = np.zeros(limit, np.int32), np.empty(limit)
    heap = np.empty(limit, np.int32)
    visited = np.full(1 << 20, -1, np.int64)
    cell = np.sqrt(steps[0, 0] ** 2 + steps[0, 1] ** 2) / rules.fineness
    feet[0] = start
    cost[0], parent[0], used, waiting = 0.0, -1, 1, 1
    heap[0], keys[0] = 0, 0.0
    while waiting > 0:
        here = heap[0]
        waiting = _heap_pop(heap, keys, waiting)
        if _visit(visited, feet[here], cell):
            continue
        x, y, z = feet[here]
        if distance_from_field(floor, field, x, y, z) <= rules.goal_m:
            return _headings_to(parent, headings, here), True
        for n in range(count):
            if used == limit:
                return np.zeros(0, np.int64), False
            heading = (headings[here] + n) % count
            to_x, to_y, to_z, stopped = move_body(
                solid, corner, x, y, z, steps[heading, 0], steps[heading, 1], size, False
            )
            if stopped:
                continue
            left = distance_from_field(floor, field, to_x, to_y, to_z)
            if not np.isfinite(left):
                continue
            feet[used, 0], feet[used, 1], feet[used, 2] = to_x, to_y, to_z
            cost[used] = cost[here] + rules.step_m + rules.turn_m * min(n, count - n)
            parent[used], headings[used] = here, heading
            keys[used] = cost[used] + HEURISTIC_FACTOR * left
            waiting = _heap_push(heap, keys, waiting, used)
            used += 1
    return np.zeros(0, np.int64), False


@njit
def _headings_to(parent, headings, last):
    """Return the headings of the steps from the start to a node as int64 [T]."""
    length, here = 0, last
    while parent[here] >= 0:
        length, here = length + 1, parent[here]
    result, here = np.empty(length, np.int64), last
    for n in range(length - 1, -1, -1):
        result[n], here = headings[here], parent[here]
    return result


@njit
def _visit(seen, feet, cell):
    """Return whether nearly the same position was visited before, and mark it as visited."""
    i, k = int(np.floor(feet[0] / cell)), int(np.floor(feet[2] / cell))
    j = int(np.floor(feet[1] * 4))
    key = ((i + 524288) << 42) | ((k + 524288) << 21) | (j + 524288)
    at = (key * 0x9E3779B1 >> 7) & (len(seen) - 1)
    while seen[at] != -1:
        if seen[at] == key:
            return True
        at = (at + 1) & (len(seen) - 1)
    seen[at] = key
    return False


@njit
def _heap_push(heap, keys, waiting, node):
    """Push a node to the heap. Nodes with equal keys keep their order."""
    n = waiting
    while n > 0:
        up = (n - 1) // 2
        if not _precedes(keys, node, heap[up]):
            break
        heap[n] = heap[up]
        n = up
    heap[n] = node
    return waiting + 1


@njit
def _heap_pop(heap, keys, waiting):
    """Remove the first node of the heap."""
    waiting -= 1
    node, n = heap[waiting], 0
    while 2 * n + 1 < waiting:
        low = 2 * n + 1
        if low + 1 < waiting and _precedes(keys, heap[low + 1], heap[low]):
            low += 1
        if _precedes(keys, node, heap[low]):
            break
        heap[n] = heap[low]
        n = low
    heap[n] = node
    return waiting


@njit
def _precedes(keys, one, other):
    return keys[one] < keys[other] or (keys[one] == keys[other] and one < other)


@dataclass(frozen=True)
class ExpertPath:
    """The path of the oracle.

    Attributes:
        moves: The moves, with STOP last.
        stances: The start and the stance after each move except STOP.
        length_m: The path length in metres.
    """

    moves: tuple[Move, ...]
    stances: tuple[Stance, ...]
    length_m: float


def plan_expert_path(
    scene: VlnScene,
    stance: Stance,
    goals: Sequence[tuple[float, float, float]],
    move_set: str | MoveSet = "vlnce",
    *,
    facing: tuple[float, float, float] | None = None,
) -> ExpertPath | None:
    """Plan the shortest path to the nearest goal, or return None if no goal is reachable.

    Args:
        scene: The scene.
        stance: The start on the floor.
        goals: The goal positions of the feet in world blocks.
        move_set: The move set or its name.
        facing: A position in world blocks to face at the end, as closely as the turns permit.

    Raises:
        UnknownNameError: If the move set is unknown.

    Example:
        >>> way = plan_expert_path(scene, scene.start, scene.goals_at(scene.landmark("piano")))
        ... # doctest: +SKIP
        >>> way.moves[-1]                                                 # doctest: +SKIP
        <Move.STOP: 0>
    """
    how = get_move_set(move_set)
    field = scene.corner_distances_m(goals)
    if not np.isfinite(scene.distance_m(stance.feet, goals)):
        return None
    step = forward_blocks(scene, how)
    count = max(1, round(360 / how.turn_deg))
    yaws = [wrap_yaw(stance.yaw_deg + n * how.turn_deg) for n in range(1, count)]
    steps = np.array([heading_vector(yaw) for yaw in (stance.yaw_deg, *yaws)]) * step
    step_m = step * scene.metres_per_block
    goal_m = max(GOAL_M, GOAL_STEPS * step_m)
    for fineness in FINENESS:
        headings, found = search_path(
            scene.solid, scene.corner, scene.floor, field, np.array(stance.feet), steps,
            body_size(scene), SearchRules(step_m, goal_m, TURN_M, fineness, MAX_NODES),
        )  # fmt: skip
        if found:
            path = _make_path(scene, stance, _moves_of_headings(headings.tolist(), count), how)
            return _turn_to_face(scene, path, facing, how) if path and facing else path
    return None


def _moves_of_headings(headings: list[int], count: int) -> list[Move]:
    """Convert the headings of steps to moves. Heading 0 is the initial direction."""
    moves, now = [], 0
    for heading in headings:
        right = (heading - now) % count
        left = count - right
        moves += [Move.RIGHT] * right if right <= left else [Move.LEFT] * left
        moves.append(Move.FORWARD)
        now = heading
    return [*moves, Move.STOP]


def _make_path(
    scene: VlnScene, stance: Stance, moves: list[Move], how: MoveSet
) -> ExpertPath | None:
    """Walk the moves, and return the path, or None if a move collides."""
    stances, length = [stance], 0.0
    for move in moves[:-1]:
        stance, collided = apply_move(scene, stance, move, how)
        if collided:
            return None
        length += float(np.linalg.norm(np.subtract(stance.feet, stances[-1].feet)))
        stances.append(stance)
    return ExpertPath(tuple(moves), tuple(stances), length * scene.metres_per_block)


def _turn_to_face(
    scene: VlnScene, way: ExpertPath, facing: tuple[float, float, float], how: MoveSet
) -> ExpertPath:
    """Append turns to a path so that it ends facing a position."""
    last, moves, stances = way.stances[-1], list(way.moves[:-1]), list(way.stances)
    x, z = facing[0] - last.x, facing[2] - last.z
    off_deg = wrap_yaw(math.degrees(math.atan2(-x, z)) - last.yaw_deg)
    turn = Move.RIGHT if off_deg > 0 else Move.LEFT
    for _ in range(round(abs(off_deg) / how.turn_deg)):
        moves.append(turn)
        stances.append(apply_move(scene, stances[-1], turn, how)[0])
    return ExpertPath((*moves, Move.STOP), tuple(stances), way.length_m)

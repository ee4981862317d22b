"""The oracle: from where one stands to a goal by discrete moves, as short as they allow.

A* over the very steps that the walker makes, so the path can be walked: ``plan_expert_path`` walks
it once more before it returns it. A node of the search is a place with its own exact coordinates,
so that nothing is rounded; of nodes that are nearly at one place the cheapest is expanded. The
distance on foot to the goal, times a factor, is the heuristic, since the graph's own paths have
corners. Files that hold expert moves name ``ORACLE_VERSION``.
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

HEURISTIC_FACTOR = 0.98  # Between places the field is too long by little: by so much at most.
ORACLE_VERSION = "w2m-oracle-2"
GOAL_M = 0.25  # It stops so near to a goal: half of the least radius of success,
GOAL_STEPS = 0.75  # or so many steps, where steps are long.
TURN_M = 0.01  # What a turn counts: of ways of one length the straighter is taken.
FINENESS = (3.0, 12.0)  # Places told apart along a step; the second where the first finds none.
MAX_NODES = 400_000


class SearchRules(NamedTuple):
    """The lengths and limits of a search."""

    step_m: float  # the length of a step
    goal_m: float  # how near to the goal ends the search
    turn_m: float  # what a turn by one heading costs, in metres
    fineness: float  # how many places along a step are told apart
    max_nodes: int  # nodes to try


@njit
def search_path(solid, corner, floor, field, start, steps, size, rules):
    """Return the headings, int64 [T], of the steps from a place to a goal, and whether one is.

    Args:
        solid: the blocks.
        corner: the world place of their first cell.
        floor: ``FloorTable`` of the graph.
        field: metres from each place to the goal.
        start: float64 [3], feet.
        steps: float64 [K, 2], the step along each heading in blocks; 0 is the first heading.
        size: the body, ``BodySize``.
        rules: ``SearchRules``.
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
    """Return the headings from the start to a node, int64 [T]."""
    length, here = 0, last
    while parent[here] >= 0:
        length, here = length + 1, parent[here]
    result, here = np.empty(length, np.int64), last
    for n in range(length - 1, -1, -1):
        result[n], here = headings[here], parent[here]
    return result


@njit
def _visit(seen, feet, cell):
    """Whether a place nearly the same was followed before; it is from now on."""
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
    """Put a node into the heap; of equal keys the earlier node comes first."""
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
    """Take the first node out of the heap."""
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
    """The oracle's way: moves, STOP last, and where each but STOP comes to, the start first."""

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
    """Return the moves of steps along headings, of which 0 is where one looks."""
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
    """Return the way of moves; None where something is in the way after all."""
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
    """Return a way with turns at its end towards a place."""
    last, moves, stances = way.stances[-1], list(way.moves[:-1]), list(way.stances)
    x, z = facing[0] - last.x, facing[2] - last.z
    off_deg = wrap_yaw(math.degrees(math.atan2(-x, z)) - last.yaw_deg)
    turn = Move.RIGHT if off_deg > 0 else Move.LEFT
    for _ in range(round(abs(off_deg) / how.turn_deg)):
        moves.append(turn)
        stances.append(apply_move(scene, stances[-1], turn, how)[0])
    return ExpertPath((*moves, Move.STOP), tuple(stances), way.length_m)

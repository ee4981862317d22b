"""Keyframes of a walk, and the rules for valid trajectories.

A keyframe follows each run of equal moves. A run is one macro action in the paper's terms. Long
runs are split so that consecutive images overlap. A valid walk is neither too short nor too long,
and its images show details.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from world2minecraft.navigation.data.picture_store import hash_distance
from world2minecraft.navigation.types import Move, MoveSet, Stance
from world2minecraft.navigation.walk_discretization import DiscreteWalk

ACTIONS = {
    Move.STOP: "stop",
    Move.FORWARD: "move forward",
    Move.LEFT: "turn left",
    Move.RIGHT: "turn right",
}
CHUNK_MOVES = 4  # So many next moves a keyframe tells: what agents are asked for at a time.
MAX_FORWARD_M = 1.0  # A guess: the next picture still shows what this one does.
TURN_AROUND_DEG = 140.0  # Who turns farther turns around, by the left or by the right.
MAX_TURN_DEG = 60.0  # Less than the width of a picture, for the same reason.
NO_MOVEMENT = "no movement"


@dataclass(frozen=True)
class KeyframeMark:
    """A keyframe before its image is rendered.

    Attributes:
        at: The number of moves made before the keyframe.
        stance: The position and heading.
        move: The move of the following run, or STOP at the end.
        run: The number of moves in the following run.
        chunk: The next moves, at most ``CHUNK_MOVES``.
    """

    at: int
    stance: Stance
    move: Move
    run: int
    chunk: tuple[Move, ...]

    @property
    def action(self) -> str:
        """The macro action that follows the keyframe."""
        return ACTIONS[self.move]


def find_keyframes(walk: DiscreteWalk, move_set: MoveSet, step_m: float) -> list[KeyframeMark]:
    """Return the keyframes of a walk: its start, the end of each run, and its end.

    Args:
        walk: The result of ``discretize_walk``, which ends with STOP.
        move_set: The move set, which defines the turn angle.
        step_m: The length of a forward step in metres.
    """
    most = {
        Move.FORWARD: max(1, round(MAX_FORWARD_M / step_m)),
        Move.LEFT: max(1, int(MAX_TURN_DEG // move_set.turn_deg)),
    }
    most[Move.RIGHT] = most[Move.LEFT]
    marks, at = [], 0
    for move, count in _runs(walk.moves):
        for run in _split_evenly(count, most.get(move, 1)):
            marks.append(
                KeyframeMark(at, walk.stances[at], move, run, walk.moves[at : at + CHUNK_MOVES])
            )
            at += run
    return marks


def _runs(moves: Sequence[Move]) -> list[tuple[Move, int]]:
    cuts = np.flatnonzero(np.diff([int(move) for move in moves])) + 1
    parts = np.split(np.arange(len(moves)), cuts)
    return [(moves[part[0]], len(part)) for part in parts if len(part)]


def _split_evenly(count: int, most: int) -> list[int]:
    """Split a run into nearly equal parts of at most ``most`` moves."""
    parts = -(-count // most)
    return [count // parts + (n < count % parts) for n in range(parts)]


def is_turn_around(marks: Sequence[KeyframeMark], step: int, turn_deg: float) -> bool:
    """Return whether a keyframe belongs to a turn so wide that either direction would be correct.

    Args:
        marks: The keyframes of a walk.
        step: The index of the keyframe.
        turn_deg: The angle of one turn in degrees.
    """
    move = marks[step].move
    if move not in (Move.LEFT, Move.RIGHT):
        return False
    first = last = step
    while first and marks[first - 1].move == move:
        first -= 1
    while last + 1 < len(marks) and marks[last + 1].move == move:
        last += 1
    return sum(mark.run for mark in marks[first : last + 1]) * turn_deg > TURN_AROUND_DEG


@dataclass(frozen=True)
class ValidityRule:
    """The limits of a valid trajectory.

    The paper only requires "meaningful" trajectories, so these limits are choices of this project.

    Attributes:
        min_keyframes: The minimum number of keyframes.
        max_keyframes: The maximum number of keyframes.
        min_path_m: The minimum path length in metres.
        max_path_m: The maximum path length in metres.
        min_distance_m: The minimum walking distance from start to end in metres.
        min_mean: The minimum mean grey value of an image, 0 to 255. Darker images count as black.
        min_hash_bits: The minimum number of bits, of 64, in which consecutive image hashes differ.
    """

    min_keyframes: int = 4
    max_keyframes: int = 40
    min_path_m: float = 1.5
    max_path_m: float = 25.0
    min_distance_m: float = 1.0
    min_mean: float = 8.0
    min_hash_bits: int = 4


def path_fault(
    marks: Sequence[KeyframeMark], path_m: float, apart_m: float, rule: ValidityRule | None = None
) -> str:
    """Return why a path is not a valid trajectory, or "" if it is valid.

    Args:
        marks: The keyframes of the path.
        path_m: The path length in metres.
        apart_m: The walking distance from start to end in metres.
        rule: The limits. None uses the defaults.
    """
    how = rule or ValidityRule()
    if not any(mark.move == Move.FORWARD for mark in marks):
        return NO_MOVEMENT
    if not how.min_path_m <= path_m <= how.max_path_m:
        return "too short" if path_m < how.min_path_m else "too long"
    if apart_m < how.min_distance_m:
        return "ends near its start"
    if len(marks) < how.min_keyframes:
        return "too few keyframes"
    return "too many keyframes" if len(marks) > how.max_keyframes else ""


def picture_fault(
    means: Sequence[float], hashes: Sequence[int], rule: ValidityRule | None = None
) -> str:
    """Return why the images do not form a valid trajectory, or "" if they do.

    Args:
        means: The mean grey value of each image, 0 to 255.
        hashes: The ``dhash`` of each image.
        rule: The limits. None uses the defaults.
    """
    how = rule or ValidityRule()
    if min(means, default=0.0) < how.min_mean:
        return "black image"
    distances = [hash_distance(a, b) for a, b in pairwise(hashes)]
    return "repeated image" if min(distances, default=64) < how.min_hash_bits else ""


def path_length_m(marks: Sequence[KeyframeMark], blocks_per_metre: float) -> float:
    """Return the length of the path through the keyframes in metres."""
    feet = np.array([mark.stance.feet for mark in marks]) / blocks_per_metre
    return float(np.linalg.norm(np.diff(feet, axis=0), axis=1).sum())

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
CHUNK_MOVES = 4  # Next moves that a keyframe records, as many as agents return at a time.
MAX_FORWARD_M = 1.0  # An estimate; consecutive images then overlap.
TURN_AROUND_DEG = 140.0  # Wider turns are possible to either side.
MAX_TURN_DEG = 60.0  # Less than the field of view, so that consecutive images overlap.
NO_MOVEMENT = "no movement"
# Limits of a valid trajectory, chosen by this project: the paper only requires "meaningful" ones.
MIN_KEYFRAMES, MAX_KEYFRAMES = 4, 40
MIN_PATH_M, MAX_PATH_M = 1.5, 25.0
MIN_DISTANCE_M = 1.0  # Walking distance from start to end.
MIN_MEAN = 8.0  # Mean grey value of an image, 0 to 255; darker images count as black.
MIN_CHANGED_BITS = 4  # Bits, of 64, in which consecutive image hashes differ.


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


def path_fault(marks: Sequence[KeyframeMark], path_m: float, apart_m: float) -> str:
    """Return why a path is not a valid trajectory, or "" if it is valid.

    Args:
        marks: The keyframes of the path.
        path_m: The path length in metres.
        apart_m: The walking distance from start to end in metres.
    """
    if not any(mark.move == Move.FORWARD for mark in marks):
        return NO_MOVEMENT
    if not MIN_PATH_M <= path_m <= MAX_PATH_M:
        return "too short" if path_m < MIN_PATH_M else "too long"
    if apart_m < MIN_DISTANCE_M:
        return "ends near its start"
    if len(marks) < MIN_KEYFRAMES:
        return "too few keyframes"
    return "too many keyframes" if len(marks) > MAX_KEYFRAMES else ""


def picture_fault(means: Sequence[float], hashes: Sequence[int]) -> str:
    """Return why the images do not form a valid trajectory, or "" if they do.

    Args:
        means: The mean grey value of each image, 0 to 255.
        hashes: The ``dhash`` of each image.
    """
    if min(means, default=0.0) < MIN_MEAN:
        return "black image"
    distances = [hash_distance(a, b) for a, b in pairwise(hashes)]
    return "repeated image" if min(distances, default=64) < MIN_CHANGED_BITS else ""


def path_length_m(marks: Sequence[KeyframeMark], blocks_per_metre: float) -> float:
    """Return the length of the path through the keyframes in metres."""
    feet = np.array([mark.stance.feet for mark in marks]) / blocks_per_metre
    return float(np.linalg.norm(np.diff(feet, axis=0), axis=1).sum())

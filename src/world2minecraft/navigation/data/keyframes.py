"""Where a walk's pictures are taken: after each run of equal moves.

A run is one macro action, as the paper words them. Long runs are cut, so that what one picture
shows is still seen in the next.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.navigation.discretise import Walk
from world2minecraft.navigation.values import Move, MoveSet, Stance

ACTIONS = {
    Move.STOP: "stop",
    Move.FORWARD: "move forward",
    Move.LEFT: "turn left",
    Move.RIGHT: "turn right",
}
CHUNK = 4  # So many next moves a keyframe tells: what agents are asked for at a time.
MOST_FORWARD_M = 1.0  # A guess: the next picture still shows what this one does.
ABOUT_DEG = 140.0  # Who turns farther turns around, by the left or by the right.
MOST_TURN_DEG = 60.0  # Less than the width of a picture, for the same reason.


@dataclass(frozen=True)
class Mark:
    """A keyframe before it has a picture: its place among the moves and what follows."""

    at: int  # of the moves: this many were made
    stance: Stance
    move: Move  # the run that follows; STOP at the end
    run: int  # how many moves it has
    chunk: tuple[Move, ...]

    @property
    def action(self) -> str:
        """The macro action that follows."""
        return ACTIONS[self.move]


def marks_of(walk: Walk, move_set: MoveSet, step_m: float) -> list[Mark]:
    """Return the keyframes of a walk: its start, the end of each run, its end.

    Args:
        walk: of ``discretise``, STOP last.
        move_set: how far a turn goes.
        step_m: how far a step goes.
    """
    most = {
        Move.FORWARD: max(1, round(MOST_FORWARD_M / step_m)),
        Move.LEFT: max(1, int(MOST_TURN_DEG // move_set.turn_deg)),
    }
    most[Move.RIGHT] = most[Move.LEFT]
    marks, at = [], 0
    for move, count in _runs(walk.moves):
        for run in _shared(count, most.get(move, 1)):
            marks.append(Mark(at, walk.stances[at], move, run, walk.moves[at : at + CHUNK]))
            at += run
    return marks


def _runs(moves: Sequence[Move]) -> list[tuple[Move, int]]:
    cuts = np.flatnonzero(np.diff([int(move) for move in moves])) + 1
    parts = np.split(np.arange(len(moves)), cuts)
    return [(moves[part[0]], len(part)) for part in parts if len(part)]


def _shared(count: int, most: int) -> list[int]:
    """Share a run into nearly equal ones of at most ``most``."""
    parts = -(-count // most)
    return [count // parts + (n < count % parts) for n in range(parts)]


def is_about_turn(marks: Sequence[Mark], step: int, turn_deg: float) -> bool:
    """Return whether a keyframe is a part of turning so far that either side would do.

    Args:
        marks: of a way.
        step: which.
        turn_deg: how far a turn goes.
    """
    move = marks[step].move
    if move not in (Move.LEFT, Move.RIGHT):
        return False
    first = last = step
    while first and marks[first - 1].move == move:
        first -= 1
    while last + 1 < len(marks) and marks[last + 1].move == move:
        last += 1
    return sum(mark.run for mark in marks[first : last + 1]) * turn_deg > ABOUT_DEG

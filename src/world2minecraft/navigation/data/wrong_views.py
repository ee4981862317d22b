"""Where wrong pictures of a question may be taken: near its place, by other moves than the way's.

    turned      the next place with another heading
    other_move  what another move would show
    mirror      where the last moves lead with left and right exchanged
    beside      some steps to a side, or back, from here or from the next place: no move leads there

Every place is one that the world's physics leads to.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.navigation.data.keyframes import MOST_FORWARD_M, Mark
from world2minecraft.navigation.discretise import Walker
from world2minecraft.navigation.values import Move, Stance
from world2minecraft.navigation.walk_stream import wrapped_deg

TAKEN = ("turned", "other_move", "mirror", "beside")
TURNS_DEG = (-180.0, -60.0, -30.0, 30.0, 60.0)
OTHER_TURNS = (1, 2, 4)  # Moves: from as like as can be to as far as a keyframe turns.
BESIDE_M = (0.25, 0.5, 0.75)  # From here; from the next place the middle one.
MIRRORED = {Move.LEFT: Move.RIGHT, Move.RIGHT: Move.LEFT}
MIRRORED_RUNS = 3  # As many as pictures are shown.


@dataclass(frozen=True)
class Scout:
    """Who goes to such places. ``walker`` is the world's physics."""

    walker: Walker
    metres_per_block: float

    def places(self, kind: str, marks: Sequence[Mark], step: int) -> list[Stance]:
        """Return where pictures of a kind may be taken, none of them the right one's stance.

        Args:
            kind: of ``TAKEN``.
            marks: the keyframes of a way.
            step: which is the current one.
        """
        right = marks[step + 1].stance
        found = {
            "turned": lambda: [_turned(right, turn) for turn in TURNS_DEG],
            "other_move": lambda: self._other_moves(marks[step]),
            "mirror": lambda: self._mirrored(marks, step),
            "beside": lambda: (
                self._beside(marks[step].stance, BESIDE_M) + self._beside(right, BESIDE_M[1:2])
            ),
        }[kind]()
        return [stance for stance in dict.fromkeys(found) if stance != right]

    def _other_moves(self, mark: Mark) -> list[Stance]:
        found = []
        for move in (Move.LEFT, Move.RIGHT):
            if move != mark.move:
                found += [self._after(mark.stance, [move] * count) for count in OTHER_TURNS]
        if mark.move != Move.FORWARD:
            found += [self._ahead(mark.stance, length_m) for length_m in (0.5, MOST_FORWARD_M)]
        return [stance for stance in found if stance is not None]

    def _mirrored(self, marks: Sequence[Mark], step: int) -> list[Stance]:
        found = []
        for first in range(max(0, step - MIRRORED_RUNS + 1), step + 1):
            moves = [mark.move for mark in marks[first : step + 1] for _ in range(mark.run)]
            if set(moves) & MIRRORED.keys():
                there = self._after(marks[first].stance, [MIRRORED.get(one, one) for one in moves])
                found += [there] if there is not None else []
        return found

    def _beside(self, stance: Stance, lengths_m: Sequence[float]) -> list[Stance]:
        found = []
        for side_deg in (-90.0, 90.0, 180.0):
            for length_m in lengths_m:
                there = self._ahead(_turned(stance, side_deg), length_m)
                found += [replace(there, yaw_deg=stance.yaw_deg)] if there is not None else []
        return found

    def _after(self, stance: Stance, moves: Sequence[Move]) -> Stance | None:
        """Return where moves lead; None where something is in the way."""
        for move in moves:
            stance, collided = self.walker(stance, move)
            if collided:
                return None
        return stance

    def _ahead(self, stance: Stance, length_m: float) -> Stance | None:
        """Return where steps of about a length lead; None where not one can be made."""
        begin, walked_m = stance, 0.0
        while walked_m < length_m - 1e-6:
            there, collided = self.walker(stance, Move.FORWARD)
            step = np.hypot(there.x - stance.x, there.z - stance.z)
            if collided or step == 0:
                break
            walked_m += float(step) * self.metres_per_block
            stance = there
        return None if stance == begin else stance


def _turned(stance: Stance, turn_deg: float) -> Stance:
    return replace(stance, yaw_deg=float(wrapped_deg(stance.yaw_deg + turn_deg)))

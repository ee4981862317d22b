"""Incorrect options (distractors) of Next-View questions, rendered near the correct view.

There are four kinds::

    turned      the next position with another heading
    other_move  the view after a different move
    mirror      the view after the last moves with left and right swapped
    beside      a few steps to the side or back, from the current or the next position

Every distractor is rendered from a position that the physics of the world can reach. The caller
chooses how many distractors resemble the current view more than the correct option does.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.navigation.data.keyframes import MAX_FORWARD_M, KeyframeMark
from world2minecraft.navigation.data.picture_store import (
    EncodedPicture,
    PictureStore,
    StoredPicture,
    are_distinguishable,
    has_detail,
    is_near_duplicate,
    picture_difference,
)
from world2minecraft.navigation.types import Move, Stance
from world2minecraft.navigation.walk_discretization import StepFunction
from world2minecraft.navigation.walk_stream import wrap_deg

CHOICES = 4
MAX_OF_A_KIND = 2  # Per question; three of a kind would reveal the correct option.
MAX_TRIES = 3  # Images rendered in full size per distractor.
RENDERED_KINDS = ("turned", "other_move", "mirror", "beside")
TURNS_DEG = (-180.0, -60.0, -30.0, 30.0, 60.0)
OTHER_TURNS = (1, 2, 4)  # Moves, from the most similar view to a whole turn of a keyframe.
BESIDE_M = (0.25, 0.5, 0.75)  # From the current position; the next one uses the middle value.
MIRRORED_TURNS = {Move.LEFT: Move.RIGHT, Move.RIGHT: Move.LEFT}
MIRRORED_RUNS = 3  # As many as images are shown.


class RankBalancer:
    """A sampler that balances how many distractors are more similar to the current view.

    It prefers the ranks of the correct option that have occurred least often, so that the rank does
    not reveal the answer.
    """

    def __init__(self, rng: np.random.Generator):
        self._rng, self._counts = rng, np.zeros(CHOICES, np.int64)

    def wanted(self) -> int:
        """Return a random rank among those that have occurred least often."""
        least = np.flatnonzero(self._counts == self._counts.min())
        return int(self._rng.choice(least))

    def came(self, rank: int) -> None:
        """Record the rank of a finished question."""
        self._counts[rank] += 1


@dataclass(frozen=True)
class DistractorSlot:
    """A rendered distractor, or a request for one of a certain kind.

    Attributes:
        kind: The kind of distractor.
        nearer: Whether the distractor resembles the current view more than the correct option does.
        picture: The rendered image, or None for a request.
    """

    kind: str
    nearer: bool
    picture: StoredPicture | None = None


class DistractorPicker:
    """A selector of the rendered distractors of one question."""

    def __init__(self, album: PictureStore, now: StoredPicture, right: StoredPicture):
        self._album, self._now, self._right = album, now, right
        self._limit = picture_difference(now, right)

    def filled(
        self, plan: Sequence[DistractorSlot], places: Sequence[tuple[str, Stance]], most_far: int
    ) -> list[DistractorSlot]:
        """Fill slots with suitable rendered images, preferring kinds that are not used yet.

        Args:
            plan: The requested slots. A slot without a suitable image is returned unchanged.
            places: The candidate stances with their kinds, in order of preference.
            most_far: The maximum number of slots with ``nearer`` False to fill.
        """
        looks = self._album.look([stance for _, stance in places])
        left: dict[bool, list[tuple[str, Stance]]] = {True: [], False: []}
        for place, look in zip(places, looks, strict=True):  # Previews preselect the candidates.
            left[picture_difference(self._now, look) < self._limit].append(place)
        slots: list[DistractorSlot] = []
        for slot in plan:
            is_wanted = slot.nearer or most_far > 0
            taken = self._one(left[slot.nearer], slots, slot.nearer) if is_wanted else None
            most_far -= taken is not None and not slot.nearer
            slots.append(taken or slot)
        return slots

    def _one(
        self, left: list[tuple[str, Stance]], slots: Sequence[DistractorSlot], near: bool
    ) -> DistractorSlot | None:
        """Return a suitable distractor and remove the tried candidates, or return None."""
        kinds = Counter(slot.kind for slot in slots if slot.picture)
        left[:] = [one for one in left if kinds[one[0]] < MAX_OF_A_KIND]
        left.sort(key=lambda one: kinds[one[0]])
        others = (self._right, *(slot.picture for slot in slots if slot.picture))
        for _ in range(min(MAX_TRIES, len(left))):
            kind, stance = left.pop(0)
            (shot,) = self._album.take([stance])
            as_wanted = (picture_difference(self._now, shot) < self._limit) == near
            if as_wanted and is_valid_choice(shot, self._now, others):
                name = f"{self._right.image.removesuffix('.jpg')}_{kind}{len(slots)}.jpg"
                return DistractorSlot(kind, near, self._album.write(name, stance, shot))
        return None


def is_valid_choice(
    one: StoredPicture | EncodedPicture, now: StoredPicture, others: Sequence[StoredPicture]
) -> bool:
    """Return whether an image has detail and differs from the current view and the others."""
    if not has_detail(one) or is_near_duplicate(one, now):
        return False
    return all(are_distinguishable(one, other) for other in others)


@dataclass(frozen=True)
class DistractorSampler:
    """A generator of candidate stances for distractors. ``walker`` is the step function."""

    walker: StepFunction
    metres_per_block: float

    def places(self, kind: str, marks: Sequence[KeyframeMark], step: int) -> list[Stance]:
        """Return candidate stances for a kind of distractor, without the correct option's stance.

        Args:
            kind: One of ``RENDERED_KINDS``.
            marks: The keyframes of a walk.
            step: The index of the current keyframe.
        """
        right = marks[step + 1].stance
        found = {
            "turned": lambda: [_turn(right, turn) for turn in TURNS_DEG],
            "other_move": lambda: self._other_moves(marks[step]),
            "mirror": lambda: self._mirrored(marks, step),
            "beside": lambda: (
                self._beside(marks[step].stance, BESIDE_M) + self._beside(right, BESIDE_M[1:2])
            ),
        }[kind]()
        return [stance for stance in dict.fromkeys(found) if stance != right]

    def _other_moves(self, mark: KeyframeMark) -> list[Stance]:
        found = []
        for move in (Move.LEFT, Move.RIGHT):
            if move != mark.move:
                found += [self._after(mark.stance, [move] * count) for count in OTHER_TURNS]
        if mark.move != Move.FORWARD:
            found += [self._ahead(mark.stance, length_m) for length_m in (0.5, MAX_FORWARD_M)]
        return [stance for stance in found if stance is not None]

    def _mirrored(self, marks: Sequence[KeyframeMark], step: int) -> list[Stance]:
        found = []
        for first in range(max(0, step - MIRRORED_RUNS + 1), step + 1):
            moves = [mark.move for mark in marks[first : step + 1] for _ in range(mark.run)]
            if set(moves) & MIRRORED_TURNS.keys():
                there = self._after(
                    marks[first].stance, [MIRRORED_TURNS.get(one, one) for one in moves]
                )
                found += [there] if there is not None else []
        return found

    def _beside(self, stance: Stance, lengths_m: Sequence[float]) -> list[Stance]:
        found = []
        for side_deg in (-90.0, 90.0, 180.0):
            for length_m in lengths_m:
                there = self._ahead(_turn(stance, side_deg), length_m)
                found += [replace(there, yaw_deg=stance.yaw_deg)] if there is not None else []
        return found

    def _after(self, stance: Stance, moves: Sequence[Move]) -> Stance | None:
        """Return the stance after several moves, or None if a move collides."""
        for move in moves:
            stance, collided = self.walker(stance, move)
            if collided:
                return None
        return stance

    def _ahead(self, stance: Stance, length_m: float) -> Stance | None:
        """Return the stance about ``length_m`` metres ahead, or None if no step is possible."""
        begin, walked_m = stance, 0.0
        while walked_m < length_m - 1e-6:
            there, collided = self.walker(stance, Move.FORWARD)
            step = np.hypot(there.x - stance.x, there.z - stance.z)
            if collided or step == 0:
                break
            walked_m += float(step) * self.metres_per_block
            stance = there
        return None if stance == begin else stance


def _turn(stance: Stance, turn_deg: float) -> Stance:
    return replace(stance, yaw_deg=float(wrap_deg(stance.yaw_deg + turn_deg)))

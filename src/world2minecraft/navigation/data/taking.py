"""Wrong pictures that are taken for a question: as many as wanted more like the present one."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.navigation.data.album import (
    Album,
    Pictured,
    is_nearly,
    look_apart,
    shows_something,
    unlike,
)
from world2minecraft.navigation.data.pictures import Shot
from world2minecraft.navigation.values import Stance

CHOICES = 4
MOST_OF_A_KIND = 2  # Of one question: three steps beside would tell the right one by being other.
MOST_TAKEN = 3  # Pictures that are taken in full for one that is kept.


class RankDeck:
    """Says how many wrong pictures are to be nearer than the right one, so that no rank leads.

    What came of a question is told to it: a rank that is seldom found is asked for more often.
    """

    def __init__(self, rng: np.random.Generator):
        self._rng, self._counts = rng, np.zeros(CHOICES, np.int64)

    def wanted(self) -> int:
        """Return the rank that came least often so far; one of them by chance."""
        least = np.flatnonzero(self._counts == self._counts.min())
        return int(self._rng.choice(least))

    def came(self, rank: int) -> None:
        """Count what came of a question."""
        self._counts[rank] += 1


@dataclass(frozen=True)
class Slot:
    """A wrong picture, or of what kind it is to be.

    ``nearer``: more like the present picture than the right one is.
    """

    kind: str
    nearer: bool
    picture: Pictured | None = None


class Taker:
    """Takes the wrong pictures of one question."""

    def __init__(self, album: Album, now: Pictured, right: Pictured):
        self._album, self._now, self._right = album, now, right
        self._limit = unlike(now, right)

    def filled(
        self, plan: Sequence[Slot], places: Sequence[tuple[str, Stance]], most_far: int
    ) -> list[Slot]:
        """Return slots with pictures, as far as there are such; a kind that has none comes first.

        Args:
            plan: what is wanted; a slot that is not filled stays as it is.
            places: where pictures may be taken, with their kinds, in the order to try.
            most_far: how many slots that are not nearer are filled.
        """
        looks = self._album.look([stance for _, stance in places])
        left: dict[bool, list[tuple[str, Stance]]] = {True: [], False: []}
        for place, look in zip(places, looks, strict=True):  # Small pictures say where to go.
            left[unlike(self._now, look) < self._limit].append(place)
        slots: list[Slot] = []
        for slot in plan:
            is_wanted = slot.nearer or most_far > 0
            taken = self._one(left[slot.nearer], slots, slot.nearer) if is_wanted else None
            most_far -= taken is not None and not slot.nearer
            slots.append(taken or slot)
        return slots

    def _one(
        self, left: list[tuple[str, Stance]], slots: Sequence[Slot], near: bool
    ) -> Slot | None:
        """Take a picture that differs from the others, and out of what is left; none at times."""
        kinds = Counter(slot.kind for slot in slots if slot.picture)
        left[:] = [one for one in left if kinds[one[0]] < MOST_OF_A_KIND]
        left.sort(key=lambda one: kinds[one[0]])
        others = (self._right, *(slot.picture for slot in slots if slot.picture))
        for _ in range(min(MOST_TAKEN, len(left))):
            kind, stance = left.pop(0)
            (shot,) = self._album.take([stance])
            as_wanted = (unlike(self._now, shot) < self._limit) == near
            if as_wanted and differs(shot, self._now, others):
                name = f"{self._right.image.removesuffix('.jpg')}_{kind}{len(slots)}.jpg"
                return Slot(kind, near, self._album.write(name, stance, shot))
        return None


def differs(one: Pictured | Shot, now: Pictured, others: Sequence[Pictured]) -> bool:
    """Whether a picture is something to choose: not the present one, not one of the others."""
    if not shows_something(one) or is_nearly(one, now):
        return False
    return all(look_apart(one, other) for other in others)

"""The pictures of a set as they are made: each is written once, and known by its name."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.core.files import write_bytes
from world2minecraft.navigation.data.pictures import Shot, hash_distance
from world2minecraft.navigation.values import Stance
from world2minecraft.navigation.walk_stream import wrapped_deg

NEAR_M, NEAR_DEG = 0.5, 20.0  # Two stances so alike show the same.
LEAST_DETAIL = 20.0  # Looked at: with less a picture shows a wall and little else.
SAME_HASH = 4  # Bits of 64 by which two pictures are told apart at all.
LEAST_HASH = 6  # Bits of 64 by which a wrong choice differs from the right one.


Taking = Callable[[Sequence[Stance]], list[Shot]]


@dataclass(frozen=True)
class Pictured:
    """A picture of a set: where it lies, where it was taken and what tells it from others."""

    image: str  # beside the records, POSIX
    stance: Stance
    sha256: str
    dhash: int
    detail: float
    small: bytes  # 32x18 of its grey


class Album:
    """Takes pictures and writes them under a folder.

    ``take`` takes them as they are kept; ``look`` as small as will do to tell how like they are.
    """

    def __init__(self, folder: Path, take: Taking, look: Taking):
        self._folder, self.take, self.look = folder, take, look

    def write(self, name: str, stance: Stance, shot: Shot) -> Pictured:
        """Write a picture. Raises OutputError."""
        write_bytes(self._folder / name, shot.jpeg)
        return Pictured(name, stance, shot.sha256, shot.dhash, shot.detail, shot.small)


def are_apart(one: Stance, other: Stance, metres_per_block: float) -> bool:
    """Return whether two stances of a scene show different things."""
    away_m = ((one.x - other.x) ** 2 + (one.y - other.y) ** 2 + (one.z - other.z) ** 2) ** 0.5
    turn_deg = abs(float(wrapped_deg(one.yaw_deg - other.yaw_deg)))
    return away_m * metres_per_block >= NEAR_M or turn_deg >= NEAR_DEG


def look_apart(one: Pictured | Shot, other: Pictured | Shot) -> bool:
    """Return whether two pictures differ enough to choose between them."""
    return hash_distance(one.dhash, other.dhash) >= LEAST_HASH


def is_nearly(one: Pictured | Shot, other: Pictured | Shot) -> bool:
    """Return whether two pictures are nearly the same."""
    return hash_distance(one.dhash, other.dhash) < SAME_HASH


def unlike(one: Pictured | Shot, other: Pictured | Shot) -> float:
    """Return how far two pictures are apart, seen so small that only things count."""
    pair = [np.frombuffer(picture.small, np.uint8).astype(np.float32) for picture in (one, other)]
    return float(((pair[0] - pair[1]) ** 2).mean())


def shows_something(one: Pictured | Shot) -> bool:
    """Return whether a picture is more than a bare wall."""
    return one.detail >= LEAST_DETAIL

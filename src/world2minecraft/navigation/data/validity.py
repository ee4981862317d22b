"""Which walks are worth asking about: not too short, not too long, and with something to see."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from world2minecraft.navigation.data.keyframes import Mark
from world2minecraft.navigation.data.pictures import hash_distance
from world2minecraft.navigation.values import Move

NOWHERE = "goes nowhere"


@dataclass(frozen=True)
class ValidRule:
    """What a trajectory must be. Choices of ours; the paper says only "meaningful"."""

    least_keyframes: int = 4
    most_keyframes: int = 40
    least_m: float = 1.5
    most_m: float = 25.0
    least_apart_m: float = 1.0  # from start to end, on foot
    least_mean: float = 8.0  # of a picture's grey, 0 to 255: darker is a black frame
    least_hash: int = 4  # bits of 64 by which a picture differs from the one before


def fault_of_way(
    marks: Sequence[Mark], path_m: float, apart_m: float, rule: ValidRule | None = None
) -> str:
    """Return why a way is no trajectory; nothing where it is one.

    Args:
        marks: its keyframes.
        path_m: how long it is.
        apart_m: from its start to its end, on foot.
        rule: what a trajectory must be.
    """
    how = rule or ValidRule()
    if not any(mark.move == Move.FORWARD for mark in marks):
        return NOWHERE
    if not how.least_m <= path_m <= how.most_m:
        return "too short" if path_m < how.least_m else "too long"
    if apart_m < how.least_apart_m:
        return "ends where it began"
    if len(marks) < how.least_keyframes:
        return "too few keyframes"
    return "too many keyframes" if len(marks) > how.most_keyframes else ""


def fault_of_pictures(
    means: Sequence[float], hashes: Sequence[int], rule: ValidRule | None = None
) -> str:
    """Return why pictures make no trajectory; nothing where they do.

    Args:
        means: of each picture's grey, 0 to 255.
        hashes: of each picture, as ``dhash`` gives them.
        rule: what a trajectory must be.
    """
    how = rule or ValidRule()
    if min(means, default=0.0) < how.least_mean:
        return "black picture"
    apart = [hash_distance(a, b) for a, b in pairwise(hashes)]
    return "twice the same picture" if min(apart, default=64) < how.least_hash else ""


def path_m(marks: Sequence[Mark], blocks_per_metre: float) -> float:
    """Return how long the way along keyframes is, metres."""
    feet = np.array([mark.stance.feet for mark in marks]) / blocks_per_metre
    return float(np.linalg.norm(np.diff(feet, axis=0), axis=1).sum())

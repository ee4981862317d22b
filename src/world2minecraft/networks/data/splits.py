"""Split the frames of a set into training, validation and test.

A set's own test split is the score's. Of the scenes that train, a share is held out to validate
on; scenes are chosen by the digest of their name, so that the same set is always split alike.
"""

import hashlib
from collections.abc import Mapping
from typing import NamedTuple

from world2minecraft.core.errors import UsageError


class Split(NamedTuple):
    """Rows of a set's frames, each in the set's order."""

    train: list[int]
    val: list[int]
    test: list[int]  # Empty where the set has no test split.

    @property
    def scored(self) -> list[int]:
        """What a finished network is scored on: the test split, or what it was validated on."""
        return self.test or self.val


def split_rows(scenes: list[str], splits: list[str], val_share: float, name: str) -> Split:
    """Split frames.

    Args:
        scenes: the scene of each frame.
        splits: train, test or "" of each.
        val_share: of the scenes that train; 0 validates on the test split.
        name: of the set, for messages.

    Raises:
        UsageError: there is nothing to train on, or nothing to validate on.

    Example:
        >>> split = split_rows(["a", "b", "c"], ["train", "train", "test"], 0.5, "set")
        >>> len(split.train), len(split.val), split.test
        (1, 1, [2])
    """
    test = [row for row, split in enumerate(splits) if split == "test"]
    pool = [row for row, split in enumerate(splits) if split != "test"]
    if not pool:
        raise UsageError(f"{name} has no frame to train on, only {len(test)} of its test split")
    if not val_share:
        if not test:
            raise UsageError(f"{name} has no test split; hold scenes out with --val-share 0.1")
        return Split(pool, test, test)
    names = sorted({scenes[row] for row in pool}, key=_digest)
    held_out = set(names[: max(1, round(val_share * len(names)))])
    if len(held_out) == len(names):
        raise UsageError(
            f"{name} has {len(names)} scene to train on, of which none can be held out; add "
            "scenes, or validate on its test split with --val-share 0"
        )
    train = [row for row in pool if scenes[row] not in held_out]
    return Split(train, [row for row in pool if scenes[row] in held_out], test)


def take_evenly(rows: list[int], limit: int) -> list[int]:
    """Return at most so many of the rows, spread evenly."""
    if len(rows) <= limit:
        return rows
    return [rows[n * len(rows) // limit] for n in range(limit)]


def describe_counts(splits: Mapping[str, list[int]]) -> str:
    """Return counts in words, such as ``80 train, 10 val``."""
    return ", ".join(f"{len(rows):,} {name}" for name, rows in splits.items() if rows)


def _digest(name: str) -> bytes:
    return hashlib.sha256(name.encode()).digest()

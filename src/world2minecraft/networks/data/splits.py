"""The split of a data set into training, validation and test frames.

The test split of the data set is used for the final score. A fraction of the training scenes is
held out for validation. Scenes are selected by a hash of their names, so the same data set is
always split in the same way.
"""

import hashlib
from collections.abc import Mapping
from typing import NamedTuple

from world2minecraft.core.errors import UsageError


class Split(NamedTuple):
    """The frame indices of each split, in the order of the data set.

    Attributes:
        train: Training frames.
        val: Validation frames.
        test: Test frames; empty if the data set has no test split.
    """

    train: list[int]
    val: list[int]
    test: list[int]

    @property
    def scored(self) -> list[int]:
        """Frames for the final score: the test split or, without one, the validation split."""
        return self.test or self.val


def split_rows(scenes: list[str], splits: list[str], val_share: float, name: str) -> Split:
    """Split the frames of a data set.

    Args:
        scenes: Scene of each frame.
        splits: Split of each frame: ``train``, ``test`` or an empty string.
        val_share: Fraction of the training scenes used for validation. 0 validates on the test
            split.
        name: Name of the data set for error messages.

    Raises:
        UsageError: If there are no frames for training or for validation.

    Example:
        >>> split = split_rows(["a", "b", "c"], ["train", "train", "test"], 0.5, "set")
        >>> len(split.train), len(split.val), split.test
        (1, 1, [2])
    """
    test = [row for row, split in enumerate(splits) if split == "test"]
    pool = [row for row, split in enumerate(splits) if split != "test"]
    if not pool:
        raise UsageError(
            f"{name} has no training frames, only {len(test)} frames in its test split"
        )
    if not val_share:
        if not test:
            raise UsageError(
                f"{name} has no test split; reserve scenes for validation (--val-share 0.1)"
            )
        return Split(pool, test, test)
    names = sorted({scenes[row] for row in pool}, key=_digest)
    held_out = set(names[: max(1, round(val_share * len(names)))])
    if len(held_out) == len(names):
        raise UsageError(
            f"{name} has only {len(names)} training scene, so none can be used for validation; add "
            "scenes, or validate on the test split (--val-share 0)"
        )
    train = [row for row in pool if scenes[row] not in held_out]
    return Split(train, [row for row in pool if scenes[row] in held_out], test)


def take_evenly(rows: list[int], limit: int) -> list[int]:
    """Return at most ``limit`` of the rows, evenly spaced."""
    if len(rows) <= limit:
        return rows
    return [rows[n * len(rows) // limit] for n in range(limit)]


def describe_counts(splits: Mapping[str, list[int]]) -> str:
    """Format the number of frames in each split, such as ``80 train, 10 val``."""
    return ", ".join(f"{len(rows):,} {name}" for name, rows in splits.items() if rows)


def _digest(name: str) -> bytes:
    return hashlib.sha256(name.encode()).digest()

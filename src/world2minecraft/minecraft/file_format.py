"""Shared parts of block formats: files known by suffix, options of writers, and losses.

``Losses`` counts what a format could not carry; ``w2m convert`` prints it.
"""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any


class Losses:
    """Counts of what was left behind on the way from one format to another, by what it is.

    Example:
        >>> losses = Losses()
        >>> losses.add("entities", 3)
        >>> losses.add("entities", 1)
        >>> list(losses)
        [('entities', 4)]
    """

    def __init__(self) -> None:
        self._counts: Counter[str] = Counter()

    def add(self, what: str, count: int = 1) -> None:
        """Count ``count`` more of what was lost; 0 or less counts nothing.

        Args:
            what: a plural, as in ``3 entities``, with its reason where it is not plain.
            count: how many.
        """
        if count > 0:
            self._counts[what] += count

    def __iter__(self) -> Iterator[tuple[str, int]]:
        return iter(sorted(self._counts.items()))

    def __len__(self) -> int:
        return len(self._counts)


class FileFormat:
    """A file that is read and written and holds blocks without their labels."""

    suffix: str
    can_read = True
    can_write = True
    keeps_labels = False

    def is_at(self, path: Path) -> bool:
        """Whether the name ends so."""
        return path.is_file() and path.suffix.lower() == self.suffix


@dataclass(frozen=True)
class WriteOptions:
    """Options of writers; a format reads those that it needs."""

    mc_version: str = "1.20.1"
    name: str = "room"
    spawn: tuple[float, float, float] | None = None
    spawn_yaw_deg: float = 0.0
    schem_version: int = 2
    other: Mapping[str, Any] = field(default_factory=dict)

"""Shared parts of block formats: the base class of file formats, write options and losses.

``Losses`` counts what a conversion drops; ``w2m convert`` prints the counts.
"""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any


class Losses:
    """Counts of the data that a conversion between formats drops, by description.

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
        """Add to the count of one kind of lost data.

        Args:
            what: A plural noun such as ``entities``, with a reason if it is not obvious.
            count: The number to add. Values of 0 or less are ignored.
        """
        if count > 0:
            self._counts[what] += count

    def __iter__(self) -> Iterator[tuple[str, int]]:
        return iter(sorted(self._counts.items()))

    def __len__(self) -> int:
        return len(self._counts)


class FileFormat:
    """Base class of single-file formats that can be read and written and do not store labels."""

    suffix: str
    can_read = True
    can_write = True
    keeps_labels = False

    def is_at(self, path: Path) -> bool:
        """Return whether the path is a file with the suffix of this format."""
        return path.is_file() and path.suffix.lower() == self.suffix


@dataclass(frozen=True)
class WriteOptions:
    """Options for writing blocks. Each format uses only the options that apply to it."""

    mc_version: str = "1.20.1"
    name: str = "room"
    spawn: tuple[float, float, float] | None = None
    spawn_yaw_deg: float = 0.0
    schem_version: int = 2
    other: Mapping[str, Any] = field(default_factory=dict)

"""A data set of another format: keys, and a sample for each, read when it is asked for."""

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.minecraftocc.values import OccSample


@dataclass(frozen=True)
class ImportedSet:
    """Samples of a folder, by key; it is read as a store is."""

    path: Path
    format: str
    splits: dict[str, str]  # key to train, test or ""
    read: Callable[[str], OccSample]
    notes: tuple[str, ...] = field(default=())
    sha256: str = ""  # The sum of all samples, where the data set tells it.

    def keys(self, split: str | None = None) -> list[str]:
        """Return the keys, of one split or of all."""
        return [key for key, of in self.splits.items() if split in (None, of)]

    def described(self) -> str:
        """Return format and counts in words, such as ``nyu, 3 samples (1 test, 2 train)``."""
        counts = Counter(self.splits.values())
        told = ", ".join(f"{counts[one]:,} {one or 'of no split'}" for one in sorted(counts))
        return f"{self.format}, {len(self):,} samples ({told})"

    def samples(self, split: str | None = None) -> Iterator[OccSample]:
        """Read the samples of one split, or all, one at a time."""
        return (self.read(key) for key in self.keys(split))

    def __getitem__(self, key: str) -> OccSample:
        if key not in self.splits:
            raise UnknownNameError("sample", key, self.splits)
        return self.read(key)

    def __iter__(self) -> Iterator[OccSample]:
        return self.samples()

    def __len__(self) -> int:
        return len(self.splits)

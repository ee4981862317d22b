"""MinecraftOcc data sets: build one from generated houses or worlds, and open one."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from world2minecraft.minecraftocc.store import OccStore
    from world2minecraft.minecraftocc.types import OccSample


@dataclass(frozen=True, eq=False)
class Dataset:
    """A data set of labelled images, read sample by sample.

    Attributes:
        folder: where it lies.
        store: the reader of its shards, by key.
    """

    folder: Path
    store: "OccStore"

    def __len__(self) -> int:
        return len(self.store)

    def __getitem__(self, number: int | str) -> "OccSample":
        """Return the sample of a number or of a key."""
        if isinstance(number, str):
            return self.store[number]
        keys = self.store.keys()
        return self.store[keys[number]]

    def __iter__(self) -> Iterator["OccSample"]:
        return self.store.samples()

    def samples(self, split: str | None = None) -> Iterator["OccSample"]:
        """Yield the samples of a split, such as ``train``; of all splits by default."""
        return self.store.samples(split)

    def keys(self, split: str | None = None) -> list[str]:
        """Return the keys of the samples of a split; of all splits by default."""
        return self.store.keys(split)

    def __repr__(self) -> str:
        return f"Dataset({str(self.folder)!r}, {len(self):,} images)"


def open_dataset(folder: str | Path) -> Dataset:
    """Open a data set that ``build_dataset`` or ``w2m dataset import`` wrote.

    Raises:
        InputError: the folder is not found, or is no data set. DamagedFileError: it is damaged.
    """
    from world2minecraft.minecraftocc.store import open_store

    return Dataset(Path(folder), open_store(folder))

"""Reader for data sets on disk, by sample key or in order.

Data sets may come from untrusted sources: names, positions and sizes are checked before a file is
opened or read into memory.
"""

import io
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import DamagedFileError, InputError, UnknownNameError, UsageError
from world2minecraft.core.whole_reads import read_whole
from world2minecraft.formats.object_names import NamedObject
from world2minecraft.minecraftocc.object_table import read_object_table
from world2minecraft.minecraftocc.store.folder import INDEX, objects_path, read_classes, read_meta
from world2minecraft.minecraftocc.store.index import read_index
from world2minecraft.minecraftocc.store.sample_files import (
    FACTS,
    IMAGE_FORMATS,
    LABELS,
    FineTable,
    unpack_sample,
)
from world2minecraft.minecraftocc.store.shard import StoredSample, stored_samples
from world2minecraft.minecraftocc.types import OccSample

MAX_SAMPLE_BYTES = 512 << 20
MAX_CACHED = 2000  # Keys among which similar ones to an unknown key are searched.


class OccStore:
    """A complete data set, opened with ``open_store``."""

    def __init__(self, folder: Path, meta: dict[str, Any], table: FineTable, rows: Any):
        """Create a reader from metadata that was already read. Shards are opened on demand."""
        self.folder, self.meta, self.table = folder, meta, table
        self._rows = rows

    def __len__(self) -> int:
        """Return the number of samples."""
        return self._rows.num_rows

    def __iter__(self) -> Iterator[str]:
        """Iterate over the keys of all samples."""
        return iter(self._names)

    def __contains__(self, key: object) -> bool:
        """Return whether a sample with this key exists."""
        return key in self._places

    @property
    def sha256(self) -> str:
        """SHA-256 of all samples. Data sets with the same value contain the same samples."""
        return str(self.meta.get("sha256", ""))

    def keys(self, split: str | None = None) -> list[str]:
        """Return the sample keys of a split, or of all splits by default, in order."""
        return [self._names[number] for number in self._numbers(split)]

    def index(self) -> dict[str, Any]:
        """Return the columns of the index as numpy arrays by name."""
        return {name: self._rows[name].to_numpy() for name in self._rows.column_names}

    def __getitem__(self, key: str) -> OccSample:
        """Return a sample with its images.

        Raises:
            UnknownNameError: If there is no sample with this key.
            DamagedFileError: If the sample cannot be read.
        """
        return self.sample(key)

    def sample(self, key: str, pictures: bool = True) -> OccSample:
        """Return a sample, with or without its images.

        Raises:
            UnknownNameError: If there is no sample with this key.
            DamagedFileError: If the sample cannot be read.
        """
        return self._read(self._place(key), pictures)

    def samples(self, split: str | None = None, pictures: bool = True) -> Iterator[OccSample]:
        """Iterate over the samples of a split, or of all splits by default, in order.

        Args:
            split: Split to read.
            pictures: Whether to read the images too.

        Raises:
            UsageError: If the split is unknown.
            DamagedFileError: If a sample cannot be read.
        """
        for number in self._numbers(split):
            yield self._read(number, pictures)

    def objects(self, scene_id: str) -> dict[int, NamedObject]:
        """Return the class and the name of each object of a scene by its number in ``instance``.

        Data sets of former versions have none.

        Raises:
            UnknownNameError: If there is no such scene.
            DamagedFileError: If the file of the objects is not valid.
        """
        listed = self.meta.get("scenes", [])
        scenes = [str(one.get("scene_id")) for one in listed if isinstance(one, dict)]
        if scene_id not in scenes or "/" in scene_id or "\\" in scene_id:
            raise UnknownNameError("scene", scene_id, scenes)
        return read_object_table(objects_path(self.folder, scene_id))

    def members(self, key: str) -> dict[str, bytes]:
        """Return the raw files of a sample by kind, such as ``json``.

        Raises:
            UnknownNameError: If there is no sample with this key.
            DamagedFileError: If the sample cannot be read.
        """
        stream, found = self._found(self._place(key))
        return {member.kind: _data(stream, member) for member in found.members}

    @cached_property
    def _names(self) -> list[str]:
        return self._rows["key"].to_pylist()

    @cached_property
    def _places(self) -> dict[str, int]:
        return {key: number for number, key in enumerate(self._names)}

    def _place(self, key: str) -> int:
        if key not in self._places:
            near = [name for name in self._names if name.startswith(key.partition("-")[0])]
            raise UnknownNameError("sample", key, near[:MAX_CACHED] or self._names[:5])
        return self._places[key]

    def _numbers(self, split: str | None) -> list[int]:
        if split is None:
            return list(range(len(self)))
        splits = self._rows["split"].to_pylist()
        known = sorted(set(splits))
        if split not in known:
            raise UsageError(
                f"{self.folder} has no split {split!r}; known splits: {', '.join(known)}"
            )
        return [number for number, one in enumerate(splits) if one == split]

    def _read(self, number: int, pictures: bool) -> OccSample:
        stream, found = self._found(number)
        wanted = [one for one in found.members if pictures or one.kind in (LABELS, FACTS)]
        kinds = {member.kind for member in wanted}
        if LABELS not in kinds or sum(kind in kinds for kind in IMAGE_FORMATS) > 1:
            raise DamagedFileError(
                self.folder,
                f"sample {found.key} has an invalid set of files: {', '.join(sorted(kinds))}",
            )
        members = {member.kind: _data(stream, member) for member in wanted}
        source = f"{self._at('shard', number)}, sample {found.key}"
        return unpack_sample(members, self.table, source, found.facts)

    def _found(self, number: int) -> tuple[io.BytesIO, StoredSample]:
        """Read the bytes of a sample and find its members in them."""
        path = self.folder / self._at("shard", number)
        offset, size = self._at("offset", number), self._at("size", number)
        if offset < 0 or not 0 < size <= MAX_SAMPLE_BYTES:
            raise DamagedFileError(
                self.folder / INDEX,
                f"row {number} has an invalid position or size ({size:,} bytes)",
            )
        try:
            if path.stat().st_size < offset + size:
                raise DamagedFileError(path, "truncated: the file ends before its last sample")
            with path.open("rb") as shard:
                shard.seek(offset)
                stream = io.BytesIO(shard.read(size))
        except OSError as error:
            raise InputError(path, f"cannot be read: {error.strerror or error}") from error
        found = next(stored_samples(stream, size), None)
        if found is None or found.size != size or found.key != self._names[number]:
            raise DamagedFileError(
                path, f"sample {self._names[number]} not found at byte {offset:,}"
            )
        return stream, found

    def _at(self, column: str, number: int) -> Any:
        return self._rows[column][number].as_py()


def open_store(path: str | Path) -> OccStore:
    """Open a complete data set.

    Raises:
        InputError: If the folder is not a data set, or if the data set is not complete.
        DamagedFileError: If a file is not valid.
        LimitError: If a file is too large.
        MissingExtraError: If pyarrow is not installed.

    Example::

        store = open_store("DATA")
        for sample in store.samples("train"):
            sample.colour, sample.depth_m, sample.occ.labels
    """
    folder = Path(path)
    return read_whole(
        folder,
        lambda: OccStore(
            folder, read_meta(folder), read_classes(folder), read_index(folder / INDEX)
        ),
    )


def _data(stream: io.BytesIO, member: Any) -> bytes:
    stream.seek(member.offset)
    return stream.read(member.size)

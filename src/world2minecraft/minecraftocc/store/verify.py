"""Verification of a data set: its files against their list, and its shards against the index."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.checksums import (
    CHECKSUMS,
    Differences,
    FileSum,
    compare_files,
    read_checksums,
)
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.whole_reads import unchanged
from world2minecraft.minecraftocc.store.folder import (
    DATASET,
    INDEX,
    META,
    SHARDS,
    leftovers,
    read_classes,
    read_meta,
)
from world2minecraft.minecraftocc.store.index import COUNTS, index_digest, read_index, shard_rows
from world2minecraft.minecraftocc.store.shard import has_valid_checksums, stored_samples

COMPARED = ("key", "offset", "size", "sha256", *(f"cells_{name}" for name in COUNTS))
Rows = dict[str, list[dict[str, Any]]]  # Rows of the index by shard.


@dataclass(frozen=True)
class VerifyReport:
    """The result of a verification.

    Attributes:
        samples: Number of samples in the index.
        shards: Number of shards.
        bytes: Total size of all listed files in bytes.
        sha256: SHA-256 of all samples.
        faults: Descriptions of the errors found; empty if the data set is valid.
        files: Number of files in the list of the data set. 0 if it has no list, as those of former
            versions; then only its shards are checked.
        missing: Names of files that do not exist.
        changed: Names of files with another content.
        extra: Names of unexpected files.
        has_valid_list: Whether ``checksums.json`` exists and is valid, so that the names are right.
    """

    samples: int
    shards: int
    bytes: int
    sha256: str
    faults: tuple[str, ...]
    files: int = 0
    missing: tuple[str, ...] = ()
    changed: tuple[str, ...] = ()
    extra: tuple[str, ...] = ()
    has_valid_list: bool = True


def verify_store(folder: str | Path, progress: Progress = no_progress) -> VerifyReport:
    """Read all files of a complete data set and verify every checksum.

    Args:
        folder: Folder of the data set.
        progress: Callback that is called after each file.

    Raises:
        InputError: If the folder is not a data set, or if the data set is not complete.
        DamagedFileError: If the data set has no list of files and its index or ``dataset.json``
            cannot be read.
        ConflictError: If another process changes the data set meanwhile.
    """
    root = Path(folder)
    with unchanged(root):
        return _verify(root, progress)


def _verify(root: Path, progress: Progress) -> VerifyReport:
    sums, faults = _read_list(root)
    if not sums:
        return _verify_unlisted(root, faults, progress)
    found = compare_files(root, sums, progress=progress)
    extra = tuple(sorted((*found.extra, *leftovers(root))))
    found = Differences(found.missing, found.changed, extra)
    meta, rows_of = _readable(root, found)
    shards = [name for name in found.damaged if name in rows_of]
    plain = found.faults()
    for name in shards:
        plain.remove(f"{name}: {'missing' if name in found.missing else 'changed'}")
    details = [fault for name in shards for fault in _check_shard(root, name, rows_of[name])]
    return VerifyReport(
        samples=sum(map(len, rows_of.values())),
        shards=sum(name.startswith(f"{SHARDS}/") for name in sums),
        bytes=sum(one.size for one in sums.values()),
        sha256=str(meta.get("sha256", "")),
        faults=(*plain, *details),
        files=len(sums),
        missing=found.missing,
        changed=found.changed,
        extra=found.extra,
    )


def _read_list(root: Path) -> tuple[dict[str, FileSum], list[str]]:
    """Return the list of files, or nothing with the fault of a list that should exist.

    Raises:
        InputError: If the folder is not a data set, or if the data set is not complete.
    """
    has_list = (root / CHECKSUMS).is_file()
    meta: dict[str, Any] = {}
    try:
        meta = read_meta(root, finished=False)
    except InputError:
        if not has_list:
            raise
    if meta.get("complete") is False or not (has_list or meta.get("complete")):
        read_meta(root)  # It raises the error for a data set that is not complete.
    if not has_list:
        return {}, [f"{CHECKSUMS}: missing"] if meta.get("checksums") else []
    try:
        return read_checksums(root), []
    except DamagedFileError as error:
        return {}, [f"{CHECKSUMS}: {error.reason}"]


def _readable(root: Path, found: Differences) -> tuple[dict[str, Any], Rows]:
    """Return ``dataset.json`` and the rows of the index, each empty if its file is damaged."""
    damaged = {*found.missing, *found.changed}
    meta = {} if META in damaged else read_meta(root, finished=False)
    return meta, {} if INDEX in damaged else _rows_of(root)


def _rows_of(root: Path) -> Rows:
    rows_of: Rows = {}
    for row in read_index(root / INDEX).select([*COMPARED, "shard"]).to_pylist():
        rows_of.setdefault(row["shard"], []).append(row)
    return rows_of


def _verify_unlisted(root: Path, faults: list[str], progress: Progress) -> VerifyReport:
    """Verify a data set without a valid list: its shards, index and unexpected files.

    Raises:
        DamagedFileError: If the index or ``dataset.json`` cannot be read.
    """
    meta, rows_of = read_meta(root), _rows_of(root)
    read_classes(root)
    extra, size = _unexpected_files(root, rows_of), 0
    found = [*faults, *(f"{name}: unexpected file" for name in extra), *_mismatches(meta, rows_of)]
    missing, changed = [], []
    for done, (name, rows) in enumerate(rows_of.items()):
        progress("verify", done, len(rows_of), name)
        if wrong := _check_shard(root, name, rows, known=False):
            (changed if (root / name).is_file() else missing).append(name)
        found += wrong
        size += (root / name).stat().st_size if (root / name).is_file() else 0
    progress("verify", len(rows_of), len(rows_of))
    return VerifyReport(
        samples=sum(map(len, rows_of.values())),
        shards=len(rows_of),
        bytes=size,
        sha256=str(meta.get("sha256", "")),
        faults=tuple(found),
        missing=tuple(missing),
        changed=tuple(changed),
        extra=tuple(extra),
        has_valid_list=False,
    )


def _check_shard(
    root: Path, name: str, rows: list[dict[str, Any]], known: bool = True
) -> list[str]:
    """Describe the damage to a shard.

    Args:
        root: Folder of the data set.
        name: Name of the shard.
        rows: Rows of its samples in the index.
        known: Whether the shard is known to be damaged, if only between its samples.
    """
    path = root / name
    if not path.is_file():
        return [f"{name}: missing, with {len(rows)} samples"]
    try:
        found = {row["key"]: row for row in shard_rows(path, name)}
    except DamagedFileError as error:
        return [f"{name}: {error.reason}"]
    faults = [
        f"{name}: sample {row['key']} is {'damaged' if row['key'] in found else 'missing'}"
        for row in rows
        if any(found.get(row["key"], {}).get(column) != row[column] for column in COMPARED)
    ]
    with path.open("rb") as stream:
        for sample in stored_samples(stream, path.stat().st_size):
            if not has_valid_checksums(stream, sample):
                faults.append(f"{name}: sample {sample.key} is damaged")
    extra = sorted(found.keys() - {row["key"] for row in rows})
    faults += [f"{name}: sample {key} is not in the index" for key in extra]
    return faults or ([f"{name}: changed, but not in its samples"] if known else [])


def _unexpected_files(root: Path, known: Rows) -> list[str]:
    """Return unexpected files: parts, temporary files, and shards that are not in the index."""
    own = {*DATASET.names, CHECKSUMS}
    strays = [path.name for path in root.iterdir() if path.name not in own and path.name[0] != "."]
    shards = [
        path.relative_to(root).as_posix()
        for path in (root / SHARDS).rglob("*")
        if path.is_file() and path.name[0] != "."
    ]
    return sorted([*strays, *leftovers(root), *(name for name in shards if name not in known)])


def _mismatches(meta: dict[str, Any], rows_of: Rows) -> list[str]:
    """Compare the index with ``dataset.json``."""
    faults = []
    if meta.get("shards") != list(rows_of):
        faults.append(f"{INDEX}: the shards differ from those in {META}")
    rows = (row for rows in rows_of.values() for row in rows)
    if meta.get("sha256") != index_digest(rows):
        faults.append(f"{INDEX}: the checksum differs from that in {META}")
    return faults

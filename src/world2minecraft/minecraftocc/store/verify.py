"""Verification of a data set: its index, files and checksums, and unexpected files."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.minecraftocc.store.folder import (
    CARD,
    CLASSES,
    CREW,
    INDEX,
    LEFTOVER,
    LOCK,
    META,
    SCENES,
    SHARDS,
    WORLDS,
    read_classes,
    read_meta,
)
from world2minecraft.minecraftocc.store.index import COUNTS, index_digest, read_index, shard_rows
from world2minecraft.minecraftocc.store.shard import has_valid_checksums, stored_samples

COMPARED = ("key", "offset", "size", "sha256", *(f"cells_{name}" for name in COUNTS))


@dataclass(frozen=True)
class VerifyReport:
    """The result of a verification.

    Attributes:
        samples: Number of samples in the index.
        shards: Number of shards.
        bytes: Total size of the shards in bytes.
        sha256: SHA-256 of all samples.
        faults: Descriptions of the errors found; empty if the data set is valid.
    """

    samples: int
    shards: int
    bytes: int
    sha256: str
    faults: tuple[str, ...]


def verify_store(folder: str | Path, progress: Progress = no_progress) -> VerifyReport:
    """Read all shards of a complete data set and verify every checksum.

    Raises:
        InputError: If the folder is not a data set, or if the data set is not complete.
        DamagedFileError: If the index or ``dataset.json`` cannot be read.
    """
    root = Path(folder)
    meta, table = read_meta(root), read_index(root / INDEX)
    read_classes(root)
    rows_of: dict[str, list[dict[str, Any]]] = {}
    for row in table.select([*COMPARED, "shard"]).to_pylist():
        rows_of.setdefault(row["shard"], []).append(row)
    faults, size = [*_unexpected_files(root, rows_of), *_mismatches(meta, rows_of)], 0
    for done, (name, rows) in enumerate(rows_of.items()):
        progress("verify", done, len(rows_of), name)
        faults += _check_shard(root / name, name, rows)
        size += (root / name).stat().st_size if (root / name).is_file() else 0
    progress("verify", len(rows_of), len(rows_of))
    return VerifyReport(len(table), len(rows_of), size, str(meta.get("sha256", "")), tuple(faults))


def _check_shard(path: Path, name: str, rows: list[dict[str, Any]]) -> list[str]:
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
    return faults + [f"{name}: sample {key} is not in the index" for key in extra]


def _unexpected_files(root: Path, known: Iterable[str]) -> list[str]:
    """Describe unexpected files: parts, temporary files, and shards that are not in the index."""
    shards = {root / name for name in known}
    own = {META, CLASSES, INDEX, CARD, LOCK, CREW, SHARDS, SCENES, WORLDS}
    strays = [
        path
        for path in root.iterdir()
        if path.name not in own and (path.name[0] != "." or LEFTOVER.fullmatch(path.name))
    ]
    strays += [path for path in (root / SHARDS).rglob("*") if path.is_file() and path not in shards]
    return [f"{path.relative_to(root)}: unexpected file" for path in sorted(strays)]


def _mismatches(meta: dict[str, Any], rows_of: dict[str, list[dict[str, Any]]]) -> list[str]:
    """Compare the index with ``dataset.json``."""
    faults = []
    if meta.get("shards") != list(rows_of):
        faults.append(f"{INDEX}: the shards differ from those in {META}")
    rows = (row for rows in rows_of.values() for row in rows)
    if meta.get("sha256") != index_digest(rows):
        faults.append(f"{INDEX}: the checksum differs from that in {META}")
    return faults

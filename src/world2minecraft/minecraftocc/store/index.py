"""The Parquet index of a data set, with one row per sample.

The index is built only from the shard headers and JSON members, without decoding images, so it can
be rebuilt at any time.
"""

import hashlib
import os
from collections.abc import Iterable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import (
    MALFORMED,
    DamagedFileError,
    LimitError,
    MissingExtraError,
    OutputError,
)
from world2minecraft.minecraftocc.store.folder import SHARD_NAME
from world2minecraft.minecraftocc.store.sample_files import DEPTH, FACTS, IMAGE_FORMATS, LABELS
from world2minecraft.minecraftocc.store.shard import StoredSample, stored_samples

COUNTS = ("occupied", "visible", "free", "in_frustum", "occluded", "unknown", "hits", "fine")
TEXTS = ("key", "scene_id", "tour_id", "split", "shard", "region", "sha256")
WHOLE = ("frame", "offset", "size", "image_bytes", "depth_bytes", "label_bytes", "json_bytes")
PLACE = ("x", "y", "z", "yaw", "pitch")  # The pose in the game, if the sample states it.
ROWS_AT_ONCE = 4096
MAX_ROWS, MAX_INDEX_BYTES = 20_000_000, 8 << 30


def arrow_modules() -> tuple[Any, Any]:
    """Import pyarrow and its Parquet module.

    Raises:
        MissingExtraError: If pyarrow is not installed.
    """
    try:
        return import_module("pyarrow"), import_module("pyarrow.parquet")
    except ImportError as error:
        raise MissingExtraError("the index of a data set", "data") from error


def columns() -> dict[str, str]:
    """Return the Arrow type of each column by name."""
    return {
        **dict.fromkeys(TEXTS, "string"),
        **dict.fromkeys(WHOLE, "int64"),
        **dict.fromkeys(PLACE, "double"),
        **dict.fromkeys((f"cells_{name}" for name in COUNTS), "int64"),
        **dict.fromkeys((f"class_{name}" for name in CLASS_NAMES), "int32"),
        **dict.fromkeys((f"visible_{name}" for name in CLASS_NAMES), "int32"),
    }


def shard_rows(path: Path, name: str) -> list[dict[str, Any]]:
    """Return the index rows for the samples of a shard.

    Args:
        path: Shard file.
        name: Path of the shard inside the data set.

    Raises:
        DamagedFileError: If the shard cannot be read, or if the JSON of a sample is incomplete.
    """
    try:
        with path.open("rb") as stream:
            length = os.fstat(stream.fileno()).st_size
            samples = list(stored_samples(stream, length))
        return [_row(sample, name) for sample in samples]
    except OSError as error:
        raise DamagedFileError(path, f"cannot be read: {error.strerror or error}") from error
    except MALFORMED as error:
        raise DamagedFileError(
            path, f"contains a sample with incomplete JSON ({error!r})"
        ) from error


def write_index(path: Path, rows: Iterable[list[dict[str, Any]]]) -> str:
    """Write the index rows of all shards, keeping only a few thousand rows in memory.

    Returns:
        The SHA-256 of the keys and checksums of all samples in order. Data sets with the same value
        contain the same samples.

    Raises:
        OutputError: If the file cannot be written.
        MissingExtraError: If pyarrow is not installed.
    """
    arrow, parquet = arrow_modules()
    schema = arrow.schema([(name, arrow.type_for_alias(kind)) for name, kind in columns().items()])
    part, total = path.with_name(f".{path.name}.part"), hashlib.sha256()
    try:
        with part.open("wb") as stream:  # Arrow opens no names that are not UTF-8.
            with parquet.ParquetWriter(stream, schema, compression="zstd") as writer:
                for batch in _batches(rows):
                    _add(total, batch)
                    writer.write_table(arrow.Table.from_pylist(batch, schema))
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(part, path)
    except OSError as error:
        raise OutputError(path, f"cannot be written: {error.strerror or error}") from error
    return total.hexdigest()


def index_digest(rows: Iterable[dict[str, Any]]) -> str:
    """Return the SHA-256 of index rows, as computed by ``write_index``."""
    total = hashlib.sha256()
    _add(total, rows)
    return total.hexdigest()


def read_index(path: Path) -> Any:
    """Read the index as an Arrow table, after checking its size and types.

    Raises:
        DamagedFileError: If the file is not a valid index.
        LimitError: If the file is too large.
        MissingExtraError: If pyarrow is not installed.
    """
    arrow, parquet = arrow_modules()
    try:
        with path.open("rb") as stream:  # Arrow opens no names that are not UTF-8.
            table = _checked_table(parquet.ParquetFile(stream), path)
    except (arrow.ArrowException, OSError, ValueError) as error:
        raise DamagedFileError(path, f"not a valid index ({str(error).splitlines()[0]})") from error
    for name in table["shard"].unique().to_pylist():
        if name is None or not SHARD_NAME.fullmatch(name):
            raise DamagedFileError(path, f"contains the invalid shard name {name!r}")
    return table


def _checked_table(file: Any, path: Path) -> Any:
    meta = file.metadata
    size = sum(meta.row_group(n).total_byte_size for n in range(meta.num_row_groups))
    if meta.num_rows > MAX_ROWS or size > MAX_INDEX_BYTES:
        raise LimitError(path, f"too large to be read: {meta.num_rows:,} rows with {size:,} bytes")
    kinds = {field.name: str(field.type) for field in file.schema_arrow}
    wrong = [name for name, kind in columns().items() if kinds.get(name) != kind]
    if wrong:
        raise DamagedFileError(
            path, f"does not contain a column {wrong[0]} of type {columns()[wrong[0]]}"
        )
    table = file.read(columns=list(columns()))
    table.validate(full=True)  # Texts must be UTF-8.
    return table


def _add(total: Any, rows: Iterable[dict[str, Any]]) -> None:
    for row in rows:
        total.update(f"{row['key']} {row['sha256']}\n".encode())


def _batches(rows: Iterable[list[dict[str, Any]]]) -> Iterator[list[dict[str, Any]]]:
    """Combine the rows of shards into batches of similar size."""
    batch: list[dict[str, Any]] = []
    for some in rows:
        batch += some
        if len(batch) >= ROWS_AT_ONCE:
            yield batch
            batch = []
    if batch:
        yield batch


def _row(sample: StoredSample, shard: str) -> dict[str, Any]:
    facts, sizes = sample.facts, {member.kind: member.size for member in sample.members}
    pose = facts.get("facts", {}).get("game_pose") or {}
    return {
        **{name: str(facts[name]) for name in ("key", "scene_id", "tour_id", "split")},
        "shard": shard,
        "region": str(facts["region"]["kind"]),
        "sha256": sample.facts_sha256,
        "frame": int(facts["frame"]),
        "offset": sample.offset,
        "size": sample.size,
        "image_bytes": sum(sizes.get(kind, 0) for kind in IMAGE_FORMATS),
        "depth_bytes": sizes.get(DEPTH, 0),
        "label_bytes": sizes[LABELS],
        "json_bytes": sizes[FACTS],
        **{name: float(pose[name]) if name in pose else None for name in PLACE},
        **{f"cells_{name}": int(facts["cells"][name]) for name in COUNTS},
        **_classes("class", facts["cells_by_class"]),
        **_classes("visible", facts["visible_by_class"]),
    }


def _classes(prefix: str, counts: list[int]) -> dict[str, int]:
    return {f"{prefix}_{name}": int(counts[n]) for n, name in enumerate(CLASS_NAMES)}

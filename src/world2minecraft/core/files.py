"""Atomic file writing with reproducible contents, and size-limited reading.

All files of the program are written by this module: to a temporary file in the same folder, flushed
to disk, then renamed, so a crash leaves either the old or the new file. Time stamps inside archives
are fixed, so equal values give identical bytes.
"""

import io
import json
import os
import tempfile
import zipfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from tokenize import TokenError
from typing import Any

import numpy as np

from world2minecraft.core.archives import UNREADABLE, ArchivePath
from world2minecraft.core.errors import (
    DamagedFileError,
    InputError,
    LimitError,
    OutputError,
    one_line,
)

FIXED_DATE = (2020, 1, 1, 0, 0, 0)
MAX_ARRAY_BYTES = 4 << 30  # A 400 x 400 x 100 grid of FusedEvidence takes about 1 GiB.
MAX_ARRAYS_BYTES = 6 << 30  # A home of 600 million cells takes 5.4 GB.


def image_bytes(image: Any, kind: str, **options: Any) -> bytes:
    """Encode a Pillow image as ``PNG``, ``JPEG`` or ``WEBP``, with options of its ``save``."""
    stream = io.BytesIO()
    image.save(stream, kind, **options)
    return stream.getvalue()


def write_bytes(path: str | Path, data: bytes) -> None:
    """Write ``data`` to ``path`` atomically, creating parent folders.

    Raises:
        OutputError: If the folder cannot be written or the disk is full.
    """
    target = Path(path)
    temporary = None
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        os.chmod(temporary, 0o644)
        os.replace(temporary, target)
    except BaseException as error:  # Ctrl-C too leaves nothing behind.
        if temporary is not None:
            Path(temporary).unlink(missing_ok=True)
        if isinstance(error, OSError):
            reason = f"cannot be written: {error.strerror or error}"
            raise OutputError(target, reason) from error
        raise


def write_text(path: str | Path, text: str) -> None:
    """Write ``text`` as UTF-8 atomically. What is no text becomes an escape of Python.

    Raises:
        OutputError: If the file cannot be written.
    """
    write_bytes(path, text.encode("utf-8", "backslashreplace"))


def write_json(path: str | Path, value: Any) -> None:
    """Write ``value`` as JSON with sorted keys atomically.

    Raises:
        OutputError: If the file cannot be written.
        ValueError: If the value contains NaN or infinity.
    """
    write_bytes(path, json_bytes(value))


def json_bytes(value: Any) -> bytes:
    """Return the contents of the file that ``write_json`` writes.

    Raises:
        ValueError: If the value contains NaN or infinity.
    """
    return (json.dumps(value, indent=1, sort_keys=True, allow_nan=False) + "\n").encode()


def read_json(path: "str | Path | ArchivePath", limit_bytes: int = 256 << 20) -> Any:
    """Read a JSON file.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not valid JSON.
        LimitError: If the file is too large.
    """
    data = read_bytes(path, limit_bytes)
    try:
        return json.loads(data)
    except (ValueError, RecursionError) as error:
        raise DamagedFileError(path, f"is not JSON ({error})") from error


def load_plain_yaml(text: str | bytes) -> Any:
    """Parse a YAML text. Aliases are rejected because they can expand a small file to a huge tree.

    Raises:
        ValueError: If the text is not valid YAML or contains aliases. The message is one line.
    """
    import yaml  # noqa: PLC0415  # Few commands read any.

    try:
        return yaml.load(text, _plain_loader())  # It is the safe loader, and stricter.
    except (yaml.YAMLError, RecursionError) as error:
        raise ValueError(one_line(error)) from error


@cache
def _plain_loader() -> Any:
    import yaml  # noqa: PLC0415

    class PlainLoader(yaml.SafeLoader):
        """A YAML loader that accepts only plain values."""

        def compose_node(self, parent: Any, index: Any) -> Any:
            if self.check_event(yaml.AliasEvent):
                raise yaml.YAMLError("aliases (*name) are not supported")
            return super().compose_node(parent, index)

    return PlainLoader


def read_bytes(path: "str | Path | ArchivePath", limit_bytes: int) -> bytes:
    """Read a whole file, or a member of an archive, of at most ``limit_bytes`` bytes.

    Raises:
        InputError: If the file does not exist or cannot be read.
        LimitError: If the file is larger than the limit.
    """
    source = Path(path) if isinstance(path, str) else path
    try:
        size = source.stat().st_size
        if size > limit_bytes:
            raise LimitError(source, f"has {size:,} bytes; the limit is {limit_bytes:,}")
        return source.read_bytes()
    except OSError as error:
        raise InputError(source, f"cannot be read: {error.strerror or error}") from error


def write_npz(path: str | Path, arrays: Mapping[str, np.ndarray]) -> None:
    """Write arrays as a compressed ``.npz`` file whose bytes depend only on the values."""
    write_bytes(path, pack_npz(arrays))


def pack_npz(arrays: Mapping[str, np.ndarray]) -> bytes:
    """Return the contents of the file that ``write_npz`` writes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name in sorted(arrays):
            entry = zipfile.ZipInfo(f"{name}.npy", FIXED_DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            payload = io.BytesIO()
            np.lib.format.write_array(payload, np.asarray(arrays[name]), allow_pickle=False)
            archive.writestr(entry, payload.getvalue(), compresslevel=1)
    return buffer.getvalue()


def read_npz(path: str | Path, names: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Read the named arrays of a ``.npz`` file, checking their sizes before allocating memory.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not a valid ``.npz`` file or lacks an array.
        LimitError: If an array is larger than ``MAX_ARRAY_BYTES``, or all together are larger than
            ``MAX_ARRAYS_BYTES``.
    """
    source = Path(path)
    if not source.is_file():
        raise InputError(source, "not found")
    try:
        with zipfile.ZipFile(source) as archive:
            _check_total(archive, names, source)
            return {name: _read_member(archive, name, source) for name in names}
    except UNREADABLE as error:
        raise DamagedFileError(source, f"is not a readable .npz ({error})") from error


def read_npz_bytes(
    data: bytes, names: tuple[str, ...], source: str | Path, limit_bytes: int
) -> dict[str, np.ndarray]:
    """Read the named arrays of a ``.npz`` file in memory, each of at most ``limit_bytes`` bytes.

    Args:
        data: Contents of the file.
        names: Names of the arrays.
        source: File to name in errors.
        limit_bytes: Maximum size of an array in bytes.

    Raises:
        DamagedFileError: If the data is not a valid ``.npz`` file or lacks an array.
        LimitError: If an array is larger than ``limit_bytes``.
    """
    place = Path(source)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return {name: _read_member(archive, name, place, limit_bytes) for name in names}
    except UNREADABLE as error:
        raise DamagedFileError(place, f"is not a readable .npz ({error})") from error


def npz_array_names(path: str | Path) -> tuple[str, ...]:
    """Return the names of the arrays in a ``.npz`` file.

    Raises:
        DamagedFileError: If the file is not a valid ``.npz`` file.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            return tuple(sorted(name.removesuffix(".npy") for name in archive.namelist()))
    except UNREADABLE as error:
        raise DamagedFileError(path, f"is not a readable .npz ({error})") from error


def read_npy(path: "str | Path | ArchivePath") -> np.ndarray:
    """Read a ``.npy`` file, or a member of an archive, checking its size before allocating memory.

    Raises:
        DamagedFileError: If the file is not a valid ``.npy`` file.
    """
    source = Path(path) if isinstance(path, str) else path
    try:
        with source.open("rb") as stream:
            _check_header(stream, source.stat().st_size, source, "of the file")
            stream.seek(0)
            return np.lib.format.read_array(stream, allow_pickle=False)
    except UNREADABLE as error:
        raise DamagedFileError(source, f"is not a readable .npy ({error})") from error


def _check_total(archive: zipfile.ZipFile, names: tuple[str, ...], source: Path) -> None:
    """Raise LimitError if the named arrays need too much memory together."""
    wanted = {f"{name}.npy" for name in names}
    total = sum(entry.file_size for entry in archive.infolist() if entry.filename in wanted)
    if total > MAX_ARRAYS_BYTES:
        raise LimitError(
            source, f"holds {total:,} bytes of arrays; the limit is {MAX_ARRAYS_BYTES:,}"
        )


def _read_member(
    archive: zipfile.ZipFile, name: str, source: Path, limit_bytes: int | None = None
) -> np.ndarray:
    member = f"{name}.npy"
    if member not in archive.namelist():
        held = ", ".join(sorted(entry.removesuffix(".npy") for entry in archive.namelist()))
        raise DamagedFileError(
            source, f"does not contain the array {name!r}; available: {held or 'none'}"
        )
    entry = archive.getinfo(member)
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise DamagedFileError(source, f"array {name!r} uses unsupported compression")
    declared = entry.file_size
    if declared > (MAX_ARRAY_BYTES if limit_bytes is None else limit_bytes):
        raise LimitError(source, f"array {name!r} has {declared:,} bytes, which exceeds the limit")
    with archive.open(member) as stream:
        _check_header(stream, declared, source, repr(name))
    with archive.open(member) as stream:
        return np.lib.format.read_array(stream, allow_pickle=False)


def _check_header(stream: Any, held: int, source: object, name: str) -> None:
    """Raise DamagedFileError for an array that is larger than its data or contains objects."""
    version = np.lib.format.read_magic(stream)
    reader = {
        (1, 0): np.lib.format.read_array_header_1_0,
        (2, 0): np.lib.format.read_array_header_2_0,
    }.get(version)
    if reader is None:
        raise DamagedFileError(source, f"array {name} has the unsupported npy version {version}")
    try:  # numpy parses the header as Python code.
        shape, _, dtype = reader(stream)
    except (IndexError, MemoryError, RecursionError, TokenError) as error:
        raise DamagedFileError(source, f"array {name} has an invalid header") from error
    needed = int(np.prod(shape, dtype=np.float64)) * dtype.itemsize
    if dtype.hasobject or needed > held:
        raise DamagedFileError(
            source, f"array {name} declares {shape} {dtype} but contains less data"
        )


def parse_json_lines(text: str, source: Path) -> list[tuple[int, dict[str, Any]]]:
    """Return the objects in a text with one JSON object per line, with their line numbers.

    Raises:
        DamagedFileError: If a line is not a JSON object. The message names ``source``.
    """
    rows = []
    for number, line in enumerate(text.split("\n"), 1):  # Strings may contain U+2028 and the like.
        if not line.strip():
            continue
        try:
            row = json.loads(line)
        except (ValueError, RecursionError) as error:
            raise DamagedFileError(source, f"line {number} is not valid JSON") from error
        if not isinstance(row, dict):
            raise DamagedFileError(source, f"line {number} is not a JSON object")
        rows.append((number, row))
    return rows

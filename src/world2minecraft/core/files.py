"""Files written whole or not at all, the same bytes for the same values.

Every file of the program is written through here: to a temporary neighbour, flushed to disk, then
renamed, so that a crash leaves the old file or the new one. Time stamps inside archives are fixed.
"""

import io
import json
import os
import tempfile
import zipfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path
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


def write_bytes(path: str | Path, data: bytes) -> None:
    """Write ``data`` to ``path`` atomically, making parent folders.

    Raises:
        OutputError: the folder cannot be written or the disk is full.
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
    """Write ``text`` as UTF-8, atomically. Raises what ``write_bytes`` raises."""
    write_bytes(path, text.encode())


def write_json(path: str | Path, value: Any) -> None:
    """Write ``value`` as JSON with sorted keys, atomically. NaN and infinity are refused."""
    write_text(path, json.dumps(value, indent=1, sort_keys=True, allow_nan=False) + "\n")


def read_json(path: "str | Path | ArchivePath", limit_bytes: int = 256 << 20) -> Any:
    """Read a JSON file.

    Raises:
        InputError: it is missing. DamagedFileError: it is no JSON. LimitError: it is too large.
    """
    data = read_bytes(path, limit_bytes)
    try:
        return json.loads(data)
    except (ValueError, RecursionError) as error:
        raise DamagedFileError(path, f"is not JSON ({error})") from error


def load_plain_yaml(text: str | bytes) -> Any:
    """Return what a YAML text holds, without aliases: they make a huge tree of a small file.

    Raises:
        ValueError: it is no YAML, or has aliases; one line.
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
        """Reads plain values alone."""

        def compose_node(self, parent: Any, index: Any) -> Any:
            if self.check_event(yaml.AliasEvent):
                raise yaml.YAMLError("aliases (*name) are not read")
            return super().compose_node(parent, index)

    return PlainLoader


def read_bytes(path: "str | Path | ArchivePath", limit_bytes: int) -> bytes:
    """Read a whole file, or a member of an archive, of at most ``limit_bytes``.

    Raises:
        InputError: it is missing or cannot be read. LimitError: it is larger.
    """
    source = Path(path) if isinstance(path, str) else path
    try:
        size = source.stat().st_size
        if size > limit_bytes:
            raise LimitError(source, f"has {size:,} bytes; at most {limit_bytes:,} are read")
        return source.read_bytes()
    except OSError as error:
        raise InputError(source, f"cannot be read: {error.strerror or error}") from error


def write_npz(path: str | Path, arrays: Mapping[str, np.ndarray]) -> None:
    """Write arrays as a compressed ``.npz`` whose bytes depend on the values alone."""
    write_bytes(path, pack_npz(arrays))


def pack_npz(arrays: Mapping[str, np.ndarray]) -> bytes:
    """Return what ``write_npz`` writes."""
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
    """Read the named arrays of a ``.npz``, their sizes checked before any memory is taken.

    Raises:
        InputError: the file is missing. DamagedFileError: it is no ``.npz`` or lacks a name.
        LimitError: an array is larger than ``MAX_ARRAY_BYTES``.
    """
    source = Path(path)
    if not source.is_file():
        raise InputError(source, "is not there")
    try:
        with zipfile.ZipFile(source) as archive:
            return {name: _read_member(archive, name, source) for name in names}
    except UNREADABLE as error:
        raise DamagedFileError(source, f"is not a readable .npz ({error})") from error


def read_npz_bytes(
    data: bytes, names: tuple[str, ...], source: str | Path, limit_bytes: int
) -> dict[str, np.ndarray]:
    """Read the named arrays of a ``.npz`` in memory, each of at most ``limit_bytes``.

    ``source`` is what errors call it. Raises what ``read_npz`` raises.
    """
    place = Path(source)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return {name: _read_member(archive, name, place, limit_bytes) for name in names}
    except UNREADABLE as error:
        raise DamagedFileError(place, f"is not a readable .npz ({error})") from error


def npz_array_names(path: str | Path) -> tuple[str, ...]:
    """Return the names of the arrays of a ``.npz``. Raises what ``read_npz`` raises."""
    try:
        with zipfile.ZipFile(path) as archive:
            return tuple(sorted(name.removesuffix(".npy") for name in archive.namelist()))
    except UNREADABLE as error:
        raise DamagedFileError(path, f"is not a readable .npz ({error})") from error


def read_npy(path: str | Path) -> np.ndarray:
    """Read a ``.npy``, its size checked before any memory is taken. Raises as ``read_npz``."""
    source = Path(path)
    try:
        with source.open("rb") as stream:
            _check_header(stream, source.stat().st_size, source, "of the file")
            stream.seek(0)
            return np.lib.format.read_array(stream, allow_pickle=False)
    except UNREADABLE as error:
        raise DamagedFileError(source, f"is not a readable .npy ({error})") from error


def _read_member(
    archive: zipfile.ZipFile, name: str, source: Path, limit_bytes: int | None = None
) -> np.ndarray:
    member = f"{name}.npy"
    if member not in archive.namelist():
        held = ", ".join(sorted(entry.removesuffix(".npy") for entry in archive.namelist()))
        raise DamagedFileError(source, f"has no array {name!r}; it holds: {held or 'nothing'}")
    entry = archive.getinfo(member)
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise DamagedFileError(source, f"array {name!r} is packed in a way no .npz is")
    declared = entry.file_size
    if declared > (MAX_ARRAY_BYTES if limit_bytes is None else limit_bytes):
        raise LimitError(source, f"array {name!r} has {declared:,} bytes; too large to read")
    with archive.open(member) as stream:
        _check_header(stream, declared, source, repr(name))
    with archive.open(member) as stream:
        return np.lib.format.read_array(stream, allow_pickle=False)


def _check_header(stream: Any, held: int, source: Path, name: str) -> None:
    """Refuse an array that says it is larger than the bytes it comes in, or holds objects."""
    version = np.lib.format.read_magic(stream)
    reader = {
        (1, 0): np.lib.format.read_array_header_1_0,
        (2, 0): np.lib.format.read_array_header_2_0,
    }.get(version)
    if reader is None:
        raise DamagedFileError(source, f"array {name} has npy version {version}")
    shape, _, dtype = reader(stream)
    needed = int(np.prod(shape, dtype=np.float64)) * dtype.itemsize
    if dtype.hasobject or needed > held:
        raise DamagedFileError(source, f"array {name} says {shape} {dtype}, holds less")


def parse_json_lines(text: str, source: Path) -> list[tuple[int, dict[str, Any]]]:
    """Return the objects of a text with one JSON object a line, each with the number of its line.

    Raises:
        DamagedFileError: a line is none; ``source`` is named.
    """
    rows = []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip():
            continue
        try:
            row = json.loads(line)
        except (ValueError, RecursionError) as error:
            raise DamagedFileError(source, f"line {number} is no JSON") from error
        if not isinstance(row, dict):
            raise DamagedFileError(source, f"line {number} is no JSON object")
        rows.append((number, row))
    return rows

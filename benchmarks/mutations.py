"""Mutations of files for fuzzing: bytes, and values of JSON, text and npz files.

A mutation is a function of the bytes of a file and a random generator. The bytes that it returns
are usually still a file of the same kind, so that readers get past the first check.
"""

import gzip
import io
import json
import re
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

NUMBERS = (0, -1, 1, 2**31 - 1, 2**31, 2**63, -(2**63), 1e-9, 1e9, 1e30, -1e30, 1e308, 0.5)
VALUES = (*NUMBERS, None, True, "", "../x", "a\0b", "x" * 5000, [], {}, [[]], [1e30] * 3)
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
Mutation = Callable[[bytes, np.random.Generator], bytes]


def broken(data: bytes, rng: np.random.Generator) -> bytes:
    """Return bytes with one to four changes; half the time of single bytes alone."""
    if len(data) and rng.random() < 0.5:
        changed = bytearray(data)
        for at in rng.integers(0, len(data), rng.integers(1, 4)).tolist():
            changed[at] = int(rng.integers(256))
        return bytes(changed)
    for _ in range(rng.integers(1, 5)):
        at = int(rng.integers(len(data) + 1))
        size = int(rng.integers(1, 9))
        match int(rng.integers(6)):
            case 0:
                data = data[:at] + rng.bytes(size) + data[at + size :]
            case 1:
                data = data[:at]
            case 2:
                data = data[:at] + rng.bytes(size) + data[at:]
            case 3:
                data = data[:at] + data[at + size :]
            case 4:
                data = data[:at] + b"\x7f\xff\xff\xff" + data[at + 4 :]
            case _:
                data = data[:at] + data[at : at + 64 * size] + data[at:]
    return data


def mutate(name: str, data: bytes, rng: np.random.Generator) -> bytes:
    """Return a mutated file: a third of the time its bytes, else its values, if known."""
    suffix = Path(name).suffix.lower()
    kinds = {".json": values_of_json, ".jsonl": values_of_lines, ".npz": values_of_npz}
    kinds |= {".npy": values_of_npy, ".gltf": values_of_json}
    kinds |= dict.fromkeys((".txt", ".csv", ".yaml", ".obj", ".ply", ".toml"), numbers_of_text)
    kinds |= dict.fromkeys((".schem", ".nbt", ".litematic", ".dat"), inside_gzip)
    if rng.random() < 0.05:
        return b""
    known = kinds.get(suffix)
    if known is None or rng.random() < 0.33:
        return broken(data, rng)
    try:
        return known(data, rng)
    except (ValueError, OSError, KeyError, EOFError, zlib.error, zipfile.BadZipFile):
        return broken(data, rng)  # Not of the kind that its name says.


def inside_gzip(data: bytes, rng: np.random.Generator) -> bytes:
    """Change what is packed."""
    return gzip.compress(broken(gzip.decompress(data), rng), 1, mtime=0)


def numbers_of_text(data: bytes, rng: np.random.Generator) -> bytes:
    """Set one to three numbers of a text to extreme values."""
    found = list(NUMBER.finditer(data[:200_000]))
    if not found:
        return broken(data, rng)
    words = (*(repr(value).encode() for value in NUMBERS), b"nan", b"inf", b"x", b"")
    for at in sorted(rng.integers(0, len(found), rng.integers(1, 4)).tolist(), reverse=True):
        word = words[int(rng.integers(len(words)))]
        data = data[: found[at].start()] + word + data[found[at].end() :]
    return data


def values_of_lines(data: bytes, rng: np.random.Generator) -> bytes:
    """Change a value in one line of JSON lines."""
    lines = data.splitlines()
    at = int(rng.integers(len(lines)))
    lines[at] = values_of_json(lines[at], rng)
    return b"\n".join(lines) + b"\n"


def values_of_json(data: bytes, rng: np.random.Generator) -> bytes:
    """Set, remove or double one to three values of a JSON document."""
    document = json.loads(data)
    for _ in range(int(rng.integers(1, 4))):
        places = list(_places(document))
        if not places:
            break
        holder, key = places[int(rng.integers(len(places)))]
        match int(rng.integers(6)):
            case 0:
                del holder[key]
            case 1 if isinstance(holder, list):
                holder.insert(0, holder[key])
            case _:
                holder[key] = VALUES[int(rng.integers(len(VALUES)))]
    return json.dumps(document).encode()


def _places(value: Any) -> Any:
    """Yield each container of a document with each of its keys."""
    keys = value if isinstance(value, dict) else range(len(value) if isinstance(value, list) else 0)
    for key in list(keys):
        yield value, key
        yield from _places(value[key])


def values_of_npz(data: bytes, rng: np.random.Generator) -> bytes:
    """Change one array of an archive: its values, shape or type, or leave it out."""
    with np.load(io.BytesIO(data), allow_pickle=False) as archive:
        arrays = {name: archive[name] for name in archive.files}
    name = list(arrays)[int(rng.integers(len(arrays)))]
    if rng.random() < 0.1:
        del arrays[name]
    else:
        arrays[name] = changed_array(arrays[name], rng)
    packed = io.BytesIO()
    np.savez_compressed(packed, **arrays)
    return packed.getvalue()


def values_of_npy(data: bytes, rng: np.random.Generator) -> bytes:
    """Change the values, shape or type of an array file."""
    packed = io.BytesIO()
    np.save(packed, changed_array(np.load(io.BytesIO(data), allow_pickle=False), rng))
    return packed.getvalue()


def changed_array(array: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return an array with another value, shape or type."""
    match int(rng.integers(5)):
        case 0:
            return array[..., None] if rng.random() < 0.5 else array.reshape(-1)
        case 1:
            return array[:0] if array.ndim else np.array([], array.dtype)
        case 2:
            other = ("f8", "i8", "u1", "f2", "?", "U4")[int(rng.integers(6))]
            return array.astype(other)
        case _ if array.size and array.dtype.kind in "fiu":
            flat = array.copy().reshape(-1)
            whole = array.dtype.kind != "f"
            info = np.iinfo(array.dtype) if whole else None
            extremes = (info.min, info.max, 0) if info else (*NUMBERS, np.nan, np.inf, -np.inf)
            places = slice(None) if rng.random() < 0.2 else rng.integers(0, array.size, 3)
            with np.errstate(over="ignore"):
                flat[places] = extremes[int(rng.integers(len(extremes)))]
            return flat.reshape(array.shape)
        case _:
            return np.array("text")

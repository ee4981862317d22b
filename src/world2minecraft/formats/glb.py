"""The container of binary glTF 2.0: one JSON chunk and one chunk of numbers.

``GlbWriter`` gathers arrays and lists and gives the bytes; ``read_glb`` gives the tree and the
numbers back, checked. The numbers are little-endian, each view starting at a multiple of four.
"""

import json
import struct
from pathlib import Path
from typing import Any, Literal

import numpy as np

from world2minecraft.core.errors import DamagedFileError, LimitError
from world2minecraft.core.files import read_bytes

MAGIC, JSON_CHUNK, BIN_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942
MAX_BYTES = 192 << 20
MAX_JSON_BYTES = 8 << 20  # A thousand objects take one; JSON grows thirtyfold in memory.
VERTICES, INDICES = 34962, 34963  # Which buffer of a graphics card a view is for.
_COMPONENTS = {np.dtype("<f4"): 5126, np.dtype("<u4"): 5125, np.dtype("<u2"): 5123}
_KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_HEAD, _CHUNK = struct.Struct("<III"), struct.Struct("<II")


class GlbWriter:
    """A glTF tree that grows: add arrays and rows of lists, then take the bytes."""

    def __init__(self, generator: str) -> None:
        self.tree: dict[str, Any] = {"asset": {"version": "2.0", "generator": generator}}
        self._numbers = bytearray()

    def add(self, kind: str, row: dict[str, Any]) -> int:
        """Add a row to a list of the tree, such as ``meshes``; return its index."""
        self.tree.setdefault(kind, []).append(row)
        return len(self.tree[kind]) - 1

    def view(self, data: bytes, target: int | None = None) -> int:
        """Add bytes; return the index of their buffer view."""
        self._numbers += bytes(-len(self._numbers) % 4)
        row: dict[str, Any] = {"buffer": 0, "byteOffset": len(self._numbers)}
        row["byteLength"] = len(data)
        if target is not None:
            row["target"] = target
        self._numbers += data
        return self.add("bufferViews", row)

    def accessor(self, values: np.ndarray, use: Literal["vertices", "indices"]) -> int:
        """Add an array [N] or [N, 2 to 4] of float32, uint32 or uint16; return its accessor.

        Bounds are written for vertices of three numbers, which positions need.
        """
        target = VERTICES if use == "vertices" else INDICES
        packed = np.ascontiguousarray(values).astype(values.dtype.newbyteorder("<"))
        row: dict[str, Any] = {
            "bufferView": self.view(packed.tobytes(), target),
            "componentType": _COMPONENTS[packed.dtype],
            "count": len(values),
            "type": _KINDS[1 if values.ndim == 1 else values.shape[1]],
        }
        if use == "vertices" and row["type"] == "VEC3":
            row["min"] = values.min(axis=0).tolist()
            row["max"] = values.max(axis=0).tolist()
        return self.add("accessors", row)

    def to_bytes(self) -> bytes:
        """Return the whole file; the same tree gives the same bytes."""
        numbers = bytes(self._numbers) + bytes(-len(self._numbers) % 4)
        tree = dict(self.tree)
        if numbers:
            tree["buffers"] = [{"byteLength": len(numbers)}]
        text = json.dumps(tree, separators=(",", ":"), sort_keys=True, allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        chunks = _CHUNK.pack(len(text), JSON_CHUNK) + text
        if numbers:
            chunks += _CHUNK.pack(len(numbers), BIN_CHUNK) + numbers
        return _HEAD.pack(MAGIC, 2, _HEAD.size + len(chunks)) + chunks


def read_glb(path: str | Path) -> tuple[dict[str, Any], memoryview]:
    """Read a binary glTF file.

    Returns:
        The tree of its JSON chunk, and the bytes of its chunk of numbers (empty without one).

    Raises:
        InputError: there is no file. DamagedFileError: it is no binary glTF 2.0.
        LimitError: it is too large.
    """
    data = read_bytes(path, MAX_BYTES)
    if len(data) < _HEAD.size + _CHUNK.size or _HEAD.unpack_from(data)[:2] != (MAGIC, 2):
        raise DamagedFileError(path, "is no binary glTF 2.0")
    chunks: dict[int, memoryview] = {}
    at, end = _HEAD.size, min(len(data), _HEAD.unpack_from(data)[2])
    while at + _CHUNK.size <= end:
        size, kind = _CHUNK.unpack_from(data, at)
        at += _CHUNK.size
        if size > end - at:
            raise DamagedFileError(path, f"says {size:,} bytes in a chunk and holds fewer")
        chunks.setdefault(kind, memoryview(data)[at : at + size])
        at += size
    nothing = memoryview(b"")
    return _tree_of(chunks.get(JSON_CHUNK, nothing), path), chunks.get(BIN_CHUNK, nothing)


def view_bytes(tree: dict[str, Any], numbers: memoryview, index: Any, path: str | Path) -> bytes:
    """Return the bytes of a buffer view.

    Raises:
        DamagedFileError: there is no such view, or it reaches beyond the numbers.
    """
    try:
        view = tree["bufferViews"][int(index)]
        start, size = int(view.get("byteOffset", 0)), int(view["byteLength"])
        if int(index) < 0 or int(view["buffer"]) != 0:
            raise ValueError("it lies in another file")
    except (KeyError, IndexError, TypeError, ValueError, AttributeError) as error:
        raise DamagedFileError(path, f"has no buffer view {str(index)[:20]}") from error
    if start < 0 or size < 0 or start + size > len(numbers):
        raise DamagedFileError(path, f"its buffer view {index} reaches beyond its numbers")
    return bytes(numbers[start : start + size])


def _tree_of(text: memoryview, path: str | Path) -> dict[str, Any]:
    if len(text) > MAX_JSON_BYTES:
        raise LimitError(path, f"has {len(text):,} bytes of JSON; at most {MAX_JSON_BYTES:,}")
    try:
        tree = json.loads(bytes(text))
    except (ValueError, RecursionError) as error:
        raise DamagedFileError(path, f"its JSON chunk is no JSON ({error})") from error
    if not isinstance(tree, dict):
        raise DamagedFileError(path, "its JSON chunk is no object")
    return tree

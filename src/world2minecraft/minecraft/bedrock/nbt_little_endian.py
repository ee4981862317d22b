"""Strict, bounded reading and writing of little-endian NBT, as used by Bedrock Edition.

Strings are plain UTF-8. Python values map to tags as in ``minecraft.nbt``, with one exception: a
List of Int is represented by an int32 array. Bedrock stores block indices this way, and the reader
returns such a list as an array that shares the memory of the file's bytes.
"""

import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.minecraft.nbt import (
    DEFAULT_LIMITS,
    INT,
    INTS,
    LIST,
    NbtLimits,
    NbtReader,
    NbtWriter,
    array_layouts,
    number_layouts,
)


def write_little(root: Mapping[str, Any]) -> bytes:
    """Return an NBT tree as little-endian bytes, with keys in the order of the mapping.

    Raises:
        UsageError: If a value has no NBT tag, a number does not fit its tag, or a list mixes types.
    """
    return _LittleWriter().root(root)


def read_little(
    data: bytes, path: str | Path, limits: NbtLimits = DEFAULT_LIMITS
) -> dict[str, Any]:
    """Read one little-endian NBT tree whose root is a Compound.

    Raises:
        DamagedFileError: If the bytes are not valid NBT.
        LimitError: If the tree exceeds ``limits``.
    """
    return _LittleReader(data, path, limits).root()[1]


class _LittleReader(NbtReader):
    """A reader of little-endian NBT with plain UTF-8 strings and lists of Int as arrays."""

    dialect, encoding = "little-endian NBT", "UTF-8"
    numbers, arrays = number_layouts("<"), array_layouts("<")
    uint16, int32 = struct.Struct("<H"), struct.Struct("<i")

    def decoded(self, raw: bytes) -> str:
        """Decode a string that is not plain ASCII."""
        return raw.decode("utf-8")

    def items(self, depth: int) -> Any:
        """Read a list, or an array for a list of Int."""
        if self.data[self.at] != INT:
            return super().items(depth)
        self.at += 1
        return self.array(self.arrays[INTS])


class _LittleWriter(NbtWriter):
    """A writer of little-endian NBT that writes arrays as lists of Int."""

    numbers, arrays = _LittleReader.numbers, _LittleReader.arrays
    uint16, int32 = _LittleReader.uint16, _LittleReader.int32

    def encoded(self, text: str) -> bytes:
        """Encode a string as plain UTF-8."""
        return text.encode("utf-8")

    def tag_of_array(self, value: np.ndarray) -> int:
        """Return the list tag, which represents an array."""
        return LIST

    def put_list(self, values: Any) -> None:
        """Append a list, or an array as a list of Int."""
        if not isinstance(values, np.ndarray):
            return super().put_list(values)
        if values.ndim != 1 or values.dtype != np.int32:
            shape = tuple(values.shape)
            raise UsageError(f"NBT list array must be int32 [N], got {values.dtype} {shape}")
        self.out.append(INT)
        return self.put_array(self.arrays[INTS], values)

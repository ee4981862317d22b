"""NBT as Bedrock keeps it: little-endian, plain UTF-8, read strictly and within bounds.

Values are those of ``minecraft.nbt``, with one difference: an int32 array stands for a List of Int,
which is how Bedrock keeps its block numbers, and such a list comes back as an array, taken from the
file's bytes without a copy.
"""

import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.errors import UsageError
from world2minecraft.minecraft.nbt import (
    BYTE,
    BYTES,
    COMPOUND,
    DEFAULT_LIMITS,
    DOUBLE,
    END,
    FLOAT,
    INT,
    INTS,
    LIST,
    LONG,
    LONGS,
    SHORT,
    STRING,
    Byte,
    Float,
    Long,
    NbtLimits,
    NbtReader,
    Short,
)

_NUMBERS: dict[int, tuple[struct.Struct, Any]] = {
    BYTE: (struct.Struct("<b"), Byte),
    SHORT: (struct.Struct("<h"), Short),
    INT: (struct.Struct("<i"), int),
    LONG: (struct.Struct("<q"), Long),
    FLOAT: (struct.Struct("<f"), Float),
    DOUBLE: (struct.Struct("<d"), float),
}
_ARRAYS = {BYTES: np.dtype("<i1"), INTS: np.dtype("<i4"), LONGS: np.dtype("<i8")}
_KINDS: tuple[tuple[type, int], ...] = (
    (str, STRING),
    (bool, BYTE),
    (Byte, BYTE),
    (Short, SHORT),
    (Long, LONG),
    (int, INT),
    (Float, FLOAT),
    (float, DOUBLE),
    (Mapping, COMPOUND),
    (list, LIST),
    (tuple, LIST),
    (np.ndarray, LIST),
)
_UINT16, _INT32 = struct.Struct("<H"), struct.Struct("<i")


def write_little(root: Mapping[str, Any]) -> bytes:
    """Return the bytes of a tree, keys in the order of the mapping.

    Raises:
        UsageError: a value has no tag, a number does not fit its tag, or a list mixes kinds.
    """
    out = bytearray([COMPOUND, 0, 0])
    _put(out, COMPOUND, root)
    return bytes(out)


def read_little(
    data: bytes, path: str | Path, limits: NbtLimits = DEFAULT_LIMITS
) -> dict[str, Any]:
    """Read one tree whose root is a Compound.

    Raises:
        DamagedFileError: the bytes are no NBT. LimitError: they ask for too much.
    """
    return _LittleReader(data, path, limits).root()[1]


class _LittleReader(NbtReader):
    """Numbers the other way round, plain texts, and lists of Int as arrays."""

    dialect, encoding = "little-endian NBT", "UTF-8"
    numbers, arrays, uint16, int32 = _NUMBERS, _ARRAYS, _UINT16, _INT32

    def decoded(self, raw: bytes) -> str:
        """Return a text that is not plain ASCII."""
        return raw.decode("utf-8")

    def items(self, depth: int) -> Any:
        """Read a list."""
        if self.data[self.at] != INT:
            return super().items(depth)
        self.at += 1
        return self.array(_ARRAYS[INTS])


def _tag_of(value: Any) -> int:
    for kind, tag in _KINDS:
        if isinstance(value, kind):
            return tag
    raise UsageError(f"a value of type {type(value).__name__} has no NBT tag")


def _put(out: bytearray, tag: int, value: Any) -> None:
    if tag in _NUMBERS:
        try:
            out += _NUMBERS[tag][0].pack(value)
        except (struct.error, OverflowError) as error:
            raise UsageError(f"the number {value} does not fit its NBT tag") from error
    elif tag == STRING:
        _put_string(out, value)
    elif tag == COMPOUND:
        for name, held in value.items():
            kind = _tag_of(held)
            out.append(kind)
            _put_string(out, name)
            _put(out, kind, held)
        out.append(END)
    else:
        _put_list(out, value)


def _put_list(out: bytearray, values: Any) -> None:
    if isinstance(values, np.ndarray):
        if values.ndim != 1 or values.dtype != np.int32:
            raise UsageError(f"an array of {values.dtype} with shape {values.shape} is no list")
        out.append(INT)
        out += _INT32.pack(len(values)) + values.astype("<i4").tobytes()
        return
    kinds = {_tag_of(value) for value in values}
    if len(kinds) > 1:
        raise UsageError("a list in NBT must hold values of one kind")
    kind = kinds.pop() if kinds else END
    out.append(kind)
    out += _INT32.pack(len(values))
    for value in values:
        _put(out, kind, value)


def _put_string(out: bytearray, text: str) -> None:
    try:
        raw = text.encode("utf-8")
    except UnicodeError as error:
        raise UsageError(f"text {text[:40]!r} cannot be written as NBT") from error
    if len(raw) > 0xFFFF:
        raise UsageError(f"a text of {len(raw):,} bytes is too long for NBT; at most 65,535")
    out += _UINT16.pack(len(raw)) + raw

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

from world2minecraft.errors import DamagedFileError, LimitError, UsageError
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
    reader = _Reader(data, path, limits)
    try:
        if not data or data[0] != COMPOUND:
            raise reader.damaged("does not begin with a compound tag")
        reader.at = 1
        reader.string()
        root = reader.compound(1)
    except (struct.error, IndexError) as error:
        raise reader.damaged("ends too early") from error
    if reader.at != len(data):
        raise reader.damaged(f"has {len(data) - reader.at} bytes after its end")
    return root


class _Reader:
    """A place in the bytes, and how many values the tree may still have."""

    def __init__(self, data: bytes, path: str | Path, limits: NbtLimits):
        self.data, self.path, self.limits = data, path, limits
        self.at = 0
        self.values_left = limits.values

    def damaged(self, reason: str) -> DamagedFileError:
        return DamagedFileError(
            self.path, f"is no valid little-endian NBT: at byte {self.at} it {reason}"
        )

    def string(self) -> str:
        size = _UINT16.unpack_from(self.data, self.at)[0]
        start, end = self.at + 2, self.at + 2 + size
        if end > len(self.data):
            raise self.damaged("ends too early")
        self.at = end
        try:
            return self.data[start:end].decode("utf-8")
        except UnicodeError as error:
            raise self.damaged("has a string that is no UTF-8") from error

    def value(self, tag: int, depth: int) -> Any:
        if depth > self.limits.depth:
            reason = f"nests deeper than {self.limits.depth} tags; at most that is read"
            raise LimitError(self.path, reason)
        if tag in _NUMBERS:
            layout, kind = _NUMBERS[tag]
            number = layout.unpack_from(self.data, self.at)[0]
            self.at += layout.size
            return kind(number)
        if tag == STRING:
            return self.string()
        if tag in _ARRAYS:
            return self.array(_ARRAYS[tag], self.count())
        if tag == COMPOUND:
            return self.compound(depth)
        if tag == LIST:
            return self.items(depth)
        raise self.damaged(f"has a tag of kind {tag}")

    def compound(self, depth: int) -> dict[str, Any]:
        result: dict[str, Any] = {}
        while (tag := self.data[self.at]) != END:
            self.at += 1
            self.take(1)
            name = self.string()
            if name in result:
                raise self.damaged(f"names {name[:40]!r} twice")
            result[name] = self.value(tag, depth + 1)
        self.at += 1
        return result

    def items(self, depth: int) -> Any:
        tag = self.data[self.at]
        self.at += 1
        count = self.count()
        if tag == INT:
            return self.array(_ARRAYS[INTS], count)
        if tag == END and count > 0:
            raise self.damaged(f"has a list of {count} tags of no kind")
        self.take(count)
        return [self.value(tag, depth + 1) for _ in range(count)]

    def count(self) -> int:
        count = _INT32.unpack_from(self.data, self.at)[0]
        self.at += 4
        if count > len(self.data) - self.at:
            raise self.damaged(f"says {count:,} values and holds fewer")
        return max(count, 0)

    def array(self, kind: np.dtype, count: int) -> np.ndarray:
        if count * kind.itemsize > len(self.data) - self.at:
            raise self.damaged(f"says {count:,} values and holds fewer")
        values = np.frombuffer(self.data, kind, count, self.at)
        self.at += values.nbytes
        return values

    def take(self, count: int) -> None:
        self.values_left -= count
        if self.values_left < 0:
            reason = f"holds more than {self.limits.values:,} values; at most that is read"
            raise LimitError(self.path, reason)


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

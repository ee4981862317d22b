"""NBT written: a tree becomes bytes. Bedrock's dialect overrides what differs there."""

import struct
from collections.abc import Mapping
from typing import Any

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.minecraft.nbt_tags import (
    BYTE,
    BYTES,
    COMPOUND,
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
    Short,
    array_layouts,
    number_layouts,
)

_ARRAY_TAGS = {np.dtype(np.int8): BYTES, np.dtype(np.int32): INTS, np.dtype(np.int64): LONGS}
_TAG_OF_TYPE: tuple[tuple[type, int], ...] = (
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
)


def write_nbt(root: Mapping[str, Any], name: str = "") -> bytes:
    """Return the bytes of an NBT tree, keys in the order of the mapping, not compressed.

    Raises:
        UsageError: a value has no tag, a number does not fit its tag, or a list mixes kinds.
    """
    return NbtWriter().root(root, name)


class NbtWriter:
    """The bytes of a tree as they grow; ``write_nbt`` is its use."""

    numbers, arrays = number_layouts(">"), array_layouts(">")
    uint16, int32 = struct.Struct(">H"), struct.Struct(">i")

    def __init__(self) -> None:
        self.out = bytearray()

    def root(self, root: Mapping[str, Any], name: str = "") -> bytes:
        """Return the bytes of a whole tree; see ``write_nbt``."""
        self.out.append(COMPOUND)
        self.put_string(name)
        self.put(COMPOUND, root)
        return bytes(self.out)

    def encoded(self, text: str) -> bytes:
        """Return Java's modified UTF-8: a zero as two bytes, other planes as two surrogates."""
        if text.isascii() and "\0" not in text:
            return text.encode("ascii")
        units = np.frombuffer(text.encode("utf-16-le"), "<u2")
        packed = "".join(map(chr, units.tolist())).encode("utf-8", "surrogatepass")
        return packed.replace(b"\0", b"\xc0\x80")

    def tag_of_array(self, value: np.ndarray) -> int:
        """Return the tag of an array."""
        if value.ndim == 1 and value.dtype in _ARRAY_TAGS:
            return _ARRAY_TAGS[value.dtype]
        raise UsageError(f"an array of {value.dtype} with shape {value.shape} has no NBT tag")

    def tag_of(self, value: Any) -> int:
        """Return the tag of any value."""
        if isinstance(value, np.ndarray):
            return self.tag_of_array(value)
        for kind, tag in _TAG_OF_TYPE:
            if isinstance(value, kind):
                return tag
        raise UsageError(f"a value of type {type(value).__name__} has no NBT tag")

    def put(self, tag: int, value: Any) -> None:
        """Add a value of the kind ``tag``."""
        if tag in self.numbers:
            try:
                self.out += self.numbers[tag][0].pack(value)
            except (struct.error, OverflowError) as error:
                raise UsageError(f"the number {value} does not fit its NBT tag") from error
        elif tag == STRING:
            self.put_string(value)
        elif tag == COMPOUND:
            self.put_compound(value)
        elif tag == LIST:
            self.put_list(value)
        else:
            self.put_array(self.arrays[tag], value)

    def put_compound(self, values: Mapping[str, Any]) -> None:
        """Add values with their names."""
        for name, held in values.items():
            kind = self.tag_of(held)
            self.out.append(kind)
            self.put_string(name)
            self.put(kind, held)
        self.out.append(END)

    def put_array(self, dtype: np.dtype, values: np.ndarray) -> None:
        """Add an array, its count before it."""
        self.out += self.int32.pack(len(values))
        self.out += values.astype(dtype).tobytes()

    def put_list(self, values: Any) -> None:
        """Add a list of one kind."""
        kinds = {self.tag_of(value) for value in values}
        if len(kinds) > 1:
            raise UsageError("a list in NBT must hold values of one kind")
        kind = kinds.pop() if kinds else END
        self.out.append(kind)
        self.out += self.int32.pack(len(values))
        for value in values:
            self.put(kind, value)

    def put_string(self, text: str) -> None:
        """Add a text."""
        try:
            raw = self.encoded(text)
        except UnicodeError as error:
            raise UsageError(f"text {text[:40]!r} cannot be written as NBT") from error
        if len(raw) > 0xFFFF:
            raise UsageError(f"a text of {len(raw):,} bytes is too long for NBT; at most 65,535")
        self.out += self.uint16.pack(len(raw))
        self.out += raw

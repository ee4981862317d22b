"""Strict, bounded reading and writing of NBT, the game's binary tree format.

Python values map to tags as follows: ``Byte``, ``Short``, ``Long`` and ``Float`` are the classes in
this module, ``int`` is an Int, ``float`` a Double, ``bool`` a Byte, ``str`` a String, ``dict`` a
Compound, a list a List of one type, and an array of int8, int32 or int64 the array tag of that
size.

The reader rejects data that ends early, has bytes after its end, or exceeds the depth, number of
values or size in ``NbtLimits``. It checks counts against the remaining bytes before it allocates
memory. Gzip output has no timestamp, so that the bytes depend only on the values.
``minecraft.bedrock.nbt_little_endian`` overrides the parts that differ in Bedrock Edition.
"""

import struct
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, LimitError, UsageError

(END, BYTE, SHORT, INT, LONG, FLOAT, DOUBLE, BYTES, STRING, LIST, COMPOUND, INTS, LONGS) = range(13)
_ARRAY_TAGS = {np.dtype(np.int8): BYTES, np.dtype(np.int32): INTS, np.dtype(np.int64): LONGS}
MAX_BYTES = 136 << 20  # Unpacked: 67 million blocks in two bytes each.
_CHUNK_BYTES = 1 << 20
# The fewest bytes that one value of each kind takes: it bounds a list's count.
_MIN_VALUE_BYTES = (0, 1, 2, 4, 8, 4, 8, 4, 2, 5, 1, 4, 4)


class Byte(int):
    """An 8-bit integer."""


class Short(int):
    """A 16-bit integer."""


class Long(int):
    """A 64-bit integer."""


class Float(float):
    """A single-precision floating-point number."""


def number_layouts(order: str) -> dict[int, tuple[struct.Struct, Any]]:
    """Return the binary layout and Python type of each number tag.

    Args:
        order: The byte order, ``>`` for big-endian or ``<`` for little-endian.
    """
    kinds = {BYTE: ("b", Byte), SHORT: ("h", Short), INT: ("i", int), LONG: ("q", Long)}
    kinds |= {FLOAT: ("f", Float), DOUBLE: ("d", float)}
    return {tag: (struct.Struct(order + code), kind) for tag, (code, kind) in kinds.items()}


def array_layouts(order: str) -> dict[int, np.dtype]:
    """Return the element dtype of each array tag.

    Args:
        order: The byte order, ``>`` for big-endian or ``<`` for little-endian.
    """
    return {
        tag: np.dtype(order + code) for tag, code in ((BYTES, "i1"), (INTS, "i4"), (LONGS, "i8"))
    }


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
    """Return an NBT tree as uncompressed bytes, with keys in the order of the mapping.

    Raises:
        UsageError: If a value has no NBT tag, a number does not fit its tag, or a list mixes types.
    """
    return NbtWriter().root(root, name)


class NbtWriter:
    """A writer that collects the bytes of an NBT tree. Use ``write_nbt`` to write a tree."""

    numbers, arrays = number_layouts(">"), array_layouts(">")
    uint16, int32 = struct.Struct(">H"), struct.Struct(">i")

    def __init__(self) -> None:
        self.out = bytearray()

    def root(self, root: Mapping[str, Any], name: str = "") -> bytes:
        """Return the bytes of a whole tree, as ``write_nbt`` does."""
        self.out.append(COMPOUND)
        self.put_string(name)
        self.put(COMPOUND, root)
        return bytes(self.out)

    def encoded(self, text: str) -> bytes:
        """Encode a string as Java's modified UTF-8.

        A zero becomes two bytes, and a character outside the basic plane becomes two surrogates.
        """
        if text.isascii() and "\0" not in text:
            return text.encode("ascii")
        units = np.frombuffer(text.encode("utf-16-le"), "<u2")
        packed = "".join(map(chr, units.tolist())).encode("utf-8", "surrogatepass")
        return packed.replace(b"\0", b"\xc0\x80")

    def tag_of_array(self, value: np.ndarray) -> int:
        """Return the NBT tag type of an array.

        Raises:
            UsageError: If no tag exists for the shape or dtype.
        """
        if value.ndim == 1 and value.dtype in _ARRAY_TAGS:
            return _ARRAY_TAGS[value.dtype]
        raise UsageError(
            f"NBT arrays must be int8, int32 or int64 [N], got {value.dtype} {value.shape}"
        )

    def tag_of(self, value: Any) -> int:
        """Return the NBT tag type of a Python value.

        Raises:
            UsageError: If the type has no tag.
        """
        if isinstance(value, np.ndarray):
            return self.tag_of_array(value)
        for kind, tag in _TAG_OF_TYPE:
            if isinstance(value, kind):
                return tag
        raise UsageError(f"NBT cannot store a value of type {type(value).__name__}")

    def put(self, tag: int, value: Any) -> None:
        """Append a value with the given tag type."""
        if tag in self.numbers:
            try:
                self.out += self.numbers[tag][0].pack(value)
            except (struct.error, OverflowError) as error:
                raise UsageError(f"number {value} is out of range for its NBT tag") from error
        elif tag == STRING:
            self.put_string(value)
        elif tag == COMPOUND:
            self.put_compound(value)
        elif tag == LIST:
            self.put_list(value)
        else:
            self.put_array(self.arrays[tag], value)

    def put_compound(self, values: Mapping[str, Any]) -> None:
        """Append the named values of a compound."""
        for name, held in values.items():
            kind = self.tag_of(held)
            self.out.append(kind)
            self.put_string(name)
            self.put(kind, held)
        self.out.append(END)

    def put_array(self, dtype: np.dtype, values: np.ndarray) -> None:
        """Append an array, preceded by its length."""
        self.out += self.int32.pack(len(values))
        self.out += values.astype(dtype).tobytes()

    def put_list(self, values: Any) -> None:
        """Append a list whose values have the same type."""
        kinds = {self.tag_of(value) for value in values}
        if len(kinds) > 1:
            raise UsageError("an NBT list must contain values of a single type")
        kind = kinds.pop() if kinds else END
        self.out.append(kind)
        self.out += self.int32.pack(len(values))
        for value in values:
            self.put(kind, value)

    def put_string(self, text: str) -> None:
        """Append a string, preceded by its length."""
        try:
            raw = self.encoded(text)
        except UnicodeError as error:
            raise UsageError(f"text {text[:40]!r} cannot be encoded as NBT") from error
        if len(raw) > 0xFFFF:
            raise UsageError(f"an NBT string must be at most 65,535 bytes, got {len(raw):,}")
        self.out += self.uint16.pack(len(raw))
        self.out += raw


def unpack(data: bytes, path: str | Path, limit: int = MAX_BYTES) -> bytes:
    """Decompress gzip or zlib data. Other data is returned unchanged.

    Raises:
        DamagedFileError: If the compressed stream is damaged.
        LimitError: If the decompressed data has more than ``limit`` bytes.
    """
    if data[:2] == b"\x1f\x8b":
        kind, window = "gzip", 31
    elif len(data) >= 2 and data[0] == 0x78 and (data[0] << 8 | data[1]) % 31 == 0:
        kind, window = "zlib", 15
    else:
        return data
    stream, parts, rest = zlib.decompressobj(window), [], b""
    size = at = 0
    try:
        while not stream.eof and size <= limit:
            rest, at = (rest, at) if rest else (data[at : at + _CHUNK_BYTES], at + _CHUNK_BYTES)
            part = stream.decompress(rest, _CHUNK_BYTES)
            rest = stream.unconsumed_tail
            if not part and not rest and at >= len(data):
                break
            size += len(part)
            parts = [*parts, part] if size <= _CHUNK_BYTES else []
        if size > limit:
            raise LimitError(path, f"exceeds the limit of {limit:,} bytes after decompression")
        if not stream.eof or stream.unused_data or at < len(data):
            where = "has bytes after its end" if stream.eof else "ends too early"
            raise DamagedFileError(path, f"the {kind} stream {where}")
        # Much of it goes into one buffer of its size: one that grows takes twice its memory.
        return b"".join(parts) if parts or not size else zlib.decompress(data, window, size)
    except zlib.error as error:
        raise DamagedFileError(path, f"is not a valid {kind} stream ({error})") from error


def pack_gzip(data: bytes, level: int = 6) -> bytes:
    """Compress data as gzip without a timestamp or name, so that equal data gives equal bytes."""
    packer = zlib.compressobj(level, zlib.DEFLATED, -15)
    body = packer.compress(data) + packer.flush()
    head = b"\x1f\x8b\x08\0\0\0\0\0\0\xff"
    return head + body + struct.pack("<II", zlib.crc32(data), len(data) & 0xFFFFFFFF)


@dataclass(frozen=True)
class NbtLimits:
    """Limits on an NBT tree. Every file that the program writes is within the defaults."""

    depth: int = 100  # The game allows 512; real files stay below 20.
    values: int = 500_000  # About 100 MB of Python objects, read in a second.
    bytes: int = MAX_BYTES  # Unpacked.
    text_bytes: int = 32 << 20  # All texts; each byte may take four in memory.


DEFAULT_LIMITS = NbtLimits()


def read_nbt(
    data: bytes, path: str | Path, limits: NbtLimits = DEFAULT_LIMITS
) -> tuple[str, dict[str, Any]]:
    """Read one uncompressed NBT tree whose root is a Compound.

    Args:
        data: The bytes of the tree. Call ``unpack`` first if they may be compressed.
        path: The file path for error messages.
        limits: The limits on the tree.

    Returns:
        The name of the root and its values.

    Raises:
        DamagedFileError: If the bytes are not valid NBT.
        LimitError: If the tree exceeds ``limits``.
    """
    return NbtReader(data, path, limits).root()


def tree_bytes(value: Any) -> int:
    """Estimate the memory in bytes that an NBT value occupies in Python."""
    if isinstance(value, dict):
        return 200 + sum(100 + len(key) + tree_bytes(held) for key, held in value.items())
    if isinstance(value, list):
        return 60 + sum(8 + tree_bytes(held) for held in value)
    if isinstance(value, np.ndarray):
        return 120 + value.nbytes
    return 60 + 4 * len(value) if isinstance(value, str) else 40


class NbtReader:
    """A reader of one NBT tree that enforces limits. Use ``read_nbt`` to read a tree."""

    must_end = True  # Whether bytes after the tree are refused.
    dialect, encoding = "NBT", "modified UTF-8"  # As errors name them.
    numbers, arrays = number_layouts(">"), array_layouts(">")
    uint16, int32 = struct.Struct(">H"), struct.Struct(">i")

    def __init__(self, data: bytes, path: str | Path, limits: NbtLimits):
        self.data, self.path, self.limits = data, path, limits
        self.at = 0
        self.key = ""  # The name of the value that is read now.
        self.values_left, self.text_left = limits.values, limits.text_bytes

    def root(self) -> tuple[str, dict[str, Any]]:
        """Read the whole tree, as ``read_nbt`` does."""
        try:
            if not self.data or self.data[0] != COMPOUND:
                raise self.damaged("the root is not a compound tag")
            self.at = 1
            name = self.string()
            root = self.compound(1)
        except (struct.error, IndexError) as error:
            raise self.damaged("the data ends too early") from error
        except RecursionError as error:  # The caller's own stack was deep already.
            raise LimitError(self.path, "contains NBT that is nested too deep to read") from error
        if self.must_end and self.at != len(self.data):
            raise self.damaged(f"{len(self.data) - self.at} extra bytes follow the end")
        return name, root

    def damaged(self, reason: str) -> DamagedFileError:
        """Return an error that describes a problem at the current position."""
        return DamagedFileError(
            self.path, f"is not valid {self.dialect}: {reason} (at byte {self.at})"
        )

    def string(self) -> str:
        """Read a length-prefixed string at the current position."""
        start = self.at + 2
        end = start + self.uint16.unpack_from(self.data, self.at)[0]
        if end > len(self.data):
            raise self.damaged("the data ends too early")
        self.at = end
        self.text_left -= end - start
        if self.text_left < 0:
            raise LimitError(
                self.path, f"exceeds the limit of {self.limits.text_bytes:,} bytes of text"
            )
        raw = self.data[start:end]
        try:
            return raw.decode("ascii") if raw.isascii() else self.decoded(raw)
        except UnicodeError as error:
            raise self.damaged(f"a string is not valid {self.encoding}") from error

    def decoded(self, raw: bytes) -> str:
        """Decode a string that is not plain ASCII."""
        return _decode(raw)

    def value(self, tag: int, depth: int) -> Any:
        """Read a value of the given tag type."""
        if tag in self.numbers:
            layout, kind = self.numbers[tag]
            number = layout.unpack_from(self.data, self.at)[0]
            self.at += layout.size
            return number if kind is int or kind is float else kind(number)
        if tag == STRING:
            return self.string()
        if tag in self.arrays:
            return self.array(self.arrays[tag])
        if depth > self.limits.depth:
            raise LimitError(self.path, f"exceeds the limit of {self.limits.depth} nested tags")
        if tag == COMPOUND:
            return self.compound(depth)
        if tag == LIST:
            return self.items(depth)
        raise self.damaged(f"unknown tag type {tag}")

    def compound(self, depth: int) -> dict[str, Any]:
        """Read a compound, in which every name must be unique."""
        result: dict[str, Any] = {}
        while tag := self.data[self.at]:
            self._take(1)
            self.at += 1
            name = self.string()
            if name in result:
                raise self.damaged(f"duplicate name {name[:40]!r}")
            self.key = name
            result[name] = self.value(tag, depth + 1)
        self.at += 1
        return result

    def items(self, depth: int) -> list[Any]:
        """Read a list at the current position."""
        tag = self.data[self.at]
        count = self.int32.unpack_from(self.data, self.at + 1)[0]
        self.at += 5
        if tag > LONGS or (tag == END and count > 0):
            raise self.damaged(f"invalid list of {count} tags of type {tag}")
        if count <= 0:
            return []
        self._hold(count, _MIN_VALUE_BYTES[tag])
        self._take(count)
        return self.elements(tag, count, depth)

    def elements(self, tag: int, count: int, depth: int) -> list[Any]:
        """Read the values of a list, after its header."""
        return [self.value(tag, depth + 1) for _ in range(count)]

    def array(self, dtype: np.dtype) -> np.ndarray:
        """Read an array and the length before it."""
        count = self.int32.unpack_from(self.data, self.at)[0]
        self.at += 4
        self._hold(count, dtype.itemsize)
        raw = np.frombuffer(self.data, dtype, count, self.at)
        self.at += raw.nbytes
        return raw.astype(dtype.newbyteorder("="), copy=False)  # Bytes stay where they are.

    def _hold(self, count: int, size: int) -> None:
        if count < 0 or count * size > len(self.data) - self.at:
            raise self.damaged(f"{count:,} values are declared, but fewer follow")

    def _take(self, count: int) -> None:
        self.values_left -= count
        if self.values_left < 0:
            raise LimitError(self.path, f"exceeds the limit of {self.limits.values:,} NBT values")


def _decode(raw: bytes) -> str:
    """Decode Java's modified UTF-8, in which zero has two bytes and surrogates are separate."""
    text = raw.replace(b"\xc0\x80", b"\0").decode("utf-8", "surrogatepass")
    return text.encode("utf-16-le", "surrogatepass").decode("utf-16-le")

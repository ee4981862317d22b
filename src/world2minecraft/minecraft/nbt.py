"""NBT, the game's binary tree format, read strictly and within bounds, and written.

Python values and tags: ``Byte Short Long Float`` are the small classes below, a plain ``int`` is
an Int, a plain ``float`` a Double, ``bool`` a Byte, ``str`` a String, ``dict`` a Compound, a list
a List of one kind, and an array of int8, int32 or int64 the array tag of that size.

A file is refused where it ends early, has bytes after its end, nests deeper, holds more values or
unpacks to more bytes than ``NbtLimits`` allows. Counts are checked against the bytes that are left
before anything is allocated. Gzip is written without a time, so that bytes depend on values alone.
``minecraft.bedrock.nbt_little_endian`` overrides what differs in Bedrock's dialect.
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
    """A number of one byte."""


class Short(int):
    """A number of two bytes."""


class Long(int):
    """A number of eight bytes."""


class Float(float):
    """A number in single precision."""


def number_layouts(order: str) -> dict[int, tuple[struct.Struct, Any]]:
    """Return by tag how a number is packed, and what it becomes; ``order`` is ``>`` or ``<``."""
    kinds = {BYTE: ("b", Byte), SHORT: ("h", Short), INT: ("i", int), LONG: ("q", Long)}
    kinds |= {FLOAT: ("f", Float), DOUBLE: ("d", float)}
    return {tag: (struct.Struct(order + code), kind) for tag, (code, kind) in kinds.items()}


def array_layouts(order: str) -> dict[int, np.dtype]:
    """Return by tag how the numbers of an array lie; ``order`` is ``>`` or ``<``."""
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


def unpack(data: bytes, path: str | Path, limit: int = MAX_BYTES) -> bytes:
    """Undo gzip or zlib where the bytes begin so; other bytes come back as they are.

    Raises:
        DamagedFileError: the stream is broken. LimitError: it holds more than ``limit`` bytes.
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
            raise LimitError(path, f"unpacks to more than {limit:,} bytes; at most that is read")
        if not stream.eof or stream.unused_data or at < len(data):
            where = "has bytes after its end" if stream.eof else "ends too early"
            raise DamagedFileError(path, f"its {kind} stream {where}")
        # Much of it goes into one buffer of its size: one that grows takes twice its memory.
        return b"".join(parts) if parts or not size else zlib.decompress(data, window, size)
    except zlib.error as error:
        raise DamagedFileError(path, f"is no whole {kind} stream ({error})") from error


def pack_gzip(data: bytes, level: int = 6) -> bytes:
    """Return ``data`` as gzip without a time or a name, so that the bytes depend on it alone."""
    packer = zlib.compressobj(level, zlib.DEFLATED, -15)
    body = packer.compress(data) + packer.flush()
    head = b"\x1f\x8b\x08\0\0\0\0\0\0\xff"
    return head + body + struct.pack("<II", zlib.crc32(data), len(data) & 0xFFFFFFFF)


@dataclass(frozen=True)
class NbtLimits:
    """What a file may ask for. The defaults hold for every file that the program writes."""

    depth: int = 100  # The game allows 512; real files stay below 20.
    values: int = 500_000  # About 100 MB of Python objects, read in a second.
    bytes: int = MAX_BYTES  # Unpacked.
    text_bytes: int = 32 << 20  # All texts; each byte may take four in memory.


DEFAULT_LIMITS = NbtLimits()


def read_nbt(
    data: bytes, path: str | Path, limits: NbtLimits = DEFAULT_LIMITS
) -> tuple[str, dict[str, Any]]:
    """Read one unpacked NBT tree whose root is a Compound.

    Args:
        data: the bytes; use ``unpack`` first where they may be compressed.
        path: the file that errors name.
        limits: what the tree may ask for.

    Returns:
        The root's name and its values.

    Raises:
        DamagedFileError: the bytes are no NBT. LimitError: they ask for too much.
    """
    return NbtReader(data, path, limits).root()


def tree_bytes(value: Any) -> int:
    """Return about how much memory a value of NBT takes, to bound what is held of many files."""
    if isinstance(value, dict):
        return 200 + sum(100 + len(key) + tree_bytes(held) for key, held in value.items())
    if isinstance(value, list):
        return 60 + sum(8 + tree_bytes(held) for held in value)
    if isinstance(value, np.ndarray):
        return 120 + value.nbytes
    return 60 + 4 * len(value) if isinstance(value, str) else 40


class NbtReader:
    """A position in the bytes, and how much the tree has requested; ``read_nbt`` is its use."""

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
        """Read the whole tree; see ``read_nbt``."""
        try:
            if not self.data or self.data[0] != COMPOUND:
                raise self.damaged("does not begin with a compound tag")
            self.at = 1
            name = self.string()
            root = self.compound(1)
        except (struct.error, IndexError) as error:
            raise self.damaged("ends too early") from error
        except RecursionError as error:  # The caller's own stack was deep already.
            raise LimitError(self.path, "nests too deep to be read") from error
        if self.must_end and self.at != len(self.data):
            raise self.damaged(f"has {len(self.data) - self.at} bytes after its end")
        return name, root

    def damaged(self, reason: str) -> DamagedFileError:
        """Return the error to raise at this place."""
        return DamagedFileError(
            self.path, f"is no valid {self.dialect}: at byte {self.at} it {reason}"
        )

    def string(self) -> str:
        """Read a text."""
        start = self.at + 2
        end = start + self.uint16.unpack_from(self.data, self.at)[0]
        if end > len(self.data):
            raise self.damaged("ends too early")
        self.at = end
        self.text_left -= end - start
        if self.text_left < 0:
            reason = f"holds more than {self.limits.text_bytes:,} bytes of text"
            raise LimitError(self.path, f"{reason}; at most that is read")
        raw = self.data[start:end]
        try:
            return raw.decode("ascii") if raw.isascii() else self.decoded(raw)
        except UnicodeError as error:
            raise self.damaged(f"has a string that is no {self.encoding}") from error

    def decoded(self, raw: bytes) -> str:
        """Return a text that is not plain ASCII."""
        return _decode(raw)

    def value(self, tag: int, depth: int) -> Any:
        """Read a value of the kind ``tag``."""
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
            reason = f"nests deeper than {self.limits.depth} tags; at most that is read"
            raise LimitError(self.path, reason)
        if tag == COMPOUND:
            return self.compound(depth)
        if tag == LIST:
            return self.items(depth)
        raise self.damaged(f"has a tag of the unknown kind {tag}")

    def compound(self, depth: int) -> dict[str, Any]:
        """Read a compound, the names of which must differ."""
        result: dict[str, Any] = {}
        while tag := self.data[self.at]:
            self._take(1)
            self.at += 1
            name = self.string()
            if name in result:
                raise self.damaged(f"names {name[:40]!r} twice")
            self.key = name
            result[name] = self.value(tag, depth + 1)
        self.at += 1
        return result

    def items(self, depth: int) -> list[Any]:
        """Read a list."""
        tag = self.data[self.at]
        count = self.int32.unpack_from(self.data, self.at + 1)[0]
        self.at += 5
        if tag > LONGS or (tag == END and count > 0):
            raise self.damaged(f"has a list of {count} tags of kind {tag}")
        if count <= 0:
            return []
        self._hold(count, _MIN_VALUE_BYTES[tag])
        self._take(count)
        return self.elements(tag, count, depth)

    def elements(self, tag: int, count: int, depth: int) -> list[Any]:
        """Read the values of a list, after its head."""
        return [self.value(tag, depth + 1) for _ in range(count)]

    def array(self, dtype: np.dtype) -> np.ndarray:
        """Read an array, its count before it."""
        count = self.int32.unpack_from(self.data, self.at)[0]
        self.at += 4
        self._hold(count, dtype.itemsize)
        raw = np.frombuffer(self.data, dtype, count, self.at)
        self.at += raw.nbytes
        return raw.astype(dtype.newbyteorder("="), copy=False)  # Bytes stay where they are.

    def _hold(self, count: int, size: int) -> None:
        if count < 0 or count * size > len(self.data) - self.at:
            raise self.damaged(f"says {count:,} values and holds fewer")

    def _take(self, count: int) -> None:
        self.values_left -= count
        if self.values_left < 0:
            reason = f"holds more than {self.limits.values:,} values; at most that is read"
            raise LimitError(self.path, reason)


def _decode(raw: bytes) -> str:
    """Read Java's modified UTF-8: a zero as two bytes, other planes as two surrogates."""
    text = raw.replace(b"\xc0\x80", b"\0").decode("utf-8", "surrogatepass")
    return text.encode("utf-16-le", "surrogatepass").decode("utf-16-le")

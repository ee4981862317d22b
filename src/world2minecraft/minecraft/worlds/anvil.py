"""Region files: 32 x 32 chunks in sectors of 4 KiB, with oversized chunks in files of their own.

Chunks packed as LZ4 are the blocks of lz4-java, each with a head and a checksum. A head is
``LZ4Block``, a byte (how the block is packed, and how large blocks are), then, each in four bytes
of which the lowest comes first, the packed size, the size, and a checksum of the unpacked block:
xxHash32 of which the four highest bits are left out. A block of size 0 ends the stream.
"""

import os
import struct
import zlib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import BinaryIO

import lz4.block
import numpy as np

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UsageError
from world2minecraft.core.files import read_bytes
from world2minecraft.core.jit import njit
from world2minecraft.minecraft.nbt import pack_gzip, unpack

MAGIC = b"LZ4Block"
RAW, PACKED = 0x10, 0x20
BLOCK_BITS = 16  # lz4-java's blocks of 64 KiB.
SEED, MASK = 0x9747B28C, 0x0FFFFFFF
_LZ4_HEADER = struct.Struct("<8sBiiI")
SECTOR = 4096
MAX_REGION_BYTES = 512 << 20
MAX_CHUNK_BYTES = 16 << 20  # Unpacked; a chunk of 4,096 kinds of blocks in 24 sections has 4 MB.
GZIP, ZLIB, PLAIN, LZ4, CUSTOM = 1, 2, 3, 4, 127
EXTERNAL = 128
COMPRESSIONS = {"gzip": GZIP, "zlib": ZLIB, "none": PLAIN, "lz4": LZ4}
_CHUNK_HEADER = struct.Struct(">IB")


def pack_lz4(data: bytes) -> bytes:
    """Return ``data`` in blocks of 64 KiB."""
    parts = []
    size = 1 << BLOCK_BITS
    for start in range(0, len(data), size):
        block = data[start : start + size]
        packed = lz4.block.compress(block, store_size=False)
        how = PACKED if len(packed) < len(block) else RAW
        held = packed if how == PACKED else block
        head = (MAGIC, how | BLOCK_BITS - 10, len(held), len(block), checksum(block))
        parts += [_LZ4_HEADER.pack(*head), held]
    return b"".join([*parts, _LZ4_HEADER.pack(MAGIC, RAW | BLOCK_BITS - 10, 0, 0, 0)])


def unpack_lz4(data: bytes, path: str | Path, limit: int) -> bytes:
    """Undo ``pack_lz4``.

    Args:
        data: the packed blocks.
        path: the file that errors name.
        limit: the most bytes to return.

    Raises:
        DamagedFileError: it is no such stream, ends too early or fails its checksum.
        LimitError: it holds more than ``limit`` bytes.
    """
    parts: list[bytes] = []
    at = total = 0
    while True:
        if at + _LZ4_HEADER.size > len(data):
            raise DamagedFileError(path, "its LZ4 stream ends too early")
        magic, how, packed_size, size, stated = _LZ4_HEADER.unpack_from(data, at)
        at += _LZ4_HEADER.size
        if magic != MAGIC:
            raise DamagedFileError(path, "its LZ4 stream has a block without its mark")
        if size == 0:
            break
        total += size if size > 0 else 0
        if total > limit:
            raise LimitError(path, f"unpacks to more than {limit:,} bytes; at most that is read")
        if not 0 < packed_size <= len(data) - at or not 0 < size <= 1 << ((how & 15) + 10):
            raise DamagedFileError(path, "its LZ4 stream has a block of a false size")
        parts.append(_block(data[at : at + packed_size], how, size, stated, path))
        at += packed_size
    if at != len(data):
        raise DamagedFileError(path, "its LZ4 stream has bytes after its end")
    return b"".join(parts)


def _block(packed: bytes, how: int, size: int, stated: int, path: str | Path) -> bytes:
    try:
        is_raw = how & 0xF0 == RAW
        block = packed if is_raw else lz4.block.decompress(packed, uncompressed_size=size)
    except lz4.block.LZ4BlockError as error:
        raise DamagedFileError(path, f"has a broken LZ4 block ({error})") from error
    if len(block) != size or checksum(block) != stated or how & 0xF0 not in (RAW, PACKED):
        raise DamagedFileError(path, "has an LZ4 block that is not what its checksum says")
    return block


def checksum(block: bytes) -> int:
    """Return lz4-java's checksum of a block.

    Example:
        >>> hex(checksum(b""))
        '0xd3b42d8'
    """
    return int(xxhash32(np.frombuffer(block, np.uint8), np.uint32(SEED))) & MASK


@njit
def _rotate_left(value, bits):  # pragma: no cover
    """Turn 32 bits to the left."""
    low = np.uint64(0xFFFFFFFF)
    value &= low
    return (value << bits | value >> (np.uint64(32) - bits)) & low


@njit
def xxhash32(data, seed):  # pragma: no cover
    """Return the xxHash32 of uint8 [N], after the description of its algorithm."""
    one, two, three = np.uint64(0x9E3779B1), np.uint64(0x85EBCA77), np.uint64(0xC2B2AE3D)
    four, five = np.uint64(0x27D4EB2F), np.uint64(0x165667B1)
    low = np.uint64(0xFFFFFFFF)
    start = np.uint64(seed)
    at, size = 0, len(data)
    if size >= 16:
        lanes = np.empty(4, np.uint64)
        lanes[0], lanes[1] = (start + one + two) & low, (start + two) & low
        lanes[2], lanes[3] = start, (start - one) & low
        while at + 16 <= size:
            for lane in range(4):
                word = np.uint64(0)
                for step in range(4):
                    word |= np.uint64(data[at + step]) << np.uint64(8 * step)
                at += 4
                mixed = (lanes[lane] + word * two) & low
                lanes[lane] = (_rotate_left(mixed, np.uint64(13)) * one) & low
        found = _rotate_left(lanes[0], np.uint64(1)) + _rotate_left(lanes[1], np.uint64(7))
        found += _rotate_left(lanes[2], np.uint64(12)) + _rotate_left(lanes[3], np.uint64(18))
    else:
        found = start + five
    found = (found + np.uint64(size)) & low
    while at + 4 <= size:
        word = np.uint64(0)
        for step in range(4):
            word |= np.uint64(data[at + step]) << np.uint64(8 * step)
        at += 4
        found = (_rotate_left(found + word * three, np.uint64(17)) * four) & low
    while at < size:
        found = (_rotate_left(found + np.uint64(data[at]) * five, np.uint64(11)) * one) & low
        at += 1
    found = ((found ^ found >> np.uint64(15)) * two) & low
    found = ((found ^ found >> np.uint64(13)) * three) & low
    return found ^ found >> np.uint64(16)


def pack_region(
    chunks: Mapping[tuple[int, int], bytes], level: int = 1, compression: str = "zlib"
) -> tuple[bytes, dict[str, bytes]]:
    """Pack the chunks of one region.

    Args:
        chunks: NBT bytes by chunk position (x, z) in the world, all of the same region.
        level: zlib level; 1 costs a third of the time of 6 and a room is mostly sector padding.
        compression: gzip, zlib (which every game reads), none, or lz4 (1.20.5 and later).

    Returns:
        The bytes of the ``.mca``, and those of each ``.mcc`` by file name: a chunk of more than
        255 sectors lies in one.

    Raises:
        UsageError: the compression is another.
    """
    if compression not in COMPRESSIONS:
        known = ", ".join(COMPRESSIONS)
        raise UsageError(f"no compression of chunks is named {compression!r}; known: {known}")
    stated = COMPRESSIONS[compression]
    table = np.zeros((2, 1024), ">u4")
    body: list[bytes] = []
    outside: dict[str, bytes] = {}
    sector = 2
    for (x, z), data in sorted(chunks.items(), key=lambda item: item[0][::-1]):
        packed, kind = pack_chunk(data, stated, level), stated
        if len(packed) + _CHUNK_HEADER.size > 255 * SECTOR:
            outside[f"c.{x}.{z}.mcc"] = packed
            packed, kind = b"", stated | EXTERNAL
        record = _CHUNK_HEADER.pack(len(packed) + 1, kind) + packed
        record += bytes(-len(record) % SECTOR)
        count = len(record) // SECTOR
        table[0, (x & 31) + (z & 31) * 32] = sector << 8 | count
        body.append(record)
        sector += count
    return b"".join([table.tobytes(), *body]), outside


def pack_chunk(data: bytes, kind: int = ZLIB, level: int = 1) -> bytes:
    """Return a chunk's NBT packed in the way ``kind``: ``GZIP``, ``ZLIB``, ``PLAIN`` or ``LZ4``."""
    if kind == PLAIN:
        return data
    if kind == LZ4:
        return pack_lz4(data)
    return pack_gzip(data, level) if kind == GZIP else zlib.compress(data, level)


def read_region(
    path: Path, is_wanted: Callable[[tuple[int, int]], bool] | None = None
) -> Iterator[tuple[tuple[int, int], bytes]]:
    """Read the chunks of a region file: the position of each in the world and its NBT bytes.

    One chunk is held at a time, however large the file is.

    Args:
        path: the file, ``r.X.Z.mca``.
        is_wanted: whether the chunk at a position is read; all are where it is left out.

    Raises:
        InputError: the file cannot be read. DamagedFileError: it is no region file.
        LimitError: it or a chunk of it is too large.
    """
    region_x, region_z = region_position(path)
    try:
        with path.open("rb") as stream:
            size = os.fstat(stream.fileno()).st_size
            for slot, sectors in _slots(stream.read(2 * SECTOR), size, path):
                position = (region_x * 32 + slot % 32, region_z * 32 + slot // 32)
                if is_wanted is None or is_wanted(position):
                    yield position, _read_chunk(path, stream, position, sectors)
    except OSError as error:
        raise InputError(path, f"cannot be read: {error.strerror or error}") from error


def _slots(head: bytes, size: int, path: Path) -> Iterator[tuple[int, range]]:
    """Return the chunks that a file's head names: the number of each and its sectors."""
    if size > MAX_REGION_BYTES:
        raise LimitError(path, f"has {size:,} bytes; at most {MAX_REGION_BYTES:,} are read")
    if not head:
        return  # The game leaves empty files where it never wrote a chunk.
    if len(head) < 2 * SECTOR:
        raise DamagedFileError(path, f"is no region file: it has {len(head)} bytes, no whole head")
    taken: set[int] = set()
    for slot, location in enumerate(np.frombuffer(head, ">u4", 1024).tolist()):
        if location:
            sectors = range(location >> 8, (location >> 8) + (location & 255))
            if sectors.start < 2 or not sectors or not taken.isdisjoint(sectors):
                raise DamagedFileError(path, f"chunk {slot} lies on the head or on another chunk")
            taken.update(sectors)
            yield slot, sectors


def region_position(path: Path) -> tuple[int, int]:
    """Return the x and z of a region file named ``r.X.Z.mca``.

    Raises:
        DamagedFileError: the name is another.
    """
    parts = path.name.split(".")
    try:
        if len(parts) != 4 or parts[0] != "r" or parts[3] != "mca":
            raise ValueError
        return int(parts[1]), int(parts[2])
    except ValueError:
        raise DamagedFileError(path, "is not named like a region file, r.X.Z.mca") from None


def _read_chunk(path: Path, stream: BinaryIO, position: tuple[int, int], sectors: range) -> bytes:
    stream.seek(sectors.start * SECTOR)
    record = stream.read(len(sectors) * SECTOR)
    if len(record) < _CHUNK_HEADER.size:
        raise DamagedFileError(path, f"ends before its chunk {position}")
    length, kind = _CHUNK_HEADER.unpack_from(record)
    packed = record[_CHUNK_HEADER.size : 4 + length]
    if not 1 <= length <= len(sectors) * SECTOR - 4 or len(packed) != length - 1:
        raise DamagedFileError(path, f"chunk {position} says {length:,} bytes and holds fewer")
    source = path
    if kind & EXTERNAL:
        source = path.parent / f"c.{position[0]}.{position[1]}.mcc"
        packed = read_bytes(source, MAX_CHUNK_BYTES)
    return unpack_chunk(packed, kind & ~EXTERNAL, source, position)


def unpack_chunk(packed: bytes, kind: int, source: Path, position: tuple[int, int]) -> bytes:
    """Return a chunk's NBT.

    Args:
        packed: the bytes after the one that says how they are packed.
        kind: that byte, without the bit of a chunk in a file of its own.
        source: the file that errors name.
        position: the chunk's place in the world, for the same.

    Raises:
        DamagedFileError: it is not packed as it says. LimitError: it is too large.
        InputError: it is packed in a way of a mod, or of a game to come.
    """
    if kind == LZ4:
        return unpack_lz4(packed, source, MAX_CHUNK_BYTES)
    if kind not in (GZIP, ZLIB, PLAIN):
        reason = (
            f"chunk {position} is packed in {_compression_name(packed, kind)}, which is not read"
        )
        advice = (
            "set region-file-compression=deflate in server.properties and let it save the world"
        )
        raise InputError(source, f"{reason}; {advice}")
    if kind == PLAIN:
        return packed
    result = unpack(packed, source, MAX_CHUNK_BYTES)
    if result is packed:
        raise DamagedFileError(source, f"chunk {position} is not packed as it says")
    return result


def _compression_name(packed: bytes, kind: int) -> str:
    """Return how a chunk is packed: a custom compression comes with a name, as texts do."""
    if kind == CUSTOM and len(packed) > 2:
        name = packed[2 : 2 + int.from_bytes(packed[:2], "big")][:80]
        return f"the server's own way {name.decode('ascii', 'replace')!r}"
    return f"way {kind}"

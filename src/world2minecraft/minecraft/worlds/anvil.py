"""Region files of 32 x 32 chunks in 4 KiB sectors, with oversized chunks in separate files.

LZ4-compressed chunks use the block format of lz4-java. Each block has a header that consists of
``LZ4Block``; a byte with the compression method and the maximum block size; and three little-endian
32-bit integers: the compressed size, the size, and a checksum of the data, which is xxHash32
without the four highest bits. A block of size 0 ends the stream.
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
MAX_SECTORS = 255  # A longer record lies in a file of its own.
LEVEL = 1  # Of zlib: a third of the time of level 6, and most of a file is padding.
MAX_REGION_BYTES = 512 << 20
MAX_CHUNK_BYTES = 16 << 20  # Unpacked; a chunk of 4,096 kinds of blocks in 24 sections has 4 MB.
GZIP, ZLIB, PLAIN, LZ4, CUSTOM = 1, 2, 3, 4, 127
EXTERNAL = 128
COMPRESSIONS = {"gzip": GZIP, "zlib": ZLIB, "none": PLAIN, "lz4": LZ4}
_CHUNK_HEADER = struct.Struct(">IB")


def pack_lz4(data: bytes) -> bytes:
    """Compress data in blocks of 64 KiB as lz4-java does."""
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
    """Decompress data that ``pack_lz4`` or lz4-java compressed.

    Args:
        data: The compressed blocks.
        path: The file path for error messages.
        limit: Maximum number of bytes to return.

    Raises:
        DamagedFileError: If the stream is invalid, ends too early or fails its checksum.
        LimitError: If the decompressed data has more than ``limit`` bytes.
    """
    parts: list[bytes] = []
    at = total = 0
    while True:
        if at + _LZ4_HEADER.size > len(data):
            raise DamagedFileError(path, "contains an LZ4 stream that ends too early")
        magic, how, packed_size, size, stated = _LZ4_HEADER.unpack_from(data, at)
        at += _LZ4_HEADER.size
        if magic != MAGIC:
            raise DamagedFileError(path, "contains an LZ4 block with an invalid signature")
        if size == 0:
            break
        total += size if size > 0 else 0
        if total > limit:
            raise LimitError(path, f"exceeds the limit of {limit:,} bytes after decompression")
        if not 0 < packed_size <= len(data) - at or not 0 < size <= 1 << ((how & 15) + 10):
            raise DamagedFileError(path, "contains an LZ4 block with an invalid size")
        parts.append(_block(data[at : at + packed_size], how, size, stated, path))
        at += packed_size
    if at != len(data):
        raise DamagedFileError(path, "contains extra bytes after the end of an LZ4 stream")
    return b"".join(parts)


def _block(packed: bytes, how: int, size: int, stated: int, path: str | Path) -> bytes:
    try:
        is_raw = how & 0xF0 == RAW
        block = packed if is_raw else lz4.block.decompress(packed, uncompressed_size=size)
    except lz4.block.LZ4BlockError as error:
        raise DamagedFileError(path, f"contains a damaged LZ4 block ({error})") from error
    if len(block) != size or checksum(block) != stated or how & 0xF0 not in (RAW, PACKED):
        raise DamagedFileError(path, "contains an LZ4 block that does not match its checksum")
    return block


def checksum(block: bytes) -> int:
    """Return the checksum that lz4-java stores for a block.

    Example:
        >>> hex(checksum(b""))
        '0xd3b42d8'
    """
    return int(xxhash32(np.frombuffer(block, np.uint8), np.uint32(SEED))) & MASK


@njit
def _rotate_left(value, bits):  # pragma: no cover
    """Rotate a 32-bit value to the left."""
    low = np.uint64(0xFFFFFFFF)
    value &= low
    return (value << bits | value >> (np.uint64(32) - bits)) & low


@njit
def xxhash32(data, seed):  # pragma: no cover
    """Return the xxHash32 of uint8 [N]."""
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
    chunks: Mapping[tuple[int, int], bytes], compression: str = "zlib"
) -> tuple[bytes, dict[str, bytes]]:
    """Pack the chunks of one region into a region file.

    Args:
        chunks: NBT bytes by chunk position (x, z) in the world, all in the same region.
        compression: One of gzip, zlib (readable by every game), none and lz4 (since 1.20.5).

    Returns:
        The bytes of the ``.mca`` file, and the bytes of each ``.mcc`` file by name. A ``.mcc`` file
        contains a chunk of more than 255 sectors.

    Raises:
        UsageError: If the compression is unknown.
    """
    if compression not in COMPRESSIONS:
        known = ", ".join(COMPRESSIONS)
        raise UsageError(f"compression must be one of {known}, got {compression!r}")
    kind = COMPRESSIONS[compression]
    records: dict[tuple[int, int], bytes] = {}
    outside: dict[str, bytes] = {}
    for place, data in chunks.items():
        packed = pack_chunk(data, kind)
        records[place] = bytes([kind]) + packed
        if len(packed) + _CHUNK_HEADER.size > MAX_SECTORS * SECTOR:
            outside[outside_name(place)], records[place] = packed, bytes([kind | EXTERNAL])
    return pack_records(records, {}), outside


def pack_records(
    records: Mapping[tuple[int, int], bytes], times: Mapping[tuple[int, int], int]
) -> bytes:
    """Return the bytes of a region file with the given chunks.

    Args:
        records: Compressed chunks by position in the world, each after its compression byte.
        times: Time in seconds at which each chunk was saved. The default is 0.
    """
    table = np.zeros((2, 1024), ">u4")
    body: list[bytes] = []
    sector = 2
    for place, record in sorted(records.items(), key=lambda item: item[0][::-1]):
        whole = len(record).to_bytes(4, "big") + record
        whole += bytes(-len(whole) % SECTOR)
        slot = (place[0] & 31) + (place[1] & 31) * 32
        table[0, slot] = sector << 8 | len(whole) // SECTOR
        table[1, slot] = times.get(place, 0)
        body.append(whole)
        sector += len(whole) // SECTOR
    return b"".join([table.tobytes(), *body])


def outside_name(place: tuple[int, int]) -> str:
    """Return the name of the separate file for a chunk that is too large for its region file."""
    return f"c.{place[0]}.{place[1]}.mcc"


def pack_chunk(data: bytes, kind: int = ZLIB) -> bytes:
    """Compress the NBT of a chunk with the method ``GZIP``, ``ZLIB``, ``PLAIN`` or ``LZ4``."""
    if kind == PLAIN:
        return data
    if kind == LZ4:
        return pack_lz4(data)
    return pack_gzip(data, LEVEL) if kind == GZIP else zlib.compress(data, LEVEL)


def read_region(
    path: Path, is_wanted: Callable[[tuple[int, int]], bool] | None = None
) -> Iterator[tuple[tuple[int, int], bytes]]:
    """Yield the position in the world and the NBT bytes of each chunk in a region file.

    Only one chunk is in memory at a time.

    Args:
        path: The region file, ``r.X.Z.mca``.
        is_wanted: Function that selects chunks by position. The default is all chunks.

    Raises:
        InputError: If the file cannot be read.
        DamagedFileError: If the file is not a valid region file.
        LimitError: If the file or a chunk exceeds the size limit.
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
    """Yield the index and the sectors of each chunk in the header."""
    if size > MAX_REGION_BYTES:
        raise LimitError(path, f"has {size:,} bytes, the limit is {MAX_REGION_BYTES:,}")
    if not head:
        return  # The game leaves empty files where it never wrote a chunk.
    if len(head) < 2 * SECTOR:
        raise DamagedFileError(
            path, f"is not a valid region file: the header is incomplete ({len(head)} bytes)"
        )
    taken: set[int] = set()
    for slot, location in enumerate(np.frombuffer(head, ">u4", 1024).tolist()):
        if location:
            sectors = range(location >> 8, (location >> 8) + (location & 255))
            if sectors.start < 2 or not sectors or not taken.isdisjoint(sectors):
                raise DamagedFileError(path, f"chunk {slot} overlaps the header or another chunk")
            taken.update(sectors)
            yield slot, sectors


def region_position(path: Path) -> tuple[int, int]:
    """Return the region position x, z from the name of a region file, ``r.X.Z.mca``.

    Raises:
        DamagedFileError: If the name has a different form.
    """
    parts = path.name.split(".")
    try:
        if len(parts) != 4 or parts[0] != "r" or parts[3] != "mca":
            raise ValueError
        return int(parts[1]), int(parts[2])
    except ValueError:
        raise DamagedFileError(path, "is not named like a region file (r.X.Z.mca)") from None


def _read_chunk(path: Path, stream: BinaryIO, position: tuple[int, int], sectors: range) -> bytes:
    stream.seek(sectors.start * SECTOR)
    record = stream.read(len(sectors) * SECTOR)
    if len(record) < _CHUNK_HEADER.size:
        raise DamagedFileError(path, f"ends before chunk {position}")
    length, kind = _CHUNK_HEADER.unpack_from(record)
    packed = record[_CHUNK_HEADER.size : 4 + length]
    if not 1 <= length <= len(sectors) * SECTOR - 4 or len(packed) != length - 1:
        raise DamagedFileError(
            path, f"chunk {position} declares {length:,} bytes but contains fewer"
        )
    source = path
    if kind & EXTERNAL:
        source = path.parent / outside_name(position)
        packed = read_bytes(source, MAX_CHUNK_BYTES)
    return unpack_chunk(packed, kind & ~EXTERNAL, source, position)


def unpack_chunk(packed: bytes, kind: int, source: Path, position: tuple[int, int]) -> bytes:
    """Decompress the NBT of a chunk.

    Args:
        packed: The bytes after the compression byte.
        kind: The compression byte, without the bit that marks a separate file.
        source: The file path for error messages.
        position: The chunk's position in the world, for error messages.

    Raises:
        DamagedFileError: If the data does not match the stated compression.
        LimitError: If the chunk exceeds the size limit.
        InputError: If the compression is unknown, such as that of a mod or a future game.
    """
    if kind == LZ4:
        return unpack_lz4(packed, source, MAX_CHUNK_BYTES)
    if kind not in (GZIP, ZLIB, PLAIN):
        name = _compression_name(packed, kind)
        raise InputError(
            source,
            f"chunk {position} uses {name}, which is not supported; set "
            "region-file-compression=deflate in server.properties and save the world again",
        )
    if kind == PLAIN:
        return packed
    result = unpack(packed, source, MAX_CHUNK_BYTES)
    if result is packed:
        raise DamagedFileError(source, f"chunk {position} does not have its stated compression")
    return result


def _compression_name(packed: bytes, kind: int) -> str:
    """Return the name of a compression type. A custom compression stores its own name."""
    if kind == CUSTOM and len(packed) > 2:
        name = packed[2 : 2 + int.from_bytes(packed[:2], "big")][:80]
        return f"the custom compression {name.decode('ascii', 'replace')!r}"
    return f"compression type {kind}"

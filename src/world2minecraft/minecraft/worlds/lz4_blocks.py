"""LZ4 as the game packs chunks with it: the blocks of lz4-java, each with a head and a checksum.

A head is ``LZ4Block``, a byte (how the block is packed, and how large blocks are), then, each in
four bytes of which the lowest comes first, the packed size, the size, and a checksum of the
unpacked block: xxHash32 of which the four highest bits are left out. A block of size 0 ends it.
"""

import struct
from pathlib import Path

import lz4.block
import numpy as np

from world2minecraft.core.errors import DamagedFileError, LimitError
from world2minecraft.core.jit import njit

MAGIC = b"LZ4Block"
RAW, PACKED = 0x10, 0x20
BLOCK_BITS = 16  # lz4-java's blocks of 64 KiB.
SEED, MASK = 0x9747B28C, 0x0FFFFFFF
_HEAD = struct.Struct("<8sBiiI")


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
        parts += [_HEAD.pack(*head), held]
    return b"".join([*parts, _HEAD.pack(MAGIC, RAW | BLOCK_BITS - 10, 0, 0, 0)])


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
        if at + _HEAD.size > len(data):
            raise DamagedFileError(path, "its LZ4 stream ends too early")
        magic, how, packed_size, size, stated = _HEAD.unpack_from(data, at)
        at += _HEAD.size
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
def _turned(value, bits):  # pragma: no cover
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
                lanes[lane] = (_turned(mixed, np.uint64(13)) * one) & low
        found = _turned(lanes[0], np.uint64(1)) + _turned(lanes[1], np.uint64(7))
        found += _turned(lanes[2], np.uint64(12)) + _turned(lanes[3], np.uint64(18))
    else:
        found = start + five
    found = (found + np.uint64(size)) & low
    while at + 4 <= size:
        word = np.uint64(0)
        for step in range(4):
            word |= np.uint64(data[at + step]) << np.uint64(8 * step)
        at += 4
        found = (_turned(found + word * three, np.uint64(17)) * four) & low
    while at < size:
        found = (_turned(found + np.uint64(data[at]) * five, np.uint64(11)) * one) & low
        at += 1
    found = ((found ^ found >> np.uint64(15)) * two) & low
    found = ((found ^ found >> np.uint64(13)) * three) & low
    return found ^ found >> np.uint64(16)

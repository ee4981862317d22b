"""Region files: 32 x 32 chunks in sectors of 4 KiB, with oversized chunks in files of their own."""

import struct
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from world2minecraft.errors import DamagedFileError, InputError
from world2minecraft.files import read_bytes
from world2minecraft.minecraft.nbt import unpack

SECTOR = 4096
MAX_REGION_BYTES = 512 << 20
MAX_CHUNK_BYTES = 16 << 20  # Unpacked; a chunk of 4,096 kinds of blocks in 24 sections has 4 MB.
GZIP, ZLIB, PLAIN = 1, 2, 3
EXTERNAL = 128
_HEAD = struct.Struct(">IB")


def pack_region(
    chunks: Mapping[tuple[int, int], bytes], level: int = 1
) -> tuple[bytes, dict[str, bytes]]:
    """Pack the chunks of one region.

    Args:
        chunks: NBT bytes by chunk position (x, z) in the world, all of the same region.
        level: zlib level; 1 costs a third of the time of 6 and a room is mostly sector padding.

    Returns:
        The bytes of the ``.mca``, and those of each ``.mcc`` by file name: a chunk of more than
        255 sectors lies in one.
    """
    table = np.zeros((2, 1024), ">u4")
    body: list[bytes] = []
    outside: dict[str, bytes] = {}
    sector = 2
    for (x, z), data in sorted(chunks.items(), key=lambda item: item[0][::-1]):
        packed = zlib.compress(data, level)
        kind = ZLIB
        if len(packed) + _HEAD.size > 255 * SECTOR:
            outside[f"c.{x}.{z}.mcc"] = packed
            packed, kind = b"", ZLIB | EXTERNAL
        record = _HEAD.pack(len(packed) + 1, kind) + packed
        record += bytes(-len(record) % SECTOR)
        count = len(record) // SECTOR
        table[0, (x & 31) + (z & 31) * 32] = sector << 8 | count
        body.append(record)
        sector += count
    return b"".join([table.tobytes(), *body]), outside


def read_region(path: Path) -> Iterator[tuple[tuple[int, int], bytes]]:
    """Read the chunks of a region file: the position of each in the world and its NBT bytes.

    Raises:
        InputError: the file cannot be read. DamagedFileError: it is no region file.
        LimitError: it or a chunk of it is too large.
    """
    region_x, region_z = region_position(path)
    data = read_bytes(path, MAX_REGION_BYTES)
    if not data:
        return  # The game leaves empty files where it never wrote a chunk.
    if len(data) < 2 * SECTOR:
        raise DamagedFileError(path, f"is no region file: it has {len(data)} bytes, no whole head")
    locations = np.frombuffer(data, ">u4", 1024).tolist()
    taken: set[int] = set()
    for slot, location in enumerate(locations):
        if location:
            sectors = range(location >> 8, (location >> 8) + (location & 255))
            if sectors.start < 2 or not sectors or not taken.isdisjoint(sectors):
                raise DamagedFileError(path, f"chunk {slot} lies on the head or on another chunk")
            taken.update(sectors)
            position = (region_x * 32 + slot % 32, region_z * 32 + slot // 32)
            yield position, _read_chunk(path, data, position, sectors)


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


def _read_chunk(path: Path, data: bytes, position: tuple[int, int], sectors: range) -> bytes:
    start = sectors.start * SECTOR
    if start + _HEAD.size > len(data):
        raise DamagedFileError(path, f"ends before its chunk {position}")
    length, kind = _HEAD.unpack_from(data, start)
    packed = data[start + _HEAD.size : start + 4 + length]
    if not 1 <= length <= len(sectors) * SECTOR - 4 or len(packed) != length - 1:
        raise DamagedFileError(path, f"chunk {position} says {length:,} bytes and holds fewer")
    source = path
    if kind & EXTERNAL:
        source = path.parent / f"c.{position[0]}.{position[1]}.mcc"
        packed = read_bytes(source, MAX_CHUNK_BYTES)
    if kind & 127 == PLAIN:
        return packed
    if kind & 127 not in (GZIP, ZLIB):
        reason = f"chunk {position} is packed in way {kind & 127} (4 is LZ4), which is not read"
        raise InputError(source, f"{reason}; open the world once with deflate and save it")
    result = unpack(packed, source, MAX_CHUNK_BYTES)
    if result is packed:
        raise DamagedFileError(source, f"chunk {position} is not packed as it says")
    return result

"""Region files with some chunks replaced: every other chunk keeps its bytes as they lie there.

Reading a whole world and writing it again would pack each of its chunks anew, and lose what a mod
keeps there. Here the table is made anew, and the records of untouched chunks are copied.
"""

import struct
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_bytes
from world2minecraft.minecraft.worlds.anvil import (
    EXTERNAL,
    MAX_CHUNK_BYTES,
    SECTOR,
    ZLIB,
    region_position,
    unpack_chunk,
)

Place = tuple[int, int]
MAX_EDITED_BYTES = 128 << 20  # It is held three times; regions of players have 2 to 20 MB.
LEVEL = 1  # As anvil.pack_region: a third of the time of 6, and most of a file is padding.
MOST_SECTORS = 255  # A longer record lies in a file of its own.
_HEAD = struct.Struct(">IB")


@dataclass(frozen=True)
class RegionFile:
    """A region file as it lies on disk.

    ``records`` are the packed chunks by their place in the world, each with the byte before it
    that says how it is packed; ``times`` are when each was saved, in seconds.
    """

    path: Path
    records: Mapping[Place, bytes] = field(default_factory=dict)
    times: Mapping[Place, int] = field(default_factory=dict)

    def chunk(self, place: Place) -> bytes | None:
        """Return the NBT of a chunk, or None where the file has none there.

        Raises:
            DamagedFileError: it is not packed as it says. LimitError: it is too large.
        """
        record = self.records.get(place)
        if record is None:
            return None
        kind, packed = record[0], record[1:]
        source = self.path
        if kind & EXTERNAL:
            source = self.path.parent / outside_name(place)
            packed = read_bytes(source, MAX_CHUNK_BYTES)
        return unpack_chunk(packed, kind & ~EXTERNAL, source, place)

    def with_chunks(self, chunks: Mapping[Place, bytes]) -> dict[str, bytes | None]:
        """Return the files that change when chunks are put in: their bytes, by name.

        None stands for a file that must go. Nothing is written.

        Args:
            chunks: NBT by place, all within this region.
        """
        records, changed = dict(self.records), {}
        for place, data in sorted(chunks.items()):
            packed, name = zlib.compress(data, LEVEL), outside_name(place)
            was_outside = bool(records.get(place, b"\0")[0] & EXTERNAL)
            if len(packed) + _HEAD.size > MOST_SECTORS * SECTOR:
                changed[name], records[place] = packed, bytes([ZLIB | EXTERNAL])
                continue
            records[place] = bytes([ZLIB]) + packed
            if was_outside:
                changed[name] = None
        return {self.path.name: _packed(records, self.times), **changed}


def read_region_file(path: Path) -> RegionFile:
    """Read a region file without unpacking its chunks; a missing or empty file has none.

    Raises:
        DamagedFileError: it is no region file. LimitError: it is too large.
    """
    region_x, region_z = region_position(path)
    data = read_bytes(path, MAX_EDITED_BYTES) if path.exists() else b""
    if not data:
        return RegionFile(path)
    if len(data) < 2 * SECTOR:
        raise DamagedFileError(path, f"is no region file: it has {len(data)} bytes, no whole head")
    locations, times = np.frombuffer(data, ">u4", 2048).reshape(2, 1024).tolist()
    records: dict[Place, bytes] = {}
    saved: dict[Place, int] = {}
    for slot, location in enumerate(locations):
        if location:
            place = (region_x * 32 + slot % 32, region_z * 32 + slot // 32)
            records[place] = _record(data, location, path, place)
            saved[place] = times[slot]
    return RegionFile(path, records, saved)


def outside_name(place: Place) -> str:
    """Return the name of the file that holds a chunk too large for its region file."""
    return f"c.{place[0]}.{place[1]}.mcc"


def _record(data: bytes, location: int, path: Path, place: Place) -> bytes:
    start, sectors = (location >> 8) * SECTOR, location & 255
    if start < 2 * SECTOR or not sectors or start + _HEAD.size > len(data):
        raise DamagedFileError(path, f"chunk {place} lies on the head or beyond the end")
    length = _HEAD.unpack_from(data, start)[0]
    record = data[start + 4 : start + 4 + length]
    if not 1 <= length <= sectors * SECTOR - 4 or len(record) != length:
        raise DamagedFileError(path, f"chunk {place} says {length:,} bytes and holds fewer")
    return record


def _packed(records: Mapping[Place, bytes], times: Mapping[Place, int]) -> bytes:
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

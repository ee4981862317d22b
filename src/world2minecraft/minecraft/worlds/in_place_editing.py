"""In-place editing of chunks of 1.18 and later, which keeps all other data of their region files.

Reading and rewriting a whole world would repack every chunk and lose the data of mods. This module
instead rebuilds the table of a region file and copies the records of unchanged chunks.
"""

import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError, InputError, UsageError
from world2minecraft.core.files import read_bytes
from world2minecraft.core.types import AIR, BlockEntity
from world2minecraft.minecraft.bit_packing import (
    SECTION,
    pack_section,
    repack_section_words,
    unpack_section,
)
from world2minecraft.minecraft.nbt import Byte, Long, NbtLimits, NbtReader
from world2minecraft.minecraft.state_nbt import state_entry, state_text
from world2minecraft.minecraft.worlds.anvil import (
    EXTERNAL,
    MAX_CHUNK_BYTES,
    MAX_SECTORS,
    SECTOR,
    ZLIB,
    outside_name,
    pack_chunk,
    pack_records,
    region_position,
    unpack_chunk,
)

MAX_EDITED_BYTES = 128 << 20  # It is held three times; regions of players have 2 to 20 MB.
_RECORD_HEADER = struct.Struct(">IB")
FIRST_DATA_VERSION = 2860  # 1.18, the first game with this layout.
FULL = ("minecraft:full", "full")
LIMITS = NbtLimits(depth=512, values=2_000_000, bytes=64 << 20)
LIGHT_KEYS = ("BlockLight", "SkyLight")
VOID_BIOMES = {"palette": ["minecraft:the_void"]}


Place = tuple[int, int]


@dataclass(frozen=True)
class RegionFile:
    """The content of a region file.

    ``records`` contains the compressed chunks by world position, each after its compression byte.
    ``times`` contains the time in seconds at which each chunk was saved.
    """

    path: Path
    records: Mapping[Place, bytes] = field(default_factory=dict)
    times: Mapping[Place, int] = field(default_factory=dict)

    def chunk(self, place: Place) -> bytes | None:
        """Return the NBT bytes of a chunk, or None if the file does not contain it.

        Raises:
            DamagedFileError: If the data does not match the stated compression.
            LimitError: If the chunk exceeds the size limit.
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
        """Return the files that change if chunks are replaced, as bytes by file name.

        None marks a file to delete. No file is written.

        Args:
            chunks: NBT bytes by chunk position, all in this region.
        """
        records, changed = dict(self.records), {}
        for place, data in sorted(chunks.items()):
            packed, name = pack_chunk(data), outside_name(place)
            was_outside = bool(records.get(place, b"\0")[0] & EXTERNAL)
            if len(packed) + _RECORD_HEADER.size > MAX_SECTORS * SECTOR:
                changed[name], records[place] = packed, bytes([ZLIB | EXTERNAL])
                continue
            records[place] = bytes([ZLIB]) + packed
            if was_outside:
                changed[name] = None
        return {self.path.name: pack_records(records, self.times), **changed}


def read_region_file(path: Path) -> RegionFile:
    """Read a region file without decompressing its chunks. A missing file has no chunks.

    Raises:
        DamagedFileError: If the file is not a valid region file.
        LimitError: If the file exceeds the size limit.
    """
    region_x, region_z = region_position(path)
    data = read_bytes(path, MAX_EDITED_BYTES) if path.exists() else b""
    if not data:
        return RegionFile(path)
    if len(data) < 2 * SECTOR:
        raise DamagedFileError(
            path, f"is not a valid region file: the header is incomplete ({len(data)} bytes)"
        )
    locations, times = np.frombuffer(data, ">u4", 2048).reshape(2, 1024).tolist()
    records: dict[Place, bytes] = {}
    saved: dict[Place, int] = {}
    for slot, location in enumerate(locations):
        if location:
            place = (region_x * 32 + slot % 32, region_z * 32 + slot // 32)
            records[place] = _record(data, location, path, place)
            saved[place] = times[slot]
    return RegionFile(path, records, saved)


def _record(data: bytes, location: int, path: Path, place: Place) -> bytes:
    start, sectors = (location >> 8) * SECTOR, location & 255
    if start < 2 * SECTOR or not sectors or start + _RECORD_HEADER.size > len(data):
        raise DamagedFileError(path, f"chunk {place} overlaps the header or is beyond the end")
    length = _RECORD_HEADER.unpack_from(data, start)[0]
    record = data[start + 4 : start + 4 + length]
    if not 1 <= length <= sectors * SECTOR - 4 or len(record) != length:
        raise DamagedFileError(path, f"chunk {place} declares {length:,} bytes but contains fewer")
    return record


@dataclass
class StateNumbers:
    """A shared index of the block states of many chunks, with the original NBT of each state."""

    texts: list[str] = field(default_factory=lambda: [AIR])
    entries: dict[int, dict[str, Any]] = field(default_factory=dict)
    _numbers: dict[str, int] = field(default_factory=lambda: {AIR: 0})

    def number(self, state: str, entry: dict[str, Any] | None = None) -> int:
        """Return the index of a state, and add the state if it is new.

        Args:
            state: The block state.
            entry: The NBT from which the state was read, if any.
        """
        if state not in self._numbers:
            if len(self.texts) > np.iinfo(np.uint16).max:
                raise InputError("palette", "exceeds the limit of 65,536 block states")
            self._numbers[state] = len(self.texts)
            self.texts.append(state)
        number = self._numbers[state]
        if entry is not None:
            self.entries.setdefault(number, entry)
        return number


class _Reader(NbtReader):
    must_end = False  # The game ignores bytes after a chunk, and other servers leave some there.


def parse_chunk(data: bytes, place: Place, path: Path) -> dict[str, Any] | None:
    """Return the NBT tree of a chunk, or None if the game has not finished generating it.

    Args:
        data: The NBT bytes of the chunk.
        place: The chunk's position in the world, in chunks.
        path: The file path for error messages.

    Raises:
        DamagedFileError: If the chunk is damaged or states a different position.
        LimitError: If the chunk exceeds the NBT limits.
        InputError: If the chunk was written by a game before 1.18.
    """
    _, root = _Reader(data, path, LIMITS).root()
    version = root.get("DataVersion", 0)
    if not isinstance(version, int) or version < FIRST_DATA_VERSION:
        raise InputError(
            path,
            f"chunk {place} was saved before Minecraft 1.18 (data version {version}); "
            "visit this place in a newer game and save the world",
        )
    stated = (root.get("xPos"), root.get("zPos"))
    if stated != place:
        raise DamagedFileError(path, f"chunk {place} states the position {stated}")
    for key in ("sections", "block_entities"):
        held = root.setdefault(key, [])
        if not isinstance(held, list) or not all(isinstance(entry, dict) for entry in held):
            raise DamagedFileError(
                path, f"chunk {place} contains a tag {key} that is not a list of compounds"
            )
    if not all(isinstance(section.get("Y"), int) for section in root["sections"]):
        raise DamagedFileError(path, f"chunk {place} contains a section without a Y position")
    return root if root.get("Status") in FULL else None


def new_chunk(place: Place, data_version: int, min_section: int) -> dict[str, Any]:
    """Return the NBT tree of a chunk of air that the game accepts as finished.

    Args:
        place: The chunk's position in the world, in chunks.
        data_version: The data version of the world.
        min_section: The y position of the lowest section, such as -4.
    """
    return {
        "DataVersion": data_version,
        "xPos": place[0],
        "zPos": place[1],
        "yPos": min_section,
        "Status": FULL[0],
        "LastUpdate": Long(0),
        "InhabitedTime": Long(0),
        "isLightOn": Byte(0),
        "Heightmaps": {},
        "structures": {"References": {}, "starts": {}},
        "block_ticks": [],
        "fluid_ticks": [],
        "PostProcessing": [],
        "block_entities": [],
        "sections": [],
    }


def read_sections(root: dict[str, Any], path: Path, numbers: StateNumbers) -> dict[int, np.ndarray]:
    """Return the blocks of a chunk as uint16 [16, 16, 16] (x, y, z) by section y position.

    Raises:
        DamagedFileError: If a section is damaged.
    """
    found = {}
    for section in root["sections"]:
        try:
            blocks = section.get("block_states")
            if blocks is None:
                continue
            local = [numbers.number(state_text(entry), entry) for entry in blocks["palette"]]
            words = blocks.get("data", np.zeros(0, np.int64)).view(np.uint64)
            place = int(section["Y"])
        except (*MALFORMED, UsageError) as error:
            raise DamagedFileError(path, f"contains a damaged section ({error})") from error
        cells = np.zeros((16, 16, 16), np.uint16)
        is_sized = 1 <= len(local) <= SECTION
        packed = repack_section_words(words, len(local), straddles=False) if is_sized else None
        if packed is None:
            states, count = len(local), len(words)
            raise DamagedFileError(path, f"section {place} has {states} states but {count} words")
        if not unpack_section(packed, np.array(local, np.uint16), cells, np.zeros(3, np.int64)):
            raise DamagedFileError(
                path, f"section {place} contains a block index that is not in its palette"
            )
        found[place] = cells
    return found


def set_section(root: dict[str, Any], place: int, cells: np.ndarray, numbers: StateNumbers) -> None:
    """Set the blocks of a section in a chunk's NBT tree, in place. A missing section is created.

    Args:
        root: The NBT tree of the chunk.
        place: The y position of the section.
        cells: Blocks as uint16 [16, 16, 16], indices of ``numbers``.
        numbers: The index of block states.
    """
    met = np.zeros(SECTION, np.uint16)
    words = np.zeros(SECTION // 4, np.uint64)
    blank = np.full(len(numbers.texts), -1, np.int32)
    count, used = pack_section(cells, np.zeros(3, np.int64), blank, met, words)
    version = root["DataVersion"]
    blocks: dict[str, Any] = {
        "palette": [
            numbers.entries.get(number) or state_entry(numbers.texts[number], version)
            for number in met[:count].tolist()
        ]
    }
    if used:
        blocks["data"] = words[:used].view(np.int64)
    for section in root["sections"]:
        if int(section["Y"]) == place:
            section["block_states"] = blocks
            section.setdefault("biomes", VOID_BIOMES)
            return
    near = min(root["sections"], key=lambda s: abs(int(s["Y"]) - place), default={})
    biomes = near.get("biomes", VOID_BIOMES)
    root["sections"].append({"Y": Byte(place), "block_states": blocks, "biomes": biomes})
    root["sections"].sort(key=lambda section: int(section["Y"]))


def set_block_entities(root: dict[str, Any], entities: Sequence[BlockEntity]) -> None:
    """Replace the block entities of a chunk, in place."""
    root["block_entities"] = [
        {
            **entity.nbt,
            "id": entity.id,
            **dict(zip("xyz", (int(v) for v in entity.block_pos), strict=True)),
        }
        for entity in entities
    ]


def clear_light(root: dict[str, Any]) -> None:
    """Remove the light and height maps of a changed chunk, so that the game recomputes them.

    The light tags of Paper servers are removed too.
    """
    root["isLightOn"] = Byte(0)
    root["Heightmaps"] = {}
    for key in [key for key in root if key.startswith("starlight.")]:
        del root[key]
    for section in root["sections"]:
        for key in [k for k in section if k in LIGHT_KEYS or k.startswith("starlight.")]:
            del section[key]

"""Chunks, columns of sections: written as since 1.18, read as since 1.13."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UsageError
from world2minecraft.minecraft.nbt import (
    BYTE,
    COMPOUND,
    END,
    LIST,
    LONGS,
    Byte,
    Long,
    NbtLimits,
    NbtReader,
    write_nbt,
)
from world2minecraft.minecraft.packing import skip_texts
from world2minecraft.minecraft.state_nbt import state_text
from world2minecraft.minecraft.versions import GameVersion
from world2minecraft.minecraft.worlds.old_chunks import (
    FIRST_DATA_VERSION,
    FIRST_WITHOUT_LEVEL,
    flattened,
    old_sections,
)
from world2minecraft.minecraft.worlds.sections import Section, SectionPacker, section_of

PALETTES = ("palette", "Palette")  # Since 1.18, and before.
MAX_KNOWN = 100_000  # Texts of states of one world, some of them the same in other orders.
VOID_BIOME = "minecraft:the_void"
CHUNK_LIMITS = NbtLimits(depth=64, values=500_000, bytes=16 << 20)


class ChunkWriter:
    """Writes the chunks of one volume."""

    def __init__(self, states: np.ndarray, palette: Sequence[str], version: GameVersion):
        self._packer = SectionPacker(states, palette, version.level_data_version)
        self._entries = [write_nbt(entry)[3:] for entry in self._packer.entries]
        self._height = states.shape[1]
        self._version = version
        self._biomes = _named(COMPOUND, "biomes", write_nbt({"palette": [VOID_BIOME]})[3:])

    def chunk(
        self,
        place: tuple[int, int],
        corner: tuple[int, int, int],
        block_entities: Sequence[Mapping[str, Any]] = (),
    ) -> bytes | None:
        """Return the NBT of the chunk at ``place`` (x, z), or None where all of it is air.

        Args:
            place: the chunk's position in the world, in chunks.
            corner: the world position of the volume's first cell.
            block_entities: NBT of the block entities in this chunk.
        """
        low = corner[1] >> 4
        high = (corner[1] + self._height - 1) >> 4
        sections = []
        for y in range(low, high + 1):
            at = (place[0] * 16 - corner[0], y * 16 - corner[1], place[1] * 16 - corner[2])
            section = self._section(y, np.array(at, np.int64))
            if section is not None:
                sections.append(section)
        if not sections and not block_entities:
            return None
        root = {
            "DataVersion": self._version.level_data_version,
            "xPos": place[0],
            "zPos": place[1],
            "yPos": self._version.min_y >> 4,
            "Status": "minecraft:full",
            "LastUpdate": Long(0),
            "InhabitedTime": Long(0),
            "isLightOn": Byte(0),  # The game lights the chunk when it loads it.
            "Heightmaps": {},
            "structures": {"References": {}, "starts": {}},
            "block_ticks": [],
            "fluid_ticks": [],
            "PostProcessing": [],
            "block_entities": [dict(entity) for entity in block_entities],
        }
        head = _named(LIST, "sections", bytes([COMPOUND]) + len(sections).to_bytes(4, "big"))
        return b"".join([write_nbt(root)[:-1], head, *sections, bytes([END])])

    def _section(self, y: int, origin: np.ndarray) -> bytes | None:
        packed = self._packer.numbers(origin)
        if packed is None:
            return None
        met, words = packed
        parts = [
            _named(BYTE, "Y", (y & 255).to_bytes(1, "big")),
            _named(COMPOUND, "block_states", b""),
            _named(LIST, "palette", bytes([COMPOUND]) + len(met).to_bytes(4, "big")),
            *[self._entries[number] for number in met],
        ]
        if len(words):
            parts += [_named(LONGS, "data", len(words).to_bytes(4, "big"))]
            parts += [words.astype(">u8").tobytes()]
        return b"".join([*parts, bytes([END]), self._biomes, bytes([END])])


class _ChunkReader(NbtReader):
    """Reads the entries of palettes as texts of states, the same bytes only once.

    Most sections of a world share their states: it makes reading three times as fast.
    """

    # The game ignores bytes after a chunk, and servers that are not Mojang's leave some there.
    must_end = False

    def __init__(self, data: bytes, path: Path, known: dict[bytes, str]):
        super().__init__(data, path, CHUNK_LIMITS)
        self._known = known

    def elements(self, tag: int, count: int, depth: int) -> list[Any]:
        """Read a list's elements; of a palette those seen before are not parsed again."""
        ends = np.empty(count if tag == COMPOUND and self.key in PALETTES else 0, np.int64)
        if not len(ends) or not skip_texts(np.frombuffer(self.data, np.uint8), self.at, ends):
            return super().elements(tag, count, depth)
        found = []
        for end in ends.tolist():
            raw = self.data[self.at : end]
            if raw not in self._known:
                if len(self._known) >= MAX_KNOWN:
                    raise LimitError(self.path, f"holds over {MAX_KNOWN:,} block states")
                self._known[raw] = state_text(self.compound(depth + 1))
            found.append(self._known[raw])
            self.at = end
        return found


def read_chunk(
    data: bytes, place: tuple[int, int], path: Path, known: dict[bytes, str]
) -> tuple[dict[str, Any], Iterator[Section]]:
    """Read a chunk and return its NBT and an iterator over its sections.

    Args:
        data: the chunk's NBT.
        place: its position in the world, in chunks.
        path: the file that errors name.
        known: what palettes held so far; one mapping for all chunks of a world.

    Raises:
        DamagedFileError: it is no chunk, or lies in another place than it says.
        LimitError: it asks for too much. InputError: it is of a game before 1.13.
    """
    try:
        _, root = _ChunkReader(data, path, known).root()
    except UsageError as error:
        raise DamagedFileError(path, f"chunk {place} has a palette with {error}") from error
    version = root.get("DataVersion", 0)
    if not isinstance(version, int) or version < FIRST_DATA_VERSION:
        reason = f"chunk {place} is of a game before 1.13 (data version {version})"
        advice = "in a newer game's list of worlds choose Edit, then Optimize World"
        raise InputError(path, f"{reason}; {advice}, or give a --box that was played in since")
    is_old = version < FIRST_WITHOUT_LEVEL or "Level" in root
    if is_old:
        root = flattened(root, place, path)
    if (root.get("xPos"), root.get("zPos")) != place:
        stated = (root.get("xPos"), root.get("zPos"))
        raise DamagedFileError(path, f"chunk {place} says that it is chunk {stated}")
    if not isinstance(root.get("sections", []), list):
        raise DamagedFileError(path, f"chunk {place} has sections that are no list")
    return root, (old_sections if is_old else _sections)(root, place, path)


def _sections(root: Mapping[str, Any], place: tuple[int, int], path: Path) -> Iterator[Section]:
    version = root["DataVersion"]
    for section in root.get("sections", []):
        if not isinstance(section, dict):
            raise DamagedFileError(path, f"chunk {place} has a broken section")
        blocks = section.get("block_states")
        if blocks is not None:
            height = section.get("Y")
            found = section_of(blocks, "palette", "data", place, path, version, y=height)
            if found is not None:
                yield found


def _named(tag: int, name: str, payload: bytes) -> bytes:
    raw = name.encode("ascii")
    return bytes([tag]) + len(raw).to_bytes(2, "big") + raw + payload

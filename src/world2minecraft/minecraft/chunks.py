"""Chunks of 1.18 and later: columns of sections, each with a palette of its own."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.errors import DamagedFileError, InputError, UsageError
from world2minecraft.minecraft.entries import state_entry, state_text
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
from world2minecraft.minecraft.packing import SECTION, pack_section, skip_texts
from world2minecraft.minecraft.versions import GameVersion

FIRST_DATA_VERSION = 2860  # 1.18, the first game with this layout.
VOID_BIOME = "minecraft:the_void"
CHUNK_LIMITS = NbtLimits(depth=64, values=500_000, bytes=16 << 20)


@dataclass(frozen=True)
class Section:
    """One packed section: ``place`` counts sections along x, y, z in the world."""

    place: tuple[int, int, int]
    palette: tuple[str, ...]
    words: np.ndarray  # uint64 [N], N = 0 where one state fills it


class ChunkWriter:
    """Writes the chunks of one volume."""

    def __init__(self, states: np.ndarray, palette: Sequence[str], version: GameVersion):
        self._states = states
        level = version.level_data_version
        self._entries = [write_nbt(state_entry(state, level))[3:] for state in palette]
        self._version = version
        self._numbers = np.full(len(palette), -1, np.int32)
        self._met = np.zeros(SECTION, np.uint16)
        self._words = np.zeros(SECTION // 4, np.uint64)
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
        high = (corner[1] + self._states.shape[1] - 1) >> 4
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
        count, used = pack_section(self._states, origin, self._numbers, self._met, self._words)
        if count == 1 and self._met[0] == 0:
            return None
        parts = [
            _named(BYTE, "Y", (y & 255).to_bytes(1, "big")),
            _named(COMPOUND, "block_states", b""),
            _named(LIST, "palette", bytes([COMPOUND]) + count.to_bytes(4, "big")),
            *[self._entries[number] for number in self._met[:count].tolist()],
        ]
        if used:
            words = self._words[:used].astype(">u8").tobytes()
            parts += [_named(LONGS, "data", used.to_bytes(4, "big")), words]
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
        ends = np.empty(count if tag == COMPOUND and self.key == "palette" else 0, np.int64)
        if not len(ends) or not skip_texts(np.frombuffer(self.data, np.uint8), self.at, ends):
            return super().elements(tag, count, depth)
        found = []
        for end in ends.tolist():
            raw = self.data[self.at : end]
            if raw not in self._known:
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
        LimitError: it asks for too much. InputError: it is of a game before 1.18.
    """
    try:
        _, root = _ChunkReader(data, path, known).root()
    except UsageError as error:
        raise DamagedFileError(path, f"chunk {place} has a palette with {error}") from error
    version = root.get("DataVersion", 0)
    if not isinstance(version, int) or version < FIRST_DATA_VERSION:
        reason = f"chunk {place} is of a game before 1.18 (data version {version})"
        raise InputError(path, f"{reason}; open the world once in a newer game, then try again")
    if (root.get("xPos"), root.get("zPos")) != place:
        stated = (root.get("xPos"), root.get("zPos"))
        raise DamagedFileError(path, f"chunk {place} says that it is chunk {stated}")
    return root, _sections(root, place, path)


def _sections(root: dict[str, Any], place: tuple[int, int], path: Path) -> Iterator[Section]:
    sections = root.get("sections", [])
    if not isinstance(sections, list):
        raise DamagedFileError(path, f"chunk {place} has sections that are no list")
    for section in sections:
        try:
            blocks = section.get("block_states")
            if blocks is None:
                continue
            palette = tuple(map(_text_of, blocks["palette"]))
            words = blocks.get("data", np.zeros(0, np.int64)).view(np.uint64)
            y = int(section["Y"])
        except (KeyError, TypeError, AttributeError, ValueError, UsageError) as error:
            raise DamagedFileError(path, f"chunk {place} has a broken section") from error
        if not 1 <= len(palette) <= SECTION or len(words) != _word_count(len(palette)):
            reason = f"{len(palette)} states in {len(words)} words"
            raise DamagedFileError(path, f"chunk {place}, section {y} has {reason}")
        if palette != ("minecraft:air",):
            yield Section((place[0], y, place[1]), palette, words)


def _text_of(entry: str | Mapping[str, Any]) -> str:
    return entry if isinstance(entry, str) else state_text(entry)


def _word_count(states: int) -> int:
    if states == 1:
        return 0
    per_word = 64 // max(4, (states - 1).bit_length())
    return -(-SECTION // per_word)


def _named(tag: int, name: str, payload: bytes) -> bytes:
    raw = name.encode("ascii")
    return bytes([tag]) + len(raw).to_bytes(2, "big") + raw + payload

"""Chunks, which are columns of 16 x 16 x 16 sections: reading and writing for games since 1.13.

From 1.13 to 1.17, the content of a chunk is in a compound named ``Level``, and the world is 256
blocks high and starts at layer 0. Palette indices are packed without gaps until 1.15, and entities
are stored in the chunk until 1.16. Chunks are written with their light and heightmaps, which are
those of the volume in empty surroundings (``stored_light``).
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import (
    MALFORMED,
    DamagedFileError,
    InputError,
    LimitError,
    UsageError,
)
from world2minecraft.core.types import AIR, BlockEntity
from world2minecraft.minecraft.bit_packing import (
    SECTION,
    pack_section,
    repack_section_words,
    skip_text_compounds,
    straddle_section_words,
)
from world2minecraft.minecraft.block_renames import read_state
from world2minecraft.minecraft.nbt import (
    BYTE,
    BYTES,
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
from world2minecraft.minecraft.state_nbt import state_entry, state_text
from world2minecraft.minecraft.versions import GameVersion
from world2minecraft.minecraft.worlds.stored_light import (
    FIRST_WITHOUT_GAPS,
    LIGHT_BYTES,
    StoredLight,
)

FIRST_DATA_VERSION = 1451  # 17w47a, the first with palettes of named blocks.
FIRST_1_14 = 1901  # 18w43a: the game lights chunks on loading, and calls the last status full.
FIRST_1_15 = 2203  # 19w36a: a biome for each 4 x 4 x 4 blocks.
FIRST_ENTITY_FILES = 2681  # 20w45a, of 1.17: entities in files of their own.
FIRST_WITHOUT_LEVEL = 2844  # 21w43a, of 1.18.
VOID_BIOME_ID = 127
PALETTES = ("palette", "Palette")  # Since 1.18, and before.
MAX_STATE_TEXTS = 100_000  # Texts of states of one world, some of them the same in other orders.
VOID_BIOME = "minecraft:the_void"
CHUNK_LIMITS = NbtLimits(depth=64, values=500_000, bytes=16 << 20)


@dataclass(frozen=True)
class Section:
    """A packed section. ``place`` is its position in sections along x, y, z in the world."""

    place: tuple[int, int, int]
    palette: tuple[str, ...]
    words: np.ndarray  # uint64 [N] in the current packing; N = 0 for a uniform section.


class SectionPacker:
    """A packer of the chunk sections of one volume."""

    def __init__(self, states: np.ndarray, palette: Sequence[str], data_version: int):
        self.entries = [state_entry(state, data_version) for state in palette]
        self._states = states
        self._numbers = np.full(len(palette), -1, np.int32)
        self._met = np.zeros(SECTION, np.uint16)
        self._words = np.zeros(SECTION // 4, np.uint64)

    def numbers(self, origin: np.ndarray) -> tuple[list[int], np.ndarray] | None:
        """Pack the section whose first cell is at ``origin`` in the volume.

        Returns:
            The volume's palette indices of the section's states in the section's own order, and the
            packed words (a view that the next call overwrites). None if the section is all air.
        """
        count, used = pack_section(self._states, origin, self._numbers, self._met, self._words)
        if count == 1 and self._met[0] == 0:
            return None
        return self._met[:count].tolist(), self._words[:used]

    def column(
        self, place: tuple[int, int], corner: tuple[int, int, int], height: int
    ) -> Iterator[tuple[int, tuple[list[dict[str, Any]], np.ndarray]]]:
        """Yield the sections of a chunk from bottom to top: y, palette entries and packed words."""
        for y in range(corner[1] >> 4, (corner[1] + height - 1 >> 4) + 1):
            at = (place[0] * 16 - corner[0], y * 16 - corner[1], place[1] * 16 - corner[2])
            packed = self.numbers(np.array(at, np.int64))
            if packed is not None:
                yield y, ([self.entries[n] for n in packed[0]], packed[1].copy())


def read_section(
    blocks: Any,
    palette_key: str,
    words_key: str,
    place: tuple[int, int],
    path: Path,
    data_version: int,
    *,
    straddles: bool = False,
    y: Any = None,
) -> Section | None:
    """Read a section from its NBT, or return None if it is all air.

    Args:
        blocks: The compound with the palette and the packed words.
        palette_key: The name of the palette tag.
        words_key: The name of the tag with the packed words.
        place: The chunk's position in the world, in chunks.
        path: The file path for error messages.
        data_version: The data version of the game that wrote the chunk.
        straddles: Whether palette indices cross word boundaries, as before 1.16.
        y: The section's y position. The default is the tag ``Y`` of ``blocks``.

    Raises:
        DamagedFileError: If the section is damaged.
    """
    try:
        palette = tuple(read_state(_text_of(held), data_version) for held in blocks[palette_key])
        words = blocks.get(words_key, np.zeros(0, np.int64))
        if words.dtype != np.int64:
            raise ValueError
        words = words.view(np.uint64)
        height = int(blocks["Y"] if y is None else y)
    except (*MALFORMED, UsageError) as error:
        raise DamagedFileError(path, f"chunk {place} contains a damaged section") from error
    is_sized = 1 <= len(palette) <= SECTION
    packed = repack_section_words(words, len(palette), straddles=straddles) if is_sized else None
    if packed is None:
        states, count = len(palette), len(words)
        raise DamagedFileError(
            path, f"chunk {place}, section {height} has {states} states but {count} words"
        )
    if palette == (AIR,):
        return None
    return Section((place[0], height, place[1]), palette, packed)


def _text_of(entry: str | Mapping[str, Any]) -> str:
    return entry if isinstance(entry, str) else state_text(entry)


def upgrade_old_chunk(
    root: Mapping[str, Any], place: tuple[int, int], path: Path
) -> dict[str, Any]:
    """Convert the NBT tree of an old chunk to the current tag names.

    Raises:
        DamagedFileError: If the tag ``Level`` is missing or invalid.
    """
    level = root.get("Level")
    if not isinstance(level, dict):
        raise DamagedFileError(path, f"chunk {place} has no Level tag")
    names = {"TileEntities": "block_entities", "Entities": "Entities", "Sections": "sections"}
    held = {new: level.get(old, []) for old, new in names.items()}
    same = {key: level[key] for key in ("xPos", "zPos", "Status") if key in level}
    return {"DataVersion": root["DataVersion"], **same, **held}


def old_sections(root: Mapping[str, Any], place: tuple[int, int], path: Path) -> Iterator[Section]:
    """Yield the sections of a chunk from 1.13 to 1.17 that are not all air.

    Raises:
        DamagedFileError: If a section is damaged.
    """
    version = root["DataVersion"]
    straddles = version < FIRST_WITHOUT_GAPS
    for nbt in root["sections"]:
        if isinstance(nbt, dict) and "Palette" not in nbt:
            continue  # It holds light alone.
        found = read_section(
            nbt, "Palette", "BlockStates", place, path, version, straddles=straddles
        )
        if found is not None:
            yield found


class OldChunkWriter:
    """A writer of the chunks of one volume for a game from 1.13 to 1.17."""

    def __init__(
        self,
        states: np.ndarray,
        palette: Sequence[str],
        corner: tuple[int, int, int],
        version: GameVersion,
    ):
        self._packer = SectionPacker(states, palette, version.level_data_version)
        self._corner, self._height = corner, states.shape[1]
        self._version = version.level_data_version
        self._light = StoredLight(states, palette, corner, version)

    def chunk(
        self,
        place: tuple[int, int],
        block_entities: Sequence[Mapping[str, Any]] = (),
        entities: Sequence[Mapping[str, Any]] = (),
    ) -> bytes | None:
        """Return the NBT of a chunk, or None if it is empty.

        Args:
            place: The chunk's position (x, z) in the world, in chunks.
            block_entities: NBT of the block entities in this chunk.
            entities: NBT of the entities in this chunk, for games that store them in chunks.
        """
        held = entities if self._version < FIRST_ENTITY_FILES else ()
        blocks = dict(self._packer.column(place, self._corner, self._height))
        if not (blocks or block_entities or held):
            return None
        light = self._light.sections(place, blocks)
        air = None
        if self._version < FIRST_1_14:  # Its sections are 0 to 15, and all have blocks.
            air = ([self._packer.entries[0]], np.zeros(0, np.uint64))
            light = {y: tags for y, tags in light.items() if 0 <= y < 16}
        sections = [
            self._section(y, blocks.get(y, air), light.get(y, {}))
            for y in sorted({*blocks, *light})
        ]
        level = {
            "xPos": place[0],
            "zPos": place[1],
            "Status": "full" if self._version >= FIRST_1_14 else "postprocessed",
            "LastUpdate": Long(0),
            "InhabitedTime": Long(0),
            "Biomes": np.full(
                1024 if self._version >= FIRST_1_15 else 256, VOID_BIOME_ID, np.int32
            ),
            "Heightmaps": self._light.heightmaps(place),
            "Structures": {"References": {}, "Starts": {}},
            "TileTicks": [],
            "LiquidTicks": [],
            "PostProcessing": [],
            "TileEntities": [dict(entity) for entity in block_entities],
            "Entities": [dict(entity) for entity in held],
        }
        if self._version >= FIRST_1_14:
            level["isLightOn"] = Byte(1)
        head = write_nbt({"DataVersion": self._version})[:-1]
        body = write_nbt({"Level": {**level, "Sections": sections}})[3:]
        return head + body

    def _section(
        self,
        y: int,
        packed: tuple[list[dict[str, Any]], np.ndarray] | None,
        light: Mapping[str, bytes],
    ) -> dict[str, Any]:
        section: dict[str, Any] = {"Y": Byte(y)}
        if packed is not None:
            entries, words = packed
            if self._version < FIRST_WITHOUT_GAPS or not len(words):
                words = straddle_section_words(words, len(entries))
            section |= {"Palette": entries, "BlockStates": words.view(np.int64)}
        if self._version < FIRST_1_14:  # It lights nothing on loading, and expects both.
            section["BlockLight"] = np.zeros(LIGHT_BYTES, np.int8)
            section["SkyLight"] = np.full(LIGHT_BYTES, -1, np.int8)
        return section | {name: np.frombuffer(levels, np.int8) for name, levels in light.items()}


class ChunkWriter:
    """A writer of the chunks of one volume for a game since 1.18."""

    def __init__(
        self,
        states: np.ndarray,
        palette: Sequence[str],
        corner: tuple[int, int, int],
        version: GameVersion,
    ):
        self._packer = SectionPacker(states, palette, version.level_data_version)
        self._light = StoredLight(states, palette, corner, version)
        self._corner = corner
        self._entries = [write_nbt(entry)[3:] for entry in self._packer.entries]
        self._height = states.shape[1]
        self._version = version
        self._biomes = _named_tag(COMPOUND, "biomes", write_nbt({"palette": [VOID_BIOME]})[3:])
        self._air = self._block_tags([0], np.zeros(0, np.uint64))

    def chunk(
        self,
        place: tuple[int, int],
        block_entities: Sequence[Mapping[str, Any]] = (),
    ) -> bytes | None:
        """Return the NBT of a chunk, or None if it is empty.

        Args:
            place: The chunk's position (x, z) in the world, in chunks.
            block_entities: NBT of the block entities in this chunk.
        """
        blocks = dict(self._blocks(place))
        if not blocks and not block_entities:
            return None
        light = self._light.sections(place, blocks)
        lowest = self._version.min_y >> 4
        sections = [
            self._section(y, blocks.get(y, self._air if y >= lowest else b""), light.get(y, {}))
            for y in sorted({*blocks, *light})
        ]
        root = {
            "DataVersion": self._version.level_data_version,
            "xPos": place[0],
            "zPos": place[1],
            "yPos": self._version.min_y >> 4,
            "Status": "minecraft:full",
            "LastUpdate": Long(0),
            "InhabitedTime": Long(0),
            "isLightOn": Byte(1),
            "Heightmaps": self._light.heightmaps(place),
            "structures": {"References": {}, "starts": {}},
            "block_ticks": [],
            "fluid_ticks": [],
            "PostProcessing": [],
            "block_entities": [dict(entity) for entity in block_entities],
        }
        head = _named_tag(LIST, "sections", bytes([COMPOUND]) + len(sections).to_bytes(4, "big"))
        return b"".join([write_nbt(root)[:-1], head, *sections, bytes([END])])

    def _blocks(self, place: tuple[int, int]) -> Iterator[tuple[int, bytes]]:
        """Yield the y and the tags of the blocks of each section that is not all air."""
        x, low, z = self._corner
        for y in range(low >> 4, (low + self._height - 1 >> 4) + 1):
            at = (place[0] * 16 - x, y * 16 - low, place[1] * 16 - z)
            packed = self._packer.numbers(np.array(at, np.int64))
            if packed is not None:
                yield y, self._block_tags(*packed)

    def _block_tags(self, met: list[int], words: np.ndarray) -> bytes:
        parts = [
            _named_tag(COMPOUND, "block_states", b""),
            _named_tag(LIST, "palette", bytes([COMPOUND]) + len(met).to_bytes(4, "big")),
            *[self._entries[number] for number in met],
        ]
        if len(words):
            parts += [_named_tag(LONGS, "data", len(words).to_bytes(4, "big"))]
            parts += [words.astype(">u8").tobytes()]
        return b"".join([*parts, bytes([END]), self._biomes])

    def _section(self, y: int, blocks: bytes, light: Mapping[str, bytes]) -> bytes:
        parts = [_named_tag(BYTE, "Y", (y & 255).to_bytes(1, "big")), blocks]
        for name, levels in light.items():
            parts += [_named_tag(BYTES, name, len(levels).to_bytes(4, "big")), levels]
        return b"".join([*parts, bytes([END])])


class _ChunkReader(NbtReader):
    """A reader of chunks that converts palette entries to state texts and caches them.

    Most sections of a world share their states, so the cache makes reading three times as fast.
    """

    # The game ignores bytes after a chunk, and servers that are not Mojang's leave some there.
    must_end = False

    def __init__(self, data: bytes, path: Path, known: dict[bytes, str]):
        super().__init__(data, path, CHUNK_LIMITS)
        self._known = known

    def elements(self, tag: int, count: int, depth: int) -> list[Any]:
        """Read the elements of a list, using cached palette entries."""
        ends = np.empty(count if tag == COMPOUND and self.key in PALETTES else 0, np.int64)
        if not len(ends) or not skip_text_compounds(
            np.frombuffer(self.data, np.uint8), self.at, ends
        ):
            return super().elements(tag, count, depth)
        found = []
        for end in ends.tolist():
            raw = self.data[self.at : end]
            if raw not in self._known:
                if len(self._known) >= MAX_STATE_TEXTS:
                    raise LimitError(
                        self.path, f"exceeds the limit of {MAX_STATE_TEXTS:,} block states"
                    )
                self._known[raw] = state_text(self.compound(depth + 1))
            found.append(self._known[raw])
            self.at = end
        return found


def read_chunk(
    data: bytes, place: tuple[int, int], path: Path, known: dict[bytes, str]
) -> tuple[dict[str, Any], Iterator[Section]]:
    """Read a chunk and return its NBT and an iterator over its sections.

    Args:
        data: The NBT bytes of the chunk.
        place: The chunk's position in the world, in chunks.
        path: The file path for error messages.
        known: Cache of palette entries, shared by all chunks of a world.

    Raises:
        DamagedFileError: If the chunk is damaged or states a different position.
        LimitError: If the chunk exceeds the NBT limits.
        InputError: If the chunk was written by a game before 1.13.
    """
    try:
        _, root = _ChunkReader(data, path, known).root()
    except UsageError as error:
        raise DamagedFileError(
            path, f"chunk {place} contains an invalid palette entry: {error}"
        ) from error
    version = root.get("DataVersion", 0)
    if not isinstance(version, int) or version < FIRST_DATA_VERSION:
        raise InputError(
            path,
            f"chunk {place} was saved before Minecraft 1.13 (data version {version}); optimize "
            "the world in a newer game (Edit, Optimize World), or use a box (--box) with newer "
            "chunks",
        )
    is_old = version < FIRST_WITHOUT_LEVEL or "Level" in root
    if is_old:
        root = upgrade_old_chunk(root, place, path)
    if (root.get("xPos"), root.get("zPos")) != place:
        stated = (root.get("xPos"), root.get("zPos"))
        raise DamagedFileError(path, f"chunk {place} states the position {stated}")
    if not isinstance(root.get("sections", []), list):
        raise DamagedFileError(path, f"chunk {place} contains a sections tag that is not a list")
    return root, (old_sections if is_old else _sections)(root, place, path)


def read_block_entities(root: Mapping[str, Any], path: Path) -> list[BlockEntity]:
    """Return the block entities of a chunk.

    Raises:
        DamagedFileError: If a block entity has no ID or position.
    """
    try:
        return [_block_entity(nbt) for nbt in root.get("block_entities", [])]
    except MALFORMED as error:
        raise DamagedFileError(path, "contains a block entity without ID or position") from error


def _block_entity(nbt: Mapping[str, Any]) -> BlockEntity:
    rest = {key: nbt[key] for key in nbt if key not in ("id", "x", "y", "z")}
    return BlockEntity((int(nbt["x"]), int(nbt["y"]), int(nbt["z"])), str(nbt["id"]), rest)


def _sections(root: Mapping[str, Any], place: tuple[int, int], path: Path) -> Iterator[Section]:
    version = root["DataVersion"]
    for section in root.get("sections", []):
        if not isinstance(section, dict):
            raise DamagedFileError(path, f"chunk {place} contains a damaged section")
        blocks = section.get("block_states")
        if blocks is not None:
            height = section.get("Y")
            found = read_section(blocks, "palette", "data", place, path, version, y=height)
            if found is not None:
                yield found


def _named_tag(tag: int, name: str, payload: bytes) -> bytes:
    raw = name.encode("ascii")
    return bytes([tag]) + len(raw).to_bytes(2, "big") + raw + payload

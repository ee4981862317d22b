"""Chunks of 1.13 to 1.17, whose content lies in a compound named ``Level``.

The world is 256 blocks high and begins at 0. Until 1.15 numbers are packed without gaps; until
1.16 entities lie in the chunk. 1.13 lights nothing when it loads a chunk, so that its sections
are written with full light from the sky.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.minecraft.nbt import Byte, Long, write_nbt
from world2minecraft.minecraft.section_words import words_before_1_16
from world2minecraft.minecraft.versions import GameVersion
from world2minecraft.minecraft.worlds.sections import Section, SectionPacker, section_of

FIRST_DATA_VERSION = 1451  # 17w47a, the first with palettes of named blocks.
FIRST_1_14 = 1901  # 18w43a: the game lights chunks on loading, and calls the last status full.
FIRST_1_15 = 2203  # 19w36a: a biome for each 4 x 4 x 4 blocks.
FIRST_WITHOUT_GAPS = 2529  # 20w17a, of 1.16: no number over two words.
FIRST_ENTITY_FILES = 2681  # 20w45a, of 1.17: entities in files of their own.
FIRST_WITHOUT_LEVEL = 2844  # 21w43a, of 1.18.
VOID_BIOME = 127
_LIGHT_BYTES = 2048


def flattened(root: Mapping[str, Any], place: tuple[int, int], path: Path) -> dict[str, Any]:
    """Return an old chunk's tree with the keys that chunks have today.

    Raises:
        DamagedFileError: there is no ``Level``, or it is another thing.
    """
    level = root.get("Level")
    if not isinstance(level, dict):
        raise DamagedFileError(path, f"chunk {place} has no Level, as its data version says")
    names = {"TileEntities": "block_entities", "Entities": "Entities", "Sections": "sections"}
    held = {new: level.get(old, []) for old, new in names.items()}
    kept = {key: level[key] for key in ("xPos", "zPos", "Status") if key in level}
    return {"DataVersion": root["DataVersion"], **kept, **held}


def old_sections(root: Mapping[str, Any], place: tuple[int, int], path: Path) -> Iterator[Section]:
    """Return the sections of a flattened old chunk that are not air alone.

    Raises:
        DamagedFileError: one is broken.
    """
    version = root["DataVersion"]
    straddles = version < FIRST_WITHOUT_GAPS
    for nbt in root["sections"]:
        if isinstance(nbt, dict) and "Palette" not in nbt:
            continue  # It holds light alone.
        found = section_of(nbt, "Palette", "BlockStates", place, path, version, straddles=straddles)
        if found is not None:
            yield found


class OldChunkWriter:
    """Writes the chunks of one volume for a game from 1.13 to 1.17."""

    def __init__(self, states: np.ndarray, palette: Sequence[str], version: GameVersion):
        self._packer = SectionPacker(states, palette, version.level_data_version)
        self._height = states.shape[1]
        self._version = version.level_data_version

    def chunk(
        self,
        place: tuple[int, int],
        corner: tuple[int, int, int],
        block_entities: Sequence[Mapping[str, Any]] = (),
        entities: Sequence[Mapping[str, Any]] = (),
    ) -> bytes | None:
        """Return the NBT of the chunk at ``place`` (x, z), or None where nothing is in it.

        Args:
            place: the chunk's position in the world, in chunks.
            corner: the world position of the volume's first cell.
            block_entities: NBT of the block entities in this chunk.
            entities: NBT of the entities in this chunk, for games that keep them here.
        """
        held = entities if self._version < FIRST_ENTITY_FILES else ()
        sections = [
            self._section(y, *packed)
            for y, packed in self._packer.column(place, corner, self._height)
        ]
        if not (sections or block_entities or held):
            return None
        level = {
            "xPos": place[0],
            "zPos": place[1],
            "Status": "full" if self._version >= FIRST_1_14 else "postprocessed",
            "LastUpdate": Long(0),
            "InhabitedTime": Long(0),
            "Biomes": np.full(1024 if self._version >= FIRST_1_15 else 256, VOID_BIOME, np.int32),
            "Heightmaps": {},
            "Structures": {"References": {}, "Starts": {}},
            "TileTicks": [],
            "LiquidTicks": [],
            "PostProcessing": [],
            "TileEntities": [dict(entity) for entity in block_entities],
            "Entities": [dict(entity) for entity in held],
        }
        if self._version >= FIRST_1_14:
            level["isLightOn"] = Byte(0)  # The game lights the chunk when it loads it.
        head = write_nbt({"DataVersion": self._version})[:-1]
        body = write_nbt({"Level": {**level, "Sections": sections}})[3:]
        return head + body

    def _section(self, y: int, entries: list[dict[str, Any]], words: np.ndarray) -> dict[str, Any]:
        section: dict[str, Any] = {"Y": Byte(y), "Palette": entries}
        if self._version < FIRST_WITHOUT_GAPS or not len(words):
            words = words_before_1_16(words, len(entries))
        section["BlockStates"] = words.view(np.int64)
        if self._version < FIRST_1_14:
            section["BlockLight"] = np.zeros(_LIGHT_BYTES, np.int8)
            section["SkyLight"] = np.full(_LIGHT_BYTES, -1, np.int8)
        return section

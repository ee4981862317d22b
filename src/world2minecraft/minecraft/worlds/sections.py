"""Sections, the cubes of 16 blocks a side that chunks of all games since 1.13 are made of."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, UsageError
from world2minecraft.core.types import AIR
from world2minecraft.minecraft.block_names import read_state
from world2minecraft.minecraft.packing import SECTION, pack_section
from world2minecraft.minecraft.section_words import words_of_today
from world2minecraft.minecraft.state_nbt import state_entry, state_text
from world2minecraft.minecraft.unlabelled_volume import MISSHAPEN


@dataclass(frozen=True)
class Section:
    """One packed section: ``place`` counts sections along x, y, z in the world."""

    place: tuple[int, int, int]
    palette: tuple[str, ...]
    words: np.ndarray  # uint64 [N] as packed today, N = 0 where one state fills it


class SectionPacker:
    """Packs the sections of one volume."""

    def __init__(self, states: np.ndarray, palette: Sequence[str], data_version: int):
        self.entries = [state_entry(state, data_version) for state in palette]
        self._states = states
        self._numbers = np.full(len(palette), -1, np.int32)
        self._met = np.zeros(SECTION, np.uint16)
        self._words = np.zeros(SECTION // 4, np.uint64)

    def numbers(self, origin: np.ndarray) -> tuple[list[int], np.ndarray] | None:
        """Pack the section whose first cell lies at ``origin`` in the volume.

        Returns:
            The numbers of its states in the volume's palette, in the section's own order, and
            its words (a view that the next call overwrites); None where all of it is air.
        """
        count, used = pack_section(self._states, origin, self._numbers, self._met, self._words)
        if count == 1 and self._met[0] == 0:
            return None
        return self._met[:count].tolist(), self._words[:used]

    def column(
        self, place: tuple[int, int], corner: tuple[int, int, int], height: int
    ) -> Iterator[tuple[int, tuple[list[dict[str, Any]], np.ndarray]]]:
        """Return the sections of a chunk from below to above: y, palette entries and words."""
        for y in range(corner[1] >> 4, (corner[1] + height - 1 >> 4) + 1):
            at = (place[0] * 16 - corner[0], y * 16 - corner[1], place[1] * 16 - corner[2])
            packed = self.numbers(np.array(at, np.int64))
            if packed is not None:
                yield y, ([self.entries[n] for n in packed[0]], packed[1].copy())


def section_of(
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
    """Return a section from its NBT, or None where it is air alone.

    Args:
        blocks: the compound that holds the palette and the words.
        palette_key: the name of the palette in it.
        words_key: the name of the words in it.
        place: the chunk's position in the world, in chunks.
        path: the file that errors name.
        data_version: that of the game that wrote the chunk.
        straddles: whether numbers go over from one word to the next, as before 1.16.
        y: the section's height; ``Y`` of ``blocks`` where it is left out.

    Raises:
        DamagedFileError: it is broken.
    """
    try:
        palette = tuple(read_state(_text_of(held), data_version) for held in blocks[palette_key])
        words = blocks.get(words_key, np.zeros(0, np.int64))
        if words.dtype != np.int64:
            raise ValueError
        words = words.view(np.uint64)
        height = int(blocks["Y"] if y is None else y)
    except (*MISSHAPEN, UsageError) as error:
        raise DamagedFileError(path, f"chunk {place} has a broken section") from error
    is_sized = 1 <= len(palette) <= SECTION
    packed = words_of_today(words, len(palette), straddles=straddles) if is_sized else None
    if packed is None:
        reason = f"{len(palette)} states in {len(words)} words"
        raise DamagedFileError(path, f"chunk {place}, section {height} has {reason}")
    if palette == (AIR,):
        return None
    return Section((place[0], height, place[1]), palette, packed)


def _text_of(entry: str | Mapping[str, Any]) -> str:
    return entry if isinstance(entry, str) else state_text(entry)

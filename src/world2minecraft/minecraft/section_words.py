"""A section's packed numbers in the layouts that they have had.

Today (since 1.16) no number goes over from one word to the next, and there are as few bits as the
palette needs, four at least. Before 1.16 numbers lay without gaps; and both before and since, a
file may keep more bits than it needs.
"""

import numpy as np

from world2minecraft.minecraft.packing import SECTION
from world2minecraft.minecraft.straddled import (
    bits_for,
    pack_straddled,
    unpack_straddled,
    words_for,
)

LEAST_BITS, MOST_BITS = 4, 16


def word_count(states: int) -> int:
    """Return how many words a section of so many states has today: none where it is all one."""
    return 0 if states == 1 else _padded_count(bits_for(states, LEAST_BITS))


def words_of_today(words: np.ndarray, states: int, *, straddles: bool) -> np.ndarray | None:
    """Return a section's words as they are packed today.

    Args:
        words: uint64 [N].
        states: how many states the section's palette has.
        straddles: whether numbers go over from one word to the next, as before 1.16.

    Returns:
        uint64 words, or None where they are too few, or no count of bits makes so many.
    """
    if states == 1:
        return np.zeros(0, np.uint64)
    if not straddles and len(words) == word_count(states):
        return words
    bits = _bits_of(len(words), bits_for(states, LEAST_BITS), straddles)
    if bits is None:
        return None
    if straddles and bits == bits_for(states, LEAST_BITS) and not 64 % bits:
        return words
    cells = _straddled_cells(words, bits) if straddles else _padded_cells(words, bits)
    return None if cells.max() >= states else _padded(cells, bits_for(states, LEAST_BITS))


def words_before_1_16(words: np.ndarray, states: int) -> np.ndarray:
    """Return today's words of a section as games before 1.16 packed them; all of one are 0."""
    bits = bits_for(states, LEAST_BITS)
    if states == 1:
        return np.zeros(words_for(SECTION, bits), np.uint64)
    if not 64 % bits:
        return words
    packed = np.zeros(words_for(SECTION, bits), np.uint64)
    pack_straddled(_padded_cells(words, bits), bits, packed)
    return packed


def _bits_of(words: int, needed: int, straddles: bool) -> int | None:
    """Return the bits of a number, at least those needed, that make so many words."""
    count = (lambda bits: words_for(SECTION, bits)) if straddles else _padded_count
    fitting = (bits for bits in range(needed, MOST_BITS + 1) if count(bits) == words)
    return next(fitting, None)


def _padded_count(bits: int) -> int:
    return -(-SECTION // (64 // bits))


def _straddled_cells(words: np.ndarray, bits: int) -> np.ndarray:
    cells = np.empty((16, 16, 16), np.uint16)
    unpack_straddled(words, bits, np.arange(1 << bits, dtype=np.uint32).astype(np.uint16), cells)
    return cells.ravel()


def _padded_cells(words: np.ndarray, bits: int) -> np.ndarray:
    shifts = np.arange(64 // bits, dtype=np.uint64) * np.uint64(bits)
    cells = words[:, None] >> shifts & np.uint64((1 << bits) - 1)
    return cells.ravel()[:SECTION].astype(np.uint16)


def _padded(cells: np.ndarray, bits: int) -> np.ndarray:
    per_word = 64 // bits
    rows = np.zeros((_padded_count(bits), per_word), np.uint64)
    rows.ravel()[:SECTION] = cells
    shifts = np.arange(per_word, dtype=np.uint64) * np.uint64(bits)
    return np.bitwise_or.reduce(rows << shifts, axis=1)

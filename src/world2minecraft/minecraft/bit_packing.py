"""Kernels that pack and unpack block numbers: sections, gapless arrays, varints, old blocks.

A section of 16 x 16 x 16 blocks is packed in 64-bit words. Since 1.16 no number goes over from one
word to the next, and there are as few bits as the palette needs, four at least. Before 1.16, and in
Litematica, numbers lie without gaps ("straddled"): number i takes the bits from i * bits on, lowest
first. Both before and since, a file may keep more bits than it needs.
"""

import numpy as np

from world2minecraft.core.jit import njit

SECTION = 4096
BAND_ROWS = 64
MIN_BITS, MAX_BITS = 4, 16


@njit
def pack_section(states, origin, numbers, palette, words):  # pragma: no cover
    """Gather one section of a volume, make its own palette and pack it as the game does.

    Args:
        states: uint16 [X, Y, Z] in block axes.
        origin: int64 [3], where the section's first cell lies in ``states``; cells outside are 0.
        numbers: int32 [palette size], all -1 on entry and on return.
        palette: uint16 [4096] out, the states met, in order of first appearance.
        words: uint64 [1024] out, LSB first, no value across two words.

    Returns:
        The count of states met and the count of words, 0 where one state fills the section.
    """
    size_x, size_y, size_z = states.shape
    cells = np.zeros(SECTION, np.uint16)
    count = 0
    for y in range(16):
        for z in range(16):
            for x in range(16):
                vx, vy, vz = origin[0] + x, origin[1] + y, origin[2] + z
                state = np.uint16(0)
                if 0 <= vx < size_x and 0 <= vy < size_y and 0 <= vz < size_z:
                    state = states[vx, vy, vz]
                number = numbers[state]
                if number < 0:
                    number = count
                    numbers[state] = number
                    palette[count] = state
                    count += 1
                cells[y * 256 + z * 16 + x] = number
    for number in range(count):
        numbers[palette[number]] = -1
    if count == 1:
        return count, 0
    bits = 4
    while (1 << bits) < count:
        bits += 1
    per_word = 64 // bits
    used = (SECTION + per_word - 1) // per_word
    at = 0
    for word in range(used):
        value = np.uint64(0)
        shift = 0
        while shift <= 64 - bits and at < SECTION:
            value |= np.uint64(cells[at]) << np.uint64(shift)
            shift += bits
            at += 1
        words[word] = value
    return count, used


@njit
def unpack_section(words, numbers, out, origin):  # pragma: no cover
    """Unpack one section into a volume; the inverse of ``pack_section``.

    Args:
        words: uint64 [N], or of length 0 where one state fills the section.
        numbers: uint16 [palette size], the volume's number of each state of the section.
        out: uint16 [X, Y, Z], written where the section lies in it.
        origin: int64 [3], where the section's first cell lies in ``out``; may be outside.

    Returns:
        False where a cell points outside the palette, and then ``out`` is half written.
    """
    size_x, size_y, size_z = out.shape
    bits = 4
    while (1 << bits) < len(numbers):
        bits += 1
    per_word = 64 // bits
    mask = np.uint64((1 << bits) - 1)
    for y in range(16):
        for x in range(16):  # A volume's memory runs along z.
            for z in range(16):
                number = np.uint64(0)
                if len(words):
                    at = y * 256 + z * 16 + x
                    shift = np.uint64(at % per_word * bits)
                    number = (words[at // per_word] >> shift) & mask
                if number >= len(numbers):
                    return False
                vx, vy, vz = origin[0] + x, origin[1] + y, origin[2] + z
                if 0 <= vx < size_x and 0 <= vy < size_y and 0 <= vz < size_z:
                    out[vx, vy, vz] = numbers[number]
    return True


@njit
def write_varints(values, out):  # pragma: no cover
    """Write uint16 values [N] as LEB128 into uint8 ``out`` [3 N]; return the bytes used."""
    at = 0
    for value in values:
        rest = np.uint32(value)
        while rest >= 128:
            out[at] = np.uint8((rest & 127) | 128)
            rest >>= np.uint32(7)
            at += 1
        out[at] = np.uint8(rest)
        at += 1
    return at


@njit
def read_varints(data, lookup, out):  # pragma: no cover
    """Read LEB128 numbers from uint8 ``data`` and write what ``lookup`` has for each.

    Args:
        data: uint8 [N].
        lookup: int32 [M], -1 for a number that means nothing.
        out: uint16 [Y, Z, X] out, filled whole, the last axis fastest.

    Returns:
        The bytes used, or -1 where the data ends too early, or -2 where a number has more than
        four bytes, or -3 - n where the number n is not in ``lookup``.
    """
    at = 0
    size_y, size_z, size_x = out.shape
    band = np.empty((min(size_z, BAND_ROWS), size_x), np.uint16)
    for y in range(size_y):
        for first in range(0, size_z, BAND_ROWS):
            rows = min(BAND_ROWS, size_z - first)
            for row in range(rows):
                for x in range(size_x):
                    value = np.int64(0)
                    shift = 0
                    while True:
                        if at >= len(data):
                            return -1
                        byte = np.int64(data[at])
                        at += 1
                        value |= (byte & 127) << shift
                        if byte < 128:
                            break
                        shift += 7
                        if shift > 21:
                            return -2
                    if value >= len(lookup) or lookup[value] < 0:
                        return -3 - value
                    band[row, x] = lookup[value]
            for x in range(size_x):  # A volume's memory runs along z: rows are written together.
                for row in range(rows):
                    out[y, first + row, x] = band[row, x]
    return at


@njit
def read_legacy_keys(numbers, values, more, out, counts):  # pragma: no cover
    """Read the blocks of a schematic from before 1.13 as number * 16 + data value.

    Args:
        numbers: uint8 [N], the low bytes of the block numbers.
        values: uint8 [N], the data values, of which four bits count.
        more: uint8 [N / 2] with four more bits of each number, the first one's low; or [0].
        out: uint16 [Y, Z, X] out, N cells, the last axis fastest.
        counts: int64 [65536], to which 1 is added for each cell.
    """
    size_y, size_z, size_x = out.shape
    for y in range(size_y):
        for x in range(size_x):  # A volume's memory runs along z.
            for z in range(size_z):
                at = (y * size_z + z) * size_x + x
                number = np.int64(numbers[at])
                if len(more):
                    number |= np.int64(more[at >> 1] >> (4 * (at & 1)) & 15) << 8
                key = number << 4 | np.int64(values[at] & 15)
                out[y, z, x] = key
                counts[key] += 1


@njit
def skip_text_compounds(data, at, ends):  # pragma: no cover
    """Find where each of ``len(ends)`` compounds of texts and of compounds of texts ends.

    Args:
        data: uint8 [N], NBT.
        at: where the first compound's content begins.
        ends: int64 out, the byte after each compound's end.

    Returns:
        False where something else is there, or the data ends too early.
    """
    for index in range(len(ends)):
        depth = 1
        while depth:
            if at + 3 > len(data):
                if at < len(data) and data[at] == 0 and depth == 1:
                    at += 1
                    break
                return False
            tag = data[at]
            at += 1
            if tag == 0:
                depth -= 1
                continue
            at += 2 + (np.int64(data[at]) << 8 | np.int64(data[at + 1]))
            if tag == 10:
                depth += 1
            elif tag == 8 and at + 2 <= len(data):
                at += 2 + (np.int64(data[at]) << 8 | np.int64(data[at + 1]))
            else:
                return False
        ends[index] = at
    return at <= len(data)


def bit_width(count: int, least: int) -> int:
    """Return how many bits the numbers 0 to ``count`` - 1 take, ``least`` at the least."""
    return max(least, (count - 1).bit_length())


def straddled_word_count(count: int, bits: int) -> int:
    """Return how many words of 64 bits ``count`` numbers of ``bits`` bits take."""
    return -(-count * bits // 64)


@njit
def pack_straddled(values, bits, words):  # pragma: no cover
    """Write uint16 ``values`` [N] into uint64 ``words``, all 0 on entry."""
    at = np.int64(0)
    for index in range(len(values)):
        value = np.uint64(values[index])
        word, shift = at >> 6, at & 63
        at += bits
        words[word] |= value << np.uint64(shift)
        if shift + bits > 64:
            words[word + 1] |= value >> np.uint64(64 - shift)


@njit
def unpack_straddled(words, bits, lookup, out):  # pragma: no cover
    """Read numbers from ``words`` and write what ``lookup`` has for each.

    Args:
        words: uint64, long enough for all of ``out``.
        bits: 1 to 32.
        lookup: uint16 [M].
        out: uint16 [Y, Z, X] out, filled whole where all goes well, the last axis fastest.

    Returns:
        -1, or a number that ``lookup`` lacks, and then ``out`` is half written.
    """
    mask = np.uint64((1 << bits) - 1)
    size_y, size_z, size_x = out.shape
    for y in range(size_y):
        for x in range(size_x):  # A volume's memory runs along z.
            for z in range(size_z):
                at = ((np.int64(y) * size_z + z) * size_x + x) * bits
                word, shift = at >> 6, at & 63
                value = words[word] >> np.uint64(shift)
                if shift + bits > 64:
                    value |= words[word + 1] << np.uint64(64 - shift)
                number = np.int64(value & mask)
                if number >= len(lookup):
                    return number
                out[y, z, x] = lookup[number]
    return -1


def word_count(states: int) -> int:
    """Return how many words a section of so many states has today: none where it is all one."""
    return 0 if states == 1 else _padded_count(bit_width(states, MIN_BITS))


def repack_section_words(words: np.ndarray, states: int, *, straddles: bool) -> np.ndarray | None:
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
    bits = _find_bit_width(len(words), bit_width(states, MIN_BITS), straddles)
    if bits is None:
        return None
    if straddles and bits == bit_width(states, MIN_BITS) and not 64 % bits:
        return words
    cells = _straddled_cells(words, bits) if straddles else _padded_cells(words, bits)
    return None if cells.max() >= states else _pack_padded(cells, bit_width(states, MIN_BITS))


def straddle_section_words(words: np.ndarray, states: int) -> np.ndarray:
    """Return today's words of a section as games before 1.16 packed them; all of one are 0."""
    bits = bit_width(states, MIN_BITS)
    if states == 1:
        return np.zeros(straddled_word_count(SECTION, bits), np.uint64)
    if not 64 % bits:
        return words
    packed = np.zeros(straddled_word_count(SECTION, bits), np.uint64)
    pack_straddled(_padded_cells(words, bits), bits, packed)
    return packed


def _find_bit_width(words: int, needed: int, straddles: bool) -> int | None:
    """Return the bits of a number, at least those needed, that make so many words."""
    count = (lambda bits: straddled_word_count(SECTION, bits)) if straddles else _padded_count
    fitting = (bits for bits in range(needed, MAX_BITS + 1) if count(bits) == words)
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


def _pack_padded(cells: np.ndarray, bits: int) -> np.ndarray:
    per_word = 64 // bits
    rows = np.zeros((_padded_count(bits), per_word), np.uint64)
    rows.ravel()[:SECTION] = cells
    shifts = np.arange(per_word, dtype=np.uint64) * np.uint64(bits)
    return np.bitwise_or.reduce(rows << shifts, axis=1)

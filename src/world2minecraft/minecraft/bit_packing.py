"""Kernels that pack and unpack block indices in chunk sections, schematics and legacy files.

A chunk section has 16 x 16 x 16 blocks, whose palette indices are packed in 64-bit words. Since
1.16, no index crosses a word boundary, and each index has as few bits as the palette requires, but
at least four. Before 1.16, and in Litematica files, indices are packed without gaps ("straddled"):
index i starts at bit i * bits, lowest bit first. Files may use more bits than the palette requires.
"""

import numpy as np

from world2minecraft.core.jit import njit

SECTION = 4096
BAND_ROWS = 64
MIN_BITS, MAX_BITS = 4, 16


@njit
def pack_section(states, origin, numbers, palette, words):  # pragma: no cover
    """Extract one section of a volume, build its palette and pack its indices as the game does.

    Args:
        states: Volume of states as uint16 [X, Y, Z] in block axes.
        origin: Position of the section's first cell in ``states``, int64 [3]. Cells outside are 0.
        numbers: Scratch array, int32 [palette size], filled with -1 on entry and on return.
        palette: Output, uint16 [4096]: the states found, in order of first appearance.
        words: Output, uint64 [1024], lowest bit first. No index crosses a word boundary.

    Returns:
        The number of states found and the number of words, which is 0 for a uniform section.
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
    """Unpack one section into a volume, the inverse of ``pack_section``.

    Args:
        words: Packed indices, uint64 [N], or an empty array for a uniform section.
        numbers: The volume's index of each state in the section palette, uint16 [palette size].
        out: Output volume, uint16 [X, Y, Z]. Only cells of the section are written.
        origin: Position of the section's first cell in ``out``, int64 [3]. May be outside ``out``.

    Returns:
        True on success; False if an index exceeds the palette, in which case ``out`` is incomplete.
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
    """Encode uint16 values [N] as LEB128 in ``out``, uint8 [3 N], and return the byte count."""
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
    """Decode LEB128 numbers and map each through a lookup table.

    Args:
        data: Encoded bytes, uint8 [N].
        lookup: Value for each number, int32 [M]. -1 marks invalid numbers.
        out: Output, uint16 [Y, Z, X], last axis fastest. Every cell is written.

    Returns:
        The number of bytes read; -1 if the data ends too early; -2 if a number has more than four
        bytes; -3 - n if the number n is not in ``lookup``.
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
    """Read the blocks of a schematic from before 1.13 as keys of block ID * 16 + data value.

    Args:
        numbers: Low bytes of the block IDs, uint8 [N].
        values: Data values, uint8 [N]. Only the low four bits are used.
        more: Four additional high bits of each block ID, uint8 [N / 2], or an empty array. The
            first block of each pair uses the low half of the byte.
        out: Output keys, uint16 [Y, Z, X] with N cells, last axis fastest.
        counts: Number of cells of each key, int64 [65536], incremented by this call.
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
    """Find the ends of consecutive NBT compounds that contain only strings and such compounds.

    Args:
        data: NBT bytes, uint8 [N].
        at: Offset of the first compound's content.
        ends: Output, int64: offset of the first byte after each compound. Its length is the number
            of compounds to skip.

    Returns:
        True on success; False if another tag is found or the data ends too early.
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
    """Return the number of bits that represent 0 to ``count`` - 1, and at least ``least``."""
    return max(least, (count - 1).bit_length())


def straddled_word_count(count: int, bits: int) -> int:
    """Return the number of 64-bit words that ``count`` gapless numbers of ``bits`` bits occupy."""
    return -(-count * bits // 64)


@njit
def pack_straddled(values, bits, words):  # pragma: no cover
    """Pack uint16 ``values`` [N] without gaps into uint64 ``words``, which must be 0 on entry."""
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
    """Unpack numbers that are packed without gaps and map each through a lookup table.

    Args:
        words: Packed numbers, uint64 [W]. Must have enough bits for every cell of ``out``.
        bits: Number of bits per number, 1 to 32.
        lookup: Value for each number, uint16 [M].
        out: Output, uint16 [Y, Z, X], last axis fastest. Every cell is written on success.

    Returns:
        -1 on success; otherwise the first number that is not in ``lookup``, and ``out`` is
        incomplete.
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
    """Return the number of 64-bit words of a current section with ``states`` palette entries.

    A uniform section has no words.
    """
    return 0 if states == 1 else _padded_count(bit_width(states, MIN_BITS))


def repack_section_words(words: np.ndarray, states: int, *, straddles: bool) -> np.ndarray | None:
    """Convert the words of a section to the current packing.

    Args:
        words: Packed indices, uint64 [N].
        states: Number of palette entries of the section.
        straddles: Whether indices cross word boundaries, as in versions before 1.16.

    Returns:
        The repacked words as uint64, or None if the number of words is invalid or an index exceeds
        the palette.
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
    """Convert the words of a section from the current packing to the packing used before 1.16.

    The words of a uniform section are all 0.
    """
    bits = bit_width(states, MIN_BITS)
    if states == 1:
        return np.zeros(straddled_word_count(SECTION, bits), np.uint64)
    if not 64 % bits:
        return words
    packed = np.zeros(straddled_word_count(SECTION, bits), np.uint64)
    pack_straddled(_padded_cells(words, bits), bits, packed)
    return packed


def _find_bit_width(words: int, needed: int, straddles: bool) -> int | None:
    """Return the number of bits, at least ``needed``, that gives the number of words, or None."""
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

"""Kernels that pack and unpack block numbers: chunk sections of 16 x 16 x 16, and varints."""

import numpy as np

from world2minecraft.core.jit import njit

SECTION = 4096
BAND_ROWS = 64


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
def read_keys(numbers, values, more, out, counts):  # pragma: no cover
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
def skip_texts(data, at, ends):  # pragma: no cover
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

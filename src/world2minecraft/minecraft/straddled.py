"""Kernels for numbers packed without gaps: Litematica, and chunks of games before 1.16.

Number i takes the bits from i * bits on, lowest first, and may go over from one word to the next.
"""

import numpy as np

from world2minecraft.core.jit import njit


def bits_for(count: int, least: int) -> int:
    """Return how many bits the numbers 0 to ``count`` - 1 take, ``least`` at the least."""
    return max(least, (count - 1).bit_length())


def words_for(count: int, bits: int) -> int:
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

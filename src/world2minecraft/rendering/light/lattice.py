"""The light lattice: for every corner of every layer of cells, the light that a face shows there.

``lattice`` uint16 [3, X + 2, Y + 2, Z + 2]: for axis 0, entry [0, i + 1, y, z] belongs to the layer
of cells x = i (from -1 to X) and to the corner (y, z) in it, between the four cells (i, y - 1 to y,
z - 1 to z); axis 1 has [1, x, j + 1, z], axis 2 [2, x, y, k + 1]. A face at its cell's boundary
reads the layer in front, one inside its cell the cell's own.

Bits 0 to 5 hold sky light in quarters of a level, 0 to 60: the mean over those of the four cells
that are not solid. Bits 6 to 11 hold block light alike. Bits 12 and 13 count the solid ones, 0 to
3, but two that touch only at the corner count 3, because they leave nothing between them.
"""

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.minecraft.rules.flood import SOLID

BLOCK_SHIFT, COUNT_SHIFT = 6, 12
_ONE, _BLOCK = 1 << 20, 1 << 10  # A packed cell: one, block light, sky light; 0 where solid.


def quarters(reach: float) -> np.ndarray:
    """Return uint16 [5, 1024]: quarters of a level by the number of cells and their sum."""
    sums = np.arange(1024)
    table = np.zeros((5, 1024), np.uint16)
    for count in range(1, 5):
        table[count] = np.minimum(np.floor(sums * 4 / (count * reach) + 0.5), 60)
    return table


@njit
def fill_lattice(lattice, sky, block, kinds, words, table, low, high):
    """Fill in the corners of all layers that the cells ``low`` to ``high`` touch.

    Args:
        lattice: uint16 [3, X + 2, Y + 2, Z + 2], changed in place.
        sky: uint8 [X + 2, Y + 2, Z + 2], with its margin; ``block``, ``kinds`` alike.
        block: uint8, block light.
        kinds: uint16, rows of ``words``.
        words: uint32 [K].
        table: what ``quarters`` returns.
        low: int64 [3], the first cell with the margin counted (the whole begins at 0, 0, 0).
        high: int64 [3], past the last one (the whole ends at X + 2, Y + 2, Z + 2).
    """
    shape = np.array(sky.shape)
    first, last = np.maximum(low - 1, 0), np.minimum(high + 1, shape)
    size = last - first
    packed = np.empty((size[0], size[1], size[2]), np.uint32)
    for x in range(size[0]):
        for y in range(size[1]):
            for z in range(size[2]):
                a, b, c = x + first[0], y + first[1], z + first[2]
                solid = words[kinds[a, b, c]] & SOLID != 0
                lit = np.uint32(_ONE + block[a, b, c] * _BLOCK + sky[a, b, c])
                packed[x, y, z] = np.uint32(0) if solid else lit
    for axis in range(3):
        step_p, step_q = (1 if axis == 0 else 0), (2 if axis < 2 else 1)
        ends = size.copy()
        ends[step_p] -= 1
        ends[step_q] -= 1
        px, py = (1, 0) if step_p == 0 else (0, 1)
        qy, qz = (1, 0) if step_q == 1 else (0, 1)
        for x in range(ends[0]):
            for y in range(ends[1]):
                for z in range(ends[2]):
                    lattice[axis, x + first[0], y + first[1], z + first[2]] = _corner(
                        packed[x, y, z], packed[x, y + qy, z + qz],
                        packed[x + px, y + py, z], packed[x + px, y + py + qy, z + qz], table,
                    )  # fmt: skip


@njit
def _corner(a, b, c, d, table):
    """Return the entry of a corner between the packed cells a b (lower row) and c d."""
    total = a + b + c + d
    count = total >> np.uint32(20)
    solid = 4 - np.int64(count)
    if solid == 4 or (solid == 2 and ((a == 0 and d == 0) or (b == 0 and c == 0))):
        solid = 3
    sky, block = table[count, total & 1023], table[count, (total >> np.uint32(10)) & 1023]
    return sky | (block << BLOCK_SHIFT) | (solid << COUNT_SHIFT)

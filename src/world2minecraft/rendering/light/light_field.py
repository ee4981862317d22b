"""The light of a volume: sky light, block light, and the light lattice that the renderer reads.

For every corner of every layer of cells, the light lattice contains the light of a face there.
``lattice`` is uint16 [3, X + 2, Y + 2, Z + 2]: for axis 0, entry [0, i + 1, y, z] belongs to the
layer of cells x = i (from -1 to X) and to the corner (y, z) in it, between the four cells (i, y - 1
to y, z - 1 to z); axis 1 has [1, x, j + 1, z], axis 2 [2, x, y, k + 1]. A face at the boundary of
its cell reads the layer in front of it; a face inside its cell reads the cell's own layer.

Bits 0 to 5 contain sky light in quarters of a level, 0 to 60: the mean over those of the four cells
that are not solid. Bits 6 to 11 contain block light in the same unit. Bits 12 and 13 contain the
number of solid cells, 0 to 3; two solid cells that only touch at the corner count as 3, because
they leave no gap.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.minecraft.rules.light import (
    SOLID,
    flood_block,
    flood_sky,
    light_tables,
    pad_margin,
    rounded_reach,
)

BLOCK_SHIFT, COUNT_SHIFT = 6, 12
_ONE, _BLOCK = 1 << 20, 1 << 10  # A packed cell: one, block light, sky light; 0 where solid.
MAX_STATES = 65_535


def quarter_level_table(reach: float) -> np.ndarray:
    """Return light in quarters of a level by cell count and light sum, uint16 [5, 1024]."""
    sums = np.arange(1024)
    table = np.zeros((5, 1024), np.uint16)
    for count in range(1, 5):
        table[count] = np.minimum(np.floor(sums * 4 / (count * reach) + 0.5), 60)
    return table


@njit
def fill_lattice(lattice, sky, block, kinds, words, table, low, high):
    """Compute the corners of all layers that the cells from ``low`` to ``high`` touch.

    Args:
        lattice: Light lattice, uint16 [3, X + 2, Y + 2, Z + 2], modified in place.
        sky: Sky light with its margin, uint8 [X + 2, Y + 2, Z + 2].
        block: Block light with its margin, uint8 [X + 2, Y + 2, Z + 2].
        kinds: Rows of ``words``, uint16 [X + 2, Y + 2, Z + 2].
        words: Light properties, uint32 [K].
        table: The result of ``quarter_level_table``.
        low: First cell including the margin, int64 [3] (0, 0, 0 for the whole volume).
        high: End cell, int64 [3] (X + 2, Y + 2, Z + 2 for the whole volume).
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


@dataclass(eq=False)
class LightField:
    """The light of a volume, kept up to date by ``relight.edit_light``.

    Grid arrays have a margin of one cell of open air: cell (x, y, z) is at [x + 1, y + 1, z + 1].
    Light is in units of 1 / ``reach`` levels.
    """

    kinds: np.ndarray  # uint16 [X + 2, Y + 2, Z + 2]: 1 + the state's index, 0 around the volume
    words: np.ndarray  # uint32 [P + 1], see minecraft.rules.light
    gives: np.ndarray  # uint8 [P + 1], levels
    sky: np.ndarray  # uint8 [X + 2, Y + 2, Z + 2]
    block: np.ndarray  # uint8 [X + 2, Y + 2, Z + 2]
    lattice: np.ndarray  # uint16 [3, X + 2, Y + 2, Z + 2], see above
    reach: float = 1.0
    hidden_lamps: bool = True

    @property
    def sky_light(self) -> np.ndarray:
        """Sky light without the margin, a view of uint8 [X, Y, Z]."""
        return self.sky[1:-1, 1:-1, 1:-1]

    @property
    def block_light(self) -> np.ndarray:
        """Block light without the margin, a view of uint8 [X, Y, Z]."""
        return self.block[1:-1, 1:-1, 1:-1]


def light_field(
    states: np.ndarray,
    palette: tuple[str, ...],
    reach: float = 1.0,
    *,
    hidden_lamps: bool = True,
) -> LightField:
    """Compute the light of a volume.

    Args:
        states: Indices of ``palette``, uint16 [X, Y, Z].
        palette: Block states.
        reach: Number of blocks over which light loses one level, 1 to 16, rounded to a fifteenth; 1
            as in the game.
        hidden_lamps: Whether the game's invisible light blocks emit light. Rooms that are filled
            with them, to keep monsters away, look natural only without their light.

    Raises:
        ValueError: If the reach is out of range, or if the palette has more than 65,535 states.
    """
    if len(palette) > MAX_STATES:
        raise ValueError(f"a palette may have at most {MAX_STATES:,} states, got {len(palette):,}")
    reach = rounded_reach(reach)
    words, gives = light_tables(palette, hidden_lamps)
    kinds = pad_margin(states.astype(np.uint16) + np.uint16(1), 0)
    sky = flood_sky(kinds, words, reach)
    block = flood_block(kinds, words, gives, reach)
    lattice = np.zeros((3, *kinds.shape), np.uint16)
    low, high = np.zeros(3, np.int64), np.array(kinds.shape, np.int64)
    fill_lattice(lattice, sky, block, kinds, words, quarter_level_table(reach), low, high)
    return LightField(kinds, words, gives, sky, block, lattice, reach, hidden_lamps)

"""Storage of the map: blocks of cells along rays, and records of cells with surface.

Cell (i, j, k) of the room belongs to block (i >> 3, j >> 3, k >> 3). ``table`` contains the number
of each block, 0 for none; block n has the cells from ``n * 512`` of the flat cell arrays. The
number of the record of a cell with surface is in ``record``, 0 for none. The memory thus grows with
the observed space, and that of the records with the observed surface.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import MAX_ARRAY_BYTES

SHIFT = 3
SIDE = 1 << SHIFT  # 0.64 m at the paper's cell: half of a room's blocks hold no surface.
MASK = SIDE - 1
BLOCK_CELLS = SIDE**3
FACES = 6  # By the direction that a surface mostly faces: -x, +x, -y, +y, -z or +z.
FACE_SUMS = 8  # Weight; weighted offset [3], normal [3] and depth sigma.
MAX_CELLS = 120_000_000  # 1.4 GB: a house of 60 x 60 x 17 m at 0.08 m, all of it seen.
MAX_TABLE = 16_000_000
# Of the box around all that was seen: the votes of evidence.npz, which is read again.
MAX_DENSE = MAX_ARRAY_BYTES // (2 * CLASS_COUNT)


class BlockTable(NamedTuple):
    """The index of each cell of the room in the flat arrays."""

    low: np.ndarray  # int64 [3], the block at table[0, 0, 0]
    numbers: np.ndarray  # int32 [X, Y, Z], the number of each block, 0 for none
    used: np.ndarray  # int64 [2], blocks and records in use


class CellArrays(NamedTuple):
    """The flat arrays of cells."""

    log_odds: np.ndarray  # float32 [C]
    record: np.ndarray  # int32 [C], 0 for none
    mark: np.ndarray  # int64 [C], the view that touched a cell last; see integration.py


class RecordArrays(NamedTuple):
    """The sums of the cells with surface; row 0 is not used."""

    votes: np.ndarray  # float32 [R, 12]
    colour_sum: np.ndarray  # float32 [R, 3]
    offset_sum: np.ndarray  # float32 [R, 3], metres from the cell's centre
    hits: np.ndarray  # int64 [R]
    faces: np.ndarray  # float32 [R, 6, 8]


class Blocks:
    """Growing storage of cells and records; numbers start at 1, so zeroed memory means none."""

    def __init__(self):
        self.low = np.zeros(3, np.int64)  # The block that stands at table[0, 0, 0].
        self.table = np.zeros((0, 0, 0), np.int32)
        self.used = np.zeros(2, np.int64)  # Blocks and records in use; kernels count them up.
        self.log_odds = np.zeros(0, np.float32)
        self.record = np.zeros(0, np.int32)
        self.mark = np.zeros(0, np.int64)  # Which view touched a cell last; see integration.py.
        self.votes = np.zeros((0, CLASS_COUNT), np.float32)
        self.colour_sum = np.zeros((0, 3), np.float32)
        self.offset_sum = np.zeros((0, 3), np.float32)
        self.hits = np.zeros(0, np.int64)
        self.faces = np.zeros((0, FACES, FACE_SUMS), np.float32)

    @property
    def by_cell(self) -> BlockTable:
        """The table of blocks for kernels; invalid after the map has grown."""
        return BlockTable(self.low, self.table, self.used)

    @property
    def cells(self) -> CellArrays:
        """The arrays of cells for kernels; invalid after the map has grown."""
        return CellArrays(self.log_odds, self.record, self.mark)

    @property
    def records(self) -> RecordArrays:
        """The arrays of records for kernels; invalid after the map has grown."""
        return RecordArrays(self.votes, self.colour_sum, self.offset_sum, self.hits, self.faces)

    def reserve_box(self, low: np.ndarray, high: np.ndarray, voxel_m: float) -> None:
        """Allocate the blocks of the cells from ``low`` to ``high`` (exclusive).

        Raises:
            CaptureError: If the capture is larger than the map may be.
        """
        first, last = low // SIDE, -(-high // SIDE)
        self._widen(first, last, voxel_m)
        box = tuple(slice(a, b) for a, b in zip(first - self.low, last - self.low, strict=True))
        missing = int((self.table[box] == 0).sum())
        cells = (int(self.used[0]) + missing + 1) * BLOCK_CELLS
        if int(self.used[0]) * BLOCK_CELLS > MAX_CELLS:
            raise CaptureError(
                "capture", "needs too many cells; use larger cells, such as 0.16 m (--voxel 0.16)"
            )
        for name in ("log_odds", "record", "mark"):
            setattr(self, name, _grown(getattr(self, name), cells))

    def reserve_records(self, count: int) -> None:
        """Allocate memory for ``count`` more records."""
        needed = int(self.used[1]) + count + 1
        for name in ("votes", "colour_sum", "offset_sum", "hits", "faces"):
            setattr(self, name, _grown(getattr(self, name), needed))

    def cells_of_blocks(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the numbers of the used blocks, int64 [B], and their first cells, [B, 3]."""
        at = np.argwhere(self.table)
        return self.table[tuple(at.T)].astype(np.int64), (at + self.low) * SIDE

    def _widen(self, first: np.ndarray, last: np.ndarray, voxel_m: float) -> None:
        size = np.array(self.table.shape)
        if size.all():
            first, last = np.minimum(first, self.low), np.maximum(last, self.low + size)
        wanted = last - first
        if (wanted == size).all() and size.all():
            return
        if wanted.astype(np.float64).prod() > MAX_TABLE:
            extent = " x ".join(f"{side * SIDE * voxel_m:.0f}" for side in wanted)
            raise CaptureError(
                "capture", f"spans {extent} m, too large for the grid; use larger cells (--voxel)"
            )
        table = np.zeros(tuple(int(side) for side in wanted), np.int32)
        shift = self.low - first
        if size.all():
            table[tuple(slice(a, a + b) for a, b in zip(shift, size, strict=True))] = self.table
        self.table, self.low = table, first.astype(np.int64)


def _grown(values: np.ndarray, count: int) -> np.ndarray:
    """Return the array with at least ``count`` rows, half as many more where it must grow."""
    if len(values) >= count:
        return values
    grown = np.zeros((max(count, len(values) * 3 // 2), *values.shape[1:]), values.dtype)
    grown[: len(values)] = values
    return grown

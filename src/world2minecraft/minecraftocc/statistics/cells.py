"""The distinct cells of a world that pictures of it hold, however many pictures hold each.

Cells are kept as bits in blocks of 32 a side, so that a scene takes about a bit a cell and a
hundred thousand pictures no more than the worlds that they show.
"""

import numpy as np

from world2minecraft.core.coordinates import apply
from world2minecraft.minecraftocc.values import LabelRegion

SIDE = 32


class WorldCells:
    """A growing set of cells of one world."""

    def __init__(self) -> None:
        self._blocks: dict[tuple[int, int, int], np.ndarray] = {}  # bits, uint8 [SIDE**3 / 8]
        self._phase: np.ndarray | None = None  # Where centres lie in a cell, of a cell's side.
        self._voxel_m = 0.0

    def add(self, region: LabelRegion, chosen: np.ndarray) -> None:
        """Add the chosen cells of a region.

        Cells of all regions count on one grid, that of the first. A region that is turned by other
        than quarter turns has each of its cells counted as the nearest of that grid.

        Args:
            region: of a picture of this world.
            chosen: bool [X, Y, Z] of it.

        Raises:
            ValueError: its cells have another size than those of the regions before.
        """
        places = np.argwhere(chosen)
        if not len(places):
            return
        centers = apply(region.region_to_room, (places + 0.5) * region.voxel_m) / region.voxel_m
        phase = self._phase
        if phase is None:
            phase, self._voxel_m = centers[0] - np.floor(centers[0]), region.voxel_m
            self._phase = phase
        _check_size(region.voxel_m, self._voxel_m)
        self._add_cells(np.rint(centers - phase).astype(np.int64))

    def _add_cells(self, cells: np.ndarray) -> None:
        """Add cells, int64 [N, 3], of this set's grid."""
        low, high = cells.min(axis=0) // SIDE, cells.max(axis=0) // SIDE + 1
        flags = np.zeros((high - low) * SIDE, np.bool_)
        flags[tuple((cells - low * SIDE).T)] = True
        for at in np.ndindex(*(high - low)):
            part = flags[tuple(slice(SIDE * n, SIDE * (n + 1)) for n in at)]
            if part.any():
                self._put((int(low[0]) + at[0], int(low[1]) + at[1], int(low[2]) + at[2]), part)

    def merge(self, other: "WorldCells") -> None:
        """Add the cells of another set of the same world.

        Where its grid lies otherwise, as that of regions which turn with the view or of another
        data set's frames does, its cells count as the nearest of this one's.

        Raises:
            ValueError: its cells have another size.
        """
        if other._phase is None:
            return
        if self._phase is None:
            self._phase, self._voxel_m = other._phase, other._voxel_m
        _check_size(other._voxel_m, self._voxel_m)
        steps = np.rint(other._phase - self._phase).astype(np.int64)
        for key, bits in other._blocks.items():
            if not steps.any():
                self._join(key, bits)
                continue
            places = np.argwhere(np.unpackbits(bits).reshape(SIDE, SIDE, SIDE))
            self._add_cells(places + np.array(key) * SIDE + steps)

    def count(self) -> int:
        """Return how many cells there are."""
        return sum(int(np.bitwise_count(bits).sum()) for bits in self._blocks.values())

    def _put(self, key: tuple[int, int, int], flags: np.ndarray) -> None:
        self._join(key, np.packbits(flags))

    def _join(self, key: tuple[int, int, int], bits: np.ndarray) -> None:
        held = self._blocks.get(key)
        self._blocks[key] = bits.copy() if held is None else held | bits


def _check_size(voxel_m: float, own_m: float) -> None:
    if abs(voxel_m - own_m) > 1e-9:
        raise ValueError(f"cells of one world must have one size, not {own_m} m and {voxel_m} m")

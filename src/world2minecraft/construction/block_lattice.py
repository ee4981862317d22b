"""The block lattice of a room, and the resampling of cells onto it.

Every array of a build is in room axes, ``[x, y, z]`` with z up and one entry per block. Only the
finished volume is converted to block axes, by ``coordinates.grid_to_block_axes``.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.coordinates import ROOM_CORNER_BLOCK, apply, room_to_block
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OccupancyGrid

MAX_BLOCKS = 1 << 25  # A 40 x 40 x 5 m hall at 12.5 blocks a metre has 16 million.
FLOOR_LAYER = ROOM_CORNER_BLOCK[1] - 1
UNDER_FLOOR = 0.75  # Blocks by which a bottom may dip below the floor that it stands on.
MARGIN = 2  # The shell and the invisible edge stand outside the room.


@dataclass(frozen=True, eq=False)
class Lattice:
    """The box of blocks that covers a grid of cells.

    A point p of the room has the lattice coordinate ``p * blocks_per_metre + offset``.

    Attributes:
        corner: World position of the block at index (0, ny - 1, 0): the minimum x, y and z in block
            axes.
        shape: Number of blocks along room x, y and z.
        corner_m: Position of the lattice corner in the room in metres.
        blocks_per_metre: Scale of the build.
        upper: Index of the first layer above the floor of each upper storey, in increasing order.
    """

    corner: tuple[int, int, int]
    shape: tuple[int, int, int]
    corner_m: np.ndarray
    blocks_per_metre: float
    upper: tuple[int, ...] = ()

    @property
    def offset(self) -> np.ndarray:
        """The lattice coordinate of the room's origin, float64 [3]."""
        at = apply(room_to_block(self.corner_m, self.blocks_per_metre), np.zeros(3))
        east, up, south = at - self.corner
        return np.array([east, self.shape[1] - south, up])

    @property
    def ground(self) -> int:
        """The index along z of the first layer above the floor."""
        return ROOM_CORNER_BLOCK[1] - self.corner[1]

    @property
    def grounds(self) -> tuple[int, ...]:
        """The index of the first layer above the floor of each storey, from bottom to top."""
        return (self.ground, *self.upper)

    @property
    def storeys(self) -> tuple[tuple[int, int], ...]:
        """The layer range of each storey: the first layer above its floor and the exclusive end."""
        tops = (*(ground - 1 for ground in self.upper), self.shape[2])
        return tuple(zip(self.grounds, tops, strict=True))

    def ground_under(self, height: float) -> int:
        """Return the ground layer of the storey that contains a lattice height."""
        return max(
            (ground for ground in self.upper if ground <= height + UNDER_FLOOR),
            default=self.ground,
        )

    def coordinates_of(self, points_m: np.ndarray) -> np.ndarray:
        """Convert room points in metres to lattice coordinates, float64 [..., 3]."""
        return np.asarray(points_m) * self.blocks_per_metre + self.offset

    def edges_of(self, grid: OccupancyGrid, axis: int) -> np.ndarray:
        """Return the lattice coordinates of the cell edges along an axis, float64 [N + 1]."""
        edges_m = grid.origin_m[axis] + np.arange(grid.shape[axis] + 1) * grid.voxel_m
        edges = edges_m * self.blocks_per_metre + self.offset[axis]
        return np.round(edges, 9)  # So that 12.5 * 0.08 does not fall short of a whole block.


def is_exact(grid: OccupancyGrid, blocks_per_metre: float) -> bool:
    """Return whether blocks and cells have the same size, so that they map one to one."""
    return abs(grid.voxel_m * blocks_per_metre - 1) < 1e-9


def snap_corner_m(grid: OccupancyGrid, corner_m: np.ndarray) -> np.ndarray:
    """Round a corner to the nearest multiple of the voxel size, float64 [2]."""
    return np.round(np.asarray(corner_m, np.float64) / grid.voxel_m) * grid.voxel_m


def lattice_over(grid: OccupancyGrid, corner_m: np.ndarray, blocks_per_metre: float) -> Lattice:
    """Return the lattice that covers a whole grid, the floor layer and a margin.

    Raises:
        UsageError: If the lattice would have more than ``MAX_BLOCKS`` blocks.
    """
    ends_m = np.stack([grid.origin_m, grid.origin_m + np.array(grid.shape) * grid.voxel_m])
    ends_m[1, 2] = max(ends_m[1, 2], 0.0)
    ends = apply(room_to_block(corner_m, blocks_per_metre), ends_m)
    low = np.floor(ends.min(0) + 1e-6).astype(int) - MARGIN
    high = np.ceil(ends.max(0) - 1e-6).astype(int) + MARGIN
    low[1] = min(low[1], FLOOR_LAYER) if is_exact(grid, blocks_per_metre) else FLOOR_LAYER
    east, up, south = (high - low).tolist()
    if float(east) * up * south > MAX_BLOCKS:
        raise UsageError(
            f"the room has {east} x {up} x {south} blocks at {blocks_per_metre:g} blocks per "
            f"metre, the limit is {MAX_BLOCKS:,}; use fewer, such as 2 (--blocks-per-metre 2)"
        )
    return Lattice(tuple(low.tolist()), (east, south, up), corner_m, blocks_per_metre)


def overlap_weights(edges: np.ndarray, count: int) -> np.ndarray:
    """Compute the share of each block that each cell covers along one axis.

    Args:
        edges: Increasing lattice coordinates of the cell edges, float64 [N + 1].
        count: Number of blocks along the axis.

    Returns:
        The covered shares in [0, 1], float32 [count, N].
    """
    starts = np.arange(count)[:, None]
    low = np.maximum(edges[None, :-1], starts)
    high = np.minimum(edges[None, 1:], starts + 1)
    return np.maximum(high - low, 0).astype(np.float32)


def center_weights(edges: np.ndarray, count: int) -> np.ndarray:
    """Assign cells to blocks along one axis, as 0/1 weights float32 [count, N].

    A cell belongs to the block that contains its centre. A block smaller than a cell belongs to the
    cell that contains the block's centre.
    """
    centres = (edges[:-1] + edges[1:]) / 2
    starts = np.arange(count)[:, None]
    inside = (centres >= starts) & (centres < starts + 1)
    around = (edges[:-1] <= starts + 0.5) & (starts + 0.5 < edges[1:])
    return (inside | around).astype(np.float32)


def resample(values: np.ndarray, weights: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
    """Sum ``values`` [X, Y, Z] along each axis with weights [blocks, cells]."""
    result = values.astype(np.float32)
    for axis in range(3):
        result = weighted_sum(weights[axis], result, axis)
    return result


def weighted_sum(weights: np.ndarray, values: np.ndarray, axis: int) -> np.ndarray:
    """Sum ``values`` along one axis with ``weights`` float32 [blocks, cells]."""
    # A kernel that computed with infinity leaves the processor's flag up, and numpy's product of
    # matrices, which does not lower it first, would warn of a value that is not there.
    with np.errstate(invalid="ignore"):
        product = np.tensordot(weights, values, axes=(1, axis))
    return np.moveaxis(product, 0, axis)


def volume_shares(mask: np.ndarray, grid: OccupancyGrid, lattice: Lattice) -> np.ndarray:
    """Return the share of each block's volume, float32, that the cells of a mask [X, Y, Z] fill."""
    weights = [
        overlap_weights(lattice.edges_of(grid, axis), lattice.shape[axis]) for axis in range(3)
    ]
    return resample(mask, (weights[0], weights[1], weights[2]))


def face_shares(mask: np.ndarray, edges: list[np.ndarray], shape: tuple[int, ...]) -> np.ndarray:
    """Return the share of each block that the cells cover in projection along the best axis.

    A sheet of one cell that crosses a block covers the whole block in projection although it fills
    only a third of its volume. Thin structures are preserved this way.

    Args:
        mask: Bool [X, Y, Z] mask of cells.
        edges: Lattice coordinates of the cell edges along each axis.
        shape: Number of blocks along each axis.

    Returns:
        The covered shares in [0, 1], float32 of the given shape.
    """
    cover = [overlap_weights(edges[axis], shape[axis]) for axis in range(3)]
    member = [center_weights(edges[axis], shape[axis]) for axis in range(3)]
    best = np.zeros(shape, np.float32)
    for axis in range(3):
        seen = weighted_sum(member[axis], mask.astype(np.float32), axis) > 0
        share = seen.astype(np.float32)
        for other in {0, 1, 2} - {axis}:
            share = weighted_sum(cover[other], share, other)
        np.maximum(best, share, out=best)
    return best

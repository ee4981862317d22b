"""Resampling of a fine ground truth to the frame and grid of a reconstruction.

The input is a label grid of small cells (2 cm) in its own frame, and the result is a label grid in
the frame of the estimated room, which differs by a small rotation and translation. Each coarse cell
is sampled at the centres of as many sub-cells as fine cells fit into it. SSCNet's labelling rule is
then applied, as in the paper's data.
"""

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.jit import njit
from world2minecraft.core.types.checks import labels as check_labels
from world2minecraft.core.types.checks import transform

EMPTY_SHARE = 0.95  # SSCNet: a cell with more of it empty or unknown is not occupied.


def carry_truth(
    labels_fine: np.ndarray,
    voxel_m: float,
    origin_m: np.ndarray,
    truth_to_room: np.ndarray,
    grid_shape: tuple[int, int, int],
    grid_origin_m: np.ndarray,
    grid_voxel_m: float,
) -> np.ndarray:
    """Resample the ground truth to the cells of a reconstruction.

    By SSCNet's rule, a cell of 4 x 4 x 4 fine cells is occupied if at least 4 of the 64 are, and
    takes their most frequent class (the lowest ID in a tie). Otherwise it is empty if there are
    more empty than unknown fine cells, and 255 if not. Everything outside the ground truth's grid
    is unknown.

    Args:
        labels_fine: The fine labels as uint8 [A, B, C], 0 to 11 or 255.
        voxel_m: The size of a fine cell in metres.
        origin_m: The minimum corner of the fine grid in its frame, as float [3].
        truth_to_room: The 4x4 rigid transform from the frame of the ground truth to that of the
            room.
        grid_shape: The number of cells of the result along x, y and z.
        grid_origin_m: The minimum corner of the result in the room frame, as float [3].
        grid_voxel_m: The size of a cell of the result in metres, at least ``voxel_m``.

    Returns:
        The labels as uint8 of shape ``grid_shape``, 0 to 11 or 255.

    Raises:
        ValueError: If a shape or a label is invalid, or the cells of the result are too small.
    """
    fine = check_labels("labels_fine", labels_fine, (None, None, None))
    if not 0 < voxel_m <= grid_voxel_m * (1 + 1e-9):
        raise ValueError(f"voxel_m must be above 0 and at most {grid_voxel_m}, got {voxel_m}")
    # The centre of sub-cell (i, j, k) of the grid, in fine cells: one affine map for all.
    per_side = max(round(grid_voxel_m / voxel_m), 1)
    room_to_truth = invert_rigid(transform("truth_to_room", truth_to_room))
    step_m = grid_voxel_m / per_side
    first_m = np.asarray(grid_origin_m, np.float64) + 0.5 * step_m
    turn = room_to_truth[:3, :3] * (step_m / voxel_m)
    start = (room_to_truth[:3, :3] @ first_m + room_to_truth[:3, 3] - origin_m) / voxel_m
    sub_cell_to_fine = np.concatenate([turn, start[:, None]], axis=1)
    return _resample(np.ascontiguousarray(fine), sub_cell_to_fine, np.array(grid_shape), per_side)


@njit
def _resample(fine, sub_cell_to_fine, grid_shape, per_side):
    """Sample ``fine`` at every sub-cell, and apply SSCNet's rule as ``carry_truth`` describes."""
    result = np.empty((grid_shape[0], grid_shape[1], grid_shape[2]), np.uint8)
    counts = np.zeros(CLASS_COUNT + 1, np.int64)
    whole = per_side**3
    m = sub_cell_to_fine
    for i in range(grid_shape[0]):
        for j in range(grid_shape[1]):
            for k in range(grid_shape[2]):
                counts[:] = 0
                for n in range(whole):
                    x = i * per_side + n // (per_side * per_side)
                    y = j * per_side + n // per_side % per_side
                    z = k * per_side + n % per_side
                    a = int(np.floor(m[0, 0] * x + m[0, 1] * y + m[0, 2] * z + m[0, 3]))
                    b = int(np.floor(m[1, 0] * x + m[1, 1] * y + m[1, 2] * z + m[1, 3]))
                    c = int(np.floor(m[2, 0] * x + m[2, 1] * y + m[2, 2] * z + m[2, 3]))
                    inside = 0 <= a < fine.shape[0] and 0 <= b < fine.shape[1]
                    if inside and 0 <= c < fine.shape[2] and fine[a, b, c] < CLASS_COUNT:
                        counts[fine[a, b, c]] += 1
                    else:
                        counts[CLASS_COUNT] += 1
                result[i, j, k] = _decide(counts, whole)
    return result


@njit
def _decide(counts, whole):
    """Return the label of a coarse cell from the counts of its fine labels, unknown last."""
    empty, unknown = counts[0], counts[CLASS_COUNT]
    if empty + unknown > EMPTY_SHARE * whole:
        return np.uint8(0) if empty > unknown else np.uint8(UNKNOWN)
    best = 1
    for class_id in range(2, CLASS_COUNT):
        if counts[class_id] > counts[best]:
            best = class_id
    return np.uint8(best)

"""Wall surface of captures without labels: large vertical planes with nothing behind them.

The reference does not depend on the classes, the layout or the cells of the reconstruction; only
the room frame is the reconstruction's. It is an approximation: a wardrobe that hides its wall up to
the ceiling counts as wall, and a wall behind which another room was seen does not.
"""

import numpy as np

CELL_M = 0.08
MAX_NORMAL_Z = 0.26  # 15 degrees off vertical.
TURN_DEG = 2.0  # Step of the azimuths that are tried.
MIN_COSINE = 0.9  # 26 degrees: normals of a wall at 4 m scatter by more than 10.
NEAR_M = 0.10  # Twice the rms of flat walls at 3 to 5 m.
BEHIND_M = 0.30
MAX_BEHIND = 2  # Cells behind a column of wall that noise explains.
MIN_CELLS = 80  # About 1 m2 in a single frame, whose patches are 12 cm wide at 3 m.
MIN_WIDTH_M, MIN_HEIGHT_M = 0.8, 0.4  # The kitchen's wall is seen for 0.45 m above the counter.
MIN_TOP_M = 1.2  # Higher than counters, chests and the backs of sofas.
MAX_PLANES = 24


def border_wall_points(points_m: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Return points on the large vertical planes at the border of a room, one per cell.

    Args:
        points_m: Surface points in the room frame, float64 [N, 3].
        normals: Unit normals towards the camera, float64 [N, 3].
    """
    points_m, normals = _one_per_cell(points_m, normals)
    upright = np.abs(normals[:, 2]) < MAX_NORMAL_Z
    free, walls = upright.copy(), [np.zeros((0, 3))]
    for _ in range(MAX_PLANES):
        plane = _largest_plane(points_m[free], normals[free])
        if plane is None:
            break
        azimuth, offset_m = plane
        inward = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        depth_m = points_m @ inward - offset_m
        support = free & (np.abs(depth_m) < NEAR_M) & (normals @ inward > MIN_COSINE)
        free &= ~support
        wall = support & ~_hides_something(points_m, depth_m, inward)
        if _is_large(points_m[wall], inward):
            walls.append(points_m[wall])
    return np.concatenate(walls)


def _one_per_cell(points_m: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean point and normal of each cell, so that near surface does not count more."""
    index = np.floor(points_m / CELL_M).astype(np.int64)
    cells, owner = np.unique(index, axis=0, return_inverse=True)
    owner, count = owner.reshape(-1), len(cells)
    hits = np.bincount(owner, minlength=count)[:, None]
    means = [
        np.stack([np.bincount(owner, of[:, axis], count) for axis in range(3)], axis=1) / hits
        for of in (points_m, normals)
    ]
    lengths = np.linalg.norm(means[1], axis=1, keepdims=True)
    return means[0], means[1] / np.maximum(lengths, 1e-9)


def _largest_plane(points_m: np.ndarray, normals: np.ndarray) -> tuple[float, float] | None:
    """Return the azimuth and offset of the vertical plane with most cells, or None."""
    best, found = MIN_CELLS - 1, None
    for azimuth in np.radians(np.arange(0, 360, TURN_DEG)):
        inward = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        facing = normals @ inward > MIN_COSINE
        if facing.sum() <= best:
            continue
        offsets = points_m[facing] @ inward
        low = offsets.min()
        bins = np.bincount(np.floor((offsets - low) / (NEAR_M / 2)).astype(np.int64))
        wide = np.convolve(bins, np.ones(3))  # Three bins fit within NEAR_M of their middle.
        if wide.max() > best:
            best = int(wide.max())
            found = (float(azimuth), float(low + (wide.argmax() - 0.5) * NEAR_M / 2))
    return found


def _hides_something(points_m: np.ndarray, depth_m: np.ndarray, inward: np.ndarray) -> np.ndarray:
    """Return which points share their vertical column of a plane with surface behind the plane."""
    along = np.array([-inward[1], inward[0], 0.0])
    column = np.floor(points_m @ along / CELL_M).astype(np.int64)
    column -= column.min()
    behind = np.bincount(column[depth_m < -BEHIND_M], minlength=column.max() + 1)
    return behind[column] > MAX_BEHIND


def _is_large(points_m: np.ndarray, inward: np.ndarray) -> bool:
    if len(points_m) < MIN_CELLS:
        return False
    along = points_m @ np.array([-inward[1], inward[0], 0.0])
    width_m = len(np.unique(np.floor(along / CELL_M))) * CELL_M
    bottom_m, top_m = np.percentile(points_m[:, 2], (5, 95))
    return bool(width_m >= MIN_WIDTH_M and top_m - bottom_m >= MIN_HEIGHT_M and top_m >= MIN_TOP_M)

"""Walls at any angle to the frame of the room, as straight upright planes.

Rooms have slanted walls, and the frame of a partial view may follow furniture instead of walls. A
slanted wall is found as a peak among the positions of the remaining upright cells along each
direction, and is a wall by the same evidence as one along an axis: it is tall and wide, and no ray
passed behind it.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy import ndimage

from world2minecraft.geometry.histogram_peaks import highest_peak
from world2minecraft.reconstruction.layout.parameters import StructureParameters
from world2minecraft.reconstruction.layout.surface_cells import Surface

TURNS_DEG = np.arange(0.0, 360.0, 4.0)
MIN_FACING = 0.9  # Cosine of a cell's normal and the direction of its wall: 26 degrees.
MAX_UPRIGHT = 0.4  # Vertical part of the normal of an upright cell.
MIN_NEIGHBOURS = 6  # Fewer give no normal.
MIN_GAIN = 1.5  # A slanted plane must explain this many times the cells of one along an axis.
MAX_PLANES = 16
REACH_M = (0.16, 0.4)  # Behind a wall, where no ray passes.
MIN_HIDDEN_SHARE = 0.6
MIN_FILLED_SHARE = 0.35  # Of the box around a wall on its plane; a plane through a room is sparse.
BEHIND_M = 0.12


@dataclass(frozen=True, eq=False)
class SlantedWall:
    """A straight upright piece of wall: the points p with ``p @ outward == offset_m``.

    Attributes:
        outward: Horizontal unit normal that points out of the room, float64 [2].
        offset_m: Position along the normal in metres.
        span_m: Range along the wall, to the left of ``outward``, in metres.
        top_m: Height of its upper edge in metres.
        cells: Mask of its cells, bool [X, Y, Z].
    """

    outward: np.ndarray
    offset_m: float
    span_m: tuple[float, float]
    top_m: float
    cells: np.ndarray


def find_slanted_walls(
    surface: Surface, rest: np.ndarray, parameters: StructureParameters
) -> tuple[SlantedWall, ...]:
    """Return the walls among the cells that belong to no other structure, the largest first.

    Args:
        surface: Surface of the room.
        rest: Mask of the occupied cells that are not structure yet, bool [X, Y, Z].
        parameters: Thresholds.
    """
    needed = parameters.wall_area_m2 / surface.voxel_m**2
    at = np.argwhere(rest)
    at = at[at[:, 2] > surface.floor_layer]
    if len(at) < needed:
        return ()
    points = surface.points_m[tuple(at.T)].astype(np.float64)
    normals = _normals(surface, rest)[tuple(at.T)]
    upright = np.abs(normals[:, 2]) <= MAX_UPRIGHT
    upright &= np.linalg.norm(normals, axis=1) > 0
    found: list[SlantedWall] = []
    left = upright.copy()
    for _ in range(MAX_PLANES):
        plane = _best_plane(points, normals, left, needed, parameters)
        if plane is None:
            break
        outward, offset_m, on = plane
        left &= ~on
        straight = _count_along_axis(points, normals, upright, outward, parameters)
        if on.sum() < MIN_GAIN * straight:
            continue  # Along an axis, where walls are found more exactly.
        for span_m, top_m in _pieces(surface, points, outward, offset_m, on, parameters):
            cells = _cells_near(surface, rest, at, points, (outward, offset_m, span_m, top_m))
            found.append(SlantedWall(outward, offset_m, span_m, top_m, cells))
    return tuple(found)


def _normals(surface: Surface, rest: np.ndarray) -> np.ndarray:
    """Return the unit normal of each cell, towards free space, float32 [X, Y, Z, 3], 0 if unknown.

    It is the direction of the least spread of the points of the 27 cells around.
    """
    x, y, z = (
        slice(max(s.start - 1, 0), s.stop + 1)
        for s in ndimage.find_objects(rest.astype(np.uint8))[0]
    )
    occupied = surface.occupied[x, y, z]
    points = np.where(occupied[..., None], surface.points_m[x, y, z], 0).astype(np.float64)
    count = _around(occupied.astype(np.float64))
    mean = np.stack([_around(points[..., a]) for a in range(3)], -1)
    mean /= np.maximum(count, 1)[..., None]
    inside = np.argwhere(rest[x, y, z] & (count >= MIN_NEIGHBOURS))
    own = tuple(inside.T)
    spread = np.zeros((len(inside), 3, 3))
    for a in range(3):
        for b in range(a, 3):
            square = _around(points[..., a] * points[..., b])[own] / count[own]
            spread[:, a, b] = spread[:, b, a] = square - mean[own][:, a] * mean[own][:, b]
    normal = np.linalg.eigh(spread)[1][:, :, 0]
    free = surface.free[x, y, z].astype(np.float64)
    slope = np.stack([ndimage.sobel(free, axis, mode="nearest")[own] for axis in range(3)], -1)
    normal *= np.where(np.sum(normal * slope, axis=1) < 0, -1.0, 1.0)[:, None]
    result = np.zeros((*rest.shape, 3), np.float32)
    result[x, y, z][own] = normal
    return result


def _around(values: np.ndarray) -> np.ndarray:
    """Return the sum over the 27 cells around each cell."""
    return ndimage.uniform_filter(values, 3, mode="constant") * 27


def _best_plane(
    points: np.ndarray,
    normals: np.ndarray,
    left: np.ndarray,
    needed: float,
    parameters: StructureParameters,
) -> tuple[np.ndarray, float, np.ndarray] | None:
    """Return the normal, position and inliers of the plane with the most cells, or None."""
    best, best_count = None, needed
    for turn in np.radians(TURNS_DEG):
        outward = np.array([np.cos(turn), np.sin(turn)])
        facing = np.flatnonzero(left & (-(normals[:, :2] @ outward) >= MIN_FACING))
        if len(facing) < best_count:
            continue
        peak, count = highest_peak(points[facing, :2] @ outward, parameters.plane_gate_m)
        if count >= best_count:
            best, best_count = (outward, peak, facing), count
    if best is None:
        return None
    outward, offset_m, facing = best
    for _ in range(3):  # From the nearest of the tried directions to the plane itself.
        inlier = facing[np.abs(points[facing, :2] @ outward - offset_m) <= parameters.plane_gate_m]
        middle = points[inlier, :2].mean(axis=0)
        normal = np.linalg.svd(points[inlier, :2] - middle, full_matrices=False)[2][1]
        outward = normal * (1.0 if normal @ outward > 0 else -1.0)
        offset_m = float(middle @ outward)
    on = np.zeros(len(points), bool)
    near = np.abs(points[:, :2] @ outward - offset_m) <= parameters.plane_gate_m
    on[near & left & (-(normals[:, :2] @ outward) >= MIN_FACING - 0.1)] = True
    return (outward, offset_m, on) if on.sum() >= needed else None


def _count_along_axis(
    points: np.ndarray,
    normals: np.ndarray,
    upright: np.ndarray,
    outward: np.ndarray,
    parameters: StructureParameters,
) -> int:
    """Return the cells of the best plane along the axis nearest to a direction."""
    facing = upright & (-(normals[:, :2] @ outward) >= MIN_FACING)
    axis = int(np.abs(outward).argmax())
    if not facing.any():
        return 0
    return highest_peak(points[facing, axis], parameters.plane_gate_m)[1]


def _pieces(
    surface: Surface,
    points: np.ndarray,
    outward: np.ndarray,
    offset_m: float,
    on: np.ndarray,
    parameters: StructureParameters,
) -> Iterator[tuple[tuple[float, float], float]]:
    """Yield the range along the wall and the top of each piece of a plane that is a wall."""
    voxel_m = surface.voxel_m
    side = np.array([-outward[1], outward[0]])
    along = np.floor(points[on, :2] @ side / voxel_m).astype(int)
    height = points[on, 2]
    present = np.unique(along)
    breaks = np.flatnonzero(np.diff(present) > round(parameters.wall_gap_m / voxel_m) + 1)
    ends = np.concatenate([[0], breaks + 1, [len(present)]])
    for first, last in pairwise(ends):
        low, high = present[first], present[last - 1]
        inside = (along >= low) & (along <= high)
        top_m = float(np.quantile(height[inside], 0.98))
        bottom_m = float(np.quantile(height[inside], 0.02))
        area_m2 = inside.sum() * voxel_m**2
        box_m2 = (high - low + 1) * voxel_m * max(top_m - bottom_m, voxel_m)
        if area_m2 < parameters.wall_area_m2 or top_m < parameters.wall_top_m:
            continue
        if area_m2 < MIN_FILLED_SHARE * box_m2:
            continue
        columns = np.unique(along[inside])
        if _hidden_share(surface, columns, outward, offset_m, parameters) >= MIN_HIDDEN_SHARE:
            yield (float(low * voxel_m), float((high + 1) * voxel_m)), top_m


def _hidden_share(
    surface: Surface,
    columns: np.ndarray,
    outward: np.ndarray,
    offset_m: float,
    parameters: StructureParameters,
) -> float:
    """Return the share of the columns of a wall behind which no ray passed at any height."""
    side = np.array([-outward[1], outward[0]])
    foot = offset_m * outward + (columns[:, None] + 0.5) * surface.voxel_m * side
    free = surface.free[:, :, max(surface.floor_layer + 1, 0) :].sum(axis=2)
    passed = np.zeros(len(columns), bool)
    for behind_m in np.arange(REACH_M[0], REACH_M[1] + 1e-9, surface.voxel_m):
        plan = foot + behind_m * outward - surface.origin_m[:2]
        cell = np.floor(plan / surface.voxel_m).astype(int)
        inside = ((cell >= 0) & (cell < free.shape)).all(axis=1)
        passed[inside] |= free[tuple(cell[inside].T)] >= parameters.passed_cells
    return float(1 - passed.mean())


def _cells_near(
    surface: Surface,
    rest: np.ndarray,
    at: np.ndarray,
    points: np.ndarray,
    piece: tuple[np.ndarray, float, tuple[float, float], float],
) -> np.ndarray:
    """Return the cells of a piece of wall, with those that noise put behind it, bool [X, Y, Z]."""
    outward, offset_m, span_m, top_m = piece
    side = np.array([-outward[1], outward[0]])
    gap = points[:, :2] @ outward - offset_m
    along = points[:, :2] @ side
    own = (gap >= -0.5 * BEHIND_M) & (gap <= BEHIND_M) & (points[:, 2] <= top_m + surface.voxel_m)
    own &= (along >= span_m[0] - surface.voxel_m) & (along <= span_m[1] + surface.voxel_m)
    cells = np.zeros(rest.shape, bool)
    cells[tuple(at[own].T)] = True
    return cells

"""Exact observed free space: the empty cells that are crossed by the ray of at least one pixel.

A ray crosses a cell if it is inside the cell for more than ``CROSSED_M`` of depth before it reaches
a surface. All pixels are considered, but most cells need only a single test: either the pixel at
the projected centre of the cell shows that the cell is free, or the nearby depths show that all
rays end before the cell. The remaining cells are tested pixel by pixel.
"""

import numpy as np

from world2minecraft.core.jit import inlined, lean
from world2minecraft.rendering.ray_caster.ray import away_from_zero

CROSSED_M = 0.001
TILE = 8  # Pixels a side whose greatest depth is kept.


@lean
def max_depth_tiles(depth, tiles):
    """Compute the maximum depth of each image tile of ``TILE`` x ``TILE`` pixels.

    Args:
        depth: Depth in metres, float32 [H, W]. A depth of 0 counts as infinite.
        tiles: Result, float32 [ceil(H / TILE), ceil(W / TILE)], filled in place.
    """
    height, width = depth.shape
    tiles[:] = 0
    for v in range(height):
        for u in range(width):
            far = depth[v, u] if depth[v, u] > 0 else np.float32(np.inf)
            if far > tiles[v // TILE, u // TILE]:
                tiles[v // TILE, u // TILE] = far


@lean
def mark_free(labels, cells_to_camera, image, tiles, ends, free):
    """Mark the cells that are observed as free.

    Args:
        labels: Class of each cell, uint8 [X, Y, Z]. Only cells with the value 0 can be free.
        cells_to_camera: Matrix from region cells to camera coordinates in metres, float64 [3, 4].
        image: ``DepthImage`` of the view.
        tiles: Result of ``max_depth_tiles``.
        ends: Working memory, float64 [9, 3].
        free: Result, bool [X, Y, Z], filled in place.
    """
    intrinsics, shape = image.intrinsics, image.depth.shape
    height, width = shape
    sizes = ends[0]
    for axis in range(3):  # Half of what a cell spans along the camera's axes.
        own = cells_to_camera[axis]
        sizes[axis] = (abs(own[0]) + abs(own[1]) + abs(own[2])) / 2
    for i in range(labels.shape[0]):
        for j in range(labels.shape[1]):
            for k in range(labels.shape[2]):
                free[i, j, k] = False
                if labels[i, j, k] != 0:
                    continue
                x, y, z = _transform(cells_to_camera, i + 0.5, j + 0.5, k + 0.5)
                if z + sizes[2] <= CROSSED_M or _outside_frustum(
                    cells_to_camera, intrinsics, width, height, x, y, z
                ):
                    continue
                if z > 0:
                    u, v = (
                        intrinsics[0] * x / z + intrinsics[2],
                        intrinsics[1] * y / z + intrinsics[3],
                    )
                    inside = 0 <= u < width and 0 <= v < height
                    if inside and ray_crosses_cell(image, int(u), int(v), i, j, k):
                        free[i, j, k] = True
                        continue
                nearest = z - sizes[2]
                if nearest > CROSSED_M:
                    box = _projected_bounds(intrinsics, sizes, x, y, z)
                    if not _any_tile_deeper(tiles, shape, box, nearest):
                        continue
                box = _corner_bounds(cells_to_camera, intrinsics, ends[1:], i, j, k)
                free[i, j, k] = _any_ray_crosses(image, tiles, box, i, j, k, nearest)


@inlined
def _projected_bounds(intrinsics, sizes, x, y, z):
    """Return pixel bounds (left, right, top, bottom) of a cell in front of the camera."""
    off = 1.0 / (z * (z - sizes[2]))
    wide = intrinsics[0] * (sizes[0] * z + abs(x) * sizes[2]) * off
    high = intrinsics[1] * (sizes[1] * z + abs(y) * sizes[2]) * off
    u, v = intrinsics[0] * x / z + intrinsics[2], intrinsics[1] * y / z + intrinsics[3]
    return u - wide, u + wide, v - high, v + high


@inlined
def _transform(matrix, x, y, z):
    return (
        matrix[0, 0] * x + matrix[0, 1] * y + matrix[0, 2] * z + matrix[0, 3],
        matrix[1, 0] * x + matrix[1, 1] * y + matrix[1, 2] * z + matrix[1, 3],
        matrix[2, 0] * x + matrix[2, 1] * y + matrix[2, 2] * z + matrix[2, 3],
    )


@inlined
def _outside_frustum(cells_to_camera, intrinsics, width, height, x, y, z):
    """Return whether a cell is completely outside one side of the camera frustum."""
    low_u, high_u, low_v, high_v = 0.0, 0.0, 0.0, 0.0
    for axis in range(3):
        ex, ey, ez = (
            cells_to_camera[0, axis] / 2,
            cells_to_camera[1, axis] / 2,
            cells_to_camera[2, axis] / 2,
        )
        low_u += abs(intrinsics[0] * ex + intrinsics[2] * ez)
        high_u += abs(intrinsics[0] * ex + (intrinsics[2] - width) * ez)
        low_v += abs(intrinsics[1] * ey + intrinsics[3] * ez)
        high_v += abs(intrinsics[1] * ey + (intrinsics[3] - height) * ez)
    return (
        intrinsics[0] * x + intrinsics[2] * z < -low_u
        or intrinsics[0] * x + (intrinsics[2] - width) * z > high_u
        or intrinsics[1] * y + intrinsics[3] * z < -low_v
        or intrinsics[1] * y + (intrinsics[3] - height) * z > high_v
    )


@lean
def ray_crosses_cell(image, u, v, i, j, k):
    """Return whether the ray of pixel (u, v) crosses cell (i, j, k) before it reaches a surface."""
    place, intrinsics, depth = image.camera_to_cells, image.intrinsics, image.depth
    end = np.float64(depth[v, u]) if depth[v, u] > 0 else np.inf
    x, y = (u + 0.5 - intrinsics[2]) / intrinsics[0], (v + 0.5 - intrinsics[3]) / intrinsics[1]
    begin = 0.0
    for axis in range(3):
        low = (i if axis == 0 else (j if axis == 1 else k)) - place[axis, 3]
        d = away_from_zero(place[axis, 0] * x + place[axis, 1] * y + place[axis, 2])
        near, far = low / d, (low + 1.0) / d
        begin, end = max(begin, min(near, far)), min(end, max(near, far))
    return end - begin > CROSSED_M


@inlined
def _pixels(shape, box):
    """Return the first and last column and row of the pixels whose centres are in a box.

    Margins avoid losing pixels by rounding, and limits avoid integer overflow.
    """
    left, right = min(max(box[0] - 1e-6, 0.0), 1e6), max(min(box[1] + 1e-6, 1e6), -1.0)
    top, bottom = min(max(box[2] - 1e-6, 0.0), 1e6), max(min(box[3] + 1e-6, 1e6), -1.0)
    return (
        int(np.ceil(left - 0.5)), min(int(np.floor(right - 0.5)), shape[1] - 1),
        int(np.ceil(top - 0.5)), min(int(np.floor(bottom - 0.5)), shape[0] - 1),
    )  # fmt: skip


@lean
def _any_tile_deeper(tiles, shape, box, nearest):
    """Return whether a tile that a box covers contains a depth beyond ``nearest``."""
    u0, u1, v0, v1 = _pixels(shape, box)
    if u1 < u0 or v1 < v0:
        return False
    for row in range(v0 // TILE, v1 // TILE + 1):
        for column in range(u0 // TILE, u1 // TILE + 1):
            if tiles[row, column] > nearest:
                return True
    return False


@lean
def _any_ray_crosses(image, tiles, box, i, j, k, nearest):
    """Return whether the ray of any pixel crosses a cell whose minimum depth is ``nearest``.

    Only pixels inside ``box`` (left, right, top, bottom) are tested, except for tiles whose rays
    all end before the cell.
    """
    depth = image.depth
    u0, u1, v0, v1 = _pixels(depth.shape, box)
    if u1 < u0 or v1 < v0:
        return False
    for row in range(v0 // TILE, v1 // TILE + 1):
        for column in range(u0 // TILE, u1 // TILE + 1):
            if tiles[row, column] <= nearest:
                continue
            for v in range(max(v0, row * TILE), min(v1 + 1, (row + 1) * TILE)):
                for u in range(max(u0, column * TILE), min(u1 + 1, (column + 1) * TILE)):
                    if 0 < depth[v, u] <= nearest:
                        continue
                    if ray_crosses_cell(image, u, v, i, j, k):
                        return True
    return False


@lean
def _corner_bounds(cells_to_camera, intrinsics, ends, i, j, k):
    """Return pixel bounds (left, right, top, bottom) of the part of a cell in front of the camera.

    The part closer than ``CROSSED_M`` is cut off, because rays are too short there to count.
    """
    box = (np.inf, -np.inf, np.inf, -np.inf)
    for corner in range(8):
        a, b, c = i + corner // 4, j + corner // 2 % 2, k + corner % 2
        ends[corner, 0], ends[corner, 1], ends[corner, 2] = _transform(cells_to_camera, a, b, c)
        if ends[corner, 2] >= CROSSED_M:
            box = _grow_bounds(box, intrinsics, ends[corner, 0], ends[corner, 1], ends[corner, 2])
    for corner in range(8):
        for bit in (1, 2, 4):
            other = corner | bit
            near, far = ends[corner, 2] - CROSSED_M, ends[other, 2] - CROSSED_M
            if corner & bit or (near >= 0) == (far >= 0):
                continue
            share = near / (near - far)
            x = ends[corner, 0] + share * (ends[other, 0] - ends[corner, 0])
            y = ends[corner, 1] + share * (ends[other, 1] - ends[corner, 1])
            box = _grow_bounds(box, intrinsics, x, y, CROSSED_M)
    return box


@inlined
def _grow_bounds(box, intrinsics, x, y, z):
    u, v = intrinsics[0] * x / z + intrinsics[2], intrinsics[1] * y / z + intrinsics[3]
    return min(box[0], u), max(box[1], u), min(box[2], v), max(box[3], v)

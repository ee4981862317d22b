"""Kernels for the labels and masks of a region: cell contents, visibility and crossing rays.

Coordinates are in cells of the region: cell (i, j, k) spans [i, i + 1].
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined, lean

OUTSIDE_LABEL = 255


class DepthImage(NamedTuple):
    """A depth image, with the pose of its camera in cell coordinates of a region.

    Attributes:
        camera_to_cells: Matrix from camera coordinates in metres to cell coordinates, float64 [3,
            4].
        intrinsics: fx, fy, cx and cy in pixels, float64 [4].
        depth: Depth along the camera's z axis in metres, float32 [H, W]; 0 if a ray hits no
            surface.
    """

    camera_to_cells: np.ndarray
    intrinsics: np.ndarray
    depth: np.ndarray


@lean
def gather_labels(labels, fine, instance, to_scene, first, out_labels, out_fine, out_instance):
    """Copy the contents of a scene at the centre of each cell of a region.

    Args:
        labels: Class of each scene cell [X, Y, Z].
        fine: Fine class of each scene cell [X, Y, Z].
        instance: Object number of each scene cell [X, Y, Z].
        to_scene: Matrix from region cells to scene cells, float64 [3, 4].
        first: Region cell that the first cell of the results corresponds to, int64 [3].
        out_labels: Resulting classes, filled in place, with ``OUTSIDE_LABEL`` outside the scene.
        out_fine: Resulting fine classes, filled in place, with 0 outside the scene.
        out_instance: Resulting object numbers, filled in place, with 0 outside the scene.
    """
    nx, ny, nz = labels.shape
    for i in range(out_labels.shape[0]):
        for j in range(out_labels.shape[1]):
            for k in range(out_labels.shape[2]):
                x, y, z = first[0] + i + 0.5, first[1] + j + 0.5, first[2] + k + 0.5
                a = int(np.floor(_row(to_scene, 0, x, y, z)))
                b = int(np.floor(_row(to_scene, 1, x, y, z)))
                c = int(np.floor(_row(to_scene, 2, x, y, z)))
                if 0 <= a < nx and 0 <= b < ny and 0 <= c < nz:
                    out_labels[i, j, k] = labels[a, b, c]
                    out_fine[i, j, k] = fine[a, b, c]
                    out_instance[i, j, k] = instance[a, b, c]
                else:
                    out_labels[i, j, k] = OUTSIDE_LABEL
                    out_fine[i, j, k], out_instance[i, j, k] = 0, 0


@inlined
def _row(matrix, row, x, y, z):
    return matrix[row, 0] * x + matrix[row, 1] * y + matrix[row, 2] * z + matrix[row, 3]


@lean
def mark_in_frustum(cells_to_camera, intrinsics, width, height, marked):
    """Mark the cells whose centre is in front of the camera and inside the image.

    Args:
        cells_to_camera: Matrix from region cells to camera coordinates in metres, float64 [3, 4].
        intrinsics: fx, fy, cx and cy in pixels, float64 [4].
        width: Image width in pixels.
        height: Image height in pixels.
        marked: Result, bool [X, Y, Z], filled in place.
    """
    for i in range(marked.shape[0]):
        for j in range(marked.shape[1]):
            for k in range(marked.shape[2]):
                z = _row(cells_to_camera, 2, i + 0.5, j + 0.5, k + 0.5)
                marked[i, j, k] = False
                if z > 0:
                    u = (
                        intrinsics[0] * _row(cells_to_camera, 0, i + 0.5, j + 0.5, k + 0.5) / z
                        + intrinsics[2]
                    )
                    v = (
                        intrinsics[1] * _row(cells_to_camera, 1, i + 0.5, j + 0.5, k + 0.5) / z
                        + intrinsics[3]
                    )
                    marked[i, j, k] = 0 <= u < width and 0 <= v < height


@lean
def count_hits(solid, image, around, reach, memo, hits, cells):
    """Count the pixels whose ray reaches each cell first.

    The ray of each pixel is followed from ``around`` before its point to ``around`` behind it. The
    pixel is counted for the first solid cell that the ray enters, else for the cell in which it
    started. If none of these cells is solid, the nearest solid cell within ``reach`` is used.

    Args:
        solid: Non-zero for solid cells, uint16 [X + 2, Y + 2, Z + 2]. This array has one additional
            cell on each side.
        image: ``DepthImage`` of the view.
        around: Distance to follow the ray before and behind the point, in metres of depth.
        reach: Maximum distance to the nearest solid cell, in cells. Must be less than 0.5.
        memo: Working memory, float64 [12]: the corners of two boxes. Rays that lead from the first
            box to the second reach the same cell as the previous ray, which is true for most
            neighbouring pixels.
        hits: Number of pixels of each cell, uint32 [X, Y, Z]. The counts are added to this array.
        cells: Cell that each pixel sees as a flat index in C order (-1 for none), int32 [H, W],
            filled in place. Pass an empty array to skip this result.
    """
    place, intrinsics, depth = image.camera_to_cells, image.intrinsics, image.depth
    wanted = cells.size > 0
    counts = hits.reshape(-1)
    own, run, length = -1, -1, 0
    memo[0] = np.inf
    ox, oy, oz = place[0, 3] + 1.0, place[1, 3] + 1.0, place[2, 3] + 1.0
    for v in range(depth.shape[0]):
        y = (v + 0.5 - intrinsics[3]) / intrinsics[1]
        rx = place[0, 1] * y + place[0, 2]
        ry = place[1, 1] * y + place[1, 2]
        rz = place[2, 1] * y + place[2, 2]
        for u in range(depth.shape[1]):
            t = np.float64(depth[v, u])
            if t <= 0:
                if wanted:
                    cells[v, u] = -1
                continue
            x = (u + 0.5 - intrinsics[2]) / intrinsics[0]
            dx, dy, dz = place[0, 0] * x + rx, place[1, 0] * x + ry, place[2, 0] * x + rz
            px, py, pz = ox + t * dx, oy + t * dy, oz + t * dz
            dx, dy, dz = around * dx, around * dy, around * dz
            ax, ay, az = px - dx, py - dy, pz - dz
            bx, by, bz = px + dx, py + dy, pz + dz
            if not (
                memo[0] <= ax < memo[3]
                and memo[1] <= ay < memo[4]
                and memo[2] <= az < memo[5]
                and memo[6] <= bx < memo[9]
                and memo[7] <= by < memo[10]
                and memo[8] <= bz < memo[11]
            ):
                own = _cell_seen(solid, ax, ay, az, bx, by, bz, reach, memo)
                if own != run:
                    if run >= 0:
                        counts[run] += length
                    run, length = own, 0
            length += 1
            if wanted:
                cells[v, u] = own
    if run >= 0:
        counts[run] += length


@lean
def _cell_seen(solid, ax, ay, az, bx, by, bz, reach, memo):
    """Return the index of the cell that a short line from a to b meets, or -1 for none.

    ``memo`` is filled with the boxes of lines that meet the same cell, see ``count_hits``.
    """
    sx, sy, sz = solid.shape
    memo[0] = np.inf
    if not (0 <= ax < sx and 0 <= ay < sy and 0 <= az < sz):
        return -1
    if not (0 <= bx < sx and 0 <= by < sy and 0 <= bz < sz):
        return -1
    i, j, k = int(bx), int(by), int(bz)
    moves = (i != int(ax)) + (j != int(ay)) + (k != int(az))
    if moves > 0:
        i, j, k = first_entered(solid, ax, ay, az, bx, by, bz)
    if moves < 2:
        memo[0], memo[1], memo[2] = np.floor(ax), np.floor(ay), np.floor(az)
        memo[6], memo[7], memo[8] = np.floor(bx), np.floor(by), np.floor(bz)
        for axis in range(3):
            memo[3 + axis], memo[9 + axis] = memo[axis] + 1.0, memo[6 + axis] + 1.0
    if solid[i, j, k] == 0:
        i, j, k = nearest_solid(solid, bx, by, bz, reach)
        if moves > 0:
            memo[0] = np.inf
        for axis in range(3):
            _narrow(memo, 6 + axis, bx if axis == 0 else (by if axis == 1 else bz), reach)
    if not (1 <= i < sx - 1 and 1 <= j < sy - 1 and 1 <= k < sz - 1):
        return -1
    return ((i - 1) * (sy - 2) + j - 1) * (sz - 2) + k - 1


@inlined
def _narrow(memo, axis, at, reach):
    """Narrow an interval of ``memo`` to positions close to the same neighbours as ``at``."""
    low, high = np.floor(at) + reach, np.floor(at) + 1.0 - reach
    if at < low:
        memo[axis + 3] = low
    elif at > high:
        memo[axis] = high
    else:
        memo[axis], memo[axis + 3] = low, high


@lean
def first_entered(solid, ax, ay, az, bx, by, bz):
    """Return the first solid cell that the short line from a to b enters, else the cell of a.

    The line must cross at most one cell border along each axis.
    """
    i, j, k = int(ax), int(ay), int(az)
    tx, ty, tz = _crossing(ax, bx), _crossing(ay, by), _crossing(az, bz)
    p, q, r = i, j, k
    for _ in range(3):
        near = min(tx, ty, tz)
        if near > 1:
            break
        if near == tx:
            p, tx = int(bx), np.inf
        elif near == ty:
            q, ty = int(by), np.inf
        else:
            r, tz = int(bz), np.inf
        if solid[p, q, r] != 0:
            return p, q, r
    return i, j, k


@inlined
def _crossing(a, b):
    """Return where (0 to 1) a line from a to b crosses a cell border, or infinity for none."""
    first, last = int(a), int(b)
    return np.inf if first == last else (max(first, last) - a) / (b - a)


@lean
def nearest_solid(solid, px, py, pz, reach):
    """Return the nearest solid cell within ``reach`` of a point, or (-1, -1, -1) if none."""
    i, j, k = int(px), int(py), int(pz)
    sx, sy, sz = _side(px - i, reach), _side(py - j, reach), _side(pz - k, reach)
    best, a, b, c = reach * reach, -1, -1, -1
    if abs(sx) + abs(sy) + abs(sz) == 1:  # The most frequent case.
        p, q, r = i + sx, j + sy, k + sz
        if 0 <= p < solid.shape[0] and 0 <= q < solid.shape[1] and 0 <= r < solid.shape[2]:
            return (p, q, r) if solid[p, q, r] != 0 else (a, b, c)
    for number in range(1, 8):
        di, dj, dk = (number & 1) * sx, (number >> 1 & 1) * sy, (number >> 2) * sz
        p, q, r = i + di, j + dj, k + dk
        if not (0 <= p < solid.shape[0] and 0 <= q < solid.shape[1] and 0 <= r < solid.shape[2]):
            continue
        if solid[p, q, r] == 0:
            continue
        away = _aside(px - i, di) ** 2 + _aside(py - j, dj) ** 2 + _aside(pz - k, dk) ** 2
        if away < best:
            best, a, b, c = away, p, q, r
    return a, b, c


@inlined
def _side(at, reach):
    """Return the neighbour that a position in a cell is close to: -1, 1, or 0 for none."""
    if at < reach:
        return -1
    return 1 if at > 1.0 - reach else 0


@inlined
def _aside(at, step):
    """Return the distance of a position in a cell to the neighbour at a step."""
    if step == 0:
        return 0.0
    return 1.0 - at if step > 0 else at


@lean
def source_cells(to_box, shape, found):
    """Find the cell of a box that contains the centre of each cell of a region.

    Args:
        to_box: Matrix from region cells to box cells, float64 [3, 4].
        shape: Shape of the box in cells.
        found: Flat index of the box cell in C order (-1 outside), int32 [X, Y, Z], filled in place.
    """
    nx, ny, nz = shape
    for i in range(found.shape[0]):
        for j in range(found.shape[1]):
            for k in range(found.shape[2]):
                a = int(np.floor(_row(to_box, 0, i + 0.5, j + 0.5, k + 0.5)))
                b = int(np.floor(_row(to_box, 1, i + 0.5, j + 0.5, k + 0.5)))
                c = int(np.floor(_row(to_box, 2, i + 0.5, j + 0.5, k + 0.5)))
                found[i, j, k] = -1
                if 0 <= a < nx and 0 <= b < ny and 0 <= c < nz:
                    found[i, j, k] = (a * ny + b) * nz + c

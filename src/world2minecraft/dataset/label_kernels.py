"""Labels and masks of a region's cells: what they hold, and which pixels they show in or meet.

Coordinates are cells of the region: cell (i, j, k) spans [i, i + 1]. ``place`` float64 [3, 4] is a
camera's ``camera_to_region`` in cells; ``lens`` float64 [4] is fx, fy, cx, cy in pixels. ``depth``
is z-depth in metres, 0 where a ray meets nothing.
"""

import numpy as np

from world2minecraft.jit import inlined, lean

OUTSIDE_LABEL = 255


@lean
def gather(labels, fine, instance, to_scene, first, out_labels, out_fine, out_instance):
    """Copy to each cell of a region what the scene has at its middle.

    Args:
        labels: the scene's, [X, Y, Z].
        fine: the scene's.
        instance: the scene's.
        to_scene: float64 [3, 4], region's cells to scene's cells.
        first: int64 [3], the cell of the region that the first of ``out_*`` is.
        out_labels: filled in place; ``OUTSIDE_LABEL`` outside the scene.
        out_fine: filled in place; 0 outside.
        out_instance: filled in place; 0 outside.
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
def mark_in_frustum(to_camera, lens, width, height, marked):
    """Mark the cells whose middle is before the camera and falls into its image.

    Args:
        to_camera: float64 [3, 4], region's cells to metres of the camera.
        lens: of the camera.
        width: pixels.
        height: pixels.
        marked: bool [X, Y, Z], filled in place.
    """
    for i in range(marked.shape[0]):
        for j in range(marked.shape[1]):
            for k in range(marked.shape[2]):
                z = _row(to_camera, 2, i + 0.5, j + 0.5, k + 0.5)
                marked[i, j, k] = False
                if z > 0:
                    u = lens[0] * _row(to_camera, 0, i + 0.5, j + 0.5, k + 0.5) / z + lens[2]
                    v = lens[1] * _row(to_camera, 1, i + 0.5, j + 0.5, k + 0.5) / z + lens[3]
                    marked[i, j, k] = 0 <= u < width and 0 <= v < height


@lean
def count_hits(solid, place, lens, depth, inward, reach, hits, cells):
    """Count the pixels that see each cell first.

    A pixel's point, moved ``inward`` along its ray, counts for the cell that holds it, where that
    is solid, else for the nearest solid one within ``reach``.

    Args:
        solid: uint16 [X + 2, Y + 2, Z + 2], not 0 where a cell holds something; one cell more on
            each side than the region.
        place: the camera, in cells of the region.
        lens: of the camera.
        depth: float32 [H, W].
        inward: metres along the ray.
        reach: cells.
        hits: uint32 [X, Y, Z], added to.
        cells: int32 [H, W], the C-order number of the cell each pixel sees, -1 for none in the
            region; or of no size where that is not wanted.
    """
    nx, ny, nz = hits.shape
    height, width = depth.shape
    wanted = cells.size > 0
    for v in range(height):
        y = (v + 0.5 - lens[3]) / lens[1]
        for u in range(width):
            if wanted:
                cells[v, u] = -1
            t = depth[v, u]
            if t <= 0:
                continue
            x = (u + 0.5 - lens[2]) / lens[0]
            t = t + inward / np.sqrt(x * x + y * y + 1.0)
            px = t * (place[0, 0] * x + place[0, 1] * y + place[0, 2]) + place[0, 3] + 1.0
            py = t * (place[1, 0] * x + place[1, 1] * y + place[1, 2]) + place[1, 3] + 1.0
            pz = t * (place[2, 0] * x + place[2, 1] * y + place[2, 2]) + place[2, 3] + 1.0
            if not (0 <= px < nx + 2 and 0 <= py < ny + 2 and 0 <= pz < nz + 2):
                continue
            i, j, k = int(px), int(py), int(pz)
            if solid[i, j, k] == 0:
                i, j, k = nearest_solid(solid, px, py, pz, reach)
            if not (1 <= i <= nx and 1 <= j <= ny and 1 <= k <= nz):
                continue
            hits[i - 1, j - 1, k - 1] += 1
            if wanted:
                cells[v, u] = ((i - 1) * ny + j - 1) * nz + k - 1


@lean
def nearest_solid(solid, px, py, pz, reach):
    """Return the solid cell nearest to a point, of those around the point's own; or -1, -1, -1."""
    i, j, k = int(px), int(py), int(pz)
    best, a, b, c = reach * reach, -1, -1, -1
    for number in range(27):
        di, dj, dk = number // 9 - 1, number // 3 % 3 - 1, number % 3 - 1
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
def _aside(at, step):
    """Return how far a place in a cell is from the neighbour at a step."""
    if step == 0:
        return 0.0
    return 1.0 - at if step > 0 else at

"""The picture kernel: one pass over the pixels gives depth, range, block, face and colour.

Colour is the block's own colour times three calm factors: the face's direction, the ambient
occlusion of the eight cells around the face, and a light that the camera carries. Blocks are told
apart by a hash of their place (3 %) and by slightly darker edges, which fade out where a block
covers few pixels.
"""

import numpy as np

from world2minecraft.jit import njit
from world2minecraft.render.trace import FULL, NO_FACE, safe_start, trace

# In the order of the faces -x +x -y +y -z +z of block axes (y is up): the game's shades, softened.
FACE_SHADE = np.array([0.85, 0.85, 0.70, 1.0, 0.94, 0.94], np.float32)
TILE = 8  # Pixels a side of the bundles that share an empty way.
HASH_SHARE = 0.03
EDGE_BLOCKS, EDGE_SHADE = 0.035, 0.10
EDGE_FADE_PX = 6.0  # Edges are drawn in full where a block covers four times as many pixels.
CORNER_SHADE = 0.15  # What each solid neighbour of a corner takes; the game takes 0.2.
HEADLIGHT = 0.14  # What a face loses that the camera sees edge-on.
EXPOSURE = 1.10
GLOW = 1.12
MEMO = 10


@njit
def draw_rows(
    cells, states, box_start, boxes, colours, pose, rays, spread, first, last, with_colour,
    background, depth, distance, index, face, colour,
):  # fmt: skip
    """Fill the rows ``first`` to ``last`` (past the end) of the outputs.

    In: the first five are those of ``RayScene``. ``pose`` float64 [3, 4] carries the camera (z
    forward, metres) to the grid; ``rays`` float64 [4] is fx, fy, cx, cy in pixels, or pixels a
    metre for parallel rays; ``spread`` is 1 for a pinhole camera, 0 for parallel rays;
    ``background`` float32 [2, 3] holds the colours of the first and the last row.

    Out: ``depth`` and ``distance`` float32 [H, W] in metres, 0 where there is nothing; ``index``
    int32 [H, W], the cell's C-order index or -1; ``face`` uint8 [H, W] or ``NO_FACE``; and, where
    ``with_colour`` says so, ``colour`` uint8 [H, W, 3].
    """
    width = depth.shape[1]
    ny, nz = cells.shape[1], cells.shape[2]
    cell_m = 1.0 / np.sqrt(pose[0, 2] ** 2 + pose[1, 2] ** 2 + pose[2, 2] ** 2)
    per_x, per_y = 1.0 / rays[0], 1.0 / rays[1]
    memo = np.full(MEMO, -1.0)
    for v_tile in range(first, last, TILE):
        for u_tile in range(0, width, TILE):
            start = bundle_start(cells, pose, rays, spread, u_tile, v_tile)
            for v in range(v_tile, min(v_tile + TILE, last)):
                for u in range(u_tile, min(u_tile + TILE, width)):
                    x, y = (u + 0.5 - rays[2]) * per_x, (v + 0.5 - rays[3]) * per_y
                    ox, oy, oz, dx, dy, dz = ray_of_pixel(pose, x, y, spread)
                    t, i, j, k, side = trace(
                        cells, states, box_start, boxes, ox, oy, oz, dx, dy, dz, start
                    )
                    face[v, u] = side
                    if side == NO_FACE:
                        depth[v, u], distance[v, u], index[v, u] = 0.0, 0.0, -1
                        if with_colour:
                            _draw_sky(background, colour, v, u)
                        continue
                    length = np.sqrt((x * x + y * y) * spread + 1.0)
                    depth[v, u], distance[v, u] = t, t * length
                    index[v, u] = (i * ny + j) * nz + k
                    if with_colour:
                        row = states[i, j, k]
                        light = GLOW
                        if colours[row, 3] == 0:
                            along = dx if side < 2 else (dy if side < 4 else dz)
                            cosine = abs(along) * cell_m / length
                            cell_px = cell_m * rays[0] / (t * spread + 1 - spread)
                            light = _light(
                                cells, memo, i, j, k, side,
                                ox + t * dx - i, oy + t * dy - j, oz + t * dz - k, cosine, cell_px,
                            )  # fmt: skip
                        for n in range(3):
                            colour[v, u, n] = np.uint8(min(255.0, colours[row, n] * light + 0.5))


@njit
def ray_of_pixel(pose, x, y, spread):
    """Return origin and direction, in the grid, of the ray through (x, y) at z = 1."""
    sx, sy = x * (1 - spread), y * (1 - spread)
    x, y = x * spread, y * spread
    return (
        pose[0, 0] * sx + pose[0, 1] * sy + pose[0, 3],
        pose[1, 0] * sx + pose[1, 1] * sy + pose[1, 3],
        pose[2, 0] * sx + pose[2, 1] * sy + pose[2, 3],
        pose[0, 0] * x + pose[0, 1] * y + pose[0, 2],
        pose[1, 0] * x + pose[1, 1] * y + pose[1, 2],
        pose[2, 0] * x + pose[2, 1] * y + pose[2, 2],
    )


@njit
def _draw_sky(background, colour, v, u):
    share = v / max(colour.shape[0] - 1, 1)
    for n in range(3):
        colour[v, u, n] = np.uint8(background[0, n] * (1 - share) + background[1, n] * share)


@njit
def _light(cells, memo, i, j, k, side, fx, fy, fz, cosine, cell_px):
    """Return the light at the point (fx, fy, fz) of a cell's face.

    ``memo`` holds what belongs to the whole face that was lit last (cell, side, layer, tone, the
    light of its four corners), because neighbouring pixels mostly meet the same face.
    """
    axis = side // 2
    along = fx if axis == 0 else (fy if axis == 1 else fz)
    p, q = (fy if axis == 0 else fx), (fy if axis == 2 else fz)
    step = 0  # A face inside its cell is shaded by the cell's own layer.
    if side % 2 == 1 and along > 0.999:
        step = 1
    elif side % 2 == 0 and along < 0.001:
        step = -1
    if memo[0] != i or memo[1] != j or memo[2] != k or memo[3] != side or memo[4] != step:
        memo[0], memo[1], memo[2], memo[3], memo[4] = i, j, k, side, step
        memo[5] = 1 + HASH_SHARE * (2 * _hash(i, j, k) - 1)
        _corner_light(cells, i, j, k, axis, step, memo[6:])
    light = EXPOSURE * FACE_SHADE[side] * (1 - HEADLIGHT * (1 - cosine)) * memo[5]
    light *= (1 - p) * ((1 - q) * memo[6] + q * memo[7]) + p * ((1 - q) * memo[8] + q * memo[9])
    return light * _edge(p, q, cell_px * max(cosine, 0.2))


@njit
def bundle_start(cells, pose, rays, spread, u, v):
    """Return ``safe_start`` for the pixels of the tile whose first pixel is (u, v)."""
    x, y = (u + TILE / 2 - rays[2]) / rays[0], (v + TILE / 2 - rays[3]) / rays[1]
    half_x, half_y = TILE / 2 / rays[0], TILE / 2 / rays[1]
    off = 0.0
    for axis in range(3):
        off = max(off, abs(pose[axis, 0]) * half_x + abs(pose[axis, 1]) * half_y)
    ox, oy, oz, dx, dy, dz = ray_of_pixel(pose, x, y, spread)
    return safe_start(cells, ox, oy, oz, dx, dy, dz, off * (1 - spread), off * spread)


@njit
def _edge(p, q, block_px):
    """Return the darkness of a block's edges at (p, q) of its face."""
    strength = min(1.0, max(0.0, (block_px - EDGE_FADE_PX) / (3 * EDGE_FADE_PX)))
    inside = max(min(p, 1 - p, q, 1 - q), 0.0)
    width = max(EDGE_BLOCKS, 0.7 / max(block_px, 1e-6))
    if inside >= width:
        return 1.0
    return 1 - EDGE_SHADE * strength * (1 - inside / width)


@njit
def _corner_light(cells, i, j, k, axis, step, corners):
    """Fill ``corners`` with the light at a face's four corners, each dimmed by three neighbours."""
    for a in range(2):
        for b in range(2):
            side_a = _solid(cells, i, j, k, axis, step, 2 * a - 1, 0)
            side_b = _solid(cells, i, j, k, axis, step, 0, 2 * b - 1)
            count = 3
            if side_a + side_b < 2:
                diagonal = _solid(cells, i, j, k, axis, step, 2 * a - 1, 2 * b - 1)
                count = side_a + side_b + diagonal
            corners[2 * a + b] = 1 - CORNER_SHADE * count


@njit
def _solid(cells, i, j, k, axis, step, dp, dq):
    """Tell (1 or 0) whether a neighbour in the layer before the face is a full cube."""
    if axis == 0:
        i, j, k = i + step, j + dp, k + dq
    elif axis == 1:
        i, j, k = i + dp, j + step, k + dq
    else:
        i, j, k = i + dp, j + dq, k + step
    nx, ny, nz = cells.shape
    if i < 0 or j < 0 or k < 0 or i >= nx or j >= ny or k >= nz:
        return 0
    return 1 if cells[i, j, k] == FULL else 0


@njit
def _hash(i, j, k):
    """Return a number from 0 to 1 that belongs to a cell."""
    mixed = (i * 73856093) ^ (j * 19349663) ^ (k * 83492791)
    mixed = ((mixed ^ (mixed >> 13)) * 1274126177) & 0x7FFFFFFF
    return ((mixed ^ (mixed >> 16)) & 0xFFFF) / 65535.0

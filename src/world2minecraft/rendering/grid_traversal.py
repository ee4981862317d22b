"""Traversal of a fine grid of full cubes by one ray, used by all virtual scans.

``cells`` uses one byte for each cell, because such grids are large: 0 is a full cube, and n >= 1 is
air whose nearest cube is n cells away (Chebyshev distance), so that a ray crosses empty space in a
few steps. Coordinates, ``t`` and faces are defined as in ``rendering.ray_caster.ray``.
"""

from world2minecraft.core.jit import inlined, lean, njit
from world2minecraft.rendering.ray_caster.ray import (
    enter_grid,
    floor_clamped,
    make_ray,
    not_behind,
    ray_of_pixel,
)
from world2minecraft.rendering.scene_tables import NO_FACE

CUBE, NEAR_AIR = 0, 1
TILE = 8  # Pixels a side of the bundles that share an empty way.


@njit
def fill_distances(cells):
    """Replace each 1 in ``cells`` by the Chebyshev distance to the nearest cube, up to 255."""
    nx, ny, nz = cells.shape
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                if cells[i, j, k] >= NEAR_AIR:
                    cells[i, j, k] = _nearest_passed(cells, i, j, k, -1)
    for i in range(nx - 1, -1, -1):
        for j in range(ny - 1, -1, -1):
            for k in range(nz - 1, -1, -1):
                if cells[i, j, k] >= NEAR_AIR:
                    cells[i, j, k] = min(cells[i, j, k], _nearest_passed(cells, i, j, k, 1))


@njit
def _nearest_passed(cells, i, j, k, side):
    """Return one more than the least of the 13 neighbours that a sweep has passed."""
    nx, ny, nz = cells.shape
    best = 254  # One more still fits a byte.
    for di in range(-1, 2):
        for dj in range(-1, 2):
            for dk in range(-1, 2):
                if (di * 9 + dj * 3 + dk) * side <= 0:
                    continue
                a, b, c = i + di, j + dj, k + dk
                if 0 <= a < nx and 0 <= b < ny and 0 <= c < nz:
                    best = min(best, int(cells[a, b, c]))
    return best + 1


@lean
def safe_start(cells, ox, oy, oz, dx, dy, dz, wide, widening):
    """Return a ``t`` before which no ray of a bundle hits anything.

    At distance ``t`` all rays of the bundle are within ``wide + t * widening`` cells of the central
    ray, along each axis. Neighbouring pixels share this empty distance.
    """
    nx, ny, nz = cells.shape
    pace = max(abs(dx), abs(dy), abs(dz)) + widening
    t = 0.0
    while True:
        x, y, z = ox + t * dx, oy + t * dy, oz + t * dz
        if not (0 <= x < nx and 0 <= y < ny and 0 <= z < nz):
            return t
        clear = cells[int(x), int(y), int(z)] - NEAR_AIR - wide - t * widening
        if clear < 0.5:
            return t
        t += clear / pace


@lean
def bundle_start(cells, pose, rays, spread, u, v):
    """Return ``safe_start`` for the pixels of the tile whose first pixel is (u, v)."""
    x, y = (u + TILE / 2 - rays[2]) / rays[0], (v + TILE / 2 - rays[3]) / rays[1]
    half_x, half_y = TILE / 2 / rays[0], TILE / 2 / rays[1]
    off = 0.0
    for axis in range(3):
        off = max(off, abs(pose[axis, 0]) * half_x + abs(pose[axis, 1]) * half_y)
    ox, oy, oz, dx, dy, dz = ray_of_pixel(pose, x, y, spread)
    return safe_start(cells, ox, oy, oz, dx, dy, dz, off * (1 - spread), off * spread)


@inlined
def trace_ray(cells, ox, oy, oz, dx, dy, dz, t):
    """Return ``(t, i, j, k, face)`` of the first cube on a ray, with ``NO_FACE`` for none.

    A cube that contains the origin is ignored: there is no near plane. The given ``t`` is 0 or the
    result of ``safe_start``.
    """
    nx, ny, nz = cells.shape
    ray = make_ray(ox, oy, oz, dx, dy, dz)
    ox, oy, oz, dx, dy, dz, rx, ry, rz = ray
    face = NO_FACE
    if not (0 <= ox < nx and 0 <= oy < ny and 0 <= oz < nz):
        t, face = enter_grid(cells.shape, ray)
        if face == NO_FACE:
            return 0.0, 0, 0, 0, NO_FACE
    # On the grid's hull rounding may point outside.
    i, j, k = (
        floor_clamped(ox + t * dx, 0, nx),
        floor_clamped(oy + t * dy, 0, ny),
        floor_clamped(oz + t * dz, 0, nz),
    )
    while 0 <= i < nx and 0 <= j < ny and 0 <= k < nz:
        cell = cells[i, j, k]
        if cell == CUBE and face != NO_FACE and t > 0:
            return t, i, j, k, face
        reach = cell - NEAR_AIR if cell > NEAR_AIR else 0
        tx = ((i + 1 + reach if dx > 0 else i - reach) - ox) * rx
        ty = ((j + 1 + reach if dy > 0 else j - reach) - oy) * ry
        tz = ((k + 1 + reach if dz > 0 else k - reach) - oz) * rz
        t = min(tx, ty, tz)
        a, b, c = i, j, k
        if t == tx:
            a, face = (i + 1 + reach, 0) if dx > 0 else (i - reach - 1, 1)
        elif t == ty:
            b, face = (j + 1 + reach, 2) if dy > 0 else (j - reach - 1, 3)
        else:
            c, face = (k + 1 + reach, 4) if dz > 0 else (k - reach - 1, 5)
        if reach > 0:
            if face > 1:
                a = not_behind(i, floor_clamped(ox + t * dx, i - reach, i + reach + 1), dx)
            if face < 2 or face > 3:
                b = not_behind(j, floor_clamped(oy + t * dy, j - reach, j + reach + 1), dy)
            if face < 4:
                c = not_behind(k, floor_clamped(oz + t * dz, k - reach, k + reach + 1), dz)
        i, j, k = a, b, c
    return 0.0, 0, 0, 0, NO_FACE

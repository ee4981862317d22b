"""One ray through a grid of cells: the core that every picture and every virtual scan shares.

``cells`` says what a ray meets, one byte a cell: 0 a full cube, 1 a list of boxes, and n >= 2 air
whose nearest filled cell is n - 1 cells away (in the Chebyshev metric), so that a ray crosses
empty space in a few jumps however fine the grid is.

Coordinates are those of the grid: cell (i, j, k) spans [i, i + 1]. ``t`` counts in lengths of the
direction; a direction whose camera z is 1 gives z-depth. Scalars are float64: on a CPU that costs
no time in scalar code, and the ids come out exact.
"""

import numpy as np

from world2minecraft.jit import njit

FULL, BOXES, NEAR_AIR = 0, 1, 2
NO_FACE = 255
# The face that is hit, by its outward normal: -x, +x, -y, +y, -z, +z.
FACE_NORMALS = np.array(
    [[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]], np.int8
)
_TINY = 1e-12


@njit
def fill_distances(cells):
    """Replace each 2 of ``cells`` by 1 + the Chebyshev distance to the nearest filled cell."""
    nx, ny, nz = cells.shape
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                if cells[i, j, k] >= NEAR_AIR:
                    cells[i, j, k] = _nearer(cells, i, j, k, -1)
    for i in range(nx - 1, -1, -1):
        for j in range(ny - 1, -1, -1):
            for k in range(nz - 1, -1, -1):
                if cells[i, j, k] >= NEAR_AIR:
                    cells[i, j, k] = min(cells[i, j, k], _nearer(cells, i, j, k, 1))


@njit
def _nearer(cells, i, j, k, side):
    """Return one more than the least of the 13 neighbours that a sweep has passed."""
    nx, ny, nz = cells.shape
    best = 254
    for di in range(-1, 2):
        for dj in range(-1, 2):
            for dk in range(-1, 2):
                if (di * 9 + dj * 3 + dk) * side <= 0:
                    continue
                a, b, c = i + di, j + dj, k + dk
                if 0 <= a < nx and 0 <= b < ny and 0 <= c < nz:
                    best = min(best, max(1, int(cells[a, b, c])))
    return best + 1


@njit
def safe_start(cells, ox, oy, oz, dx, dy, dz, wide, widening):
    """Return a ``t`` before which no ray of a bundle meets anything.

    The bundle is all rays that are at ``t`` within ``wide + t * widening`` cells of the middle
    ray, along each axis. Neighbouring pixels share the empty way that this finds.
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


@njit
def trace(cells, states, box_start, boxes, ox, oy, oz, dx, dy, dz, t):
    """Return ``(t, i, j, k, face)`` of the first surface ahead; face is ``NO_FACE`` for none.

    A box or cube that holds the origin is ignored: there is no near plane. The given ``t`` is 0
    or comes from ``safe_start``.
    """
    nx, ny, nz = cells.shape
    if abs(dx) < _TINY:
        dx = _TINY
    if abs(dy) < _TINY:
        dy = _TINY
    if abs(dz) < _TINY:
        dz = _TINY
    rx, ry, rz = 1.0 / dx, 1.0 / dy, 1.0 / dz
    face = NO_FACE
    if not (0 <= ox < nx and 0 <= oy < ny and 0 <= oz < nz):
        t, face = _entry(nx, ny, nz, ox, oy, oz, rx, ry, rz)
        if face == NO_FACE:
            return 0.0, 0, 0, 0, NO_FACE
    i, j, k = int(ox + t * dx), int(oy + t * dy), int(oz + t * dz)
    if face != NO_FACE:  # On the grid's hull rounding may point outside.
        i, j, k = min(max(i, 0), nx - 1), min(max(j, 0), ny - 1), min(max(k, 0), nz - 1)
    while 0 <= i < nx and 0 <= j < ny and 0 <= k < nz:
        cell = cells[i, j, k]
        if cell == FULL:
            if face != NO_FACE and t > 0:
                return t, i, j, k, face
        elif cell == BOXES:
            state = states[i, j, k]
            near, side = meet_boxes(
                boxes, box_start[state], box_start[state + 1],
                ox - i, oy - j, oz - k, rx, ry, rz,
            )  # fmt: skip
            if side != NO_FACE:
                return near, i, j, k, side
        reach = cell - NEAR_AIR if cell > NEAR_AIR else 0
        tx = ((i + 1 + reach if dx > 0 else i - reach) - ox) * rx
        ty = ((j + 1 + reach if dy > 0 else j - reach) - oy) * ry
        tz = ((k + 1 + reach if dz > 0 else k - reach) - oz) * rz
        a, b, c = i, j, k
        if tx <= ty and tx <= tz:
            t = tx
            a, face = (i + 1 + reach, 0) if dx > 0 else (i - reach - 1, 1)
        elif ty <= tz:
            t = ty
            b, face = (j + 1 + reach, 2) if dy > 0 else (j - reach - 1, 3)
        else:
            t = tz
            c, face = (k + 1 + reach, 4) if dz > 0 else (k - reach - 1, 5)
        if reach > 0:
            if face > 1:
                a = min(max(int(np.floor(ox + t * dx)), i - reach), i + reach)
            if face < 2 or face > 3:
                b = min(max(int(np.floor(oy + t * dy)), j - reach), j + reach)
            if face < 4:
                c = min(max(int(np.floor(oz + t * dz)), k - reach), k + reach)
        i, j, k = a, b, c
    return 0.0, 0, 0, 0, NO_FACE


@njit
def _entry(nx, ny, nz, ox, oy, oz, rx, ry, rz):
    """Return ``(t, face)`` where a ray from outside enters the grid; ``NO_FACE`` if it does not."""
    ax, bx = min(-ox * rx, (nx - ox) * rx), max(-ox * rx, (nx - ox) * rx)
    ay, by = min(-oy * ry, (ny - oy) * ry), max(-oy * ry, (ny - oy) * ry)
    az, bz = min(-oz * rz, (nz - oz) * rz), max(-oz * rz, (nz - oz) * rz)
    t = max(ax, ay, az)
    if t <= 0 or t >= min(bx, by, bz):
        return 0.0, NO_FACE
    if t == ax:
        return t, 0 if rx > 0 else 1
    if t == ay:
        return t, 2 if ry > 0 else 3
    return t, 4 if rz > 0 else 5


@njit
def meet_boxes(boxes, start, stop, ox, oy, oz, rx, ry, rz):
    """Return ``(t, face)`` where a ray first enters one of a cell's boxes, from outside it."""
    best, face = np.inf, NO_FACE
    for n in range(start, stop):
        ax, bx = (boxes[n, 0] - ox) * rx, (boxes[n, 3] - ox) * rx
        ay, by = (boxes[n, 1] - oy) * ry, (boxes[n, 4] - oy) * ry
        az, bz = (boxes[n, 2] - oz) * rz, (boxes[n, 5] - oz) * rz
        enter_x, enter_y, enter_z = min(ax, bx), min(ay, by), min(az, bz)
        enter = max(enter_x, enter_y, enter_z)
        leave = min(max(ax, bx), max(ay, by), max(az, bz))
        if enter <= leave and 0 < enter < best:
            best = enter
            if enter == enter_x:
                face = 0 if rx > 0 else 1
            elif enter == enter_y:
                face = 2 if ry > 0 else 3
            else:
                face = 4 if rz > 0 else 5
    return best, face

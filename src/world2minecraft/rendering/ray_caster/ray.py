"""Intersection of a ray with a scene: empty boxes take one step, elements are tested exactly.

Coordinates are those of the grid: cell (i, j, k) spans [i, i + 1]. ``t`` is in units of the
direction's length, so a direction with camera z of 1 gives z-depth. Scalars are float64, which
costs no time in scalar CPU code and makes ids exact. Direction components are never exactly 0
(``away_from_zero``), so that their reciprocals are finite.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined, inner, inner_call, lean
from world2minecraft.rendering.scene_tables import (
    ABSOLUTE,
    BOXES,
    FLAGS,
    FULL,
    JOINS,
    NO_FACE,
    PANE,
    SEE_THROUGH,
    TURN,
)

OUTSIDE = -3  # The kind that ``cross_air`` returns where the ray has left the grid.
SOLID = 250  # Texels of glass with at least this alpha are opaque.
_TINY = 1e-12
_SLACK = 1e-9  # Cells: how far outside the cell that lists it a freestanding box may be met.


class Ray(NamedTuple):
    """The origin, direction and reciprocal direction of a ray in the grid; see ``make_ray``."""

    ox: float
    oy: float
    oz: float
    dx: float
    dy: float
    dz: float
    rx: float
    ry: float
    rz: float


class GridCamera(NamedTuple):
    """A camera in grid coordinates, as read by the kernels."""

    pose: np.ndarray  # float64 [3, 4]: camera (z forward, metres) to grid
    rays: np.ndarray  # float64 [4]: fx, fy, cx, cy in pixels, or pixels per metre if orthographic
    spread: float  # 1 for a pinhole camera, 0 for parallel rays


class Hit(NamedTuple):
    """The position of a ray: cell (i, j, k), entered at ``t`` by ``face``.

    On a surface, ``face`` is the face that was hit and ``element`` is the element, or -1 for a full
    cube. ``NO_FACE`` means no surface, or a ray that starts in the cell. i is -1 for a ray that
    misses the grid.
    """

    t: float
    i: int | np.signedinteger
    j: int | np.signedinteger
    k: int | np.signedinteger
    face: int
    element: int


class ElementTables(NamedTuple):
    """The fields of ``SceneTables`` that ``intersect_elements`` reads.

    Calls that are not inlined copy every array argument, so passing all tables would take twice as
    long.
    """

    looks: np.ndarray
    look_start: np.ndarray
    refs: np.ndarray
    boxes: np.ndarray
    traits: np.ndarray
    turns: np.ndarray
    layers: np.ndarray
    uv: np.ndarray
    texels: np.ndarray
    translucent: np.ndarray


@inlined
def away_from_zero(d):
    """Return a component of a direction, moved away from 0."""
    return d if abs(d) > _TINY else _TINY


@inlined
def make_ray(ox, oy, oz, dx, dy, dz):
    """Return the ``Ray`` with an origin and a direction."""
    dx, dy, dz = away_from_zero(dx), away_from_zero(dy), away_from_zero(dz)
    return Ray(ox, oy, oz, dx, dy, dz, 1.0 / dx, 1.0 / dy, 1.0 / dz)


@inlined
def floor_clamped(value, low, high):
    """Return the integer part of a coordinate, clipped to ``low`` to ``high`` - 1."""
    return min(max(int(np.floor(value)), low), high - 1)


@inlined
def not_behind(cell, found, d):
    """Return the cell found on a ray, or the previous cell if the found cell is behind it.

    On an edge between cells, rounding may point backwards, and two overlapping boxes would then
    pass the ray to each other forever.
    """
    return max(cell, found) if d > 0 else min(cell, found)


@inlined
def ray_of_camera(camera, u, v):
    """Return the ``Ray`` through a position (u, v) of an image, in pixels."""
    x, y = (u - camera.rays[2]) / camera.rays[0], (v - camera.rays[3]) / camera.rays[1]
    ox, oy, oz, dx, dy, dz = ray_of_pixel(camera.pose, x, y, camera.spread)
    return make_ray(ox, oy, oz, dx, dy, dz)


@inlined
def ray_of_pixel(pose, x, y, spread):
    """Return the origin and direction in the grid of the ray through (x, y) at z = 1."""
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


@lean
def enter_grid(shape, ray):
    """Return ``(t, face)`` where a ray from outside enters the grid, or ``NO_FACE`` for a miss."""
    nx, ny, nz = shape
    ox, oy, oz, rx, ry, rz = ray.ox, ray.oy, ray.oz, ray.rx, ray.ry, ray.rz
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


@inlined
def first_cell(shape, ray):
    """Return the ``Hit`` of the first cell of a ray; i is -1 if the ray misses the grid."""
    nx, ny, nz = shape
    if 0 <= ray.ox < nx and 0 <= ray.oy < ny and 0 <= ray.oz < nz:
        return Hit(0.0, int(ray.ox), int(ray.oy), int(ray.oz), NO_FACE, -1)
    t, face = enter_grid(shape, ray)
    if face == NO_FACE:
        return Hit(0.0, -1, 0, 0, NO_FACE, -1)
    i = floor_clamped(ray.ox + t * ray.dx, 0, nx)
    j = floor_clamped(ray.oy + t * ray.dy, 0, ny)
    k = floor_clamped(ray.oz + t * ray.dz, 0, nz)
    return Hit(t, i, j, k, face, -1)


@inner
def cross_air(space, bounds, ray, t, i, j, k, face):
    """Cross air from a cell, and return ``(t, i, j, k, face, kind)`` of the first other cell."""
    ox, oy, oz, dx, dy, dz, rx, ry, rz = ray
    nx, ny, nz = np.uint64(space.shape[0]), np.uint64(space.shape[1]), np.uint64(space.shape[2])
    # Whole numbers without a sign: no code for counting from the end, and one comparison each.
    while np.uint64(i) < nx and np.uint64(j) < ny and np.uint64(k) < nz:
        row = space[np.uint64(i), np.uint64(j), np.uint64(k)]
        if row < 0:
            return t, i, j, k, face, row
        box = bounds[np.uint64(row)]
        x0, y0, z0 = np.int64(box[0]), np.int64(box[1]), np.int64(box[2])
        x1, y1, z1 = np.int64(box[3]), np.int64(box[4]), np.int64(box[5])
        tx = ((x1 if dx > 0 else x0) - ox) * rx
        ty = ((y1 if dy > 0 else y0) - oy) * ry
        tz = ((z1 if dz > 0 else z0) - oz) * rz
        t = min(tx, ty, tz)
        if t == tx:
            i, face = (x1, 0) if dx > 0 else (x0 - 1, 1)
            j = not_behind(j, floor_clamped(oy + t * dy, y0, y1), dy)
            k = not_behind(k, floor_clamped(oz + t * dz, z0, z1), dz)
        elif t == ty:
            j, face = (y1, 2) if dy > 0 else (y0 - 1, 3)
            i = not_behind(i, floor_clamped(ox + t * dx, x0, x1), dx)
            k = not_behind(k, floor_clamped(oz + t * dz, z0, z1), dz)
        else:
            k, face = (z1, 4) if dz > 0 else (z0 - 1, 5)
            i = not_behind(i, floor_clamped(ox + t * dx, x0, x1), dx)
            j = not_behind(j, floor_clamped(oy + t * dy, y0, y1), dy)
    return t, i, j, k, face, OUTSIDE


@inlined
def intersect_box(boxes, n, ox, oy, oz, rx, ry, rz):
    """Return ``(t, leave, face)`` where a ray from outside enters box n, or ``NO_FACE``."""
    ax, bx = (boxes[n, 0] - ox) * rx, (boxes[n, 3] - ox) * rx
    ay, by = (boxes[n, 1] - oy) * ry, (boxes[n, 4] - oy) * ry
    az, bz = (boxes[n, 2] - oz) * rz, (boxes[n, 5] - oz) * rz
    enter_x, enter_y, enter_z = min(ax, bx), min(ay, by), min(az, bz)
    enter = max(enter_x, enter_y, enter_z)
    leave = min(max(ax, bx), max(ay, by), max(az, bz))
    if enter > leave:
        return enter, leave, NO_FACE
    if enter == enter_x:
        return enter, leave, 0 if rx > 0 else 1
    if enter == enter_y:
        return enter, leave, 2 if ry > 0 else 3
    return enter, leave, 4 if rz > 0 else 5


@inlined
def transform(turns, row, x, y, z, w):
    """Transform a point (w = 1) or a direction (w = 0) by a row of ``turns``."""
    m = turns[row]
    return (
        m[0, 0] * x + m[0, 1] * y + m[0, 2] * z + m[0, 3] * w,
        m[1, 0] * x + m[1, 1] * y + m[1, 2] * z + m[1, 3] * w,
        m[2, 0] * x + m[2, 1] * y + m[2, 2] * z + m[2, 3] * w,
    )


@inlined
def texel_at(uv, n, face, x, y, z, side_px):
    """Return the column and row of the finest texel at a point in an element's frame."""
    u = uv[n, face, 0, 0] * x + uv[n, face, 0, 1] * y + uv[n, face, 0, 2] * z + uv[n, face, 0, 3]
    v = uv[n, face, 1, 0] * x + uv[n, face, 1, 1] * y + uv[n, face, 1, 2] * z + uv[n, face, 1, 3]
    column, row = int((u - np.floor(u)) * side_px), int((v - np.floor(v)) * side_px)
    return min(column, side_px - 1), min(row, side_px - 1)


@inner_call
def intersect_elements(tables, side_px, i, j, k, ray, after, until):
    """Return ``(t, face, element)`` of the first intersection with the elements of a cell.

    Only intersections beyond ``after`` are considered, and those with freestanding elements only
    before ``until``, where the ray leaves the cell. If two coincide, the later element is used, as
    in the game.

    Args:
        tables: ``ElementTables`` with textures of ``side_px``.
        side_px: Texture size in pixels.
        i: Cell index along x.
        j: Cell index along y.
        k: Cell index along z.
        ray: ``Ray``.
        after: ``t`` up to which intersections are ignored.
        until: ``t`` at which the ray leaves the cell.
    """
    looks, look_start, refs, boxes, traits, turns, layers, uv, texels, translucent = tables
    ox, oy, oz, dx, dy, dz, rx, ry, rz = ray
    best, side, found = np.inf, NO_FACE, -1
    look = looks[i, j, k]
    for place in range(look_start[look], look_start[look + 1]):
        n = refs[place]
        flags, turn = traits[n, FLAGS], traits[n, TURN]
        px, py, pz = ox - i, oy - j, oz - k
        ex, ey, ez = dx, dy, dz
        if flags & ABSOLUTE:
            px, py, pz = ox, oy, oz
        if turn >= 0:
            px, py, pz = transform(turns, turn, px, py, pz, 1.0)
            ex, ey, ez = transform(turns, turn, dx, dy, dz, 0.0)
            ex, ey, ez = away_from_zero(ex), away_from_zero(ey), away_from_zero(ez)
            t, _, face = intersect_box(boxes, n, px, py, pz, 1 / ex, 1 / ey, 1 / ez)
        else:
            t, _, face = intersect_box(boxes, n, px, py, pz, rx, ry, rz)
        if face == NO_FACE or t <= after or t > best or t <= 0:
            continue
        if flags & ABSOLUTE and t > until + _SLACK:
            continue
        if flags & SEE_THROUGH:
            layer = layers[n, face]
            if layer < 0:
                continue
            if flags & JOINS and joins_neighbour(looks, i, j, k, face):
                continue
            if not (translucent[layer] or flags & PANE):
                column, row = texel_at(uv, n, face, px + t * ex, py + t * ey, pz + t * ez, side_px)
                if texels[layer, row * side_px + column, 3] < 128:
                    continue
        best, side, found = t, face, n
    return best, side, found


@inlined
def joins_neighbour(looks, i, j, k, face):
    """Return whether the neighbour at a face has the same appearance."""
    a, b, c = i, j, k
    step = 1 if face % 2 else -1
    if face < 2:
        a += step
    elif face < 4:
        b += step
    else:
        c += step
    nx, ny, nz = looks.shape
    if a < 0 or b < 0 or c < 0 or a >= nx or b >= ny or c >= nz:
        return False
    return looks[a, b, c] == looks[i, j, k]


@inlined
def next_cell(i, j, k, ray):
    """Return ``(t, i, j, k, face)`` of the next cell on a ray."""
    ox, oy, oz, dx, dy, dz, rx, ry, rz = ray
    tx = ((i + 1 if dx > 0 else i) - ox) * rx
    ty = ((j + 1 if dy > 0 else j) - oy) * ry
    tz = ((k + 1 if dz > 0 else k) - oz) * rz
    if tx <= ty and tx <= tz:
        return (tx, i + 1, j, k, 0) if dx > 0 else (tx, i - 1, j, k, 1)
    if ty <= tz:
        return (ty, i, j + 1, k, 2) if dy > 0 else (ty, i, j - 1, k, 3)
    return (tz, i, j, k + 1, 4) if dz > 0 else (tz, i, j, k - 1, 5)


@inner
def first_hit(tables, side_px, ray, start, after):
    """Return the ``Hit`` of the first surface at or after a cell.

    ``start`` is the ``Hit`` to continue from; surfaces up to ``after`` are ignored. ``face`` is in
    the element's own frame, or ``NO_FACE`` without a surface. A cube or box that contains the
    origin is ignored: there is no near plane.
    """
    t, i, j, k, face, _ = start
    while True:
        t, i, j, k, face, kind = cross_air(tables.space, tables.bounds, ray, t, i, j, k, face)
        if kind == OUTSIDE:
            return Hit(0.0, 0, 0, 0, NO_FACE, -1)
        if kind == FULL and face != NO_FACE and t > after:
            return Hit(t, i, j, k, face, -1)
        until, a, b, c, ahead = next_cell(i, j, k, ray)
        if kind == BOXES:
            elements = ElementTables(
                tables.looks, tables.look_start, tables.refs, tables.boxes, tables.traits,
                tables.turns, tables.layers, tables.uv, tables.texels, tables.translucent,
            )  # fmt: skip
            near, side, element = intersect_elements(elements, side_px, i, j, k, ray, after, until)
            if side != NO_FACE:
                return Hit(near, i, j, k, side, element)
        t, i, j, k, face = until, a, b, c, ahead


@inner
def is_see_through(tables, side_px, ray, hit):
    """Return whether a hit is transparent: it is glass with a texture that is not opaque there."""
    t, i, j, k, face, element = hit
    if element < 0:
        return False
    layer, flags = tables.layers[element, face], tables.traits[element, FLAGS]
    if not (tables.translucent[layer] or flags & PANE):
        return False
    x, y, z = ray.ox + t * ray.dx, ray.oy + t * ray.dy, ray.oz + t * ray.dz
    if not flags & ABSOLUTE:
        x, y, z = x - i, y - j, z - k
    if tables.traits[element, TURN] >= 0:
        x, y, z = transform(tables.turns, tables.traits[element, TURN], x, y, z, 1.0)
    column, row = texel_at(tables.uv, element, face, x, y, z, side_px)
    return tables.texels[layer, row * side_px + column, 3] < SOLID

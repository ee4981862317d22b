"""What a path meets: the place, its normal, and what its texture says there."""

import numpy as np

from world2minecraft.core.jit import inlined
from world2minecraft.rendering.path_tracing.path import put
from world2minecraft.rendering.ray_caster.ray import SOLID, carried, texel_at
from world2minecraft.rendering.ray_caster.shading import normal_of
from world2minecraft.rendering.scene_tables import ABSOLUTE, FLAGS, PANE, TURN

_FLAT = 128  # A normal map's middle.


@inlined
def is_glass(tables, n, face):
    """Tell whether one may see through a face of an element."""
    return tables.translucent[tables.layers[n, face]] or tables.traits[n, FLAGS] & PANE != 0


@inlined
def glass_texel(tables, side_px, n, face, i, j, k, x, y, z):
    """Return the place, in its texture, of the finest texel at a place of a cell's element."""
    flags, turn = tables.traits[n, FLAGS], tables.traits[n, TURN]
    if not flags & ABSOLUTE:
        x, y, z = x - i, y - j, z - k
    if turn >= 0:
        x, y, z = carried(tables.turns, turn, x, y, z, 1.0)
    column, row = texel_at(tables.uv, n, face, x, y, z, side_px)
    return row * side_px + column


@inlined
def meet_surface(tables, material, side_px, decode, s):
    """Fill the path's surface from what ``first_hit`` gave: t, cell, face and element."""
    i, j, k = s.cell[0], s.cell[1], s.cell[2]
    n = s.element
    if n < 0:
        n = tables.refs[tables.look_start[tables.looks[i, j, k]]]
        s.element = n
    for axis in range(3):
        s.at[axis] = s.o[axis] + s.t * s.d[axis]
    flags, turn = tables.traits[n, FLAGS], tables.traits[n, TURN]
    x, y, z = s.at[0] - i, s.at[1] - j, s.at[2] - k
    if flags & ABSOLUTE:
        x, y, z = s.at[0], s.at[1], s.at[2]
    if turn >= 0:
        x, y, z = carried(tables.turns, turn, x, y, z, 1.0)
    s.out[0], s.out[1], s.out[2] = normal_of(tables, turn, s.face)
    put(s.normal, s.out)
    cosine = abs(s.out[0] * s.d[0] + s.out[1] * s.d[1] + s.out[2] * s.d[2])
    m = tables.uv[n, s.face]
    u = m[0, 0] * x + m[0, 1] * y + m[0, 2] * z + m[0, 3]
    v = m[1, 0] * x + m[1, 1] * y + m[1, 2] * z + m[1, 3]
    size, start = side_px, 0
    fine = side_px * (s.wide + s.widens * s.t) / np.sqrt(max(cosine, 0.04))  # Texels.
    while fine > 1.5 and size > 1:
        start += size * size
        size //= 2
        fine *= 0.5
    column, row = int((u - np.floor(u)) * size), int((v - np.floor(v)) * size)
    at = start + min(row, size - 1) * size + min(column, size - 1)
    layer = tables.layers[n, s.face]
    texel, more = tables.texels[layer, at], material[layer, at]
    for channel in range(3):
        s.colour[channel] = decode[texel[channel]] * tables.tints[n, s.face, channel]
    s.alpha = texel[3] / 255.0
    s.clear = 1 if is_glass(tables, n, s.face) and texel[3] < SOLID else 0
    s.rough, s.metal = more[2] / 255.0, more[3] / 255.0
    s.level = max(tables.emission[n], more[4] / 255.0)
    if more[0] != _FLAT or more[1] != _FLAT:
        lean_normal(tables, turn, m, (more[0] - 128) / 127.0, (more[1] - 128) / 127.0, s)


@inlined
def lean_normal(tables, turn, m, p, q, s):
    """Turn the path's normal by a normal map: p along u, q along v (down)."""
    for axis in range(3):
        nx, ny, nz = normal_of(tables, turn, 2 * axis + 1)
        along = p * m[0, axis] + q * m[1, axis]  # Textures may be mirrored or stretched.
        s.normal[0] += along * nx
        s.normal[1] += along * ny
        s.normal[2] += along * nz
    length = np.sqrt(s.normal[0] ** 2 + s.normal[1] ** 2 + s.normal[2] ** 2)
    facing = s.normal[0] * s.d[0] + s.normal[1] * s.d[1] + s.normal[2] * s.d[2]
    if facing > -0.02 * length:  # It would be seen from behind.
        put(s.normal, s.out)
        return
    for axis in range(3):
        s.normal[axis] /= length

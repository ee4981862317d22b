"""The colour of a point: its texel, times the light there, in linear light.

The light of a face is found at the four corners of the block's face that the point lies in, as
colours, and is even between them; neighbouring pixels mostly share those four.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.jit import inlined, lean
from world2minecraft.render.light.background import Background, background_light
from world2minecraft.render.light.lit import (
    LitParameters,
    direction_shade,
    glow_light,
    lit_colour,
    to_linear,
)
from world2minecraft.render.light.tone import Tone, finish
from world2minecraft.render.ray import begin, carried, first_hit, steep
from world2minecraft.render.tables import (
    ABSOLUTE,
    EVEN,
    FACE_NORMALS,
    FLAGS,
    NO_FACE,
    TURN,
    UNSHADED,
)

MEMO = 20  # Numbers; see ``find_light``.
MOST_GLASS = 32  # Panes that one ray goes through.
_OFF = 1e-5  # Blocks: how far before a surface a ray to the sun begins.
_NEAR_EDGE = 1e-3  # Blocks: a face so near its cell's boundary is lit from beyond it.


class Lamp(NamedTuple):
    """What the kernels know of light and of how it becomes sRGB."""

    lit: LitParameters
    tone: Tone
    background: Background
    paper: np.ndarray  # float64 [2, 3]: linear colours of the first and last row
    by_row: bool  # paper lies behind all, and not the sky


@inlined
def shade_hit(
    tables, side_px, lamp, memo, rays, spread, t, i, j, k, side, element,
    ox, oy, oz, dx, dy, dz, length,
):  # fmt: skip
    """Return ``(red, green, blue, alpha)`` of what ``first_hit`` gave, linear."""
    gx, gy, gz = ox + t * dx, oy + t * dy, oz + t * dz
    n = element
    if element < 0:
        n = tables.refs[tables.look_start[tables.looks[i, j, k]]]
    flags, turn = tables.traits[n, FLAGS], tables.traits[n, TURN]
    ex, ey, ez = gx - i, gy - j, gz - k
    if flags & ABSOLUTE:
        ex, ey, ez = gx, gy, gz
    if turn >= 0:
        ex, ey, ez = carried(tables.turns, turn, ex, ey, ez, 1.0)
    nx, ny, nz = normal_of(tables, turn, side)
    face = main_face(nx, ny, nz)
    speed = np.sqrt(dx * dx + dy * dy + dz * dz)
    cosine = abs(nx * dx + ny * dy + nz * dz) / speed
    cell_px = rays[0] * length / (speed * (t * spread + 1 - spread))
    r, g, b, alpha = texel_colour(tables, side_px, lamp.tone, n, side, ex, ey, ez, cell_px, cosine)
    find_light(tables.light, lamp.lit, memo, i, j, k, face, flags & EVEN, gx - i, gy - j, gz - k)
    p, q = (gy - j if face < 2 else gx - i), (gy - j if face >= 4 else gz - k)
    p, q = min(max(p, 0.0), 1.0), min(max(q, 0.0), 1.0)
    shade = 1.0
    if not flags & UNSHADED:
        shade = direction_shade(nx, ny, nz, cosine, lamp.lit)
        if lamp.lit.screen > 0:
            shade = to_linear(shade)
    red = shade * between(memo, 8, p, q)
    green = shade * between(memo, 12, p, q)
    blue = shade * between(memo, 16, p, q)
    if lamp.lit.sun_r > 0:
        sun = nx * lamp.lit.sun_x + ny * lamp.lit.sun_y + nz * lamp.lit.sun_z
        if sun > 0 and sun_reaches(
            tables, side_px, lamp.lit, gx + _OFF * nx, gy + _OFF * ny, gz + _OFF * nz
        ):
            red, green, blue = (
                red + sun * lamp.lit.sun_r,
                green + sun * lamp.lit.sun_g,
                blue + sun * lamp.lit.sun_b,
            )
    if tables.emission[n] > 0:
        own = glow_light(15.0 * tables.emission[n], lamp.lit)
        red, green, blue = max(own, red), max(own, green), max(own, blue)
    return r * red, g * green, b * blue, alpha


@inlined
def normal_of(tables, turn, side):
    """Return the outward unit normal, in the grid, of a face of an element."""
    if turn < 0:
        return (
            float(FACE_NORMALS[side, 0]),
            float(FACE_NORMALS[side, 1]),
            float(FACE_NORMALS[side, 2]),
        )
    sign = 1.0 if side % 2 else -1.0
    row = tables.normals[turn, side // 2]
    return sign * row[0], sign * row[1], sign * row[2]


@inlined
def main_face(nx, ny, nz):
    """Return the face of a block that looks most like a normal."""
    x, y, z = abs(nx), abs(ny), abs(nz)
    if x >= y and x >= z:
        return 1 if nx > 0 else 0
    if y >= z:
        return 3 if ny > 0 else 2
    return 5 if nz > 0 else 4


@inlined
def between(memo, at, p, q):
    """Return the value at (p, q) between four corners."""
    return (1 - p) * ((1 - q) * memo[at] + q * memo[at + 1]) + p * (
        (1 - q) * memo[at + 2] + q * memo[at + 3]
    )


@inlined
def texel_colour(tables, side_px, tone, n, side, x, y, z, cell_px, cosine):
    """Return linear red, green, blue and alpha of the texture at a point of an element.

    ``cell_px`` is how many pixels a block would cover there, seen straight on.
    """
    m = tables.uv[n, side]
    u = m[0, 0] * x + m[0, 1] * y + m[0, 2] * z + m[0, 3]
    v = m[1, 0] * x + m[1, 1] * y + m[1, 2] * z + m[1, 3]
    size, start = side_px, 0
    fine = side_px / (cell_px * np.sqrt(max(cosine, 0.04)))  # Texels a pixel.
    while fine > 1.5 and size > 1:
        start += size * size
        size //= 2
        fine *= 0.5
    column, row = int((u - np.floor(u)) * size), int((v - np.floor(v)) * size)
    at = start + min(row, size - 1) * size + min(column, size - 1)
    texel = tables.texels[tables.layers[n, side], at]
    tint = tables.tints[n, side]
    return (
        tone.decode[texel[0]] * tint[0],
        tone.decode[texel[1]] * tint[1],
        tone.decode[texel[2]] * tint[2],
        texel[3] / 255.0,
    )


@inlined
def find_light(light, lit, memo, i, j, k, face, even, px, py, pz):
    """Fill the memo with the light at the corners of a block's face, unless it has them.

    ``memo``: the cell, face and layer that it belongs to, then red at four corners from 8 on,
    green from 12, blue from 16. ``even`` leaves out what corners darken.
    """
    along = px if face < 2 else (py if face < 4 else pz)
    step = 0  # A face inside its cell is lit by the cell's own layer.
    if face % 2 == 1 and along > 1 - _NEAR_EDGE:
        step = 1
    elif face % 2 == 0 and along < _NEAR_EDGE:
        step = -1
    way = face + 8 * step + (64 if even else 0)
    if memo[0] == i and memo[1] == j and memo[2] == k and memo[3] == way:
        return
    memo[0], memo[1], memo[2], memo[3] = i, j, k, way
    for corner in range(4):
        a, b = corner // 2, corner % 2
        if face < 2:
            word = int(light[0, i + step + 1, j + a, k + b])
        elif face < 4:
            word = int(light[1, i + a, j + step + 1, k + b])
        else:
            word = int(light[2, i + a, j + b, k + step + 1])
        dark = 0.0 if even else float(word >> 12)
        memo[8 + corner], memo[12 + corner], memo[16 + corner] = lit_colour(
            (word & 63) * 0.25, (word >> 6 & 63) * 0.25, dark, 1.0, 0.0, lit
        )


@lean
def sun_reaches(tables, side_px, lit, ox, oy, oz):
    """Tell whether nothing but glass lies between a point and the sun."""
    dx, dy, dz = steep(lit.sun_x), steep(lit.sun_y), steep(lit.sun_z)
    rx, ry, rz = 1.0 / dx, 1.0 / dy, 1.0 / dz
    t, i, j, k, face = begin(tables.space.shape, ox, oy, oz, dx, dy, dz, rx, ry, rz)
    if i < 0:
        return True
    for _ in range(MOST_GLASS):
        t, i, j, k, face, element = first_hit(
            tables, side_px, ox, oy, oz, dx, dy, dz, rx, ry, rz, t, i, j, k, face, t
        )
        if face == NO_FACE:
            return True
        if element < 0 or not tables.translucent[tables.layers[element, face]]:
            return False
        face = NO_FACE
    return False


@inlined
def write_pixel(lamp, colour, v, u, red, green, blue):
    """Write a linear colour as sRGB."""
    colour[v, u, 0], colour[v, u, 1], colour[v, u, 2] = finish(red, green, blue, lamp.tone)


@inlined
def write_sky(lamp, colour, v, u, dx, dy, dz, red, green, blue, clear):
    """Write the sky, seen through what lies before it."""
    if lamp.by_row:
        share = v / max(colour.shape[0] - 1, 1)
        r = lamp.paper[0, 0] * (1 - share) + lamp.paper[1, 0] * share
        g = lamp.paper[0, 1] * (1 - share) + lamp.paper[1, 1] * share
        b = lamp.paper[0, 2] * (1 - share) + lamp.paper[1, 2] * share
    else:
        speed = np.sqrt(dx * dx + dy * dy + dz * dz)
        r, g, b = background_light(dx / speed, dy / speed, dz / speed, lamp.background)
    write_pixel(lamp, colour, v, u, red + clear * r, green + clear * g, blue + clear * b)

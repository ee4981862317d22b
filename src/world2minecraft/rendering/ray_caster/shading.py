"""Shading of a point: its texel times the light there, in linear light.

The light of a block's face is computed at its four corners and interpolated between them.
Neighbouring pixels usually share these corners.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined, inner, inner_call, lean
from world2minecraft.rendering.light.pixel_light import (
    LightCoefficients,
    direction_shade,
    emission_light,
    light_multipliers,
    to_linear,
)
from world2minecraft.rendering.light.sky import Background, background_light
from world2minecraft.rendering.light.tone_mapping import Tone, tone_map_pixel
from world2minecraft.rendering.ray_caster.ray import (
    Hit,
    first_cell,
    first_hit,
    is_see_through,
    make_ray,
    transform,
)
from world2minecraft.rendering.scene_tables import (
    ABSOLUTE,
    EVEN,
    FACE_NORMALS,
    FLAGS,
    NO_FACE,
    TURN,
    UNSHADED,
)

CORNER_LIGHT_NUMBERS = 20  # See ``cache_corner_light``.
MAX_GLASS_PANES = 32  # Panes that one ray goes through.
MAX_TEXELS = 2.25  # For a pixel, before the next mip level takes over.
SURFACE_OFFSET = 1e-5  # Blocks: how far before a surface a ray to the sun begins.
_NEAR_EDGE = 1e-3  # Blocks: a face so near its cell's boundary is lit from beyond it.


class ShadingParameters(NamedTuple):
    """The light and tone mapping parameters of the kernels."""

    lit: LightCoefficients
    corners: np.ndarray  # float32 [16384, 3]: the light that each entry of the lattice stands for
    shades: np.ndarray  # float64 [6]: of each face of a block
    tone: Tone
    background: Background
    paper: np.ndarray  # float64 [2, 3]: linear colours of the first and last row
    by_row: bool  # paper lies behind all, and not the sky


@inner
def shade_hit(tables, side_px, shading, memo, block_px, ray, hit, speed):
    """Return the linear ``(red, green, blue, alpha)`` of a hit.

    Args:
        tables: ``SceneTables`` with textures of ``side_px``.
        side_px: Texture size in pixels.
        shading: ``ShadingParameters``.
        memo: Cache of corner light, float64 [CORNER_LIGHT_NUMBERS]; see ``cache_corner_light``.
        block_px: Number of pixels that a block would cover there, seen frontally.
        ray: ``Ray``.
        hit: ``Hit`` with a surface.
        speed: Length of the ray's direction.
    """
    t, i, j, k, side, element = hit
    dx, dy, dz = ray.dx, ray.dy, ray.dz
    gx, gy, gz = ray.ox + t * dx, ray.oy + t * dy, ray.oz + t * dz
    px, py, pz = gx - i, gy - j, gz - k
    n = np.int64(element)
    if element < 0:
        look = tables.looks[np.uint64(i), np.uint64(j), np.uint64(k)]
        n = np.int64(tables.refs[np.uint64(tables.look_start[np.uint64(look)])])
    traits = tables.traits[np.uint64(n)]
    flags, turn = traits[FLAGS], traits[TURN]
    ex, ey, ez, face = px, py, pz, side
    if flags & ABSOLUTE:
        ex, ey, ez = gx, gy, gz
    if turn >= 0:
        ex, ey, ez = transform(tables.turns, turn, ex, ey, ez, 1.0)
        nx, ny, nz = normal_of(tables, turn, side)
        face = dominant_face(nx, ny, nz)
        cosine = abs(nx * dx + ny * dy + nz * dz) / speed
        shade = face_shade(nx, ny, nz, cosine, shading.lit)
    else:
        cosine = abs(dx if side < 2 else (dy if side < 4 else dz)) / speed
        shade = shading.shades[np.uint64(side)]
        if shading.lit.headlight > 0:
            nx, ny, nz = normal_of(tables, -1, side)
            shade = face_shade(nx, ny, nz, cosine, shading.lit)
    if flags & UNSHADED:
        shade = 1.0
    r, g, b, alpha = texel_colour(
        tables, side_px, shading.tone, n, side, ex, ey, ez, block_px, cosine
    )
    cache_corner_light(tables.light, shading.corners, memo, i, j, k, face, flags & EVEN, px, py, pz)
    p, q = (py if face < 2 else px), (py if face >= 4 else pz)
    p, q = min(max(p, 0.0), 1.0), min(max(q, 0.0), 1.0)
    red = shade * bilinear(memo, 8, p, q)
    green = shade * bilinear(memo, 12, p, q)
    blue = shade * bilinear(memo, 16, p, q)
    if shading.lit.sun_r > 0:
        sun = sun_cosine(tables, side_px, shading.lit, turn, side, gx, gy, gz)
        red, green, blue = (
            red + sun * shading.lit.sun_r,
            green + sun * shading.lit.sun_g,
            blue + sun * shading.lit.sun_b,
        )
    if tables.emission[n] > 0:
        own = emission_light(15.0 * tables.emission[n], shading.lit)
        red, green, blue = max(own, red), max(own, green), max(own, blue)
    return r * red, g * green, b * blue, alpha


@inlined
def face_shade(nx, ny, nz, cosine, lit):
    """Return the linear shade of a face by its normal."""
    shade = direction_shade(nx, ny, nz, cosine, lit)
    return to_linear(shade) if lit.screen > 0 else shade


def block_face_shades(lit: LightCoefficients) -> np.ndarray:
    """Return the linear shade of each face of a block, float64 [6]."""
    return np.array([face_shade(x, y, z, 1.0, lit) for x, y, z in FACE_NORMALS.astype(float)])


def corner_lights(lit: LightCoefficients) -> np.ndarray:
    """Return the linear light of each possible light lattice entry, float32 [16384, 3]."""
    result = np.empty((1 << 14, 3), np.float32)
    _fill_corners(result, lit)
    return result


@lean
def _fill_corners(result, lit):
    for word in range(len(result)):
        sky, block, dark = (word & 63) * 0.25, (word >> 6 & 63) * 0.25, float(word >> 12)
        r, g, b = light_multipliers(sky, block, dark, 1.0, 0.0, lit)
        result[word, 0], result[word, 1], result[word, 2] = r, g, b


@inner
def sun_cosine(tables, side_px, lit, turn, side, gx, gy, gz):
    """Return the cosine of the sun on a face, or 0 if it does not shine there."""
    nx, ny, nz = normal_of(tables, turn, side)
    cosine = nx * lit.sun_x + ny * lit.sun_y + nz * lit.sun_z
    if cosine <= 0:
        return 0.0
    free = is_sunlit(
        tables,
        side_px,
        lit,
        gx + SURFACE_OFFSET * nx,
        gy + SURFACE_OFFSET * ny,
        gz + SURFACE_OFFSET * nz,
    )
    return cosine if free else 0.0


@inlined
def normal_of(tables, turn, side):
    """Return the outward unit normal of an element's face, in the grid."""
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
def dominant_face(nx, ny, nz):
    """Return the block face whose direction is most similar to a normal."""
    x, y, z = abs(nx), abs(ny), abs(nz)
    if x >= y and x >= z:
        return 1 if nx > 0 else 0
    if y >= z:
        return 3 if ny > 0 else 2
    return 5 if nz > 0 else 4


@inlined
def bilinear(memo, at, p, q):
    """Return the bilinear interpolation at (p, q) of four corner values."""
    return (1 - p) * ((1 - q) * memo[at] + q * memo[at + 1]) + p * (
        (1 - q) * memo[at + 2] + q * memo[at + 3]
    )


@inner
def texel_colour(tables, side_px, tone, n, side, x, y, z, block_px, cosine):
    """Return the linear red, green, blue and alpha of the texture at a point of an element."""
    n, side = np.uint64(n), np.uint64(side)
    m = tables.uv[n, side]
    u = m[0, 0] * x + m[0, 1] * y + m[0, 2] * z + m[0, 3]
    v = m[1, 0] * x + m[1, 1] * y + m[1, 2] * z + m[1, 3]
    size, start = side_px, 0
    # Texels a pixel, by its longer side on the face: the shorter one would leave moire.
    many = side_px / (block_px * max(cosine, 0.04))
    many = many * many
    while many > MAX_TEXELS and size > 1:
        start += size * size
        size //= 2
        many *= 0.25
    column, row = int((u - np.floor(u)) * size), int((v - np.floor(v)) * size)
    at = start + min(row, size - 1) * size + min(column, size - 1)
    texel = tables.texels[np.uint64(tables.layers[n, side]), np.uint64(at)]
    tint = tables.tints[n, side]
    return (
        tone.decode[np.uint64(texel[0])] * tint[0],
        tone.decode[np.uint64(texel[1])] * tint[1],
        tone.decode[np.uint64(texel[2])] * tint[2],
        texel[3] * (1 / 255),
    )


@inner
def cache_corner_light(light, corners, memo, i, j, k, face, even, px, py, pz):
    """Fill the cache with the light at the corners of a block's face, unless already there.

    ``memo`` contains the cell, face and layer, then red at four corners from index 8, green from 12
    and blue from 16. ``even`` disables ambient occlusion.
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
            word = light[0, np.uint64(i + step + 1), np.uint64(j + a), np.uint64(k + b)]
        elif face < 4:
            word = light[1, np.uint64(i + a), np.uint64(j + step + 1), np.uint64(k + b)]
        else:
            word = light[2, np.uint64(i + a), np.uint64(j + b), np.uint64(k + step + 1)]
        colour = corners[np.uint64(word) & np.uint64(0xFFF if even else 0x3FFF)]
        memo[8 + corner], memo[12 + corner], memo[16 + corner] = colour[0], colour[1], colour[2]


@inner_call
def is_sunlit(tables, side_px, lit, ox, oy, oz):
    """Return whether only glass is between a point and the sun."""
    ray = make_ray(ox, oy, oz, lit.sun_x, lit.sun_y, lit.sun_z)
    hit = first_cell(tables.space.shape, ray)
    if hit.i < 0:
        return True
    for _ in range(MAX_GLASS_PANES):
        hit = first_hit(tables, side_px, ray, hit, hit.t)
        if hit.face == NO_FACE:
            return True
        if not is_see_through(tables, side_px, ray, hit):
            return False
        hit = Hit(hit.t, hit.i, hit.j, hit.k, NO_FACE, hit.element)
    return False


@inner
def write_pixel(shading, colour, v, u, red, green, blue):
    """Write a linear colour as sRGB."""
    colour[v, u, 0], colour[v, u, 1], colour[v, u, 2] = tone_map_pixel(
        red, green, blue, shading.tone
    )


@inner
def write_sky(shading, colour, v, u, ray, red, green, blue, clear):
    """Write the sky, seen through the glass in front of it."""
    if shading.by_row:
        share = v / max(colour.shape[0] - 1, 1)
        r = shading.paper[0, 0] * (1 - share) + shading.paper[1, 0] * share
        g = shading.paper[0, 1] * (1 - share) + shading.paper[1, 1] * share
        b = shading.paper[0, 2] * (1 - share) + shading.paper[1, 2] * share
    else:
        dx, dy, dz = ray.dx, ray.dy, ray.dz
        speed = np.sqrt(dx * dx + dy * dy + dz * dz)
        r, g, b = background_light(dx / speed, dy / speed, dz / speed, shading.background)
    write_pixel(shading, colour, v, u, red + clear * r, green + clear * g, blue + clear * b)

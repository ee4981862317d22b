"""The surface that a path hits, and its scattering of light by a diffuse and a glossy lobe.

``PATH`` is the record of one path, which the kernels of a band of rows share. Lengths are in grid
cells, directions are unit vectors, and colours are linear. The diffuse lobe is Lambertian. The
glossy lobe is the microfacet model of Trowbridge and Reitz (GGX) with Smith shadowing and sampling
of visible normals. Rough non-metallic surfaces have no glossy lobe, because it would cost rays
without a visible effect.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined
from world2minecraft.rendering.path_tracing.sky_light import tangent_frame
from world2minecraft.rendering.ray_caster.ray import SOLID, texel_at, transform
from world2minecraft.rendering.ray_caster.shading import normal_of
from world2minecraft.rendering.scene_tables import ABSOLUTE, FLAGS, PANE, TURN, SceneTables

# Where the light of a path goes: found at its first surface that is no glass.
UNDECIDED, MATT, GLOSS = 0, 1, 2

_NUMBER, _WHOLE, _POINT = np.float64, np.int64, (np.float64, (3,))
PATH = np.dtype(
    [
        ("key", np.uint32),  # of the pixel's random numbers
        ("sample", _WHOLE),
        ("use", _WHOLE),  # of random numbers, the next
        # The ray, and how wide a pixel's beam is at its origin and how it widens.
        ("o", *_POINT), ("d", *_POINT), ("wide", _NUMBER), ("widens", _NUMBER),
        # What a surface there would send on to the eye.
        ("share", *_POINT), ("lobe", _WHOLE), ("sharp", _WHOLE), ("bounces", _WHOLE),
        # The surface: where it is, its outward normal, the one of its relief, and its look.
        ("t", _NUMBER), ("cell", np.int64, (3,)), ("face", _WHOLE), ("element", _WHOLE),
        ("at", *_POINT), ("out", *_POINT), ("normal", *_POINT), ("colour", *_POINT),
        ("alpha", _NUMBER), ("clear", _WHOLE), ("rough", _NUMBER), ("metal", _NUMBER),
        ("level", _NUMBER), ("own", _WHOLE), ("first", *_POINT), ("first_out", *_POINT),
        # How it scatters: shares of both lobes, and how often the gloss is followed.
        ("matt", *_POINT), ("shine", *_POINT), ("gloss_odds", _NUMBER),
        # The light that is aimed at: direction, distance, light over density, density.
        ("to", *_POINT), ("far", _NUMBER), ("aimed", *_POINT), ("density", _NUMBER),
        ("unseen", _WHOLE),  # whether no ray can meet it
        ("way", *_POINT),
        # The last bounce: density of its direction, and what the choice of a lamp depended on.
        ("last", _NUMBER), ("from_at", *_POINT), ("from_out", *_POINT), ("weights", _NUMBER),
        ("aim_odds", _NUMBER),  # how often lamps are aimed at
        # What the sample has come to.
        ("seen", *_POINT), ("spread", *_POINT), ("gloss", *_POINT),
        ("spread_share", *_POINT), ("gloss_share", *_POINT),
    ],
    align=True,
)  # fmt: skip
_FLAT = 128  # A normal map's middle.
MIN_WIDTH = 0.02  # Of the glossy lobe: what is smoother is followed as if it were this.
SHARP_WIDTH = 0.05  # Below it lamps are found by following the gloss alone.
_DULL, _FADE = 0.50, 0.15  # Width from which no gloss is left, and how it fades before.
_MIRROR = 0.04  # What glass and lacquer mirror straight ahead.


class PathScene(NamedTuple):
    """The data of a scene that the path tracing kernels read."""

    tables: SceneTables
    material: np.ndarray  # uint8 [L, M, 5], see ``rendering.atlas``
    side_px: int  # of a texture
    decode: np.ndarray  # float32 [256], sRGB to linear light


def new_path() -> np.ndarray:
    """Return an array with one path record."""
    return np.zeros(1, PATH)


@inlined
def copy_vector(to, vector):
    """Copy three numbers without the memory allocation of numba's array copy."""
    to[0], to[1], to[2] = vector[0], vector[1], vector[2]


@inlined
def is_glass(tables, n, face):
    """Return whether a face of an element is transparent."""
    return tables.translucent[tables.layers[n, face]] or tables.traits[n, FLAGS] & PANE != 0


@inlined
def glass_texel(tables, side_px, n, face, i, j, k, x, y, z):
    """Return the index of the finest texel at a point of a cell's element."""
    flags, turn = tables.traits[n, FLAGS], tables.traits[n, TURN]
    if not flags & ABSOLUTE:
        x, y, z = x - i, y - j, z - k
    if turn >= 0:
        x, y, z = transform(tables.turns, turn, x, y, z, 1.0)
    column, row = texel_at(tables.uv, n, face, x, y, z, side_px)
    return row * side_px + column


@inlined
def load_surface(scene, s):
    """Fill the path's surface from the result of ``first_hit``: t, cell, face and element."""
    tables, material, side_px, decode = scene
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
        x, y, z = transform(tables.turns, turn, x, y, z, 1.0)
    s.out[0], s.out[1], s.out[2] = normal_of(tables, turn, s.face)
    copy_vector(s.normal, s.out)
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
        apply_normal_map(tables, turn, m, (more[0] - 128) / 127.0, (more[1] - 128) / 127.0, s)


@inlined
def apply_normal_map(tables, turn, m, p, q, s):
    """Rotate the path's normal by a normal map, with p along u and q along v (down)."""
    for axis in range(3):
        nx, ny, nz = normal_of(tables, turn, 2 * axis + 1)
        along = p * m[0, axis] + q * m[1, axis]  # Textures may be mirrored or stretched.
        s.normal[0] += along * nx
        s.normal[1] += along * ny
        s.normal[2] += along * nz
    length = np.sqrt(s.normal[0] ** 2 + s.normal[1] ** 2 + s.normal[2] ** 2)
    facing = s.normal[0] * s.d[0] + s.normal[1] * s.d[1] + s.normal[2] * s.d[2]
    if facing > -0.02 * length:  # It would be seen from behind.
        copy_vector(s.normal, s.out)
        return
    for axis in range(3):
        s.normal[axis] /= length


@inlined
def fresnel(base, cosine):
    """Return the reflectance at an angle from the reflectance at normal incidence (Schlick)."""
    dark = 1.0 - min(max(cosine, 0.0), 1.0)
    square = dark * dark
    return base + (1.0 - base) * square * square * dark


@inlined
def lobe_width(s):
    """Return the width of the glossy lobe, the alpha of GGX."""
    return max(s.rough * s.rough, MIN_WIDTH)


@inlined
def pane_reflectance(s):
    """Return the reflectance of a glass pane, including both of its faces."""
    cosine = -(s.out[0] * s.d[0] + s.out[1] * s.d[1] + s.out[2] * s.d[2])
    once = fresnel(_MIRROR, cosine)
    return 2.0 * once / (1.0 + once)


@inlined
def set_lobes(s):
    """Compute the weights of both lobes, and the probability of sampling the glossy lobe."""
    # By the face, since relief that is seen edge-on would glitter.
    cosine = -(s.out[0] * s.d[0] + s.out[1] * s.d[1] + s.out[2] * s.d[2])
    width = lobe_width(s)
    glossy = min(max((_DULL - width) / _FADE, 0.0), 1.0)
    gloss_light, matt_light = 0.0, 0.0
    lacquer = glossy * fresnel(_MIRROR, cosine)
    for n in range(3):
        s.shine[n] = (1.0 - s.metal) * lacquer + s.metal * fresnel(s.colour[n], cosine)
        s.matt[n] = (1.0 - s.metal) * (1.0 - lacquer) * s.colour[n]
        gloss_light += s.shine[n]
        matt_light += s.matt[n]
    s.gloss_odds = 0.0
    if gloss_light > 0:
        s.gloss_odds = min(max(gloss_light / (gloss_light + matt_light), 0.15), 0.85)
        if matt_light <= 0:
            s.gloss_odds = 1.0


@inlined
def smith_shadowing(cosine, width):
    """Return Smith's fraction of microfacets that are visible at an angle."""
    if cosine <= 0:
        return 0.0
    square = cosine * cosine
    return 2.0 / (1.0 + np.sqrt(1.0 + width * width * (1.0 - square) / square))


@inlined
def evaluate_gloss(s, x, y, z):
    """Return ``(value, density)`` of the glossy lobe in a direction, including the cosine.

    The value does not include the weight of the lobe, ``shine``.
    """
    width = lobe_width(s)
    seen = -(s.normal[0] * s.d[0] + s.normal[1] * s.d[1] + s.normal[2] * s.d[2])
    lit = s.normal[0] * x + s.normal[1] * y + s.normal[2] * z
    if seen <= 0 or lit <= 0:
        return 0.0, 0.0
    hx, hy, hz = x - s.d[0], y - s.d[1], z - s.d[2]
    length = np.sqrt(hx * hx + hy * hy + hz * hz)
    up = (s.normal[0] * hx + s.normal[1] * hy + s.normal[2] * hz) / max(length, 1e-12)
    square = width * width
    under = up * up * (square - 1.0) + 1.0
    spread = square / (np.pi * under * under)
    density = smith_shadowing(seen, width) * spread / (4.0 * seen)
    return density * smith_shadowing(lit, width), density


@inlined
def sample_matt(s, first, second):
    """Sample a cosine-distributed direction above the surface, and return its density."""
    ax, ay, az, bx, by, bz = tangent_frame(s.normal[0], s.normal[1], s.normal[2])
    radius, turn = np.sqrt(first), 2 * np.pi * second
    p, q, up = radius * np.cos(turn), radius * np.sin(turn), np.sqrt(max(1.0 - first, 1e-9))
    s.d[0] = p * ax + q * bx + up * s.normal[0]
    s.d[1] = p * ay + q * by + up * s.normal[1]
    s.d[2] = p * az + q * bz + up * s.normal[2]
    return up / np.pi


@inlined
def sample_gloss(s, first, second):
    """Sample a direction of the glossy lobe, and return ``(share, density)`` without ``shine``.

    The microfacet normal is sampled from the visible normals (Heitz 2018).
    """
    width = lobe_width(s)
    ax, ay, az, bx, by, bz = tangent_frame(s.normal[0], s.normal[1], s.normal[2])
    vx = -(s.d[0] * ax + s.d[1] * ay + s.d[2] * az)
    vy = -(s.d[0] * bx + s.d[1] * by + s.d[2] * bz)
    vz = -(s.d[0] * s.normal[0] + s.d[1] * s.normal[1] + s.d[2] * s.normal[2])
    vz = max(vz, 1e-6)
    sx, sy, sz = width * vx, width * vy, vz
    length = np.sqrt(sx * sx + sy * sy + sz * sz)
    sx, sy, sz = sx / length, sy / length, sz / length
    tx, ty, tz, wx, wy, wz = tangent_frame(sx, sy, sz)
    radius, turn = np.sqrt(first), 2 * np.pi * second
    # A disc square to the eye, its half behind the horizon pressed together. (t, w) is any frame;
    # the one below has its first axis level.
    flat = np.sqrt(sx * sx + sy * sy)
    if flat > 1e-9:
        tx, ty, tz = -sy / flat, sx / flat, 0.0
        wx, wy, wz = sy * tz - sz * ty, sz * tx - sx * tz, sx * ty - sy * tx
    p, q = radius * np.cos(turn), radius * np.sin(turn)
    half = 0.5 * (1.0 + sz)
    q = (1.0 - half) * np.sqrt(max(1.0 - p * p, 0.0)) + half * q
    r = np.sqrt(max(1.0 - p * p - q * q, 0.0))
    hx = width * (p * tx + q * wx + r * sx)
    hy = width * (p * ty + q * wy + r * sy)
    hz = max(p * tz + q * wz + r * sz, 1e-6)
    length = np.sqrt(hx * hx + hy * hy + hz * hz)
    hx, hy, hz = hx / length, hy / length, hz / length
    twice = 2.0 * (vx * hx + vy * hy + vz * hz)
    lx, ly, lz = twice * hx - vx, twice * hy - vy, twice * hz - vz
    ux = lx * ax + ly * bx + lz * s.normal[0]
    uy = lx * ay + ly * by + lz * s.normal[1]
    uz = lx * az + ly * bz + lz * s.normal[2]
    _, density = evaluate_gloss(s, ux, uy, uz)
    share = smith_shadowing(lz, width)
    s.d[0], s.d[1], s.d[2] = ux, uy, uz
    return share, density

"""How a surface sends light on: a matt lobe by the cosine, and a glossy one of small mirrors.

The glossy lobe is the microfacet model of Trowbridge and Reitz (GGX) with Smith's shadowing, its
mirrors drawn among those that are seen. Rough surfaces that are no metal have no gloss at all: it
would cost rays and show nothing.
"""

import numpy as np

from world2minecraft.core.jit import inlined
from world2minecraft.rendering.path_tracing.sky_light import around

LEAST_WIDTH = 0.02  # Of the glossy lobe: what is smoother is followed as if it were this.
SHARP_WIDTH = 0.05  # Below it lamps are found by following the gloss alone.
_DULL, _FADE = 0.50, 0.15  # Width from which no gloss is left, and how it fades before.
_MIRROR = 0.04  # What glass and lacquer mirror straight ahead.


@inlined
def fresnel(base, cosine):
    """Return the share that is mirrored at an angle, of the share straight ahead (Schlick)."""
    dark = 1.0 - min(max(cosine, 0.0), 1.0)
    square = dark * dark
    return base + (1.0 - base) * square * square * dark


@inlined
def width_of(s):
    """Return the width of the glossy lobe, GGX's alpha."""
    return max(s.rough * s.rough, LEAST_WIDTH)


@inlined
def pane_mirror(s):
    """Return what a pane of glass mirrors, both of its faces counted."""
    cosine = -(s.out[0] * s.d[0] + s.out[1] * s.d[1] + s.out[2] * s.d[2])
    once = fresnel(_MIRROR, cosine)
    return 2.0 * once / (1.0 + once)


@inlined
def set_lobes(s):
    """Fill the shares of both lobes, and how often the glossy one is followed."""
    cosine = -(s.normal[0] * s.d[0] + s.normal[1] * s.d[1] + s.normal[2] * s.d[2])
    width = width_of(s)
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
def shadowing(cosine, width):
    """Return Smith's share of small mirrors that are seen at an angle."""
    if cosine <= 0:
        return 0.0
    square = cosine * cosine
    return 2.0 / (1.0 + np.sqrt(1.0 + width * width * (1.0 - square) / square))


@inlined
def gloss_of(s, x, y, z):
    """Return ``(value, density)`` of the glossy lobe towards a direction, cosine counted.

    The value is without the lobe's share, ``shine``.
    """
    width = width_of(s)
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
    density = shadowing(seen, width) * spread / (4.0 * seen)
    return density * shadowing(lit, width), density


@inlined
def follow_matt(s, first, second):
    """Point the ray anywhere above the surface, by the cosine; return the density of that."""
    ax, ay, az, bx, by, bz = around(s.normal[0], s.normal[1], s.normal[2])
    radius, turn = np.sqrt(first), 2 * np.pi * second
    p, q, up = radius * np.cos(turn), radius * np.sin(turn), np.sqrt(max(1.0 - first, 1e-9))
    s.d[0] = p * ax + q * bx + up * s.normal[0]
    s.d[1] = p * ay + q * by + up * s.normal[1]
    s.d[2] = p * az + q * bz + up * s.normal[2]
    return up / np.pi


@inlined
def follow_gloss(s, first, second):
    """Point the ray as a small mirror sends it; return ``(share, density)``, share without shine.

    The mirror is drawn among those that the eye sees (Heitz 2018).
    """
    width = width_of(s)
    ax, ay, az, bx, by, bz = around(s.normal[0], s.normal[1], s.normal[2])
    vx = -(s.d[0] * ax + s.d[1] * ay + s.d[2] * az)
    vy = -(s.d[0] * bx + s.d[1] * by + s.d[2] * bz)
    vz = -(s.d[0] * s.normal[0] + s.d[1] * s.normal[1] + s.d[2] * s.normal[2])
    vz = max(vz, 1e-6)
    sx, sy, sz = width * vx, width * vy, vz
    length = np.sqrt(sx * sx + sy * sy + sz * sz)
    sx, sy, sz = sx / length, sy / length, sz / length
    tx, ty, tz, wx, wy, wz = around(sx, sy, sz)
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
    _, density = gloss_of(s, ux, uy, uz)
    share = shadowing(lz, width)
    s.d[0], s.d[1], s.d[2] = ux, uy, uz
    return share, density

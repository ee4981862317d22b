"""Denoising by an edge-preserving a-trous filter on light divided by surface reflectance.

Dividing by the reflectance keeps textures sharp. Five passes of doubling width average over
neighbours on the same surface: same plane, same relief, and a difference in light that noise can
explain. The noise is estimated from the samples of each pixel and decreases with each pass, so that
shadow edges are preserved.
"""

from collections.abc import Callable

import numpy as np

from world2minecraft.core.jit import inlined, lean
from world2minecraft.rendering.path_tracing.film import (
    SAME_NORMAL,
    SAME_PLANE,
    SAME_PLANE_FAR,
    luminance,
)

SWEEPS = 5  # The last reaches 32 pixels to each side.
GLOSS_SWEEPS = 3  # What is mirrored has edges of its own.
GRAIN = 4.0  # Standard deviations of difference that still count as one light.
_RELIEF = 3  # The cosine of two normals counts to the power of 2 ** _RELIEF.
_SOFT = 0.015  # Of the light: a difference that is nothing.

Bands = Callable[[Callable[[tuple[int, int]], None], int], None]


def denoise_light(
    light: np.ndarray,
    squares: np.ndarray,
    count: np.ndarray,
    guides: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray],
    sweeps: int,
    run: Bands,
) -> np.ndarray:
    """Return denoised light, float32 [H, W, 3].

    Args:
        light: Means over samples, float32 [H, W, 3].
        squares: Means of the squared luminances of the samples, float32 [H, W].
        count: Number of samples, float32 [H, W]. Pixels without samples are ignored and not
            changed.
        guides: ``place``, ``normal``, ``out`` and ``far`` of a ``Film``.
        sweeps: Number of filter passes.
        run: Function that calls another function for bands that cover a number of rows.
    """
    grain = np.zeros(light.shape[:2], np.float32)
    now, then = light.copy(), light.copy()
    rows = len(light)
    run(lambda band: estimate_variance(light, squares, count, guides, band, now, grain), rows)
    other = grain.copy()
    for sweep in range(sweeps):
        step = 1 << sweep

        def one(
            band: tuple[int, int], step=step, now=now, then=then, grain=grain, other=other
        ) -> None:
            filter_pass(now, grain, count, guides, step, band, then, other)

        run(one, rows)
        now, then, grain, other = then, now, other, grain
    return now


@inlined
def same_surface(guides, v, u, y, x):
    """Return whether two pixels show the same surface, or both show none."""
    place, _, out, far = guides
    cosine = out[v, u, 0] * out[y, x, 0] + out[v, u, 1] * out[y, x, 1] + out[v, u, 2] * out[y, x, 2]
    if cosine <= SAME_NORMAL:
        return far[v, u] == 0 and far[y, x] == 0
    off = (
        out[v, u, 0] * (place[y, x, 0] - place[v, u, 0])
        + out[v, u, 1] * (place[y, x, 1] - place[v, u, 1])
        + out[v, u, 2] * (place[y, x, 2] - place[v, u, 2])
    )
    return abs(off) < SAME_PLANE + SAME_PLANE_FAR * far[v, u]


@lean
def estimate_variance(light, squares, count, guides, rows, cut, grain):
    """Clip isolated bright pixels, and estimate the variance of the other pixels' means."""
    height, width = grain.shape
    for v in range(rows[0], rows[1]):
        for u in range(width):
            if count[v, u] <= 0:
                continue
            most, total, weights = 0.0, 0.0, 0.0
            for y in range(max(v - 1, 0), min(v + 2, height)):
                for x in range(max(u - 1, 0), min(u + 2, width)):
                    if count[y, x] <= 0 or not same_surface(guides, v, u, y, x):
                        continue
                    bright = luminance(light[y, x, 0], light[y, x, 1], light[y, x, 2])
                    weight = 1.0 / (1 + abs(y - v)) / (1 + abs(x - u))
                    if count[y, x] > 1:
                        own = max(squares[y, x] - bright * bright, 0.0) / (count[y, x] - 1)
                    else:
                        own = bright * bright
                    total += weight * own
                    weights += weight
                    if y != v or x != u:
                        most = max(most, bright)
            own = luminance(light[v, u, 0], light[v, u, 1], light[v, u, 2])
            grain[v, u] = total / weights
            shrink = most / own if own > most > 0 else 1.0
            for n in range(3):
                cut[v, u, n] = light[v, u, n] * shrink


@lean
def filter_pass(light, grain, count, guides, step, rows, out_light, out_grain):
    """Apply one filter pass to a band of rows, with 5 x 5 taps that are ``step`` pixels apart."""
    normal = guides[1]
    height, width = grain.shape
    for v in range(rows[0], rows[1]):
        for u in range(width):
            if count[v, u] <= 0:
                continue
            own = luminance(light[v, u, 0], light[v, u, 1], light[v, u, 2])
            differ = 1.0 / (GRAIN * np.sqrt(grain[v, u]) + _SOFT * own + 1e-6)
            red, green, blue, rough, weights = 0.0, 0.0, 0.0, 0.0, 0.0
            for b in range(-2, 3):
                y = v + b * step
                if y < 0 or y >= height:
                    continue
                for a in range(-2, 3):
                    x = u + a * step
                    if x < 0 or x >= width or count[y, x] <= 0:
                        continue
                    if not same_surface(guides, v, u, y, x):
                        continue
                    r, g, c = light[y, x, 0], light[y, x, 1], light[y, x, 2]
                    relief = (
                        normal[v, u, 0] * normal[y, x, 0]
                        + normal[v, u, 1] * normal[y, x, 1]
                        + normal[v, u, 2] * normal[y, x, 2]
                    )
                    relief = max(relief, 0.0) if guides[3][v, u] > 0 else 1.0
                    for _ in range(_RELIEF):
                        relief *= relief
                    off = abs(luminance(r, g, c) - own) * differ
                    weight = relief * np.exp(-off) * spline_weight(a) * spline_weight(b)
                    red, green, blue = red + weight * r, green + weight * g, blue + weight * c
                    rough += weight * weight * grain[y, x]
                    weights += weight
            out_light[v, u, 0] = red / weights
            out_light[v, u, 1] = green / weights
            out_light[v, u, 2] = blue / weights
            out_grain[v, u] = rough / (weights * weights)


@inlined
def spline_weight(n):
    """Return the weight of a tap of the cubic spline: 3/8, 1/4 or 1/16."""
    n = abs(n)
    return 0.375 if n == 0 else (0.25 if n == 1 else 0.0625)

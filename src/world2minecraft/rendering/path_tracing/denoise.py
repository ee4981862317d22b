"""Denoising by an edge-preserving a-trous filter on light divided by surface reflectance.

Dividing by the reflectance keeps textures sharp. Light far above that of its neighbours is first
spread over them, which keeps the mean: cutting it instead would darken walls in stains. Five passes
of doubling width then average over neighbours on the same surface: same plane, same relief, and a
difference in light that the noise of both pixels can explain. The noise is estimated from the
samples of each pixel and decreases with each pass, so that shadow edges are preserved.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined, lean
from world2minecraft.rendering.path_tracing.film import Film, luminance

SWEEPS = 5  # The last reaches 32 pixels to each side.
GLOSS_SWEEPS = 3  # What is mirrored has edges of its own.
GRAIN = 4.0  # Standard deviations of a difference that still count as one light; 3 left stains.
SPREAD = 3  # Pixels to each side over which outliers are spread,
OUTLIER = 3.0  # which are so many times as bright as the mean there,
DISAGREEMENT = 0.5  # and whose mean has so much of itself as its standard deviation.
MIN_NEIGHBOURS = 3  # Pixels of a surface that tell what an outlier is.
_RELIEF = 3  # The cosine of two normals counts to the power of 2 ** _RELIEF.
_SOFT = 0.015  # Of the light: a difference that is nothing.
_GAP = 0.01  # Cells between two planes.
_STEPS = 1000  # Of a normal's components, to tell planes apart.

Bands = Callable[[Callable[[tuple[int, int]], None], int], None]


class Guides(NamedTuple):
    """What tells the surfaces of an image apart."""

    surface: np.ndarray  # int32 [H, W]: number of the plane at the pixel's centre, 0 for none
    normal: np.ndarray  # float32 [H, W, 3]: of its relief
    uneven: np.ndarray  # bool [H, W]: whether that is not the plane's


def guides_of(film: Film) -> Guides:
    """Return the guides of a film, with a number for each plane that it shows."""
    shown = film.far > 0
    out = film.out[shown].astype(np.float64)
    steps = np.rint(out * _STEPS).astype(np.int64) + _STEPS
    direction = (steps * (2 * _STEPS + 1) ** np.arange(3)).sum(axis=1)
    offset = (out * film.place[shown]).sum(axis=1)
    order = np.lexsort((offset, direction))
    begins = np.diff(direction[order], prepend=-1) != 0
    begins |= np.diff(offset[order], prepend=0) > _GAP
    numbers = np.empty(len(order), np.int32)
    numbers[order] = np.cumsum(begins)
    surface = np.zeros(shown.shape, np.int32)
    surface[shown] = numbers
    uneven = np.abs(film.normal - film.out).max(axis=-1) > 1 / _STEPS
    return Guides(surface, film.normal, uneven)


def denoise_light(
    light: np.ndarray,
    squares: np.ndarray,
    count: np.ndarray,
    guides: Guides,
    sweeps: int,
    run: Bands,
) -> np.ndarray:
    """Return denoised light, float32 [H, W, 3].

    Args:
        light: Means over samples, float32 [H, W, 3].
        squares: Means of the squared luminances of the samples, float32 [H, W].
        count: Number of samples, float32 [H, W]. Pixels without samples are ignored and not
            changed.
        guides: The result of ``guides_of``.
        sweeps: Number of filter passes.
        run: Function that calls another function for bands that cover a number of rows.
    """
    grain, excess, sharers = (np.zeros(light.shape[:2], np.float32) for _ in range(3))
    now, then = light.copy(), light.copy()
    rows = len(light)
    run(lambda band: estimate_variance(light, squares, count, guides, band, grain), rows)
    run(lambda band: find_outliers(light, squares, count, guides, band, excess, sharers), rows)
    run(lambda band: spread_outliers(light, excess, sharers, guides, band, now), rows)
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
def luminance_at(light, v, u):
    """Return the luminance of a pixel."""
    return luminance(light[v, u, 0], light[v, u, 1], light[v, u, 2])


@inlined
def variance_of_mean(bright, squares, count):
    """Return the variance of the mean luminance of some samples."""
    square = bright * bright
    return max(squares - square, 0.0) / (count - 1) if count > 1 else square


@lean
def estimate_variance(light, squares, count, guides, rows, grain):
    """Estimate the variance of the pixels' means, from 3 x 3 pixels of a surface."""
    surface = guides.surface
    height, width = grain.shape
    for v in range(rows[0], rows[1]):
        for u in range(width):
            if count[v, u] <= 0:
                continue
            total, weights = 0.0, 0.0
            for y in range(max(v - 1, 0), min(v + 2, height)):
                for x in range(max(u - 1, 0), min(u + 2, width)):
                    if count[y, x] <= 0 or surface[y, x] != surface[v, u]:
                        continue
                    bright = luminance_at(light, y, x)
                    weight = 1.0 / (1 + abs(y - v)) / (1 + abs(x - u))
                    total += weight * variance_of_mean(bright, squares[y, x], count[y, x])
                    weights += weight
            grain[v, u] = total / weights


@lean
def find_outliers(light, squares, count, guides, rows, excess, sharers):
    """Fill the share of each pixel's light that is too much, and how many neighbours share it."""
    surface = guides.surface
    height, width = excess.shape
    for v in range(rows[0], rows[1]):
        for u in range(width):
            if count[v, u] <= 0:
                continue
            total, found = 0.0, -1
            for y in range(max(v - SPREAD, 0), min(v + SPREAD + 1, height)):
                for x in range(max(u - SPREAD, 0), min(u + SPREAD + 1, width)):
                    if count[y, x] > 0 and surface[y, x] == surface[v, u]:
                        total += luminance_at(light, y, x)
                        found += 1
            own = luminance_at(light, v, u)
            sharers[v, u] = found
            if found >= MIN_NEIGHBOURS:
                most = OUTLIER * (total - own) / found
                noise = np.sqrt(variance_of_mean(own, squares[v, u], count[v, u]))
                if own > most > 0 and noise > DISAGREEMENT * own:
                    excess[v, u] = 1.0 - most / own


@lean
def spread_outliers(light, excess, sharers, guides, rows, result):
    """Move the excess light of outliers to their neighbours on the same surface, in equal parts.

    ``result`` is a copy of ``light``.
    """
    surface = guides.surface
    height, width = excess.shape
    for v in range(rows[0], rows[1]):
        for u in range(width):
            if sharers[v, u] <= 0:
                continue
            for n in range(3):
                result[v, u, n] *= 1.0 - excess[v, u]
            for y in range(max(v - SPREAD, 0), min(v + SPREAD + 1, height)):
                for x in range(max(u - SPREAD, 0), min(u + SPREAD + 1, width)):
                    if excess[y, x] <= 0 or surface[y, x] != surface[v, u]:
                        continue
                    if y != v or x != u:
                        for n in range(3):
                            result[v, u, n] += light[y, x, n] * excess[y, x] / sharers[y, x]


@lean
def filter_pass(light, grain, count, guides, step, rows, out_light, out_grain):
    """Apply one filter pass to a band of rows, with 5 x 5 taps that are ``step`` pixels apart."""
    surface, normal, uneven = guides.surface, guides.normal, guides.uneven
    height, width = grain.shape
    for v in range(rows[0], rows[1]):
        for u in range(width):
            if count[v, u] <= 0:
                continue
            own, noise = luminance_at(light, v, u), grain[v, u]
            alike = _SOFT * own + 1e-6
            red, green, blue, rough, weights = 0.0, 0.0, 0.0, 0.0, 0.0
            for b in range(-2, 3):
                y = v + b * step
                if y < 0 or y >= height:
                    continue
                for a in range(-2, 3):
                    x = u + a * step
                    if x < 0 or x >= width or count[y, x] <= 0:
                        continue
                    if surface[y, x] != surface[v, u]:
                        continue
                    weight = spline_weight(a) * spline_weight(b)
                    if uneven[v, u] or uneven[y, x]:
                        weight *= relief_weight(normal, v, u, y, x)
                    off = luminance_at(light, y, x) - own
                    off /= GRAIN * np.sqrt(noise + grain[y, x]) + alike
                    weight *= np.exp(-off * off)
                    red += weight * light[y, x, 0]
                    green += weight * light[y, x, 1]
                    blue += weight * light[y, x, 2]
                    rough += weight * weight * grain[y, x]
                    weights += weight
            out_light[v, u, 0] = red / weights
            out_light[v, u, 1] = green / weights
            out_light[v, u, 2] = blue / weights
            out_grain[v, u] = rough / (weights * weights)


@inlined
def relief_weight(normal, v, u, y, x):
    """Return the weight of a tap whose surface is turned to another side."""
    cosine = 0.0
    for n in range(3):
        cosine += normal[v, u, n] * normal[y, x, n]
    cosine = max(cosine, 0.0)
    for _ in range(_RELIEF):
        cosine *= cosine
    return cosine


@inlined
def spline_weight(n):
    """Return the weight of a tap of the cubic spline: 3/8, 1/4 or 1/16."""
    n = abs(n)
    return 0.375 if n == 0 else (0.25 if n == 1 else 0.0625)

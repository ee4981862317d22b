"""The film of a path-traced image: sums over paths, and the surface at each pixel's centre.

Light from diffuse surfaces is stored in two parts, depending on whether the sample hit the surface
at the pixel's centre. The denoiser filters each surface separately and recombines both parts of
edge pixels at the end.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined

SAME_NORMAL = 0.9  # Cosine of two normals of one surface.
SAME_PLANE, SAME_PLANE_FAR = 0.02, 0.002  # Cells off its plane, and the more per cell of distance.


class Film(NamedTuple):
    """Sums over samples, float32 [H, W, 3] unless stated otherwise."""

    seen: np.ndarray  # sky and lamps themselves
    light: np.ndarray  # by the matt surface in the pixel's middle
    share: np.ndarray  # of that surface: what it would send of light 1
    other_light: np.ndarray  # by other matt surfaces in the pixel
    other_share: np.ndarray
    gloss: np.ndarray  # by glossy ones, and by the mirror of glass
    gloss_share: np.ndarray
    squares: np.ndarray  # [H, W, 2]: of the light over its share, luminances: matt, and glossy
    # times its share
    share_squares: np.ndarray  # [H, W]: of the glossy shares' luminances
    samples: np.ndarray  # [H, W, 2]: those of the middle's surface, and all
    place: np.ndarray  # of the middle's surface, cells
    normal: np.ndarray  # of its relief, 0 where there is none
    out: np.ndarray  # of its face, 0 where there is none
    far: np.ndarray  # [H, W]: how far it is, cells


def new_film(height: int, width: int) -> Film:
    """Return an empty film."""
    depths = {"squares": (2,), "samples": (2,), "share_squares": (), "far": ()}
    return Film(
        *(np.zeros((height, width, *depths.get(name, (3,))), np.float32) for name in Film._fields)
    )


@inlined
def luminance(r, g, b):
    """Return the luminance of a linear colour."""
    return 0.2126 * r + 0.7152 * g + 0.0722 * b


@inlined
def store_center_surface(film, v, u, s):
    """Store the surface at a pixel's centre."""
    far = 0.0
    for n in range(3):
        film.place[v, u, n] = s.at[n]
        film.normal[v, u, n] = s.normal[n]
        film.out[v, u, n] = s.out[n]
        far += (s.at[n] - s.o[n]) ** 2
    film.far[v, u] = np.sqrt(far)


@inlined
def is_center_surface(film, v, u, s):
    """Return whether a sample's first surface is the surface at the pixel's centre."""
    cosine, off = 0.0, 0.0
    for n in range(3):
        cosine += film.out[v, u, n] * s.first_out[n]
        off += film.out[v, u, n] * (s.first[n] - film.place[v, u, n])
    return cosine > SAME_NORMAL and abs(off) < SAME_PLANE + SAME_PLANE_FAR * film.far[v, u]


@inlined
def add_sample(film, v, u, s):
    """Add the result of a path to a pixel."""
    film.samples[v, u, 1] += 1
    for n in range(3):
        film.seen[v, u, n] += s.seen[n]
        film.gloss[v, u, n] += s.gloss[n]
        film.gloss_share[v, u, n] += s.gloss_share[n]
    share = luminance(s.gloss_share[0], s.gloss_share[1], s.gloss_share[2])
    value = luminance(s.gloss[0], s.gloss[1], s.gloss[2])
    film.squares[v, u, 1] += value * value / max(share, 1e-4)
    film.share_squares[v, u] += share * share
    if s.own == 0:
        return
    if not is_center_surface(film, v, u, s):
        for n in range(3):
            film.other_light[v, u, n] += s.spread[n]
            film.other_share[v, u, n] += s.spread_share[n]
        return
    film.samples[v, u, 0] += 1
    for n in range(3):
        film.light[v, u, n] += s.spread[n]
        film.share[v, u, n] += s.spread_share[n]
    share = luminance(s.spread_share[0], s.spread_share[1], s.spread_share[2])
    value = luminance(s.spread[0], s.spread[1], s.spread[2]) / max(share, 1e-4)
    film.squares[v, u, 0] += value * value

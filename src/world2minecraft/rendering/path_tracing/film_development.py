"""Development of a film to an image: denoising, recombination, exposure and tone mapping."""

import numpy as np

from world2minecraft.core.jit import lean
from world2minecraft.rendering.light import Tone, tone_map_pixel
from world2minecraft.rendering.light.exposure import LUMINANCE
from world2minecraft.rendering.path_tracing.denoise import (
    GLOSS_SWEEPS,
    SWEEPS,
    Bands,
    Guides,
    denoise_light,
    guides_of,
)
from world2minecraft.rendering.path_tracing.film import Film

DAY_KEY, NIGHT_KEY = 1.10, 0.30  # What the geometric mean of irradiance over pi is exposed to.
ADAPTATION = 0.85  # How much of the way there: what is dim stays a little dim.
MIN_EXPOSURE, MAX_EXPOSURE = 0.25, 60.0
BRIGHT = 1.2  # Irradiance beyond which only the root of it counts: windows keep their colours.
MIN_SHARE = 0.01  # Of light that a surface sends on, where that divides.
SEEN_POWER = 0.5  # Sky and lamps themselves are opened up half as far as what they light.


def surface_light(film: Film, denoise: bool, run: Bands) -> np.ndarray:
    """Return the light of surfaces, float32 [H, W, 3], without directly visible sky and lamps.

    Args:
        film: Sums over samples.
        denoise: Whether to denoise the light.
        run: Function that calls another function for bands that cover a number of rows.
    """
    count = np.maximum(film.samples[..., 1:], 1)
    if not denoise:
        return (film.light + film.other_light + film.gloss) / count
    guides = guides_of(film)
    own = np.ascontiguousarray(film.samples[..., 0])
    squares = film.squares[..., 0] / np.maximum(own, 1)
    light = denoise_light(
        _divide_by_share(film.light, film.share), squares, own, guides, SWEEPS, run
    )
    result = film.share / count * light
    add_other(light, own, film.other_light, film.other_share, film.samples, guides.surface, result)
    if film.gloss_share.any():
        result += film.gloss_share / count * _denoised_gloss(film, guides, run)
    return result


def _denoised_gloss(film: Film, guides: Guides, run: Bands) -> np.ndarray:
    """Return the light of glossy surfaces over their share, denoised.

    Samples count by their share, since few of a pixel's may meet what shines.
    """
    share = film.gloss_share @ LUMINANCE.astype(np.float32)
    squares = film.squares[..., 1] / np.maximum(share, 1e-6)
    count = share * share / np.maximum(film.share_squares, 1e-12)
    light = _divide_by_share(film.gloss, film.gloss_share)
    return denoise_light(light, squares, count, guides, GLOSS_SWEEPS, run)


def _divide_by_share(light: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Return light over share, where there is enough of it to tell."""
    return light / np.maximum(share, 1e-6)


@lean
def add_other(light, own, other_light, other_share, count, surface, result):
    """Light the secondary surfaces of each pixel like those of its neighbours."""
    height, width = own.shape
    for v in range(height):
        for u in range(width):
            share = other_share[v, u, 0] + other_share[v, u, 1] + other_share[v, u, 2]
            if share <= 0:
                continue
            red, green, blue, found = 0.0, 0.0, 0.0, 0
            for y in range(max(v - 1, 0), min(v + 2, height)):
                for x in range(max(u - 1, 0), min(u + 2, width)):
                    if own[y, x] > 0 and surface[y, x] != surface[v, u]:
                        red, green = red + light[y, x, 0], green + light[y, x, 1]
                        blue, found = blue + light[y, x, 2], found + 1
            if found > 0:
                result[v, u, 0] += other_share[v, u, 0] / count[v, u, 1] * red / found
                result[v, u, 1] += other_share[v, u, 1] / count[v, u, 1] * green / found
                result[v, u, 2] += other_share[v, u, 2] / count[v, u, 1] * blue / found
            else:
                for n in range(3):
                    result[v, u, n] += other_light[v, u, n] / count[v, u, 1]


def irradiance(light: np.ndarray, film: Film) -> np.ndarray:
    """Return the luminance of surfaces' light over what they send on of it, float32 [H, W].

    Args:
        light: Light of surfaces, float32 [H, W, 3].
        film: Sums over samples.
    """
    weights = LUMINANCE.astype(np.float32)
    share = (film.share + film.other_share + film.gloss_share) @ weights
    return light @ weights / np.maximum(share / np.maximum(film.samples[..., 1], 1), MIN_SHARE)


def picture_exposure(bright: np.ndarray, film: Film, daylight: float) -> float:
    """Return the exposure of an image, computed from its light, not from the colours of surfaces.

    Args:
        bright: The result of ``irradiance``.
        film: The film, which marks the pixels with surfaces.
        daylight: Amount of daylight, 0 to 1. Images at night are darker.
    """
    shows = film.far > 0
    if not shows.any():
        return 1.0
    mean = np.exp(np.log(np.maximum(bright[shows].astype(np.float64), 1e-4)).mean())
    key = NIGHT_KEY + (DAY_KEY - NIGHT_KEY) * daylight
    return float(np.clip((key / mean) ** ADAPTATION, MIN_EXPOSURE, MAX_EXPOSURE))


def dodging(bright: np.ndarray, exposure: float) -> np.ndarray:
    """Return factors of surfaces' light, [H, W, 1], that hold back what is lit far too brightly.

    They depend on irradiance and not on colours, so that textures keep their contrast, and a garden
    in the sun is seen through the window of a room.
    """
    over = bright * np.float32(exposure / BRIGHT)
    return ((1 + over * over) ** np.float32(-0.25))[..., None]


@lean
def to_screen(radiance, exposure, tone, colour):
    """Fill uint8 [H, W, 3] with the sRGB colours of linear light."""
    for v in range(radiance.shape[0]):
        for u in range(radiance.shape[1]):
            colour[v, u, 0], colour[v, u, 1], colour[v, u, 2] = tone_map_pixel(
                radiance[v, u, 0] * exposure,
                radiance[v, u, 1] * exposure,
                radiance[v, u, 2] * exposure,
                tone,
            )


def screen_colours(radiance: np.ndarray, exposure: float, tone: Tone) -> np.ndarray:
    """Return the sRGB colours of linear light, uint8 [H, W, 3]."""
    colour = np.empty(radiance.shape, np.uint8)
    to_screen(radiance, exposure, tone, colour)
    return colour

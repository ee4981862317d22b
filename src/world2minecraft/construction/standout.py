"""Rugs and pictures: parts of a flat surface whose paint is another, told from shade and noise.

Shade multiplies light, which in Oklab multiplies all three coordinates alike; so hue and chroma are
compared at one lightness. Lightness by itself is compared with a smooth surface fitted over the
patch, so that the fall of light towards a corner counts for nothing.
"""

from typing import NamedTuple

import numpy as np
from scipy import ndimage

from world2minecraft.geometry.connected_components import label_components

ROUNDS = 4
SCALE = 0.05  # Oklab distance at which a block counts half in the fit.
LEAST_BLOCKS = 12  # A fit of six numbers to fewer blocks says nothing.
MOST_SHARE = 0.6  # What covers more of a surface is the surface.


class Steps(NamedTuple):
    """From which differences on a block surely is of another paint, and from which it may be."""

    hue: float  # Oklab distance of hue and chroma at one lightness
    lightness: float  # infinite: never by lightness alone
    weak_hue: float  # Blocks beside sure ones belong to them from here on.
    weak_lightness: float
    least_m2: float


# All 20 rugs of the generated rooms differ by 0.05 and more, planks of one floor by up to 0.03.
RUG = Steps(0.04, np.inf, 0.03, np.inf, 0.5)
# A picture is a mix of colours at 4 blocks a metre, darker than its wall by 0.25 to 0.3; a curtain
# darkens the wall beside it by up to 0.19.
PICTURE = Steps(0.04, 0.22, 0.015, 0.045, 0.3)
SURE_SHARE = 0.3  # Of a part that stands out. A guess: a picture's rim is half wall.


def standing_out(mask: np.ndarray, colours: np.ndarray, step_m: float, steps: Steps) -> np.ndarray:
    """Return the parts of a flat surface that stand out, int32 [N], numbered from 1; 0: none.

    Args:
        mask: bool [X, Y, Z] with N blocks in one layer.
        colours: float32 [N, 3], their Oklab colours in the order of the mask.
        step_m: the side of a block.
        steps: from which differences on.
    """
    places = np.argwhere(mask)
    flat = np.flatnonzero(np.ptp(places, axis=0) > 0) if len(places) else np.zeros(0, int)
    if len(places) < LEAST_BLOCKS or len(flat) != 2:
        return np.zeros(len(places), np.int32)
    at = places[:, flat] - places[:, flat].min(0)
    sure, maybe = _differ(at.astype(float), colours, steps)
    sheet = np.zeros((2, *(at.max(0) + 1)), bool)
    sheet[:, at[:, 0], at[:, 1]] = sure, maybe
    wide = np.asarray(ndimage.binary_opening(sheet[1], np.ones((2, 2), bool)), bool)
    parts, _ = label_components(wide, corners=False)
    sizes = np.bincount(parts.ravel())
    held = np.bincount(parts[sheet[0]], minlength=len(sizes))
    good = (sizes * step_m**2 >= steps.least_m2) & (sizes <= MOST_SHARE * len(places))
    good &= held >= SURE_SHARE * sizes
    good[0] = False
    return np.where(good, np.arange(len(sizes)), 0).astype(np.int32)[parts[tuple(at.T)]]


def _differ(at: np.ndarray, colours: np.ndarray, steps: Steps) -> tuple[np.ndarray, np.ndarray]:
    """Return which blocks surely differ from the paint of most, and which may, bool [N] each."""
    lightness = np.maximum(colours[:, 0], 0.05)
    middle = np.median(lightness)
    hues = colours[:, 1:] / lightness[:, None] * middle
    # What dark cells have of hue is noise: it counts as much less as they are darker.
    trust = np.minimum(1.0, lightness / middle)
    hue = np.linalg.norm(hues - np.median(hues, axis=0), axis=1) * trust
    light = np.abs(lightness - _smooth(at, lightness))
    sure = (hue >= steps.hue) | (light >= steps.lightness)
    return sure, (hue >= steps.weak_hue) | (light >= steps.weak_lightness)


def _smooth(at: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return a quadratic surface, float64 [N], fitted to most of the values at places [N, 2]."""
    u, v = (at / np.maximum(at.max(0), 1)).T
    terms = np.stack([np.ones_like(u), u, v, u * u, u * v, v * v], axis=1)
    fitted = np.full(len(values), np.median(values))
    for _ in range(ROUNDS):
        weights = 1 / (1 + ((values - fitted) / SCALE) ** 2)
        factor = np.sqrt(weights)[:, None]
        solution = np.linalg.lstsq(terms * factor, values * factor[:, 0], rcond=None)[0]
        fitted = terms @ solution
    return fitted

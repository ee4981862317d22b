"""Natural scene statistics, which NIQE, PIQE and BRISQUE share.

``to_grey`` converts colour to grey exactly as OpenCV does. ``normalise`` computes mean-subtracted,
contrast-normalised coefficients with a local mean and deviation weighted by a 7x7 Gaussian of sigma
7/6. In photographs, these coefficients have nearly a normal distribution, from which distortions
deviate (Mittal et al., 2013, eq. 1). ``fit_asymmetric`` describes a set of coefficients by an
asymmetric generalised Gaussian with four parameters, fitted by moment matching after Lasmar, Stitou
and Berthoumieu (2009).
"""

from typing import Literal, NamedTuple

import numpy as np
from scipy import ndimage
from scipy.special import gamma

from world2minecraft.core.types import checks

BITS = 15
WEIGHTS = (9798, 19235, 3735)  # Red, green, blue of ITU-R BT.601, of 2**15: OpenCV's integers.

RADIUS_PX = 3
SIGMA_PX = 7 / 6
STEADY = 1.0  # Added to the deviation, so that flat parts do not divide by zero.
# Below this a coefficient is the rounding error of a flat part, with an arbitrary sign.
NOTHING = 1e-6
_PLACES = np.arange(-RADIUS_PX, RADIUS_PX + 1)
_WINDOW = np.exp(-(_PLACES**2) / (2 * SIGMA_PX**2))
_WINDOW = _WINDOW / _WINDOW.sum()

_SHAPES = np.arange(0.2, 10, 0.001)  # The shapes searched, as in the authors' code.
_RATIOS = gamma(2 / _SHAPES) ** 2 / (gamma(1 / _SHAPES) * gamma(3 / _SHAPES))  # Ascending.


def to_grey(picture: np.ndarray) -> np.ndarray:
    """Return the luma of an image as uint8 [H, W]. A grey image is returned unchanged.

    The result equals ``cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)``.

    Args:
        picture: The image as uint8 [H, W] or [H, W, 3] in sRGB.

    Raises:
        ValueError: If the shape or type is not supported, or the image is empty.

    Example:
        >>> to_grey(np.array([[[255, 0, 0], [0, 255, 0], [0, 0, 255]]], np.uint8)).tolist()
        [[76, 150, 29]]
    """
    picture = np.asarray(picture)
    if not picture.size:
        raise ValueError(f"an image must have at least one pixel, got shape {picture.shape}")
    if picture.ndim == 2:
        return checks.array("picture", picture, np.uint8, (None, None))
    checks.array("picture", picture, np.uint8, (None, None, 3))
    sums = sum(picture[..., n].astype(np.int32) * weight for n, weight in enumerate(WEIGHTS))
    return np.asarray((sums + (1 << (BITS - 1))) >> BITS).astype(np.uint8)


Edges = Literal["nearest", "constant"]


def normalise(grey: np.ndarray, edges: Edges = "nearest") -> tuple[np.ndarray, np.ndarray]:
    """Return the normalised coefficients and the local deviation of an image.

    Args:
        grey: The image as [H, W] of any numeric type, 0 to 255.
        edges: The padding outside the image: the ``nearest`` pixel, or black (``constant``).

    Returns:
        The coefficients and the deviation, both as float64 [H, W].
    """
    values = grey.astype(np.float64)
    mean = _smooth(values, edges)
    deviation = np.sqrt(np.abs(_smooth(values * values, edges) - mean * mean))
    coefficients = (values - mean) / (deviation + STEADY)
    coefficients[np.abs(coefficients) < NOTHING] = 0.0
    return coefficients, deviation


def _smooth(values: np.ndarray, edges: Edges) -> np.ndarray:
    once = ndimage.correlate1d(values, _WINDOW, axis=0, mode=edges)
    return ndimage.correlate1d(once, _WINDOW, axis=1, mode=edges)


class Fitted(NamedTuple):
    """The parameters of P fitted distributions, each as float64 [P].

    The parameters are not finite if a set of coefficients has only one sign.

    Attributes:
        shape: The shape, 2 for a normal distribution and 1 for a Laplacian.
        mean: The mean.
        left: The scale of the negative values.
        right: The scale of the positive values.
    """

    shape: np.ndarray
    mean: np.ndarray
    left: np.ndarray
    right: np.ndarray


def fit_asymmetric(values: np.ndarray, zero_is_right: bool = False) -> Fitted:
    """Fit an asymmetric generalised Gaussian to each row of ``values``.

    Args:
        values: P sets of N coefficients as float64 [P, N].
        zero_is_right: Whether zeros count as positive values. If False, they count on neither side.
    """
    squares = values * values
    left = _root_mean(squares, values < 0)
    right = _root_mean(squares, values >= 0 if zero_is_right else values > 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        lean = left / right
        peaked = np.abs(values).mean(axis=1) ** 2 / squares.mean(axis=1)
        wanted = peaked * (lean**3 + 1) * (lean + 1) / (lean**2 + 1) ** 2
    shape = np.where(np.isfinite(wanted), _SHAPES[_nearest(wanted)], np.nan)
    narrow = np.sqrt(gamma(1 / shape) / gamma(3 / shape))
    left, right = left * narrow, right * narrow
    return Fitted(shape, (right - left) * gamma(2 / shape) / gamma(1 / shape), left, right)


def _root_mean(squares: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return the root mean square of the selected values in each row, or nan if there are none."""
    sums = np.where(chosen, squares, 0.0).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.sqrt(sums / chosen.sum(axis=1))


def _nearest(ratios: np.ndarray) -> np.ndarray:
    """Return the index of the nearest entry of ``_RATIOS`` for each value."""
    after = np.clip(np.searchsorted(_RATIOS, ratios), 1, len(_RATIOS) - 1)
    return after - (ratios - _RATIOS[after - 1] <= _RATIOS[after] - ratios)

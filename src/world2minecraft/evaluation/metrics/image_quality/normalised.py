"""Mean-subtracted, contrast-normalised coefficients: a picture freed of brightness and contrast.

The local mean and deviation are weighted by a 7x7 Gaussian of sigma 7/6; in photographs what is
left is close to a normal distribution, and distortions move it away (Mittal et al., 2013, eq. 1).
"""

from typing import Literal

import numpy as np
from scipy import ndimage

RADIUS_PX = 3
SIGMA_PX = 7 / 6
STEADY = 1.0  # Added to the deviation, so that flat parts divide by no zero.
# Below this a coefficient is what rounding left of a flat part; its sign would be chance.
NOTHING = 1e-6

Edges = Literal["nearest", "constant"]
_PLACES = np.arange(-RADIUS_PX, RADIUS_PX + 1)
_WINDOW = np.exp(-(_PLACES**2) / (2 * SIGMA_PX**2))
_WINDOW = _WINDOW / _WINDOW.sum()


def normalise(grey: np.ndarray, edges: Edges = "nearest") -> tuple[np.ndarray, np.ndarray]:
    """Return the coefficients and the local deviation of a picture, both float64 [H, W].

    Args:
        grey: [H, W] of 0 to 255, any number type.
        edges: what lies outside the picture: its ``nearest`` pixel, or black (``constant``).
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

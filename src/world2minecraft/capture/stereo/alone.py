"""Depth by a network alone, for photos that cannot be compared: each map laid on its own photo.

A network errs by some per cent from photo to photo, each its own way. So each map is first laid on
the sparse points of its photo, by one factor (or a factor and a shift) and then by what lies around
each pixel. A photo with too few points takes the factor that most others have; registration evens
out what is left.
"""

from collections.abc import Iterator

import numpy as np

from world2minecraft.capture.stereo.downscaled_photos import small_photos
from world2minecraft.capture.stereo.guide import DepthModel, laid_on_points
from world2minecraft.capture.stereo.parameters import StereoParameters
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.progress import Progress, silent
from world2minecraft.core.types import Camera, DepthMap, PhotoStream, SparseScene

TRUST = 160  # More than half, so that it is registered; less than what several photos confirm.
WIDTH_PX = 640  # Networks see more in more pixels, and each photo costs them alone.
STAGE = "stereo"


def network_maps(
    photos: PhotoStream,
    scene: SparseScene,
    guide: DepthModel,
    parameters: StereoParameters | None = None,
    progress: Progress = silent,
) -> Iterator[DepthMap]:
    """Yield the network's depth of each photo of a scene, in its order and its unit.

    A network of inverse depth says nothing of a photo with too few points.

    Raises:
        CaptureError: no photo has points enough to tell the network's scale.
    """
    width_px = max(WIDTH_PX, (parameters or StereoParameters()).width_px)
    small = small_photos(photos, scene, width_px, silent)
    found: list[tuple[np.ndarray, float]] = []
    for number, photo in enumerate(small):
        predicted = guide.predict(photo.colour, photo.camera)
        laid = laid_on_points(predicted, guide.kind, photo.guide_px, photo.guide_m)
        found.append((predicted, np.nan) if laid is None else (laid[0].astype(np.float32), laid[1]))
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
        yield _as_map(photo.name, photo.camera, depth_m)


def _as_map(name: str, camera: Camera, depth_m: np.ndarray) -> DepthMap:
    known = np.isfinite(depth_m) & (depth_m > 0)
    depth = np.where(known, depth_m, 0).astype(np.float32)
    return DepthMap(name, camera, depth, np.where(known, TRUST, 0).astype(np.uint8))

"""SIFT features of photos, with colours and the sharpness of each photo."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.capture.sfm.parameters import SfmParameters
from world2minecraft.capture.sfm.progress import ProgressSteps
from world2minecraft.capture.sfm.pycolmap_access import PHOTOS, pycolmap_session
from world2minecraft.core.errors import CaptureError, LimitError
from world2minecraft.core.types import Camera
from world2minecraft.core.types.photos import Photo, PhotoStream, RigMember

MAX_PHOTOS = 3000  # Their features take about 1 GB.
PEAK_THRESHOLD = 0.0067  # COLMAP's own threshold, for images of 0 to 1.


@dataclass(frozen=True, eq=False)
class Features:
    """The features of a photo, without its pixels.

    Attributes:
        name: Name of the photo.
        width_px: Width in pixels.
        height_px: Height in pixels.
        camera: Stated or guessed intrinsics, or None.
        camera_guessed: Whether the intrinsics are an initial guess.
        camera_to_scan: Stated pose, float64 [4, 4], or None.
        pixels: Feature positions with pixel centres at +0.5, float64 [K, 2], the largest feature
            first.
        descriptors: SIFT descriptors of norm 512, uint8 [K, 128].
        colours: Colours at the features, uint8 [K, 3].
        sharpness: Edge sharpness; about 1 for sharp photos.
        rig: Part in a rig, for photos that share a place, or None.
    """

    name: str
    width_px: int
    height_px: int
    camera: Camera | None
    camera_guessed: bool
    camera_to_scan: np.ndarray | None
    pixels: np.ndarray
    descriptors: np.ndarray
    colours: np.ndarray
    sharpness: float
    rig: RigMember | None = None

    @property
    def size(self) -> tuple[int, int]:
        """The width and height in pixels."""
        return self.width_px, self.height_px


def pixel_unit(photos: list[Features]) -> float:
    """Return the scale of pixel thresholds relative to images 640 pixels wide, from 0.5 to 3."""
    longer = float(np.median([max(photo.size) for photo in photos])) if photos else 640.0
    return min(max(longer / 640, 0.5), 3.0)


def extract_features(
    photos: PhotoStream, parameters: SfmParameters, steps: ProgressSteps
) -> list[Features]:
    """Return the features of all photos in order.

    Raises:
        CaptureError: If two photos have the same name.
        LimitError: If there are too many photos.
    """
    if len(photos) > MAX_PHOTOS:
        raise LimitError(
            PHOTOS,
            f"got {len(photos)} photos, the limit is {MAX_PHOTOS}; use fewer, for "
            "example with --set capture.every=10",
        )
    gathered: list[Features] = []
    with pycolmap_session() as pycolmap:
        extractor = _extractor(pycolmap, parameters)
        for photo in photos:
            gathered.append(_extract_photo(photo, extractor, pycolmap, parameters))
            steps.done("features")
    names = [photo.name for photo in gathered]
    if len(set(names)) != len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise CaptureError(
            PHOTOS, f"two photos have the name {twice!r}; give each photo a unique name"
        )
    return gathered


def _extractor(pycolmap: Any, parameters: SfmParameters) -> Any:
    options = pycolmap.FeatureExtractionOptions()
    options.num_threads = 1
    options.use_gpu = False
    options.sift.first_octave = 0  # The image is enlarged before.
    options.sift.peak_threshold = PEAK_THRESHOLD
    options.sift.max_num_features = 2 * parameters.most_features
    return pycolmap.FeatureExtractor.create(options, pycolmap.Device.cpu)


def _extract_photo(
    photo: Photo, extractor: Any, pycolmap: Any, parameters: SfmParameters
) -> Features:
    height, width = photo.colour.shape[:2]
    times = min(2.0, (parameters.working_px / (width * height)) ** 0.5)
    size = max(1, round(width * times)), max(1, round(height * times))
    grey = Image.fromarray(photo.colour).convert("L").resize(size, Image.Resampling.BICUBIC)
    keypoints, descriptors = extractor.extract_from_uint8_array(np.asarray(grey))
    found = np.asarray(pycolmap.keypoints_to_matrix(keypoints), np.float64).reshape(-1, 4)
    order = np.argsort(-found[:, 2], kind="stable")[: parameters.most_features]
    pixels = found[order, :2] * [width / size[0], height / size[1]]
    at = np.clip(pixels.astype(np.intp), 0, [width - 1, height - 1])
    return Features(
        photo.name,
        width,
        height,
        photo.camera,
        photo.camera_guessed,
        photo.camera_to_scan,
        pixels,
        np.asarray(descriptors.data, np.uint8).reshape(-1, 128)[order],
        photo.colour[at[:, 1], at[:, 0]],
        sharpness(np.asarray(grey)),
        photo.rig,
    )


def sharpness(grey: np.ndarray) -> float:
    """Return the ratio of the steepest to the highest edges of a uint8 image [H, W].

    In a sharp image, an edge rises within about one pixel, and the ratio is close to 1.
    """
    values = grey[::4].astype(np.int16)  # Every fourth row tells as much.
    near = np.abs(np.diff(values, axis=1))
    far = np.abs(values[:, 8:] - values[:, :-8]) if values.shape[1] > 8 else near
    high = float(np.percentile(far, 99)) if far.size else 0.0
    return float(np.percentile(near, 99.5)) / high if high > 0 else 0.0

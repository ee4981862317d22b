"""SIFT features of photos, with colours and the sharpness of each photo.

pycolmap extracts features on several threads only from image files to a database, so both are
written to a temporary folder, a few photos at a time. The features do not depend on the threads.
"""

from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from shutil import rmtree
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.capture.sfm.parameters import SfmParameters
from world2minecraft.capture.sfm.progress import ProgressSteps
from world2minecraft.capture.sfm.pycolmap_access import PHOTOS, pycolmap_session
from world2minecraft.core.errors import CaptureError, LimitError
from world2minecraft.core.machine import usable_cores
from world2minecraft.core.parallel import read_ahead
from world2minecraft.core.types import Camera
from world2minecraft.core.types.photos import Photo, PhotoStream, RigMember

MAX_PHOTOS = 3000  # Their features take about 1 GB.
PEAK_THRESHOLD = 0.0067  # COLMAP's own threshold, for images of 0 to 1.
MAX_THREADS = 8  # Each needs about 50 MB.


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
    threads = min(usable_cores(), MAX_THREADS)
    stream = read_ahead(photos, 2 * threads)
    with pycolmap_session() as pycolmap, TemporaryDirectory(prefix="w2m-features-") as folder:
        options = _options(pycolmap, parameters, threads)
        while batch := list(islice(stream, 2 * threads)):
            place = Path(folder) / str(len(gathered))
            gathered += _extract_batch(batch, place, options, pycolmap, parameters)
            for _ in batch:
                steps.done("features")
    names = [photo.name for photo in gathered]
    if len(set(names)) != len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise CaptureError(
            PHOTOS, f"two photos have the name {twice!r}; give each photo a unique name"
        )
    return gathered


def _options(pycolmap: Any, parameters: SfmParameters, threads: int) -> Any:
    options = pycolmap.FeatureExtractionOptions()
    options.num_threads = threads
    options.use_gpu = False
    options.sift.first_octave = 0  # The image is enlarged before.
    options.sift.peak_threshold = PEAK_THRESHOLD
    options.sift.max_num_features = 2 * parameters.most_features
    return options


def _extract_batch(
    photos: list[Photo], folder: Path, options: Any, pycolmap: Any, parameters: SfmParameters
) -> list[Features]:
    """Return the features of a few photos; their files are written to a new folder."""
    images = folder / "images"
    images.mkdir(parents=True)
    greys = [_resized_grey(photo, parameters.working_px) for photo in photos]
    for number, grey in enumerate(greys):
        grey.save(images / f"{number}.bmp")
    database = folder / "features.db"
    pycolmap.extract_features(
        database, images, camera_mode=pycolmap.CameraMode.PER_IMAGE,
        extraction_options=options, device=pycolmap.Device.cpu,
    )  # fmt: skip
    found: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    with pycolmap.Database.open(database) as stored:
        for image in stored.read_all_images():
            keypoints = np.asarray(stored.read_keypoints(image.image_id)).reshape(-1, 6)
            descriptors = stored.read_descriptors(image.image_id).data
            found[image.name] = keypoints, np.asarray(descriptors, np.uint8).reshape(-1, 128)
    rmtree(folder)
    return [
        _features(photo, grey, *found[f"{number}.bmp"], parameters.most_features)
        for number, (photo, grey) in enumerate(zip(photos, greys, strict=True))
    ]


def _resized_grey(photo: Photo, working_px: int) -> Image.Image:
    height, width = photo.colour.shape[:2]
    times = min(2.0, (working_px / (width * height)) ** 0.5)
    size = max(1, round(width * times)), max(1, round(height * times))
    return Image.fromarray(photo.colour).convert("L").resize(size, Image.Resampling.BICUBIC)


def _features(
    photo: Photo, grey: Image.Image, keypoints: np.ndarray, descriptors: np.ndarray, count: int
) -> Features:
    """Return the largest features of a photo.

    Args:
        photo: The photo.
        grey: Its resized image.
        keypoints: x, y and the 2x2 matrix of each feature in the resized image, float32 [K, 6].
        descriptors: SIFT descriptors, uint8 [K, 128].
        count: Maximum number of features.
    """
    height, width = photo.colour.shape[:2]
    scale = np.sqrt(keypoints[:, 2] ** 2 + keypoints[:, 4] ** 2)  # The matrix is a similarity.
    order = np.argsort(-scale, kind="stable")[:count]
    pixels = keypoints[order, :2].astype(np.float64) * [width / grey.width, height / grey.height]
    at = np.clip(pixels.astype(np.intp), 0, [width - 1, height - 1])
    return Features(
        photo.name,
        width,
        height,
        photo.camera,
        photo.camera_guessed,
        photo.camera_to_scan,
        pixels,
        descriptors[order],
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

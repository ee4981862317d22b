"""Imported data sets, and the conversion of labels, cameras and images to samples.

The published formats do not identify blocks or objects, so the fine classes of a sample are the 12
classes and there are no instances. If depth is available, it determines which cells are seen first
and which empty cells are observed as free. Otherwise both masks are empty, and the facts of the
sample say so.
"""

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.capture.depth_images import check_depth_kind
from world2minecraft.capture.images import read_colour, read_header, read_raw
from world2minecraft.core.classes import CLASS_COUNT, CLASS_NAMES, UNKNOWN
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import MALFORMED, DamagedFileError, UnknownNameError
from world2minecraft.core.types import Camera, checks
from world2minecraft.geometry.rotations import nearest_rigid
from world2minecraft.minecraftocc.formats.image_conventions import DepthCode, decode_depth
from world2minecraft.minecraftocc.formats.label_grids import cells_behind_depth, cells_in_image
from world2minecraft.minecraftocc.types import (
    DEFAULT_SHAPE,
    DEFAULT_VOXEL_M,
    FineClass,
    LabelRegion,
    OccLabels,
    OccSample,
)

CLASS_KINDS = tuple(FineClass(f"nyu:{name}") for name in CLASS_NAMES)
MAX_SKEW = 1e-3  # Poses in float32 or with few digits are corrected within this tolerance.
HITS_FACT, FREE_FACT = "first surface, from depth", "cell centres in front of the depth"


@dataclass(frozen=True)
class ImportedSet:
    """An imported data set, which provides its samples by key with the same interface as a store.

    Attributes:
        path: Folder or file of the data set.
        format: Name of its format.
        splits: Split of each key: ``train``, ``test`` or an empty string.
        read: Function that reads the sample with a key.
        notes: Remarks for the user.
        sha256: SHA-256 of all samples, if the data set states it.
    """

    path: Path
    format: str
    splits: dict[str, str]
    read: Callable[[str], OccSample]
    notes: tuple[str, ...] = field(default=())
    sha256: str = ""

    def keys(self, split: str | None = None) -> list[str]:
        """Return the sample keys of a split, or of all splits by default."""
        return [key for key, of in self.splits.items() if split in (None, of)]

    def describe(self) -> str:
        """Return the format and sample counts, such as ``nyu, 3 samples (1 test, 2 train)``."""
        counts = Counter(self.splits.values())
        parts = ", ".join(f"{counts[one]:,} {one or 'without split'}" for one in sorted(counts))
        return f"{self.format}, {len(self):,} samples ({parts})"

    def samples(self, split: str | None = None) -> Iterator[OccSample]:
        """Iterate over the samples of a split, or of all splits by default."""
        return (self.read(key) for key in self.keys(split))

    def __getitem__(self, key: str) -> OccSample:
        if key not in self.splits:
            raise UnknownNameError("sample", key, self.splits)
        return self.read(key)

    def __iter__(self) -> Iterator[OccSample]:
        return self.samples()

    def __len__(self) -> int:
        return len(self.splits)


def read_colour_if_present(path: Path) -> np.ndarray | None:
    """Read a colour image as uint8 [H, W, 3], or return None if the file does not exist."""
    return read_colour(path) if path.is_file() else None


def read_depth_if_present(path: Path, code: DepthCode) -> np.ndarray | None:
    """Read a depth image in metres as float32 [H, W], or return None if the file does not exist.

    Raises:
        CaptureError: If the image type cannot contain depth.
    """
    if not path.is_file():
        return None
    check_depth_kind(path, read_header(path))
    return decode_depth(read_raw(path), code)


def resize_colour(pixels: np.ndarray, width_px: int, height_px: int) -> np.ndarray:
    """Resize a colour image with a bilinear filter, as the published loaders do."""
    if pixels.shape[:2] == (height_px, width_px):
        return pixels
    image = Image.fromarray(pixels).resize((width_px, height_px), Image.Resampling.BILINEAR)
    return np.asarray(image)


@dataclass(frozen=True, eq=False)
class ImportedFrame:
    """The data of one image in a published format.

    Attributes:
        name: File to name in error messages.
        labels: Class of each cell, uint8 [60, 60, 36], with axes x, y and z (up).
        origin_m: Minimum corner of cell (0, 0, 0) in metres, float64 [3].
        camera_to_world: Camera pose in the world, float64 [4, 4].
        camera: Camera of the image.
        colour: Colour image, uint8 [H, W, 3], or None.
        depth_m: Depth in metres, float32 [H, W], or None.
    """

    name: Path
    labels: np.ndarray
    origin_m: np.ndarray
    camera_to_world: np.ndarray
    camera: Camera
    colour: np.ndarray | None
    depth_m: np.ndarray | None


def make_sample(
    found: ImportedFrame,
    key: str,
    *,
    scene_id: str,
    tour_id: str,
    frame: int,
    split: str,
    format: str,
) -> OccSample:
    """Convert an imported frame to a sample. Its world coordinates become the room coordinates.

    Raises:
        DamagedFileError: If the labels or the camera pose are not valid.
    """
    region_to_room = np.eye(4)
    region_to_room[:3, 3] = checked_place(found.origin_m, "voxel origin", found.name)
    camera_to_room = _orthonormal_pose(found)
    region = LabelRegion(DEFAULT_SHAPE, DEFAULT_VOXEL_M, region_to_room)
    facts: dict[str, Any] = {"format": format}
    has_depth = found.depth_m is not None
    facts["hits"] = HITS_FACT if has_depth else "none, because there is no depth"
    facts["free"] = FREE_FACT if has_depth else "none, because there is no depth"
    return OccSample(
        key=key,
        scene_id=scene_id,
        tour_id=tour_id,
        frame=frame,
        camera=found.camera,
        camera_to_room=camera_to_room,
        occ=_labels_with_masks(found, region, camera_to_room),
        fine_classes=CLASS_KINDS,
        colour=found.colour,
        depth_m=found.depth_m,
        split=split,
        facts=facts,
    )


def checked_labels(values: Any, shape: tuple[int, ...], name: Path) -> np.ndarray:
    """Check class ids and convert them to uint8.

    Raises:
        DamagedFileError: If the array has another shape, or contains values other than class ids.
    """
    labels = np.asarray(values)
    if labels.shape != shape or labels.dtype.kind not in "biuf":
        raise DamagedFileError(
            name, f"labels must be numbers of shape {shape}, got {labels.dtype} {labels.shape}"
        )
    whole = labels.astype(np.uint8)
    if not (np.array_equal(whole, labels) and np.all((whole < CLASS_COUNT) | (whole == UNKNOWN))):
        raise DamagedFileError(name, "labels must be class ids from 0 to 11, or 255")
    return whole


def checked_numbers(values: Any, shape: tuple[int, ...], what: str, name: Path) -> np.ndarray:
    """Check an array of finite numbers and convert it to float64.

    Raises:
        DamagedFileError: If the values are not finite numbers, or if the array has another shape.
    """
    try:
        numbers = np.array(values, np.float64)
    except MALFORMED as error:
        raise DamagedFileError(name, f"the {what} does not consist of numbers") from error
    if numbers.shape != shape or not np.isfinite(numbers).all():
        raise DamagedFileError(name, f"the {what} must be a {shape} array of finite numbers")
    return numbers


def checked_place(values: Any, what: str, name: Path) -> np.ndarray:
    """Check a position in metres and convert it to float64 [3].

    Raises:
        DamagedFileError: If it does not consist of three finite numbers, or is too far away.
    """
    numbers = checked_numbers(values, (3,), what, name)
    try:
        return checks.coordinates(what, numbers, (3,))
    except ValueError as error:
        raise DamagedFileError(name, f"the {error}") from error


def resize_depth(depth_m: np.ndarray, camera: Camera) -> np.ndarray:
    """Resize a depth map to the size of a camera by nearest neighbour."""
    rows, columns = depth_m.shape
    if (rows, columns) == (camera.height_px, camera.width_px):
        return depth_m
    down = (np.arange(camera.height_px) + 0.5) * rows / camera.height_px
    across = (np.arange(camera.width_px) + 0.5) * columns / camera.width_px
    return np.ascontiguousarray(depth_m[down.astype(int)[:, None], across.astype(int)])


def _orthonormal_pose(found: ImportedFrame) -> np.ndarray:
    """Return the camera pose with an exactly orthonormal rotation."""
    pose = checked_numbers(found.camera_to_world, (4, 4), "camera pose", found.name)
    if fault := checks.rigid_fault(pose, MAX_SKEW):
        raise DamagedFileError(
            found.name, f"the camera pose is not a rotation and a translation: it {fault}"
        )
    return nearest_rigid(pose)


def _labels_with_masks(
    found: ImportedFrame, region: LabelRegion, camera_to_room: np.ndarray
) -> OccLabels:
    labels, depth_m = found.labels, found.depth_m
    region_to_camera = invert_rigid(camera_to_room) @ region.region_to_room
    inside, pixels, centre_m = cells_in_image(
        region.shape, region.voxel_m, region_to_camera, found.camera
    )
    hits = np.zeros(region.shape, np.uint32)
    free = np.zeros(region.shape, bool)
    if depth_m is not None:
        hits = _hits(found, region, invert_rigid(region_to_camera))
        seen_to = depth_m[pixels[..., 1], pixels[..., 0]]
        free = inside & (labels == 0) & (centre_m < seen_to - region.voxel_m / 2)
    return OccLabels(
        region=region,
        labels=labels,
        fine=np.where(labels == UNKNOWN, 0, labels).astype(np.uint16),
        instance=np.zeros(region.shape, np.uint16),
        in_frustum=inside,
        hits=hits,
        free=free,
    )


def _hits(found: ImportedFrame, region: LabelRegion, camera_to_region: np.ndarray) -> np.ndarray:
    """Count the pixels whose point, moved slightly behind its depth, is in each occupied cell."""
    if found.depth_m is None:
        return np.zeros(region.shape, np.uint32)
    _, cells = cells_behind_depth(found.depth_m, found.camera, region, camera_to_region)
    flat = np.ravel_multi_index(tuple(cells.T), region.shape)
    counts = np.bincount(flat, minlength=found.labels.size).reshape(region.shape)
    occupied = (found.labels > 0) & (found.labels != UNKNOWN)
    return np.where(occupied, counts, 0).astype(np.uint32)

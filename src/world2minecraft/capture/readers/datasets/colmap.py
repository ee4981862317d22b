"""Reader of COLMAP projects: photos with camera poses and intrinsics, but without depth or scale.

The model is in ``sparse/0``, ``sparse`` or the folder itself, and the photos are in ``images/``.
Models may be text or binary. Binary files are little-endian: a uint64 count, followed by records.
Image records end with the observed points, which are skipped. Text files have one line per camera
and two lines per image, of which the second may be empty. Poses are world-to-camera: a quaternion
w x y z and a translation.
"""

import struct
from collections import Counter
from dataclasses import dataclass
from pathlib import PurePosixPath

import numpy as np

from world2minecraft.capture.readers.datasets.intrinsics import stated_camera
from world2minecraft.capture.readers.datasets.text_tables import (
    check_relative_path,
    read_rows,
    to_floats,
)
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import CaptureError, DamagedFileError
from world2minecraft.core.files import read_bytes
from world2minecraft.core.types import Camera
from world2minecraft.geometry.rotations import pose_from_quaternion

MAX_MODEL_BYTES = 1 << 30  # Ten thousand photos with ten thousand points each have 2.4 GB: split.
MAX_NAME_BYTES = 1024
# The name of each model by its number, and how many parameters it has.
MODELS = (
    ("SIMPLE_PINHOLE", 3),
    ("PINHOLE", 4),
    ("SIMPLE_RADIAL", 4),
    ("RADIAL", 5),
    ("OPENCV", 8),
    ("OPENCV_FISHEYE", 8),
    ("FULL_OPENCV", 12),
    ("FOV", 5),
    ("SIMPLE_RADIAL_FISHEYE", 4),
    ("RADIAL_FISHEYE", 5),
    ("THIN_PRISM_FISHEYE", 12),
)
UNDISTORT_ADVICE = "run colmap image_undistorter and use its output folder"
_CAMERA = struct.Struct("<IiQQ")
_IMAGE = struct.Struct("<I7dI")
_Image = tuple[int, np.ndarray, int, str]
_COUNT = struct.Struct("<Q")
IMAGE_FOLDERS = ("images", "rgb", "image", ".")
_SAMPLED = 20  # Number of names that are tried to find the folder of the photos.


@dataclass(frozen=True, eq=False)
class ModelImage:
    """A photo of a COLMAP model.

    Attributes:
        name: Path of the photo below the image folder.
        camera: Intrinsics of the photo.
        camera_to_world: Camera pose, float64 [4, 4].
    """

    name: str
    camera: Camera
    camera_to_world: np.ndarray


def read_model(folder: AnyPath) -> tuple[ModelImage, ...]:
    """Read the photos of a COLMAP model, in the order of their image ids.

    Args:
        folder: Folder with ``cameras.bin`` and ``images.bin``, or both as ``.txt``.

    Raises:
        CaptureError: If a camera model is not supported or a camera is missing.
        DamagedFileError: If a file is truncated or damaged.
    """
    suffix = ".bin" if (folder / "images.bin").is_file() else ".txt"
    cameras_path, images_path = folder / f"cameras{suffix}", folder / f"images{suffix}"
    if suffix == ".bin":
        cameras, images = _binary_cameras(cameras_path), _binary_images(images_path)
    else:
        cameras, images = _text_cameras(cameras_path), _text_images(images_path)
    found = []
    for number, values, camera, name in sorted(images, key=lambda image: image[0]):
        if camera not in cameras:
            raise CaptureError(
                images_path,
                f"image {number} refers to the missing camera {camera}; copy the cameras and "
                "images files again",
            )
        world_to_camera = pose_from_quaternion(values[4:7], values[[1, 2, 3, 0]])
        lost = not np.isfinite(world_to_camera).all()
        pose = np.full((4, 4), np.nan) if lost else invert_rigid(world_to_camera)
        found.append(ModelImage(name, cameras[camera], pose))
    return tuple(found)


def _camera(path: AnyPath, model: str, size: tuple[int, int], values: np.ndarray) -> Camera:
    """Return the camera of a COLMAP model; its pixel centres are at +0.5 as in this project."""
    if model in ("SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL"):
        lens, bent = (values[0], values[0], *values[1:3]), values[3:]
    elif model in ("PINHOLE", "OPENCV", "FULL_OPENCV"):
        lens, bent = values[:4], values[4:]
    else:
        raise CaptureError(
            path, f"contains a camera of the unsupported model {model}; {UNDISTORT_ADVICE}"
        )
    if len(bent) > 5 and np.any(bent[5:]):
        raise CaptureError(
            path, f"contains a lens with unsupported terms beyond k3; {UNDISTORT_ADVICE}"
        )
    return stated_camera(path, size, lens, bent[:5], centre=0.0)


class _Reader:
    """A reader of binary values that checks the remaining length."""

    def __init__(self, path: AnyPath):
        self.path, self.data, self.position = path, read_bytes(path, MAX_MODEL_BYTES), 0

    def take(self, layout: struct.Struct) -> tuple:
        """Return the next values."""
        start = self.skip(layout.size)
        return layout.unpack_from(self.data, start)

    def skip(self, size: int) -> int:
        """Skip a number of bytes, and return their start."""
        start = self.position
        if size > len(self.data) - start:
            raise DamagedFileError(self.path, "is truncated; copy the file again")
        self.position += size
        return start

    def take_name(self) -> str:
        """Return the next zero-terminated text."""
        end = self.data.find(b"\0", self.position, self.position + MAX_NAME_BYTES)
        if end < 0:
            raise DamagedFileError(
                self.path, "contains an image without a name; copy the file again"
            )
        name = self.data[self.position : end]
        self.position = end + 1
        return name.decode("utf-8", "replace")


def _binary_cameras(path: AnyPath) -> dict[int, Camera]:
    reader = _Reader(path)
    cameras = {}
    (count,) = reader.take(_COUNT)
    for _ in range(count):
        number, model, width, height = reader.take(_CAMERA)
        if not 0 <= model < len(MODELS):
            raise CaptureError(
                path,
                f"contains a camera of the unsupported model number {model}; {UNDISTORT_ADVICE}",
            )
        name, parameters = MODELS[model]
        values = np.array(reader.take(struct.Struct(f"<{parameters}d")))
        cameras[number] = _camera(path, name, (width, height), values)
    return cameras


def _binary_images(path: AnyPath) -> list[_Image]:
    reader = _Reader(path)
    images: list[_Image] = []
    (count,) = reader.take(_COUNT)
    for _ in range(count):
        number, *values, camera = reader.take(_IMAGE)
        name = reader.take_name()
        (points,) = reader.take(_COUNT)
        reader.skip(24 * points)
        images.append((number, np.array(values), camera, name))
    return images


def _text_cameras(path: AnyPath) -> dict[int, Camera]:
    counts = dict(MODELS)
    cameras = {}
    for row in read_rows(path):
        if len(row) < 5 or not all(
            word.isdecimal() and len(word) < 10 for word in (row[0], *row[2:4])
        ):
            raise CaptureError(
                path, "must contain lines of the form: id, model, width, height, parameters"
            )
        if row[1] in counts and len(row) != 4 + counts[row[1]]:
            raise CaptureError(
                path,
                f"camera model {row[1]} must have {counts[row[1]]} parameters, got {len(row) - 4}",
            )
        values = to_floats(path, row[4:])
        cameras[int(row[0])] = _camera(path, row[1], (int(row[2]), int(row[3])), values)
    return cameras


def _text_images(path: AnyPath) -> list[_Image]:
    lines = iter(read_bytes(path, MAX_MODEL_BYTES).decode("utf-8", "replace").splitlines())
    images: list[_Image] = []
    for line in lines:
        if not line.strip() or line.startswith("#"):
            continue
        row = line.split(maxsplit=9)
        if len(row) != 10 or not row[0].isdecimal() or not row[8].isdecimal():
            raise CaptureError(
                path,
                "must contain lines of the form: id, QW QX QY QZ, TX TY TZ, camera id, name; "
                "each followed by a line of points",
            )
        images.append((int(row[0]), to_floats(path, row[1:8]), int(row[8]), row[9].strip()))
        next(lines, None)  # The points that this image saw; the line may be empty.
    return images


class ColmapSource:
    """A reader of COLMAP models with their photos."""

    layout = "sparse/0/cameras and images (.bin or .txt) with images/*.jpg (COLMAP)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains a COLMAP model and no ``transforms.json``."""
        return bool(_find_models(folder)) and not (folder / "transforms.json").is_file()

    def read(self, folder: AnyPath) -> Capture:
        """Read the photos and poses of the largest COLMAP model in a folder.

        Raises:
            CaptureError: If the model or its photos cannot be used.
        """
        chosen, *others = _find_models(folder)
        images = read_model(chosen)
        if not images:
            raise CaptureError(chosen, "contains no photos; run colmap mapper again")
        files = [check_relative_path(chosen, image.name) for image in images]
        place = _image_folder(folder, chosen, files)
        size = _most_common_size(images)
        frames = tuple(
            FrameFiles(
                name,
                image.camera_to_world,
                place / str(file),
                image.camera,
                problem=_size_problem(image, size),
            )
            for name, file, image in zip(_names(files), files, images, strict=True)
        )
        notes = ()
        if others:
            notes = (f"read {chosen.name}, the largest of {1 + len(others)} models",)
        return Capture(folder, "colmap", frames, notes=notes, scale="unknown")


def _find_models(folder: AnyPath) -> list[AnyPath]:
    """Return the folders that contain a model, the one with the most photos first."""
    sparse = [folder / "sparse", folder / "colmap" / "sparse"]
    places = [folder, *sparse]
    for place in sparse:
        if place.is_dir():
            places += sorted((path for path in place.iterdir() if path.is_dir()), key=str)
    found = [place for place in places if _has_model(place)]
    return sorted(found, key=lambda place: -_model_size(place))


def _has_model(place: AnyPath) -> bool:
    return any(
        all((place / f"{kind}{suffix}").is_file() for kind in ("cameras", "images"))
        for suffix in (".bin", ".txt")
    )


def _model_size(place: AnyPath) -> int:
    binary = place / "images.bin"
    return int((binary if binary.is_file() else place / "images.txt").stat().st_size)


def _image_folder(folder: AnyPath, model: AnyPath, files: list[PurePosixPath]) -> AnyPath:
    """Return the folder that contains most of the named photos."""
    tops = list(dict.fromkeys([folder, model.parent, model.parent.parent]))
    places = [top if name == "." else top / name for top in tops for name in IMAGE_FOLDERS]
    sampled = files[:: max(1, len(files) // _SAMPLED)]

    def there(place: AnyPath) -> int:
        return sum((place / str(file)).is_file() for file in sampled)

    best = max(places, key=there)
    if not there(best):
        raise CaptureError(
            folder,
            f"contains a model but none of its photos, such as images/{str(files[0])[:80]}; "
            "copy the photos next to the model",
        )
    return best


def _names(files: list[PurePosixPath]) -> list[str]:
    """Return a unique name for each photo, with folders separated by dots."""
    names: list[str] = []
    seen: dict[str, int] = {}
    for file in files:
        name = ".".join([*file.parent.parts, file.stem])[-150:]
        count = seen[name] = seen.get(name, 0) + 1
        names.append(name if count == 1 else f"{name}.{count}")
    return names


def _most_common_size(images: tuple[ModelImage, ...]) -> tuple[int, int]:
    """Return the most common image size in pixels; ties are decided by the first photo."""
    counts = Counter((image.camera.width_px, image.camera.height_px) for image in images)
    return counts.most_common(1)[0][0]


def _size_problem(image: ModelImage, size: tuple[int, int]) -> str:
    """Return why a photo is excluded, because all photos of a reconstruction need the same size."""
    width, height = image.camera.width_px, image.camera.height_px
    return (
        ""
        if (width, height) == size
        else f"is {width}x{height} px; most photos are {size[0]}x{size[1]} px"
    )

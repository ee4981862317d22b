"""Reader of 360-degree panoramas: equirectangular pictures, twice as wide as high.

Each panorama is cut into perspective views in level directions, which share its place. The middle
of a panorama is ahead, its upper edge is above.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from world2minecraft.capture.images import (
    ImageHeader,
    check_whole,
    read_colour,
    read_header,
    read_small,
)
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.readers.photo_folder import (
    PHOTO_SUFFIXES,
    evenly_thinned,
    list_photos,
    natural_key,
    plain_name,
)
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError, DamagedFileError, InputError
from world2minecraft.core.types import Camera
from world2minecraft.core.types.photos import RigMember

VIEWS = 6  # Level views, each 90 degrees wide: neighbours share a third.
HEIGHT_SHARE = 1.4  # Height / width: 109 degrees, from furniture feet to the ceiling.
MAX_SIDE_PX = 1024  # Maximum width of a view; photos are read at this size too.
MIN_WIDTH_PX = 1000
ASPECT_TOLERANCE = 0.01
MIN_PANORAMAS = 3
CHECKED = 3  # Number of images of a folder whose edges are compared.
SEAM_PX = 256  # Width at which the left edge is compared with the right edge.
MAX_SEAM_RATIO = 3.0  # Maximum difference of the edges / difference of neighbouring columns.
MAX_SEAM_GREY = 4.0  # Differences below this are always accepted.
MAX_CACHED = 2  # Decoded panoramas; a panorama of 8192 x 4096 px takes 100 MB.
ADVICE = (
    "take at least 4 panoramas of the room, 0.5 to 1.5 m apart, with lights on and nothing moving"
)


def is_panorama_size(width_px: int, height_px: int) -> bool:
    """Return whether a picture of this size may be a full panorama."""
    wide_enough = width_px >= MIN_WIDTH_PX
    return wide_enough and abs(width_px / (2 * height_px) - 1) <= ASPECT_TOLERANCE


def wraps_around(colour: np.ndarray) -> bool:
    """Return whether the left edge of a picture, uint8 [H, W, 3], continues its right edge."""
    values = colour.astype(np.float64).mean(axis=2)
    seam = float(np.abs(values[:, 0] - values[:, -1]).mean())
    beside = float(np.abs(np.diff(values, axis=1)).mean())
    return seam <= max(MAX_SEAM_RATIO * beside, MAX_SEAM_GREY)


def is_panorama(path: AnyPath) -> bool:
    """Return whether an image file is a full panorama, by its size and its edges."""
    try:
        header = read_header(path)
        if not is_panorama_size(header.width_px, header.height_px):
            return False
        return wraps_around(read_small(path, SEAM_PX))
    except InputError:
        return False


def view_camera(panorama_width_px: int) -> Camera:
    """Return the camera of the views of a panorama, at about its resolution."""
    width = min(MAX_SIDE_PX, max(2, round(panorama_width_px / np.pi)))
    height = round(HEIGHT_SHARE * width)
    return Camera(width, height, width / 2, width / 2, width / 2, height / 2)


def view_to_panorama(view: int) -> np.ndarray:
    """Return the pose of a view in the frame of its panorama, float64 [4, 4], OpenCV axes.

    View 0 looks ahead, the others are turned to the right.
    """
    angle = 2 * np.pi * view / VIEWS
    pose = np.eye(4)
    pose[0, 0], pose[0, 2] = np.cos(angle), np.sin(angle)
    pose[2, 0], pose[2, 2] = -np.sin(angle), np.cos(angle)
    return pose


def cut_view(panorama: np.ndarray, camera: Camera, rotation: np.ndarray) -> np.ndarray:
    """Return a perspective view of a panorama, with bilinear interpolation.

    Args:
        panorama: Equirectangular picture, uint8 [H, W, 3].
        camera: Camera of the view, without distortion.
        rotation: Rotation from the camera to the panorama, float64 [3, 3], OpenCV axes.

    Returns:
        The view, uint8 [h, w, 3].
    """
    height, width = panorama.shape[:2]
    x = (np.arange(camera.width_px) + 0.5 - camera.cx_px) / camera.fx_px
    y = (np.arange(camera.height_px) + 0.5 - camera.cy_px) / camera.fy_px
    rays = np.stack([*np.meshgrid(x, y), np.ones((len(y), len(x)))], axis=-1) @ rotation.T
    across = np.arctan2(rays[..., 0], rays[..., 2]) / (2 * np.pi) + 0.5
    down = np.arctan2(rays[..., 1], np.hypot(rays[..., 0], rays[..., 2])) / np.pi + 0.5
    column, row = across * width - 0.5, np.clip(down * height - 0.5, 0, height - 1)
    left, top = np.floor(column).astype(int), np.floor(row).astype(int)
    right_share, low_share = (column - left)[..., None], (row - top)[..., None]
    below = np.minimum(top + 1, height - 1)
    left, right = left % width, (left + 1) % width
    upper = panorama[top, left] * (1 - right_share) + panorama[top, right] * right_share
    lower = panorama[below, left] * (1 - right_share) + panorama[below, right] * right_share
    return np.round(upper * (1 - low_share) + lower * low_share).astype(np.uint8)


@lru_cache(maxsize=MAX_CACHED)
def _decoded(path: AnyPath) -> np.ndarray:
    return read_colour(path)


@dataclass(frozen=True)
class PanoramaView:
    """A perspective view of a panorama. It implements ``ImageSource``.

    Attributes:
        path: The panorama.
        view: Number of the view, from 0.
        camera: Camera of the view.
    """

    path: AnyPath
    view: int
    camera: Camera

    def __str__(self) -> str:
        """Return the path of the panorama and the view, for messages."""
        return f"{self.path}/view {self.view}"

    @property
    def stem(self) -> str:
        """The name by which label images are found."""
        return f"{self.path.stem}.{self.view}"

    @property
    def name(self) -> str:
        """A short name for messages."""
        return f"{self.path.name} (view {self.view})"

    def header(self) -> ImageHeader:
        """Return the size and mode of the view."""
        read_header(self.path)
        return ImageHeader(self.camera.width_px, self.camera.height_px, "RGB")

    def check_whole(self) -> None:
        """Check that the panorama is not truncated."""
        check_whole(self.path)

    def colour(self) -> np.ndarray:
        """Return the view, uint8 [H, W, 3]."""
        return cut_view(_decoded(self.path), self.camera, view_to_panorama(self.view)[:3, :3])

    def raw(self) -> np.ndarray:
        """Raise DamagedFileError, because a panorama contains colours."""
        raise DamagedFileError(self, "contains colours, not single values")


def panorama_frames(
    path: AnyPath, name: str, camera: Camera, pose: np.ndarray | None = None
) -> list[FrameFiles]:
    """Return the views of a panorama as frames.

    Args:
        path: The panorama.
        name: Name of the panorama; frames are named ``NAME.0`` and so on.
        camera: Camera of the views.
        pose: Panorama-to-world transform, float64 [4, 4] with OpenCV axes, or None.
    """
    frames = []
    for view in range(VIEWS):
        own = view_to_panorama(view)
        frames.append(
            FrameFiles(
                f"{name}.{view}",
                None if pose is None else pose @ own,
                PanoramaView(path, view, camera),
                camera,
                rig=RigMember(name, view, own),
            )
        )
    return frames


class PanoramaSource:
    """A reader of folders and zip archives of panoramas without poses."""

    layout = "a folder of 360-degree panoramas (2:1 .jpg or .png)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the path is a panorama, or a folder that contains mostly panoramas."""
        if folder.is_file():
            return folder.suffix.lower() in PHOTO_SUFFIXES and is_panorama(folder)
        photos = list_photos(folder)
        some = photos[:: max(1, len(photos) // CHECKED)][:CHECKED]
        return bool(some) and all(is_panorama(path) for path in some)

    def read(self, folder: AnyPath) -> Capture:
        """Read all panoramas of a folder.

        Raises:
            CaptureError: If there are too few panoramas.
        """
        return self.read_with(folder, ScanOptions())

    def read_with(self, folder: AnyPath, options: ScanOptions) -> Capture:
        """Read the panoramas of a folder, at most ``options.frames``.

        Raises:
            CaptureError: If there are too few panoramas.
        """
        paths = [folder] if folder.is_file() else list_photos(folder)
        accepted: list[AnyPath] = []
        skipped: list[tuple[str, str]] = []
        widths: list[int] = []
        for path in sorted(paths, key=lambda path: natural_key(path.name)):
            try:
                header = read_header(path)
            except InputError as error:
                skipped.append((path.name, error.reason))
                continue
            if is_panorama_size(header.width_px, header.height_px):
                accepted.append(path)
                widths.append(header.width_px)
            else:
                size = f"{header.width_px}x{header.height_px} px"
                skipped.append((path.name, f"is not a panorama (2:1): {size}"))
        if len(accepted) < MIN_PANORAMAS:
            count = f"{len(accepted)} panorama" + "s" * (len(accepted) != 1)
            raise CaptureError(
                folder,
                f"contains {count}, which {'do' if len(accepted) != 1 else 'does'} not show the "
                f"room from enough places to measure depth; {ADVICE}",
            )
        camera = view_camera(int(np.median(widths)))
        accepted = evenly_thinned(accepted, options.frames)
        return Capture(
            folder,
            "panoramas",
            tuple(_frames(accepted, camera)),
            notes=(panorama_note(len(accepted)),),
            scale="unknown",
            skipped=tuple(skipped),
        )


def panorama_note(count: int) -> str:
    """Return the note on the panoramas of a capture."""
    return f"{count} panoramas are split into {VIEWS} views each, which share a position"


def _frames(paths: Sequence[AnyPath], camera: Camera) -> list[FrameFiles]:
    frames: list[FrameFiles] = []
    used: set[str] = set()
    for path in paths:
        name = plain_name(path.stem, used)
        used.add(name)
        frames += panorama_frames(path, name, camera)
    return frames

"""Reader of Stray Scanner: ``odometry.csv``, ``camera_matrix.csv``, video, depth and confidence.

Rows of the odometry contain timestamp, frame, x, y, z, qx, qy, qz, qw. The pose is camera-to-world
in ARKit's world but with OpenCV camera axes, because the app converts them. Newer versions add fx,
fy, cx, cy. Frame N consists of image N of ``rgb.mp4`` (or ``rgb/N.jpg``), ``depth/N.png`` in
millimetres and ``confidence/N.png`` with values from 0 to 2.
"""

import csv
import io

import numpy as np

from world2minecraft.capture.images import ImagePlace, read_header
from world2minecraft.capture.readers.apps.app_values import (
    ARKIT_UP,
    files_by_stem,
    parse_camera,
    read_text,
)
from world2minecraft.capture.readers.apps.video_frames import VideoFrame, open_video
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import Camera
from world2minecraft.geometry.rotations import pose_from_quaternion

ODOMETRY = "odometry.csv"
MATRIX = "camera_matrix.csv"
VIDEO = "rgb.mp4"
MAX_ROWS = 1_000_000
_POSE = ("x", "y", "z", "qx", "qy", "qz", "qw")
_LENS = ("fx", "fy", "cx", "cy")
Rows = dict[int, dict[str, float]]


class StraySource:
    """A reader of Stray Scanner recordings."""

    layout = "odometry.csv with rgb.mp4, depth/, camera_matrix.csv (Stray Scanner)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains an odometry file and a video, images or depth."""
        if not folder.is_dir() or not (folder / ODOMETRY).is_file():
            return False
        parts = (folder / VIDEO, folder / "rgb", folder / "depth")
        return any(part.exists() for part in parts)

    def read(self, folder: AnyPath) -> Capture:
        """Read the frames of a Stray Scanner recording.

        Raises:
            CaptureError: If the odometry, images or intrinsics are missing or not valid.
        """
        rows = _rows(folder / ODOMETRY)
        pictures = _pictures(folder, rows)
        depths = _by_index(folder / "depth", (".png", ".npy"))
        trusts = _by_index(folder / "confidence", (".png",))
        if not pictures and not depths:
            raise CaptureError(
                folder, f"contains neither {VIDEO} nor rgb/ nor depth/; copy the complete recording"
            )
        size = _size(folder, pictures)
        matrix = _matrix(folder / MATRIX) if (folder / MATRIX).is_file() else None
        frames = []
        for index, row in sorted(rows.items()):
            lens = _lens(folder, row, matrix, size)
            depth, picture = depths.get(index), pictures.get(index)
            frames.append(
                FrameFiles(
                    f"{index:06d}",
                    _pose(row),
                    picture,
                    lens if picture else None,
                    depth,
                    lens if depth else None,
                    problem="" if picture or depth else "has neither a colour nor a depth image",
                    trust_path=trusts.get(index) if depth else None,
                    time_s=row.get("timestamp"),
                )
            )
        return Capture(
            folder, "stray", tuple(frames), depth_unit="mm", full_trust=2.0, world_up=ARKIT_UP
        )


def _rows(path: AnyPath) -> Rows:
    """Return the rows of the odometry by frame number."""
    lines = csv.reader(io.StringIO(read_text(path)))
    try:
        header = [word.strip() for word in next(lines, [])]
    except csv.Error as error:
        raise CaptureError(path, "is not a table of comma-separated numbers") from error
    missing = [name for name in ("frame", *_POSE) if name not in header]
    if missing:
        raise CaptureError(
            path, f"must start with a header row; the column {missing[0]} is missing"
        )
    rows: Rows = {}
    try:
        for line in lines:
            if not line:
                continue
            values = {name: float(word) for name, word in zip(header, line, strict=True)}
            if not 0 <= values["frame"] < MAX_ROWS:
                raise ValueError(f"invalid frame {line[header.index('frame')][:20]}")
            rows[int(values["frame"])] = values
    except (ValueError, csv.Error) as error:
        where = f"line {lines.line_num}"
        raise CaptureError(path, f"{where} is not a row of numbers ({str(error)[:60]})") from error
    if not rows:
        raise CaptureError(path, "contains no poses; copy the file again")
    return rows


def _pose(row: dict[str, float]) -> np.ndarray:
    place_m = np.array([row[name] for name in _POSE[:3]])
    return pose_from_quaternion(place_m, np.array([row[name] for name in _POSE[3:]]))


def _by_index(folder: AnyPath, suffixes: tuple[str, ...]) -> dict[int, AnyPath]:
    return {
        int(stem): path
        for stem, path in files_by_stem(folder, suffixes).items()
        if stem.isascii() and stem.isdigit() and len(stem) < 9
    }


def _pictures(folder: AnyPath, rows: Rows) -> dict[int, ImagePlace]:
    """Return the colour images by number, from files or else from the video."""
    files = _by_index(folder / "rgb", (".jpg", ".jpeg", ".png"))
    if files:
        return dict(files)
    if not (folder / VIDEO).is_file():
        return {}
    return {index: VideoFrame(folder / VIDEO, index) for index in rows}


def _size(folder: AnyPath, pictures: dict[int, ImagePlace]) -> tuple[int, int]:
    """Return the image size that the intrinsics refer to.

    Without colour images, it is the size that all phones with LiDAR record.
    """
    if not pictures:
        return 1920, 1440
    first = pictures[min(pictures)]
    return open_video(first.path).size if isinstance(first, VideoFrame) else read_header(first).size


def _matrix(path: AnyPath) -> list[float]:
    """Return fx, fy, cx, cy of a 3x3 matrix file."""
    words = read_text(path).replace(",", " ").split()
    try:
        values = np.array([float(word) for word in words])
    except ValueError:
        values = np.zeros(0)
    if len(values) != 9 or not np.isfinite(values).all():
        raise CaptureError(path, "must contain 9 numbers, a 3x3 matrix")
    return [values[0], values[4], values[2], values[5]]


def _lens(
    folder: AnyPath, row: dict[str, float], matrix: list[float] | None, size: tuple[int, int]
) -> Camera:
    stated = [row.get(name, 0.0) for name in _LENS]
    if min(stated) > 0:
        return parse_camera(folder / ODOMETRY, size, stated)
    if matrix is None:
        raise CaptureError(
            folder, f"does not contain {MATRIX} (3x3: fx, 0, cx, 0, fy, cy, 0, 0, 1)"
        )
    return parse_camera(folder / MATRIX, size, matrix)

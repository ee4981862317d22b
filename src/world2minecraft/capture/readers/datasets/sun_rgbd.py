"""Reader of SUN3D and SUN RGB-D: ``image/``, ``depth/``, ``extrinsics/`` and ``intrinsics.txt``.

Both data sets store depth in millimetres with the 16 bits rotated by three. SUN RGB-D has one frame
per folder, and its extrinsics rotate the camera axes so that -y is up. SUN3D is a sequence with
three rows of extrinsics per frame, camera to world. Axes are those of OpenCV.
"""

import re

import numpy as np

from world2minecraft.capture.images import SUFFIXES
from world2minecraft.capture.readers.datasets.intrinsics import first_image_size, matrix_camera
from world2minecraft.capture.readers.datasets.text_tables import (
    files_with_suffix,
    read_matrix,
    read_rows,
    to_floats,
)
from world2minecraft.capture.readers.datasets.time_sync import pair_times
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError

DEPTH_UNIT = "rotated"
WITHIN_S = 0.033  # SUN3D's recorder pairs each picture with a depth of the same thirtieth.
ONE_FRAME_NOTE = "the capture is a single frame; everything that it does not show stays unknown"
_STAMPED = re.compile(r"(\d{1,9})-(\d{1,15})")


class SunSource:
    """A reader of SUN RGB-D frames and SUN3D sequences."""

    layout = "image/*.jpg, depth_bfx/*.png, extrinsics/*.txt, intrinsics.txt (SUN RGB-D, SUN3D)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains the image folders and the intrinsics."""
        depth = _depth_folder(folder)
        return (
            depth is not None and (folder / "image").is_dir() and _intrinsics_file(folder).is_file()
        )

    def read(self, folder: AnyPath) -> Capture:
        """Read a SUN RGB-D frame or the frames of a SUN3D sequence.

        Raises:
            CaptureError: If images cannot be paired, or intrinsics or poses are not valid.
        """
        depth_folder = _depth_folder(folder) or folder
        colours = files_with_suffix(folder / "image", SUFFIXES)
        pairs = _pairs(folder, colours, files_with_suffix(depth_folder, SUFFIXES))
        matrix = read_matrix(_intrinsics_file(folder), [(3, 3), (4, 4)])
        size = first_image_size([colour for colour, _ in pairs])
        if size is None:
            raise CaptureError(folder, "contains no readable image; copy the folder again")
        camera = matrix_camera(_intrinsics_file(folder), size, matrix)
        poses = _poses(folder, len(pairs))
        frames = tuple(
            FrameFiles(colour.stem, pose, colour, camera, depth, camera, time_s=_seconds(colour))
            for (colour, depth), pose in zip(pairs, poses, strict=True)
        )
        single = len(frames) == 1
        return Capture(
            folder,
            "sun",
            frames,
            depth_unit=DEPTH_UNIT,
            notes=(ONE_FRAME_NOTE,) if single else (),
            world_up=np.array([0.0, -1.0, 0.0]) if single else None,
        )


def _intrinsics_file(folder: AnyPath) -> AnyPath:
    return folder / "intrinsics.txt"


def _depth_folder(folder: AnyPath) -> AnyPath | None:
    """Return the depth folder. ``depth_bfx`` is the second choice: its holes are inpainted."""
    return next(
        (folder / name for name in ("depth", "depth_bfx") if (folder / name).is_dir()), None
    )


def _seconds(path: AnyPath) -> float | None:
    """Return the time in seconds in a SUN3D file name such as ``0000001-000000033369.jpg``."""
    match = _STAMPED.fullmatch(path.stem)
    return int(match[2]) / 1e6 if match else None


def _pairs(
    folder: AnyPath, colours: list[AnyPath], depths: list[AnyPath]
) -> list[tuple[AnyPath, AnyPath]]:
    """Pair images in order if the counts match, or else by the times in their names."""
    if colours and len(colours) == len(depths):
        return list(zip(colours, depths, strict=True))
    times = [[_seconds(path) for path in paths] for paths in (colours, depths)]
    if not colours or not depths or any(None in stamps for stamps in times):
        raise CaptureError(
            folder,
            f"contains {len(colours)} colour and {len(depths)} depth images; the "
            "counts or the times must match",
        )
    colour_s, depth_s = (np.array(stamps, np.float64) for stamps in times)
    pairs = pair_times(colour_s, depth_s, WITHIN_S)
    if not pairs:
        raise CaptureError(folder, "contains no colour and depth images of the same time")
    return [(colours[first], depths[second]) for first, second in pairs]


def _poses(folder: AnyPath, count: int) -> list[np.ndarray | None]:
    """Return the camera-to-world pose of each frame, from the newest file in ``extrinsics``."""
    files = sorted((folder / "extrinsics").glob("*.txt"), key=str)
    if not files:
        return [np.eye(4)] if count == 1 else [None] * count
    path = files[-1]
    words = [word for row in read_rows(path) for word in row]
    if len(words) != 12 * count:
        raise CaptureError(
            path,
            f"must contain a 3x4 matrix for each of {count} frames ({12 * count} "
            f"numbers), got {len(words)} numbers",
        )
    stated = to_floats(path, words).reshape(count, 3, 4)
    poses = []
    for rows in stated:
        pose = np.vstack([rows, [0, 0, 0, 1]])
        if count == 1:
            pose[:3, 3] = 0  # The camera is the origin; it is turned level, no more.
        poses.append(pose)
    return poses

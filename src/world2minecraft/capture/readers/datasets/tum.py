"""Reader of TUM RGB-D sequences: ``rgb.txt``, ``depth.txt`` and ``groundtruth.txt``.

Lines have the form ``seconds file`` or ``seconds tx ty tz qx qy qz qw`` (camera to world). Images
are paired by time. Poses are measured more often than images are taken, and are interpolated. Depth
is registered to colour, so both share one camera with its distortion. The intrinsics are those in
``calibration.txt`` (fx fy cx cy and up to five of k1 k2 p1 p2 k3, as in ETH3D), those published for
the sequence (freiburg1 to 3), or the default of such cameras.
"""

import re

import numpy as np

from world2minecraft.capture.readers.datasets.intrinsics import (
    PRIMESENSE,
    VGA,
    first_image_size,
    intrinsics_size,
    stated_camera,
)
from world2minecraft.capture.readers.datasets.text_tables import (
    check_relative_path,
    read_rows,
    to_floats,
)
from world2minecraft.capture.readers.datasets.time_sync import interpolate_pose, pair_times
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import Camera

WITHIN_S = 0.02  # The bound of the benchmark's own script.
MAX_GAP_S = 0.2  # Between two measured poses; a hand turns by a few degrees in that time.
DEPTH_UNIT = "5000"
# fx fy cx cy and k1 k2 p1 p2 k3, from the benchmark's page on file formats.
PUBLISHED = {
    "1": ((517.3, 516.5, 318.6, 255.3), (0.2624, -0.9531, -0.0054, 0.0026, 1.1633)),
    "2": ((520.9, 521.0, 325.1, 249.7), (0.2312, -0.7849, -0.0033, -0.0001, 0.9172)),
    "3": ((535.4, 539.2, 320.1, 247.6), ()),
}
_SEQUENCE = re.compile(r"(?:freiburg|(?<![a-z])fr)([123])(?!\d)", re.IGNORECASE)


class TumSource:
    """A reader of sequences in the layout of the TUM RGB-D benchmark."""

    layout = "rgb.txt, depth.txt and groundtruth.txt (TUM RGB-D)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains ``rgb.txt`` and ``depth.txt``."""
        return (folder / "rgb.txt").is_file() and (folder / "depth.txt").is_file()

    def read(self, folder: AnyPath) -> Capture:
        """Read the pairs of colour and depth images with their interpolated poses.

        Raises:
            CaptureError: If images do not match in time, or a file is not valid.
        """
        colour_s, colours = _read_image_list(folder / "rgb.txt")
        depth_s, depths = _read_image_list(folder / "depth.txt")
        pairs = pair_times(colour_s, depth_s, WITHIN_S)
        if not pairs:
            raise CaptureError(
                folder,
                f"contains no colour and depth images within {WITHIN_S} s of each other "
                "(rgb.txt, depth.txt)",
            )
        camera, notes = _camera(folder, [colours[index] for index, _ in pairs])
        poses = _Trajectory(folder / "groundtruth.txt")
        frames = []
        for index, other in pairs:
            seconds = float(colour_s[index])
            pose, problem = poses.at(seconds)
            frames.append(
                FrameFiles(
                    colours[index].stem,
                    pose,
                    colours[index],
                    camera,
                    depths[other],
                    camera,
                    problem=problem,
                    time_s=seconds,
                )
            )
        alone = len(colours) - len(pairs)
        if alone:
            notes += (f"{alone} colour images have no depth within {WITHIN_S} s",)
        return Capture(folder, "tum", tuple(frames), depth_unit=DEPTH_UNIT, notes=notes)


def _read_image_list(path: AnyPath) -> tuple[np.ndarray, list[AnyPath]]:
    """Return the times and files in a list; all files must be inside the folder."""
    rows = read_rows(path)
    if not rows or any(len(row) < 2 for row in rows):
        raise CaptureError(
            path, "must contain lines of the form: seconds file, such as 1.5 rgb/1.5.png"
        )
    seconds = to_floats(path, [row[0] for row in rows])
    if not np.isfinite(seconds).all():
        raise CaptureError(path, "must contain a finite time in seconds at the start of each line")
    files = [path.parent / str(check_relative_path(path, row[1])) for row in rows]
    stems = [file.stem for file in files]
    if len(set(stems)) != len(stems):
        twice = next(stem for stem in stems if stems.count(stem) > 1)
        raise CaptureError(path, f"contains the file {twice[:80]!r} twice; remove one of the lines")
    return seconds, files


def _camera(folder: AnyPath, images: list[AnyPath]) -> tuple[Camera, tuple[str, ...]]:
    """Return the camera of both streams, and a note if it is not specified by the sequence."""
    stated = folder / "calibration.txt"
    if stated.is_file():
        words = [word for row in read_rows(stated, 1 << 20) for word in row]
        if not 4 <= len(words) <= 9:
            raise CaptureError(
                stated,
                "must contain fx fy cx cy and up to five distortion coefficients, got "
                f"{len(words)} values",
            )
        values = to_floats(stated, words)
        size = intrinsics_size((values[2], values[3]), [first_image_size(images), VGA]) or VGA
        return stated_camera(stated, size, values[:4], values[4:]), ()
    match = _SEQUENCE.search(folder.name) or _SEQUENCE.search(folder.parent.name)
    if match:
        lens, distortion = PUBLISHED[match[1]]
        note = f"using the intrinsics published for freiburg{match[1]}"
        return stated_camera(folder, VGA, lens, distortion), (note,)
    note = (
        "no calibration.txt (fx fy cx cy) found; using the default intrinsics of "
        "Kinect-like cameras (525 px)"
    )
    return stated_camera(folder, VGA, PRIMESENSE), (note,)


class _Trajectory:
    """Measured poses that can be interpolated at any time; empty if the file is missing."""

    def __init__(self, path: AnyPath):
        self.seconds = np.zeros(0)
        self.stated = path.is_file()
        if not self.stated:
            return
        rows = read_rows(path)
        if not rows or any(len(row) != 8 for row in rows):
            raise CaptureError(path, "must contain lines of the form: seconds tx ty tz qx qy qz qw")
        words = [word for row in rows for word in row]
        table = to_floats(path, words).reshape(len(rows), 8)
        table = table[np.isfinite(table).all(axis=1)]
        table = table[np.linalg.norm(table[:, 4:], axis=1) > 1e-6]
        if not len(table):
            raise CaptureError(
                path,
                "contains no finite pose; correct the file, or delete it to have the "
                "poses estimated",
            )
        table = table[np.argsort(table[:, 0], kind="stable")]
        self.seconds, self.poses = table[:, 0], table[:, 1:]

    def at(self, seconds: float) -> tuple[np.ndarray | None, str]:
        """Return the camera-to-world pose at a time, or None and the reason."""
        if not self.stated:
            return None, ""
        after = int(np.searchsorted(self.seconds, seconds))
        around = range(max(after - 1, 0), min(after + 1, len(self.seconds)))
        nearest = min(around, key=lambda index: abs(self.seconds[index] - seconds))
        if 0 < after < len(self.seconds):
            gap = float(self.seconds[after] - self.seconds[after - 1])
            if 0 < gap <= MAX_GAP_S:
                share = float(seconds - self.seconds[after - 1]) / gap
                return interpolate_pose(self.poses[after - 1], self.poses[after], share), ""
        if abs(self.seconds[nearest] - seconds) <= WITHIN_S:
            return interpolate_pose(self.poses[nearest], self.poses[nearest], 0.0), ""
        return None, "has no pose near its time in groundtruth.txt"

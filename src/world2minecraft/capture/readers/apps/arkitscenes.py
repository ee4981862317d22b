"""Reader of ARKitScenes (raw and 3DOD): colour images, depth and poses matched by time.

Images are named ``VIDEO_SECONDS.png``. ``lowres_wide.traj`` contains ten poses per second: the time
in seconds, a rotation vector and a translation, world-to-camera with OpenCV axes, in a world with z
up. There are up to sixty images per second. For each pose, the nearest depth image is used, and the
pose is interpolated to its time. Confidence ranges from 0 to 2, and intrinsics are in ``.pincam``
files.
"""

import re
from bisect import bisect_left
from collections.abc import Sequence

import numpy as np

from world2minecraft.capture.readers.apps.app_values import files_by_stem, parse_camera, read_text
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError, InputError
from world2minecraft.core.types import Camera
from world2minecraft.geometry.rotations import rotation_from_vector

TRAJECTORY = "lowres_wide.traj"
SAME_TIME_S = 0.009  # About half a frame at 60 Hz; stamps of a frame differ by 1 ms.
MAX_GAP_S = 0.25  # Poses come every 0.1 s; they are not interpolated over longer gaps.
COLOUR_FOLDERS = ("vga_wide", "lowres_wide")  # The first holds the same view at 640x480.
ARKITSCENES_UP = np.array([0.0, 0.0, 1.0])
_STEM = re.compile(r"(?:.*_)?(\d{1,9}\.\d{1,9})", re.ASCII)
Timed = tuple[list[float], list[AnyPath]]


class ARKitScenesSource:
    """A reader of single videos of the ARKitScenes data set."""

    layout = "lowres_wide.traj with lowres_wide/, lowres_depth/ (ARKitScenes)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder, or its folder of frames, contains a trajectory."""
        return folder.is_dir() and _trajectory_folder(folder) is not None

    def read(self, folder: AnyPath) -> Capture:
        """Read the frames of an ARKitScenes video, matched by time.

        Raises:
            CaptureError: If images or the trajectory are missing, not valid or do not match.
        """
        inner = _trajectory_folder(folder) or folder
        times, poses = _trajectory(inner / TRAJECTORY)
        kind = next((name for name in COLOUR_FOLDERS if (inner / name).is_dir()), None)
        if kind is None:
            raise CaptureError(
                inner, "does not contain lowres_wide/ with images; download the complete video"
            )
        colours, lenses = (
            _timed_files(inner / kind, ".png"),
            _timed_files(inner / f"{kind}_intrinsics", ".pincam"),
        )
        depths, trusts = (
            _timed_files(inner / "lowres_depth", ".png"),
            _timed_files(inner / "confidence", ".png"),
        )
        chosen = depths if depths[0] else colours
        frames = tuple(
            _frame(time, times, poses, colours, lenses, depths, trusts)
            for time in _times_near_poses(chosen[0], times)
        )
        if not frames:
            raise CaptureError(
                inner,
                f"contains no image at a time covered by {TRAJECTORY}; copy images and "
                "trajectory of the same video",
            )
        left = len(chosen[0]) - len(frames)
        notes = (f"{left} images between the poses of the trajectory are ignored",) if left else ()
        return Capture(
            folder,
            "arkitscenes",
            frames,
            depth_unit="mm",
            notes=notes,
            full_trust=2.0,
            world_up=ARKITSCENES_UP,
        )


def _trajectory_folder(folder: AnyPath) -> AnyPath | None:
    """Return the folder of the trajectory: this folder or the frames folder of 3DOD."""
    if (folder / TRAJECTORY).is_file():
        return folder
    parts = sorted(folder.glob("*_frames"), key=lambda path: path.name)
    return next((part for part in parts if (part / TRAJECTORY).is_file()), None)


def _trajectory(path: AnyPath) -> tuple[list[float], list[np.ndarray]]:
    """Return the sorted times in seconds, and the camera-to-world poses at those times."""
    rows: dict[float, np.ndarray] = {}
    for line, text in enumerate(read_text(path).splitlines(), 1):
        words = text.split()
        if not words:
            continue
        try:
            values = np.array([float(word) for word in words])
        except ValueError:
            values = np.zeros(0)
        if len(values) != 7 or not np.isfinite(values[0]):
            raise CaptureError(
                path, f"line {line} must contain 7 numbers: time, rotation vector, translation"
            )
        rows[float(values[0])] = _camera_to_world(values[1:4], values[4:7])
    if not rows:
        raise CaptureError(path, "contains no poses; copy the file again")
    times = sorted(rows)
    return times, [rows[time] for time in times]


def _camera_to_world(turn: np.ndarray, place: np.ndarray) -> np.ndarray:
    pose = np.eye(4)
    rotation = rotation_from_vector(turn)
    pose[:3, :3] = rotation.T
    pose[:3, 3] = -rotation.T @ place
    return pose


def _rotation_vector(rotation: np.ndarray) -> np.ndarray:
    """Return the rotation vector of a rotation well below 180 degrees."""
    twice = np.array(
        [
            rotation[2, 1] - rotation[1, 2],
            rotation[0, 2] - rotation[2, 0],
            rotation[1, 0] - rotation[0, 1],
        ]
    )
    sine = np.linalg.norm(twice) / 2
    angle = np.arctan2(sine, (np.trace(rotation) - 1) / 2)
    return twice / 2 * (angle / sine if sine > 1e-12 else 1.0)


def _timed_files(folder: AnyPath, suffix: str) -> Timed:
    """Return the files of a folder with their times, sorted by time."""
    found = []
    for stem, path in files_by_stem(folder, (suffix,)).items():
        match = _STEM.fullmatch(stem)
        if match:
            found.append((float(match[1]), path))
    found.sort(key=lambda item: item[0])
    return [time for time, _ in found], [path for _, path in found]


def _times_near_poses(image_times: Sequence[float], pose_times: Sequence[float]) -> list[float]:
    """Return the image times nearest to each pose, without duplicates, sorted."""
    near = {
        image_times[index] for time in pose_times if (index := _nearest(image_times, time)) >= 0
    }
    return sorted(time for time in near if _time_gap(pose_times, time) <= MAX_GAP_S)


def _nearest(times: Sequence[float], time: float) -> int:
    """Return the index of the nearest time, or -1 if there are no times."""
    place = bisect_left(times, time)
    around = [index for index in (place - 1, place) if 0 <= index < len(times)]
    return min(around, key=lambda index: abs(times[index] - time), default=-1)


def _time_gap(times: Sequence[float], time: float) -> float:
    index = _nearest(times, time)
    return abs(times[index] - time) if index >= 0 else float("inf")


def _file_at(timed: Timed, time: float, within_s: float = SAME_TIME_S) -> AnyPath | None:
    index = _nearest(timed[0], time)
    return timed[1][index] if index >= 0 and abs(timed[0][index] - time) <= within_s else None


def _frame(
    time: float,
    pose_times: Sequence[float],
    poses: Sequence[np.ndarray],
    colours: Timed,
    lenses: Timed,
    depths: Timed,
    trusts: Timed,
) -> FrameFiles:
    name = f"{time:.3f}"
    picture, depth = _file_at(colours, time, 2 * SAME_TIME_S), _file_at(depths, time)
    lens_path = _file_at(lenses, time, 2 * SAME_TIME_S)
    if picture is None or lens_path is None:
        lacks = "colour image" if picture is None else "intrinsics (.pincam)"
        return FrameFiles(name, None, problem=f"has no {lacks} at its time")
    try:
        lens = _lens(lens_path)
    except InputError as error:
        return FrameFiles(name, None, problem=f"{lens_path.name} {error.reason}")
    pose = _pose_at(time, pose_times, poses)
    return FrameFiles(
        name,
        pose,
        picture,
        lens,
        depth,
        lens if depth else None,
        problem="" if pose is not None else "has no pose near its time",
        trust_path=_file_at(trusts, time) if depth else None,
        time_s=time,
    )


def _lens(path: AnyPath) -> Camera:
    words = read_text(path).split()
    try:
        values = [float(word) for word in words]
    except ValueError:
        values = []
    if len(values) != 6:
        raise CaptureError(
            path, f"must contain width, height, fx, fy, cx and cy, got {len(words)} values"
        )
    return parse_camera(path, (values[0], values[1]), values[2:])


def _pose_at(time: float, times: Sequence[float], poses: Sequence[np.ndarray]) -> np.ndarray | None:
    """Return the pose at a time, interpolated between the poses around it."""
    after = bisect_left(times, time)
    nearest = _nearest(times, time)
    if abs(times[nearest] - time) < 1e-3 or after in (0, len(times)):
        return poses[nearest] if abs(times[nearest] - time) <= 2 * SAME_TIME_S else None
    first, second = poses[after - 1], poses[after]
    span = times[after] - times[after - 1]
    if span > MAX_GAP_S:
        return None
    share = (time - times[after - 1]) / span
    pose = np.eye(4)
    turn = _rotation_vector(first[:3, :3].T @ second[:3, :3])
    pose[:3, :3] = first[:3, :3] @ rotation_from_vector(share * turn)
    pose[:3, 3] = (1 - share) * first[:3, 3] + share * second[:3, 3]
    return pose

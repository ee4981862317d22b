"""The frames used by a finished run, with their corrected camera poses in the room."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.capture.options import parse_options
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.capture.validation import ValidatedCapture, validate_capture
from world2minecraft.core.errors import InputError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import Camera
from world2minecraft.evaluation.scoring.used_frames import computed
from world2minecraft.formats.scan_record import read_poses


@dataclass(frozen=True, eq=False)
class PlacedFrame:
    """A frame with its camera pose in the room.

    Attributes:
        frame: The files of the frame.
        camera: The colour camera, or the depth camera if there is no colour image.
        camera_to_room: The pose as corrected by the run, as float64 [4, 4] with OpenCV axes.
    """

    frame: FrameFiles
    camera: Camera
    camera_to_room: np.ndarray


def judge_capture_of(run: Path, capture: Path) -> ValidatedCapture:
    """Validate the capture of a run, using the run's capture options.

    Raises:
        CaptureError: If the capture cannot be read.
    """
    options = {} if capture == computed(run) else _options_of(run)
    return validate_capture(capture, parse_options(options))


def placed_frames(
    run: Path, judged: ValidatedCapture, scan_to_room: np.ndarray
) -> Iterator[PlacedFrame]:
    """Yield the posed frames that a run used, or all posed frames if it does not list them.

    Args:
        run: The folder of the run, whose ``poses.npz`` contains the pose corrections.
        judged: The validated capture.
        scan_to_room: The transform from scan to room as float64 [4, 4].
    """
    changes, used = _changes_of(run), used_by(run)
    for frame in judged.frames:
        camera = frame.colour_camera if frame.colour_path else frame.depth_camera
        if camera is None or frame.camera_to_world is None or (used and frame.name not in used):
            continue
        change = changes.get(frame.name, np.eye(4))
        yield PlacedFrame(frame, camera, scan_to_room @ change @ frame.camera_to_world)


def used_by(run: Path) -> frozenset[str]:
    """Return the names of the frames that a run used, or an empty set if it does not list them."""
    try:
        used = read_json(run / "scan.json")["frames_used"]
        return frozenset(str(name) for name in used)
    except (InputError, KeyError, TypeError):
        return frozenset()


def _changes_of(run: Path) -> dict[str, np.ndarray]:
    """Return the pose corrections of a run by frame, or an empty mapping if there are none."""
    try:
        found = read_poses(run / "poses.npz")
    except InputError:
        return {}
    return dict(zip(found.names, found.pose_change, strict=True))


def _options_of(run: Path) -> dict[str, str]:
    try:
        stated = read_json(run / "manifest.json")["parameters"]["capture"]
        return {str(key): str(value) for key, value in stated.items()}
    except (InputError, KeyError, TypeError, AttributeError):
        return {}

"""The frames that a finished run was made of, each where its camera stood in the room."""

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
    """One frame: ``camera`` is that of its colour, of its depth where it has none.

    ``camera_to_room`` is float64 [4, 4] with OpenCV axes, as the run corrected it.
    """

    frame: FrameFiles
    camera: Camera
    camera_to_room: np.ndarray


def judge_capture_of(run: Path, capture: Path) -> ValidatedCapture:
    """Return what can be used of a run's capture, read with the options that the run was given.

    Raises:
        CaptureError: the capture cannot be read.
    """
    options = {} if capture == computed(run) else _options_of(run)
    return validate_capture(capture, parse_options(options))


def placed_frames(
    run: Path, judged: ValidatedCapture, scan_to_room: np.ndarray
) -> Iterator[PlacedFrame]:
    """Yield the posed frames that a run used, all posed ones where it does not say which.

    Args:
        run: the run's folder; its ``poses.npz`` says how poses were corrected.
        judged: its capture.
        scan_to_room: float64 [4, 4].
    """
    changes, used = _changes_of(run), used_by(run)
    for frame in judged.frames:
        camera = frame.colour_camera if frame.colour_path else frame.depth_camera
        if camera is None or frame.camera_to_world is None or (used and frame.name not in used):
            continue
        change = changes.get(frame.name, np.eye(4))
        yield PlacedFrame(frame, camera, scan_to_room @ change @ frame.camera_to_world)


def used_by(run: Path) -> frozenset[str]:
    """Return the names of the frames that a run used; empty where it does not say."""
    try:
        used = read_json(run / "scan.json")["frames_used"]
        return frozenset(str(name) for name in used)
    except (InputError, KeyError, TypeError):
        return frozenset()


def _changes_of(run: Path) -> dict[str, np.ndarray]:
    """Return how a run corrected poses, by frame; nothing where it did not."""
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

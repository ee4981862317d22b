"""The frames that a run used: their cameras, where they truly stood, and where it was said."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import Camera
from world2minecraft.evaluation.scoring.truth_files import Truth, read_truth

COMPUTED = "capture"  # Where ``prepare`` keeps what it made.
MIN_POSED = 3


@dataclass(frozen=True, eq=False)
class UsedFrame:
    """One frame; the camera is that of the depth, or of the colour where there is no depth."""

    name: str
    camera: Camera
    camera_to_truth: np.ndarray  # float64 [4, 4], the true pose
    colour_to_truth: np.ndarray  # float64 [4, 4], that of the colour camera
    camera_to_scan: np.ndarray  # float64 [4, 4], as the capture states it


def used_frames(out: Path, truth: Truth) -> tuple[UsedFrame, ...]:
    """Return the frames that the run in ``out`` used, in its order.

    Raises:
        InputError: ``out`` has no ``scan.json``. CaptureError: no capture lies beside the truth.
        DamagedFileError: the run used a frame that the capture does not have.
    """
    path = out / "scan.json"
    try:
        names = [str(name) for name in read_json(path)["frames_used"]]
    except (KeyError, TypeError) as error:
        raise DamagedFileError(path, f"has no list frames_used ({error})") from error
    frames = {frame.name: frame for frame in find_capture(computed(out) or truth.capture).frames}
    strange = [name for name in names if name not in frames]
    if strange:
        raise DamagedFileError(
            path,
            f"used frame {strange[0]!r}, which {truth.capture} does not have; another capture?",
        )
    return tuple(_used(frames[name], truth) for name in names)


def all_frames(truth: Truth) -> tuple[UsedFrame, ...]:
    """Return every frame of a truth's capture that has a camera and a pose.

    Raises:
        CaptureError: no capture lies where the truth says.
    """
    true = truth.camera_to_truth or {}
    return tuple(
        _used(frame, truth)
        for frame in find_capture(truth.capture).frames
        if (frame.depth_camera or frame.colour_camera) is not None
        and frame.camera_to_world is not None
        and (frame.name in true or np.isfinite(frame.camera_to_world).all())
    )


def computed(out: Path) -> Path | None:
    """Return the capture that a run completed before it read it, None where it had all."""
    return out / COMPUTED if (out / COMPUTED / "capture.json").is_file() else None


def truth_of_run(out: Path, folder: Path) -> Truth:
    """Return the truth of a run, in the frame that its poses are in.

    Poses that were computed from photos have a frame of their own; the truth is laid upon it by a
    turn and a shift, so that a wrong scale stays a fault.

    Raises:
        InputError: a file is missing. DamagedFileError: it is no truth, or of other photos.
    """
    known, place = read_truth(folder), computed(out)
    if place is None:
        return known
    true = known.camera_to_truth or {}
    posed = [f for f in find_capture(place).frames if f.name in true]
    if len(posed) < MIN_POSED:
        raise DamagedFileError(folder / "truth.npz", "tells no poses of the photos that were used")
    stated = [np.asarray(frame.camera_to_world, np.float64) for frame in posed]
    common = common_move([true[frame.name] for frame in posed], stated)
    return replace(known, truth_to_scan=common)


def common_move(one: Sequence[np.ndarray], other: Sequence[np.ndarray]) -> np.ndarray:
    """Return the rigid 4x4 that carries poses [4, 4] of one frame to another best on average."""
    between = np.mean([b[:3, :3] @ a[:3, :3].T for a, b in zip(one, other, strict=True)], axis=0)
    left, _, right = np.linalg.svd(between)
    move = np.eye(4)
    move[:3, :3] = left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right
    shifts = [b[:3, 3] - move[:3, :3] @ a[:3, 3] for a, b in zip(one, other, strict=True)]
    move[:3, 3] = np.mean(shifts, axis=0)
    return move


def _used(frame, truth: Truth) -> UsedFrame:
    camera = frame.depth_camera or frame.colour_camera
    stated = np.asarray(frame.camera_to_world, np.float64)
    true = (truth.camera_to_truth or {}).get(frame.name)
    if true is None:
        true = invert_rigid(truth.truth_to_scan) @ stated
    to_colour = frame.depth_to_colour if frame.depth_camera else np.eye(4)
    return UsedFrame(frame.name, camera, true @ to_colour, true, stated @ to_colour)

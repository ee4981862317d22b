"""The frames used by a run, with their cameras, true poses and recorded poses."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.pose_validation import move_like_capture
from world2minecraft.capture.source_types import Capture
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import Camera
from world2minecraft.evaluation.scoring.same_room import check_same_room
from world2minecraft.evaluation.scoring.truth_files import Truth, read_truth
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.formats.scan_record import read_source_to_scan
from world2minecraft.geometry.rotations import nearest_rotation

COMPUTED = "capture"  # Where ``prepare`` keeps what it made.
MIN_POSED = 3


@dataclass(frozen=True, eq=False)
class UsedFrame:
    """A frame with its camera poses, all as float64 [4, 4].

    Attributes:
        name: The name of the frame.
        camera: The depth camera, or the colour camera if there is no depth.
        camera_to_truth: The true pose of ``camera``.
        colour_to_truth: The true pose of the colour camera.
        camera_to_scan: The pose of ``camera`` as recorded in the capture.
    """

    name: str
    camera: Camera
    camera_to_truth: np.ndarray
    colour_to_truth: np.ndarray
    camera_to_scan: np.ndarray


def used_frames(out: Path, truth: Truth) -> tuple[UsedFrame, ...]:
    """Return the frames that a run used, in order.

    Raises:
        InputError: If the run has no ``scan.json``.
        CaptureError: If the capture of the ground truth is not found.
        DamagedFileError: If the run used a frame that the capture does not contain.
    """
    path = out / "scan.json"
    try:
        names = [str(name) for name in read_json(path)["frames_used"]]
    except (KeyError, TypeError) as error:
        raise DamagedFileError(
            path, f"the list frames_used is missing or not valid ({error})"
        ) from error
    frames = {frame.name: frame for frame in find_capture(computed(out) or truth.capture).frames}
    strange = [name for name in names if name not in frames]
    if strange:
        raise DamagedFileError(
            path,
            f"frame {strange[0]!r} was used, but {truth.capture} does not contain it; "
            "score against the capture of this run",
        )
    return tuple(_used(frames[name], truth) for name in names)


def all_frames(truth: Truth, capture: Capture) -> tuple[UsedFrame, ...]:
    """Return all frames with a camera and a pose in the capture of a ground truth."""
    true = truth.camera_to_truth or {}
    return tuple(
        _used(frame, truth)
        for frame in capture.frames
        if (frame.depth_camera or frame.colour_camera) is not None
        and frame.camera_to_world is not None
        and (frame.name in true or np.isfinite(frame.camera_to_world).all())
    )


def computed(out: Path) -> Path | None:
    """Return the capture that a run completed before reading it, or None."""
    return out / COMPUTED if (out / COMPUTED / "capture.json").is_file() else None


def truth_of_run(out: Path, folder: Path) -> Truth:
    """Return the ground truth of a run in the frame of its poses.

    Poses computed from photos have their own frame. The ground truth is aligned to it by a rotation
    and a translation only, so that a wrong scale remains an error.

    Raises:
        InputError: If a file is missing, or it is the ground truth of another room.
        DamagedFileError: If a file is not a valid ground truth, or belongs to other photos.
    """
    known, place = read_truth(folder), computed(out)
    if place is None:
        known = move_truth(known, read_source_to_scan(out / "scan.json"))
        check_same_room(out, known, *read_room(out / "room.npz"))
        return known
    true = known.camera_to_truth or {}
    posed = [f for f in find_capture(place).frames if f.name in true]
    if len(posed) < MIN_POSED:
        raise DamagedFileError(
            folder / "truth.npz", "poses of the used photos are missing; scan the room again"
        )
    stated = [np.asarray(frame.camera_to_world, np.float64) for frame in posed]
    common = common_move([true[frame.name] for frame in posed], stated)
    return replace(known, truth_to_scan=common)


def move_truth(known: Truth, source_to_scan: np.ndarray) -> Truth:
    """Return a ground truth in the coordinates of a capture's files, moved as its poses were."""
    moved = move_like_capture(known.truth_to_scan, source_to_scan, known.origin_m)
    return replace(known, truth_to_scan=moved)


def common_move(one: Sequence[np.ndarray], other: Sequence[np.ndarray]) -> np.ndarray:
    """Return the rigid 4x4 transform between two sequences of poses [4, 4], best on average."""
    between = np.mean([b[:3, :3] @ a[:3, :3].T for a, b in zip(one, other, strict=True)], axis=0)
    move = np.eye(4)
    move[:3, :3] = nearest_rotation(between)
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

"""Validation of camera poses: repair of small errors, and rejection of wrong poses."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import read_bytes
from world2minecraft.core.types import checks

ORTHONORMAL_TOLERANCE = 1e-3  # The shared kitchen is off by 4e-4; a scale of 1.001 is no slip.
ROUNDING = 1e-12  # Rotations that are orthonormal to this tolerance are not changed.
MAX_DISTANCE_M = 25.0  # Maximum distance from the cameras' centre within one room.
MAX_POSE_BYTES = 10_000
MAX_NEAR_M, OFFSET_STEP_M = 1000.0, 100.0  # A room keeps its coordinates; a survey is moved.


def read_pose(path: AnyPath) -> np.ndarray:
    """Read a 4x4 pose from a text file; entries such as nan or -1.#IND become NaN.

    Raises:
        CaptureError: If the file does not contain 16 entries.
        InputError: If the file cannot be read.
    """
    words = read_bytes(path, MAX_POSE_BYTES).decode("ascii", "replace").split()
    if len(words) != 16:
        raise CaptureError(path, f"must contain 16 numbers, a 4x4 matrix, got {len(words)}")
    return np.array([_number(path, word) for word in words]).reshape(4, 4)


def _number(path: AnyPath, word: str) -> float:
    try:
        return float(word)
    except ValueError as error:
        if "#" in word:  # How Windows' C library prints NaN and infinity.
            return float("nan")
        raise CaptureError(path, f"contains {word[:20]!r}, which is not a number") from error


def is_lost(pose: np.ndarray) -> bool:
    """Return whether tracking was lost, that is, whether the pose contains NaN or infinity."""
    return not np.isfinite(pose).all()


def repair_pose(pose: np.ndarray, where: AnyPath, frame: str) -> np.ndarray:
    """Return a rigid pose with an exactly orthonormal rotation.

    Args:
        pose: Camera-to-world matrix, finite, float64 [4, 4].
        where: File that contains the pose, for error messages.
        frame: Name of the frame, for error messages.

    Raises:
        CaptureError: If the rotation is mirrored, scaled or not a rotation.
    """
    if fault := checks.rigid_fault(pose, ORTHONORMAL_TOLERANCE):
        raise CaptureError(where, f"the pose of {frame} {fault}")
    rotation = pose[:3, :3]
    left, _, right = np.linalg.svd(rotation)
    off = np.abs(rotation @ rotation.T - np.eye(3)).max()
    repaired = np.eye(4)
    repaired[:3, :3] = left @ right if off > ROUNDING else rotation
    repaired[:3, 3] = pose[:3, 3]
    return repaired


def move_near_origin(capture: Capture) -> Capture:
    """Return a capture with its poses near the origin, and what moved them.

    Georeferenced positions, millions of metres from the origin, have a precision of half a metre in
    float32. The first pose decides, so that parts of a capture are moved like the whole.
    """
    places = (
        np.asarray(frame.camera_to_world, np.float64)[:3, 3]
        for frame in capture.frames
        if frame.camera_to_world is not None and not is_lost(frame.camera_to_world)
    )
    first = next(places, np.zeros(3))
    if not MAX_NEAR_M < np.abs(first).max() <= checks.MAX_COORDINATE_M:
        return capture
    move = np.eye(4)
    move[:3, 3] = -np.round(first / OFFSET_STEP_M) * OFFSET_STEP_M
    frames = tuple(
        frame
        if frame.camera_to_world is None
        else replace(frame, camera_to_world=move @ frame.camera_to_world)
        for frame in capture.frames
    )
    room = capture.room and (capture.room[0] @ invert_rigid(move), capture.room[1])
    x, y, z = -move[:3, 3]
    note = f"camera positions are georeferenced; ({x:.0f}, {y:.0f}, {z:.0f}) m was subtracted"
    return replace(
        capture,
        frames=frames,
        room=room,
        notes=(*capture.notes, f"{note} and is stored in source_to_scan of scan.json"),
        source_to_scan=move @ capture.source_to_scan,
    )


def move_like_capture(
    to_files: np.ndarray, source_to_scan: np.ndarray, corner_m: np.ndarray | None = None
) -> np.ndarray:
    """Return a transform to the coordinates of a capture's files, moved as its poses were.

    A transform that the shift of the capture would move away from the origin is returned
    unchanged: it leads to the moved poses already.

    Args:
        to_files: Rigid transform, float64 [4, 4].
        source_to_scan: That of the capture, float64 [4, 4].
        corner_m: Position that comes near the origin, before the transform. Its origin by default.
    """
    shift_m = source_to_scan[:3, 3]
    at_m = apply(to_files, np.zeros(3) if corner_m is None else corner_m)
    if np.abs(shift_m).max() < MAX_NEAR_M or np.abs(at_m + shift_m).max() >= np.abs(at_m).max():
        return to_files
    moved = to_files.copy()
    moved[:3, 3] += shift_m
    return moved


def check_camera_spread(
    frames: Sequence[FrameFiles], where: AnyPath, typical_depth_m: float
) -> tuple[tuple[FrameFiles, ...], tuple[tuple[str, str], ...]]:
    """Check that the camera positions are plausible for one room, and remove outliers.

    Args:
        frames: Frames with rigid poses.
        where: File or folder that contains the poses, for error messages.
        typical_depth_m: Median depth in metres, or 0 without depth.

    Returns:
        The remaining frames, and (name, reason) of the frames with outlying positions.

    Raises:
        CaptureError: If the positions are too far apart, for example because of a wrong unit.
    """
    places = np.array([np.asarray(frame.camera_to_world)[:3, 3] for frame in frames])
    away_m = np.linalg.norm(places - np.median(places, axis=0), axis=1)
    spread_m = float(np.quantile(away_m, 0.9))
    if spread_m > MAX_DISTANCE_M:
        advice = "the positions appear to be in millimetres: divide them by 1000"
        raise CaptureError(
            where,
            f"camera positions are up to {spread_m:,.0f} m from their median"
            + (f", but the median depth is {typical_depth_m:.1f} m; " if typical_depth_m else "; ")
            + (advice if spread_m / 1000 < MAX_DISTANCE_M else "poses must be in metres"),
        )
    inside = away_m <= MAX_DISTANCE_M
    strays = tuple(
        (frame.name, f"tracking jumped: the camera is {away:,.0f} m from the others")
        for frame, away, stay in zip(frames, away_m, inside, strict=True)
        if not stay
    )
    return tuple(frame for frame, stay in zip(frames, inside, strict=True) if stay), strays

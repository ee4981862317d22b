"""Camera poses: read, repaired where slightly off, skipped where lost, refused where wrong."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import read_bytes

ORTHONORMAL_TOLERANCE = 1e-3  # The shared kitchen is off by 4e-4; a scale of 1.001 is no slip.
ROUNDING = 1e-12  # What is orthonormal already stays as stated, to the last bit.
MAX_DISTANCE_M = 25.0  # From the middle of the cameras; further ones did not see one room.
MAX_POSE_BYTES = 10_000


def read_pose(path: AnyPath) -> np.ndarray:
    """Read four rows of four numbers; what is not a number (-1.#IND, nan) becomes NaN.

    Raises:
        CaptureError: there are not 16 entries. InputError: the file cannot be read.
    """
    words = read_bytes(path, MAX_POSE_BYTES).decode("ascii", "replace").split()
    if len(words) != 16:
        raise CaptureError(path, f"must hold 16 numbers, a 4x4 matrix, not {len(words)}")
    return np.array([_number(path, word) for word in words]).reshape(4, 4)


def _number(path: AnyPath, word: str) -> float:
    try:
        return float(word)
    except ValueError as error:
        if "#" in word:  # How Windows' C library prints NaN and infinity.
            return float("nan")
        raise CaptureError(path, f"holds {word[:20]!r}, which is no number") from error


def is_lost(pose: np.ndarray) -> bool:
    """Return whether tracking was lost: a NaN or an infinity stands in the pose."""
    return not np.isfinite(pose).all()


def repair_pose(pose: np.ndarray, where: AnyPath, frame: str) -> np.ndarray:
    """Return a rigid pose, exactly orthonormal.

    Args:
        pose: float64 [4, 4], finite, camera to world.
        where: the file that states it, for the message.
        frame: the frame's name, for the message.

    Raises:
        CaptureError: the rotation is mirrored, scaled or no rotation at all.
    """
    rotation = pose[:3, :3]
    if not np.allclose(pose[3], [0, 0, 0, 1], rtol=0, atol=1e-6):
        raise CaptureError(
            where,
            f"the pose of {frame} ends with {pose[3].tolist()}, not 0 0 0 1: transpose it",
        )
    left, sizes, right = np.linalg.svd(rotation)
    if np.linalg.det(rotation) < 0:
        raise CaptureError(
            where,
            f"the pose of {frame} mirrors (determinant {np.linalg.det(rotation):.3f}); poses must "
            "be rotations: an axis was flipped on export",
        )
    off = np.abs(rotation @ rotation.T - np.eye(3)).max()
    if off > ORTHONORMAL_TOLERANCE:
        kind = f"is scaled by {sizes.mean():.4g}" if np.ptp(sizes) < 0.01 * sizes[0] else "is bent"
        raise CaptureError(
            where,
            f"the rotation of {frame} {kind}; poses must be rigid: divide the scale out",
        )
    repaired = np.eye(4)
    repaired[:3, :3] = left @ right if off > ROUNDING else rotation
    repaired[:3, 3] = pose[:3, 3]
    return repaired


def check_camera_spread(
    frames: Sequence[FrameFiles], where: AnyPath, typical_depth_m: float
) -> tuple[tuple[FrameFiles, ...], tuple[tuple[str, str], ...]]:
    """Refuse poses whose places cannot be those of a camera in one room; leave out strays.

    Args:
        frames: with rigid poses.
        where: the file or folder that states them.
        typical_depth_m: what the cameras see, in metres; 0 where there is no depth.

    Returns:
        The frames that stay, and (name, reason) of those whose tracking jumped away.

    Raises:
        CaptureError: the places are too far apart, as millimetres taken for metres are.
    """
    places = np.array([np.asarray(frame.camera_to_world)[:3, 3] for frame in frames])
    away_m = np.linalg.norm(places - np.median(places, axis=0), axis=1)
    spread_m = float(np.quantile(away_m, 0.9))
    if spread_m > MAX_DISTANCE_M:
        advice = "they look like millimetres: divide the translations by 1000"
        raise CaptureError(
            where,
            f"the cameras stand up to {spread_m:,.0f} m from their middle"
            + (f" and see {typical_depth_m:.1f} m far; " if typical_depth_m else "; ")
            + (advice if spread_m / 1000 < MAX_DISTANCE_M else "the poses must be in metres"),
        )
    inside = away_m <= MAX_DISTANCE_M
    strays = tuple(
        (frame.name, f"tracking jumped: its camera is {away:,.0f} m from the others")
        for frame, away, stay in zip(frames, away_m, inside, strict=True)
        if not stay
    )
    return tuple(frame for frame, stay in zip(frames, inside, strict=True) if stay), strays

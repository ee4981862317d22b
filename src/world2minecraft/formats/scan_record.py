"""``scan.json`` (reading and alignment of a capture) and ``poses.npz`` (pose corrections).

``poses.npz`` contains for each frame: ``names`` [F]; ``pose_change`` float64 [F, 4, 4], scan to
scan, applied on the left of the frame's pose; ``depth_scale`` float64 [F], a factor for the depth.
"""

from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError
from world2minecraft.core.files import read_json, read_npz, write_json, write_npz
from world2minecraft.core.types import Corrections, FrameSigmas, Scan, checks

POSE_ARRAYS = ("names", "pose_change", "depth_scale")
MAX_NAME_LENGTH = 60
MAX_CAMERAS = 200


def write_poses(path: str | Path, corrections: Corrections) -> None:
    """Write corrections. Equal corrections give identical files."""
    write_npz(
        path,
        {
            "names": np.array(corrections.names, np.str_),
            "pose_change": corrections.pose_change,
            "depth_scale": corrections.depth_scale,
        },
    )


def read_poses(path: str | Path) -> Corrections:
    """Read corrections without their facts, which are stored in ``scan.json``.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file does not contain valid corrections.
        LimitError: If an array is too large.
    """
    arrays = read_npz(path, POSE_ARRAYS)
    try:
        names = tuple(str(name) for name in arrays["names"])
        return Corrections(names, arrays["pose_change"], arrays["depth_scale"])
    except MALFORMED as error:
        raise DamagedFileError(path, f"does not contain valid corrections ({error})") from error


def write_scan(path: str | Path, scan: Scan, registration: Mapping[str, Any] | None = None) -> None:
    """Write the properties of a scan, without its images, and the results of the registration."""
    write_json(
        path,
        {
            "source": scan.source,
            "name": scan.name,
            "scan_to_room": scan.scan_to_room.tolist(),
            "source_to_scan": scan.source_to_scan.tolist(),
            "room_size_m": scan.room_size_m.tolist(),
            "colour_correction": list(scan.colour_correction),
            "frame_sigmas": None if scan.frame_sigmas is None else asdict(scan.frame_sigmas),
            "frames_used": list(scan.frames_used),
            "frames_skipped": [{"frame": n, "reason": r} for n, r in scan.frames_skipped],
            "scale": scan.scale,
            "scale_sigma": scan.scale_sigma,
            "depth_kind": scan.depth_kind,
            "notes": list(scan.notes),
            "cameras": camera_rays(scan),
            "registration": dict(registration or {}),
        },
    )


def read_source_to_scan(path: str | Path) -> np.ndarray:
    """Return the transform from the files of a capture to its scan frame, float64 [4, 4].

    It is the identity without the file and in those of former versions.

    Raises:
        DamagedFileError: If the file is not a valid ``scan.json``.
    """
    found = read_json(path) if Path(path).is_file() else {}
    try:
        return checks.floats("source_to_scan", found.get("source_to_scan", np.eye(4)), (4, 4))
    except MALFORMED as error:
        raise DamagedFileError(path, f"is not a valid scan.json ({error})") from error


def camera_rays(scan: Scan) -> list[list[float]]:
    """Return positions and viewing directions of at most ``MAX_CAMERAS`` frames, for displays.

    Each row is x, y, z in metres and a unit vector, both in the room frame. Scans whose views do
    not name their frames, such as plans, have none.
    """
    frames = getattr(scan.views, "frames", ())
    used = set(scan.frames_used)
    poses = [
        scan.scan_to_room @ frame.camera_to_world
        for frame in frames
        if frame.camera_to_world is not None and frame.name in used
    ]
    chosen = np.unique(np.linspace(0, len(poses) - 1, min(len(poses), MAX_CAMERAS)).astype(int))
    rows = [
        np.concatenate([pose[:3, 3], pose[:3, 2] / np.linalg.norm(pose[:3, 2])])
        for pose in (poses[index] for index in chosen)
    ]
    return [np.round(row, 3).tolist() for row in rows if np.isfinite(row).all()]


def read_registration(path: str | Path) -> dict[str, Any]:
    """Return the results of the registration in a ``scan.json``, or an empty dictionary.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not a valid ``scan.json``.
    """
    found = read_json(path)
    if not isinstance(found, dict) or not isinstance(found.get("registration", {}), dict):
        raise DamagedFileError(path, "is not a valid scan.json")
    return found.get("registration", {})


def read_scene_name(path: str | Path) -> str:
    """Return the printable scene name in a ``scan.json``, or an empty string.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not a valid ``scan.json``.
    """
    found = read_json(path)
    if not isinstance(found, dict):
        raise DamagedFileError(path, "is not a valid scan.json")
    name = found.get("name", "")
    return name[:MAX_NAME_LENGTH] if isinstance(name, str) and name.isprintable() else ""


def read_depth_kind(path: str | Path) -> str:
    """Return the source of the depth in a ``scan.json``. Defaults to ``sensor``.

    Raises:
        DamagedFileError: If the file is not a valid ``scan.json``.
    """
    if not Path(path).is_file():
        return "sensor"
    found = read_json(path)
    if not isinstance(found, dict):
        raise DamagedFileError(path, "is not a valid scan.json")
    return str(found.get("depth_kind", "sensor"))


class RecordedAlignment(NamedTuple):
    """What opening and registering a capture determined, as recorded in a ``scan.json``.

    Attributes:
        scan_to_room: Transform to the room frame, float64 [4, 4].
        room_size_m: Size of the room in metres, float64 [3].
        notes: Remarks of all stages up to fusion.
        sigmas: Uncertainty of the frame, or None.
        colour_correction: ``Scan.colour_correction``; None in files of version 0.1.
    """

    scan_to_room: np.ndarray
    room_size_m: np.ndarray
    notes: tuple[str, ...]
    sigmas: FrameSigmas | None
    colour_correction: tuple[float, float, float] | None


def read_alignment(path: str | Path) -> RecordedAlignment:
    """Read the alignment recorded in a ``scan.json``.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file does not contain a valid alignment.
    """
    try:
        found = read_json(path)
        return RecordedAlignment(
            np.array(found["scan_to_room"], np.float64),
            read_room_size(path),
            tuple(str(note) for note in found["notes"]),
            _frame_sigmas(found.get("frame_sigmas")),
            _colour_correction(found.get("colour_correction")),
        )
    except MALFORMED as error:
        raise DamagedFileError(
            path, f"does not contain a valid room alignment ({error})"
        ) from error


def with_recorded_alignment(scan: Scan, path: str | Path) -> Scan:
    """Return a scan with the alignment and the notes recorded in a ``scan.json``.

    Raises the exceptions of ``read_alignment``.
    """
    found = read_alignment(path)
    try:
        return replace(
            scan,
            scan_to_room=found.scan_to_room,
            room_size_m=found.room_size_m,
            notes=found.notes,
            frame_sigmas=found.sigmas,
        )
    except MALFORMED as error:
        raise DamagedFileError(
            path, f"does not contain a valid room alignment ({error})"
        ) from error


def _colour_correction(stated: Any) -> tuple[float, float, float] | None:
    if stated is None:
        return None
    scale, right, down = checks.floats("colour_correction", stated, (3,)).tolist()
    if scale <= 0:
        raise ValueError(f"the factor of colour_correction must be above 0, got {scale}")
    return scale, right, down


def _frame_sigmas(stated: Any) -> FrameSigmas | None:
    """Return the uncertainties of a ``scan.json``; version 0.1 wrote none."""
    return None if stated is None else FrameSigmas(**stated)


def read_room_size(path: str | Path) -> np.ndarray:
    """Return ``room_size_m`` from a ``scan.json``, float64 [3].

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file does not contain a valid size.
    """
    try:
        size = checks.lengths("room_size_m", read_json(path)["room_size_m"], (3,))
    except MALFORMED as error:
        raise DamagedFileError(path, f"does not contain a valid room_size_m ({error})") from error
    if (size <= 0).any():
        raise DamagedFileError(path, f"room_size_m must be above 0, got {size.tolist()}")
    return size

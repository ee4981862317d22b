"""Pose files: one JSON object per line, or CSV with the same columns.

The keys are frame, t (seconds), x, y, z (world block coordinates), yaw, pitch (Minecraft's
convention, degrees), vertical_fov_deg, width, height (pixels), scene_id, tour_id and image. Only x,
y, z, yaw and pitch are required. x, y, z is the position of the eye unless ``at`` is ``feet``.
``intrinsics`` [3][3] takes precedence over the field of view. ``file`` is an alias of ``image``.
Other keys are ignored.
"""

import csv
import io
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from world2minecraft.core.errors import DamagedFileError, UsageError
from world2minecraft.core.files import parse_json_lines, read_bytes, write_text
from world2minecraft.core.types import Camera
from world2minecraft.rendering.views.cameras import (
    GamePose,
    Shot,
    camera_of,
    game_pose_of,
    vertical_fov_deg_of,
)

MAX_BYTES = 256 << 20  # About a million poses.
REQUIRED = ("x", "y", "z", "yaw", "pitch")


@dataclass(frozen=True)
class TourPose:
    """A line of a pose file: the pose, and its time, camera and names if present."""

    pose: GamePose
    t_s: float = 0.0
    camera: Camera | None = None
    frame: int | None = None
    tour_id: str = ""
    scene_id: str = ""
    image: str = ""  # A file's name, relative to the tour's folder.
    vertical_fov_deg: float | None = None


def read_tour(path: str | Path, at: Literal["feet", "eye"] = "eye") -> list[TourPose]:
    """Read a pose file in JSON Lines format, or in CSV format if its name ends in .csv.

    Args:
        path: The file.
        at: Default meaning of x, y, z in lines without ``at``: ``eye`` or ``feet``.

    Raises:
        InputError: If the file cannot be read.
        DamagedFileError: If a line is not a valid pose, or if there are no poses.
        LimitError: If the file is too large.
    """
    source = Path(path)
    try:
        text = read_bytes(source, MAX_BYTES).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise DamagedFileError(source, "not a UTF-8 text file") from error
    rows = (
        _csv_rows(text, source)
        if source.suffix.lower() == ".csv"
        else parse_json_lines(text, source)
    )
    poses = [_pose({"at": at, **row}, number, source) for number, row in rows]
    if not poses:
        raise DamagedFileError(source, "contains no poses; each line needs x, y, z, yaw and pitch")
    return poses


def tour_line(
    shot: Shot, number: int, block_to_room: np.ndarray, more: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the line of a shot as a dict, followed by the keys in ``more``."""
    pose = game_pose_of(shot.camera_to_room, block_to_room)
    own = {
        "frame": number,
        "t": _short(shot.t_s),
        "x": _short(pose.x),
        "y": _short(pose.y),
        "z": _short(pose.z),
        "yaw": _short(pose.yaw_deg),
        "pitch": _short(pose.pitch_deg),
        "vertical_fov_deg": _short(vertical_fov_deg_of(shot.camera)),
        "width": shot.camera.width_px,
        "height": shot.camera.height_px,
    }
    return {**own, **more}


def _short(value: float) -> float:
    return round(value, 6) + 0.0  # No -0.0.


def write_lines(path: str | Path, lines: Sequence[Mapping[str, Any]]) -> None:
    """Write dicts as lines of JSON, atomically.

    Raises:
        OutputError: If the file cannot be written.
    """
    write_text(path, "".join(json.dumps(line, allow_nan=False) + "\n" for line in lines))


def _csv_rows(text: str, source: Path) -> list[tuple[int, Mapping[str, Any]]]:
    lines = io.StringIO(text, newline=None)  # They may end as those of any system.
    try:
        reader = csv.DictReader(lines, skipinitialspace=True)
        rows = [{key: value for key, value in row.items() if key and value} for row in reader]
    except csv.Error as error:
        raise DamagedFileError(source, f"not a valid CSV file ({error})") from error
    return [(number, row) for number, row in enumerate(rows, 2) if row]


def _pose(row: Mapping[str, Any], number: int, source: Path) -> TourPose:
    missing = [key for key in REQUIRED if key not in row]
    if missing:
        raise DamagedFileError(source, f"line {number} does not contain {missing[0]}")
    try:
        x, y, z, yaw, pitch = (float(row[key]) for key in REQUIRED)
        pose = GamePose(x, y, z, yaw, pitch, row["at"])
        frame = int(row["frame"]) if row.get("frame") is not None else None
        tour, scene = (str(row.get(key) or "") for key in ("tour_id", "scene_id"))
        image = str(row.get("image") or row.get("file") or "")
        stated = row.get("vertical_fov_deg")
        fov_deg = None if stated is None else float(stated)
        t_s = float(row.get("t", 0.0))
        if not math.isfinite(t_s):
            raise ValueError(f"t must be a finite number, got {t_s}")
        return TourPose(pose, t_s, _camera(row), frame, tour, scene, image, fov_deg)
    except (TypeError, ValueError, OverflowError, UsageError) as error:
        raise DamagedFileError(source, f"line {number} is not a valid pose ({error})") from error


def _camera(row: Mapping[str, Any]) -> Camera | None:
    if "width" not in row or "height" not in row:
        return None
    size = int(row["width"]), int(row["height"])
    if "intrinsics" in row:
        return camera_of(*size, intrinsics=np.array(row["intrinsics"], np.float64))
    if "vertical_fov_deg" in row:
        return camera_of(*size, vertical_fov_deg=float(row["vertical_fov_deg"]))
    return None

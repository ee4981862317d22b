"""Options of the capture stage, set with ``--set capture.KEY=VALUE``."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from world2minecraft.capture.depth_images import DepthEncoding
from world2minecraft.core.errors import UnknownNameError, UsageError

OPTION_NAMES = (
    "depth_unit", "every", "colour_camera", "unit", "up", "inside", "frames", "fov_deg",
    "eye_height_m", "pitch_deg",
)  # fmt: skip
MESH_UNITS_M = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "foot": 0.3048}
MIN_FRAMES = 3  # Two photos cannot check each other.
UP_AXES = ("x", "y", "z", "-x", "-y", "-z")


@dataclass(frozen=True)
class ScanOptions:
    """The parsed options of the capture stage. The defaults suit most captures."""

    depth_unit: str | None = None
    """Depth unit: mm, 5000, rotated, m, nyu_raw or metres per unit. Default: stated or inferred."""
    every: int | None = None
    """Use every n-th frame. Default: all, less those of a long recording that show the same."""
    colour_camera: str = "auto"
    """auto: estimate the colour camera if depth and colour share one matrix; stated: do not."""
    unit: str | None = None
    """Unit of a mesh or point cloud: m, cm, mm, inch or foot. Default: inferred from the size."""
    up: str | None = None
    """Up axis of a mesh or point cloud. Default: inferred from the surfaces."""
    inside: tuple[float, float, float] | None = None
    """A point inside the room of a mesh or point cloud, in the units and axes of the file."""
    frames: int | None = None
    """Maximum number of frames of a video (default 100) or photos of a folder (default all)."""
    fov_deg: float | None = None
    """Vertical field of view of a single photo in degrees. Default: from EXIF, or common."""
    eye_height_m: float = 1.5
    """Camera height above the floor for a single photo without depth, in metres."""
    pitch_deg: float = 0.0
    """Camera pitch for a single photo without depth, in degrees; negative values look down."""


def parse_options(options: Mapping[str, str]) -> ScanOptions:
    """Parse the options of the capture stage.

    Raises:
        UnknownNameError: If an option is unknown.
        UsageError: If a value is not valid.
    """
    for name in options:
        if name not in OPTION_NAMES:
            raise UnknownNameError("scan option", name, OPTION_NAMES)
    every = options.get("every")
    if every is not None and not (every.isascii() and every.isdigit() and 0 < int(every) < 10**6):
        raise UsageError(f"capture.every must be a positive integer, got {every!r}")
    colour_camera = options.get("colour_camera", "auto")
    if colour_camera not in ("auto", "stated"):
        raise UsageError(f"capture.colour_camera must be auto or stated, got {colour_camera!r}")
    unit = options.get("depth_unit")
    if unit is not None:
        DepthEncoding(unit)
    return ScanOptions(
        unit,
        None if every is None else int(every),
        colour_camera,
        _choice("unit", options.get("unit"), tuple(MESH_UNITS_M)),
        _choice("up", options.get("up"), UP_AXES),
        _point("inside", options.get("inside")),
        _frames(options.get("frames")),
        _number("fov_deg", options.get("fov_deg"), 5, 170),
        _number("eye_height_m", options.get("eye_height_m"), 0.1, 10) or 1.5,
        _number("pitch_deg", options.get("pitch_deg"), -89, 89) or 0.0,
    )


def _number(name: str, value: str | None, minimum: float, maximum: float) -> float | None:
    if value is None:
        return None
    try:
        number = float(value)
    except ValueError:
        number = math.nan
    if not minimum <= number <= maximum:
        raise UsageError(f"capture.{name} must be from {minimum:g} to {maximum:g}, got {value!r}")
    return number


def _frames(value: str | None) -> int | None:
    if value is None:
        return None
    if not value.isascii() or not value.isdigit() or not MIN_FRAMES <= int(value) < 10**5:
        raise UsageError(
            f"capture.frames must be an integer of {MIN_FRAMES} or more, got {value!r}"
        )
    return int(value)


def _choice(name: str, value: str | None, known: tuple[str, ...]) -> str | None:
    if value is not None and value not in known:
        raise UsageError(f"capture.{name} must be one of {', '.join(known)}, got {value!r}")
    return value


def _point(name: str, value: str | None) -> tuple[float, float, float] | None:
    if value is None:
        return None
    try:
        x, y, z = (float(part) for part in value.split(","))
    except ValueError:
        x = y = z = math.nan
    if not all(map(math.isfinite, (x, y, z))):
        raise UsageError(f"capture.{name} must be three numbers such as 1.5,2,1.2, got {value!r}")
    return x, y, z

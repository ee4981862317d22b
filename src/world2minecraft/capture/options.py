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
    """The options, parsed; each default is what fits most captures."""

    depth_unit: str | None = None
    """mm, 5000, rotated, m, nyu_raw or metres per unit; else as stated, else inferred."""
    every: int = 1
    """Take each n-th frame; a video's neighbours say little new."""
    colour_camera: str = "auto"
    """auto: estimate it where depth and colour share one stated matrix; stated: take that."""
    unit: str | None = None
    """Of a mesh or point cloud: m, cm, mm, inch or foot; else inferred from its size."""
    up: str | None = None
    """Of a mesh or point cloud: which of its axes points up; else inferred from its surfaces."""
    inside: tuple[float, float, float] | None = None
    """Of a mesh or point cloud: a point inside the room, in the file's own units and axes."""
    frames: int | None = None
    """How many pictures to take of a video (else 100 at most) or a folder of photos (else all)."""
    fov_deg: float | None = None
    """Of one photo: the angle from its lower to its upper edge; else by EXIF, else a usual lens."""
    eye_height_m: float = 1.5
    """Of one photo without depth: how high over the floor the camera was held."""
    pitch_deg: float = 0.0
    """Of one photo without depth: how far the camera looked up; below 0 down."""


def parse_options(options: Mapping[str, str]) -> ScanOptions:
    """Return the options by name.

    Raises:
        UnknownNameError: an option is not known. UsageError: a value is wrong.
    """
    for name in options:
        if name not in OPTION_NAMES:
            raise UnknownNameError("scan option", name, OPTION_NAMES)
    every = options.get("every", "1")
    if not every.isascii() or not every.isdigit() or not 0 < int(every) < 10**6:
        raise UsageError(f"every must be a whole number above 0, not {every!r}")
    colour_camera = options.get("colour_camera", "auto")
    if colour_camera not in ("auto", "stated"):
        raise UsageError(f"colour_camera must be auto or stated, not {colour_camera!r}")
    unit = options.get("depth_unit")
    if unit is not None:
        DepthEncoding(unit)
    return ScanOptions(
        unit,
        int(every),
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
        raise UsageError(f"{name} must be {minimum:g} to {maximum:g}, not {value!r}")
    return number


def _frames(value: str | None) -> int | None:
    if value is None:
        return None
    if not value.isascii() or not value.isdigit() or not MIN_FRAMES <= int(value) < 10**5:
        raise UsageError(f"frames must be a whole number of {MIN_FRAMES} or more, not {value!r}")
    return int(value)


def _choice(name: str, value: str | None, known: tuple[str, ...]) -> str | None:
    if value is not None and value not in known:
        raise UsageError(f"{name} must be one of {', '.join(known)}, not {value!r}")
    return value


def _point(name: str, value: str | None) -> tuple[float, float, float] | None:
    if value is None:
        return None
    try:
        x, y, z = (float(part) for part in value.split(","))
    except ValueError:
        x = y = z = math.nan
    if not all(map(math.isfinite, (x, y, z))):
        raise UsageError(f"{name} must be three numbers such as 1.5,2,1.2, not {value!r}")
    return x, y, z

"""Conversion of depth images to metres, and detection of their unit.

``DEPTH_UNITS`` lists the encodings used by depth cameras. If a capture does not state its encoding,
the encoding is inferred from the range and the quantisation of the values.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.depth_steps import depth_step_m, smooth_depth_steps
from world2minecraft.capture.images import ImageHeader, ImagePlace, read_header, read_raw
from world2minecraft.core.errors import CaptureError, UnknownNameError

INVALID = 65535  # Kinect drivers write 0 or 65535 where they saw nothing.
MAX_INDOOR_M = 12.0  # No depth camera for rooms reaches further.
STEPPED_SHARE = 0.9  # Minimum share of multiples of 5 or 8; SUN frames have 0.97.
DISTINCT_VALUES = 12  # Fewer say nothing about steps.


def _nyu_raw(raw: np.ndarray) -> np.ndarray:
    """Decode Kinect disparities of NYUv2 raw data: swap bytes, then apply a rational fit."""
    disparity = raw.astype(np.uint16).byteswap().astype(np.float64)
    seen = disparity < 1090  # Beyond, the fit runs to infinity; 2047 marks a hole.
    return np.where(seen, 351.3 / (1092.5 - np.where(seen, disparity, 0)), 0)


def _rotated(raw: np.ndarray) -> np.ndarray:
    """Undo the 3-bit rotation of 16-bit depth values in SUN RGB-D."""
    bits = raw.astype(np.uint16)
    return ((bits >> 3) | (bits << 13)) / 1000.0


DEPTH_UNITS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "mm": lambda raw: raw / 1000.0,
    "5000": lambda raw: raw / 5000.0,
    "rotated": _rotated,
    "m": lambda raw: raw.astype(np.float64),
    "nyu_raw": _nyu_raw,
}
_DESCRIPTIONS = {
    "mm": "millimetres",
    "5000": "units of 1/5000 m",
    "rotated": "millimetres, bits rotated by three",
    "m": "metres",
    "nyu_raw": "raw NYU disparities",
}


@dataclass(frozen=True)
class DepthEncoding:
    """The encoding of stored depth values.

    Attributes:
        unit: A name in ``DEPTH_UNITS``, or metres per unit as a string.
        guessed: Whether the unit was inferred from the values.
    """

    unit: str
    guessed: bool = False

    def __post_init__(self):
        if self.unit not in DEPTH_UNITS and not _is_scale(self.unit):
            raise UnknownNameError("depth unit", self.unit, (*DEPTH_UNITS, "METRES_PER_UNIT"))

    @property
    def description(self) -> str:
        """The unit in words."""
        return _DESCRIPTIONS.get(self.unit, f"units of {self.unit} m")

    def to_metres(self, raw: np.ndarray) -> np.ndarray:
        """Convert stored values to metres as float32; invalid values become 0."""
        valid = np.isfinite(raw) & (raw > 0)
        if raw.dtype.kind != "f":
            valid &= raw != INVALID
        clean = np.where(valid, raw, raw.dtype.type(0))
        with np.errstate(over="ignore"):
            if self.unit in DEPTH_UNITS:
                metres = DEPTH_UNITS[self.unit](clean).astype(np.float32)
            else:
                metres = (clean * float(self.unit)).astype(np.float32)
        metres[~valid | ~np.isfinite(metres) | (metres < 0)] = 0
        return metres


def _is_scale(unit: str) -> bool:
    try:
        return 1e-7 < float(unit) < 1e3
    except ValueError:
        return False


def check_depth_kind(path: ImagePlace, header: ImageHeader) -> None:
    """Check that an image has a pixel format that can contain depth.

    Raises:
        CaptureError: If the image has 8 bits per pixel or is a colour image.
    """
    if header.mode in ("1", "L", "P", "LA", "PA", "uint8"):
        raise CaptureError(
            path, "is an 8-bit image, but depth requires 16-bit or float values; export it again"
        )
    if not header.mode.startswith(("I", "F", "uint", "float")):
        raise CaptureError(
            path,
            f"is a colour image ({header.mode}), but depth requires a single 16-bit "
            "or float channel",
        )


def find_encoding(paths: Sequence[ImagePlace], stated: str | None) -> DepthEncoding:
    """Determine the encoding of a stream of depth images.

    Args:
        paths: Sample of depth images of the stream.
        stated: Unit stated by the capture or the user, or None to infer it.

    Raises:
        CaptureError: If the images contain no depth, or the depth is implausible for a room.
        UnknownNameError: If the stated unit is unknown.
    """
    values = np.concatenate([_sample_values(path) for path in paths])
    if not len(values):
        raise CaptureError(
            paths[0],
            f"contains no depth values, like all {len(paths)} sampled depth images; record "
            "the scan again",
        )
    encoding = DepthEncoding(stated) if stated else DepthEncoding(_guess_unit(values), guessed=True)
    _check_range(paths[0], encoding, values)
    return encoding


def read_depth(path: ImagePlace, encoding: DepthEncoding) -> np.ndarray:
    """Read a depth image in metres as float32 [H, W], with 0 for missing depth.

    Depth that was stored in steps of centimetres is smoothed within its steps.
    """
    check_depth_kind(path, read_header(path))
    depth_m = encoding.to_metres(read_raw(path))
    step_m = depth_step_m(depth_m)
    return smooth_depth_steps(depth_m, step_m) if step_m else depth_m


def _sample_values(path: ImagePlace) -> np.ndarray:
    """Return the valid stored values of every third pixel of an image."""
    raw = read_raw(path)[::3, ::3].reshape(-1)
    valid = np.isfinite(raw) & (raw > 0)
    if raw.dtype.kind != "f":
        valid &= raw != INVALID
    return raw[valid]


def _guess_unit(values: np.ndarray) -> str:
    """Infer the unit from the range and the quantisation of the values."""
    typical, far = np.percentile(values, [50, 98])
    if values.dtype.kind == "f" and far < 100:
        return "m"
    if len(np.unique(values)) >= DISTINCT_VALUES and values.dtype.kind != "f":
        # Kinect millimetres times 5 or 8: the steps stay in the stored values.
        if np.mean(values % 8 == 0) > STEPPED_SHARE:
            return "rotated"
        if np.mean(values % 5 == 0) > STEPPED_SHARE:
            return "5000"
    return "5000" if far > MAX_INDOOR_M * 1000 and typical > 2500 else "mm"


def _check_range(path: ImagePlace, encoding: DepthEncoding, values: np.ndarray) -> None:
    metres = encoding.to_metres(values)
    typical = float(np.median(metres))
    if not 0.15 <= typical <= MAX_INDOOR_M:
        raise CaptureError(
            path,
            f"has a median depth of {typical:.3g} m if read as {encoding.description}, which "
            "is implausible for a room; set --set "
            f"capture.depth_unit={'|'.join(DEPTH_UNITS)} or metres per unit",
        )

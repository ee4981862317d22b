"""Depth images in metres, and detection of their unit.

``DEPTH_UNITS`` names the encodings that depth cameras write. Where a capture does not state which
is meant, it is inferred from the values: their range, and the steps that an encoding leaves.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.images import ImageHeader, ImagePlace, read_header, read_raw
from world2minecraft.core.errors import CaptureError, UnknownNameError

INVALID = 65535  # Kinect drivers write 0 or 65535 where they saw nothing.
MAX_INDOOR_M = 12.0  # No depth camera for rooms reaches further.
STEPPED_SHARE = 0.9  # Of the values that must be multiples of 5 or 8; SUN frames show 0.97.
DISTINCT_VALUES = 12  # Fewer say nothing about steps.


def _nyu_raw(raw: np.ndarray) -> np.ndarray:
    """Decode Kinect disparities as NYUv2 dumped them: bytes swapped, metres by a rational fit."""
    disparity = raw.astype(np.uint16).byteswap().astype(np.float64)
    seen = disparity < 1090  # Beyond, the fit runs to infinity; 2047 marks a hole.
    return np.where(seen, 351.3 / (1092.5 - np.where(seen, disparity, 0)), 0)


def _rotated(raw: np.ndarray) -> np.ndarray:
    """Undo SUN RGB-D's rotation of the 16 bits by three."""
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
    """How the stored values become metres: a name of ``DEPTH_UNITS`` or metres per unit."""

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
        """Return float32 metres of stored values; whatever is no depth becomes 0."""
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
    """Refuse an image that cannot hold depth.

    Raises:
        CaptureError: it has 8 bits a pixel or is a colour image.
    """
    if header.mode in ("1", "L", "P", "LA", "PA", "uint8"):
        raise CaptureError(path, "is 8-bit; depth needs 16-bit or float values: export it again")
    if not header.mode.startswith(("I", "F", "uint", "float")):
        raise CaptureError(
            path, f"is a colour image ({header.mode}); depth needs one 16-bit or float channel"
        )


def find_encoding(paths: Sequence[ImagePlace], stated: str | None) -> DepthEncoding:
    """Return the encoding of a stream of depth images, stated or inferred from some of them.

    Args:
        paths: a few depth images of the stream.
        stated: the unit that the capture or the user states, or None.

    Raises:
        CaptureError: none of the images has any depth, or no unit makes a room of them.
        UnknownNameError: no unit has the stated name.
    """
    values = np.concatenate([_sample_values(path) for path in paths])
    if not len(values):
        raise CaptureError(
            paths[0],
            f"is all holes, as are all {len(paths)} depth images looked at: record it again",
        )
    encoding = DepthEncoding(stated) if stated else DepthEncoding(_guess_unit(values), guessed=True)
    _check_range(paths[0], encoding, values)
    return encoding


def read_depth(path: ImagePlace, encoding: DepthEncoding) -> np.ndarray:
    """Return float32 [H, W] z-depth in metres, 0 where there is none."""
    check_depth_kind(path, read_header(path))
    return encoding.to_metres(read_raw(path))


def _sample_values(path: ImagePlace) -> np.ndarray:
    """Return the valid stored values of every third pixel of one image."""
    raw = read_raw(path)[::3, ::3].reshape(-1)
    valid = np.isfinite(raw) & (raw > 0)
    if raw.dtype.kind != "f":
        valid &= raw != INVALID
    return raw[valid]


def _guess_unit(values: np.ndarray) -> str:
    """Infer the unit from the values' range and steps."""
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
            f"a typical depth of {typical:.3g} m (read as {encoding.description}) is no room; "
            f"say --set capture.depth_unit={'|'.join(DEPTH_UNITS)} or metres per unit",
        )

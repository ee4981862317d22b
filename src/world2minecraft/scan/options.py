"""What a user can set of this stage, as ``--set key=value``."""

from collections.abc import Mapping
from dataclasses import dataclass

from world2minecraft.errors import UnknownNameError, UsageError
from world2minecraft.scan.depth import DepthEncoding

OPTION_NAMES = ("depth_unit", "every", "colour_camera")


@dataclass(frozen=True)
class ScanOptions:
    """The options, parsed; each default is what fits most captures."""

    depth_unit: str | None = None
    """mm, 5000, rotated, m, nyu_raw or metres per unit; else as stated, else told from values."""
    every: int = 1
    """Take each n-th frame; a video's neighbours say little new."""
    colour_camera: str = "auto"
    """auto: estimate it where depth and colour share one stated matrix; stated: take that."""


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
    return ScanOptions(unit, int(every), colour_camera)

"""``scan.json``: how a capture was read and aligned."""

from pathlib import Path

import numpy as np

from world2minecraft.errors import DamagedFileError
from world2minecraft.files import read_json, write_json
from world2minecraft.types import Scan


def write_scan(path: str | Path, scan: Scan) -> None:
    """Write everything of a scan but its pictures."""
    write_json(
        path,
        {
            "source": scan.source,
            "scan_to_room": scan.scan_to_room.tolist(),
            "room_size_m": scan.room_size_m.tolist(),
            "frames_used": list(scan.frames_used),
            "frames_skipped": [{"frame": n, "reason": r} for n, r in scan.frames_skipped],
            "scale": scan.scale,
            "scale_sigma": scan.scale_sigma,
            "notes": list(scan.notes),
        },
    )


def read_room_size(path: str | Path) -> np.ndarray:
    """Return ``room_size_m`` float64 [3] of a ``scan.json``.

    Raises:
        InputError: the file is missing. DamagedFileError: it holds no size.
    """
    try:
        size = np.array(read_json(path)["room_size_m"], np.float64).reshape(3)
    except (KeyError, TypeError, ValueError) as error:
        raise DamagedFileError(path, f"has no room_size_m ({error})") from error
    if not (np.isfinite(size).all() and (size > 0).all()):
        raise DamagedFileError(path, f"room_size_m must be above 0, not {size.tolist()}")
    return size

"""``poses.npz``: what registration changed, frame by frame.

``names`` [F]; ``pose_change`` float64 [F, 4, 4], scan to scan, applied on the left of a frame's
pose; ``depth_scale`` float64 [F], what its depth is multiplied by.
"""

from pathlib import Path

import numpy as np

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_npz, write_npz
from world2minecraft.core.types import Corrections

POSE_ARRAYS = ("names", "pose_change", "depth_scale")


def write_poses(path: str | Path, corrections: Corrections) -> None:
    """Write corrections; the same corrections give the same bytes."""
    write_npz(
        path,
        {
            "names": np.array(corrections.names, np.str_),
            "pose_change": corrections.pose_change,
            "depth_scale": corrections.depth_scale,
        },
    )


def read_poses(path: str | Path) -> Corrections:
    """Read corrections; their facts stay in ``scan.json``.

    Raises:
        InputError: the file is missing. DamagedFileError: it holds no corrections.
        LimitError: an array is too large.
    """
    arrays = read_npz(path, POSE_ARRAYS)
    try:
        names = tuple(str(name) for name in arrays["names"])
        return Corrections(names, arrays["pose_change"], arrays["depth_scale"])
    except (ValueError, TypeError) as error:
        raise DamagedFileError(path, f"holds no corrections ({error})") from error

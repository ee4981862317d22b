"""``evidence.npz``: FusedEvidence, enough to run the label stage and all after it again.

Arrays as in FusedEvidence. Cells without votes take most of the room, and compress to nothing.
"""

from pathlib import Path

import numpy as np

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_npz, write_npz
from world2minecraft.core.types import FusedEvidence

EVIDENCE_ARRAYS = (
    "log_odds",
    "votes",
    "colour_sum",
    "offset_sum",
    "hits",
    "voxel_m",
    "origin_m",
    "scan_to_room",
)


def write_evidence(path: str | Path, evidence: FusedEvidence) -> None:
    """Write fused evidence; the same evidence gives the same bytes."""
    write_npz(path, {name: np.asarray(getattr(evidence, name)) for name in EVIDENCE_ARRAYS})


def read_evidence(path: str | Path) -> FusedEvidence:
    """Read fused evidence.

    Raises:
        InputError: the file is missing. DamagedFileError: it holds no valid evidence.
        LimitError: an array is too large.
    """
    arrays = read_npz(path, EVIDENCE_ARRAYS)
    try:
        arrays["voxel_m"] = float(arrays["voxel_m"])  # type: ignore[assignment]
        return FusedEvidence(**arrays)  # type: ignore[arg-type]
    except (ValueError, TypeError) as error:
        raise DamagedFileError(path, f"is no evidence ({error})") from error

"""Another occupancy of the same room, laid on the cells of the document: a truth, a prediction.

The page counts what was added, removed and changed, and the IoU, from the two arrays of labels.
"""

from pathlib import Path

import numpy as np
from scipy.ndimage import binary_dilation

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.errors import InputError
from world2minecraft.core.types import UNSEEN
from world2minecraft.editing.scene import SceneDraft
from world2minecraft.editing.scene.difference import resample_labels
from world2minecraft.evaluation.metrics.truth_resampling import carry_truth
from world2minecraft.evaluation.scoring.truth_files import read_truth
from world2minecraft.formats.occupancy_files import read_occupancy

SUFFIXES = (".npz", ".npy", ".json")


def read_file_labels(path: Path, draft: SceneDraft) -> np.ndarray:
    """Return the labels uint8 [X, Y, Z] of an occupancy file in the cells of a scene.

    A cell takes the label at its centre, 255 where the file does not reach.

    Raises:
        InputError: it is no occupancy file.
        UsageError: it lies beside the scene, or has larger cells.
    """
    return resample_labels(read_occupancy(path), draft)


def find_truth_folder(run: Path, capture: Path | None) -> Path | None:
    """Return where the truth of a generated room lies, None where there is none."""
    for folder in (run / "capture", capture):
        if folder is not None and (folder / "truth.npz").is_file():
            return folder
    return None


def read_truth_labels(folder: Path, draft: SceneDraft, scan_to_room: np.ndarray) -> np.ndarray:
    """Return the truth uint8 [X, Y, Z] of a generated room in the cells of a scene.

    Raises:
        InputError: it cannot be read.
    """
    truth = read_truth(folder)
    truth_to_room = scan_to_room @ truth.truth_to_scan
    place = (draft.shape, draft.origin_m, draft.voxel_m)
    return carry_truth(truth.labels, truth.voxel_m, truth.origin_m, truth_to_room, *place)


def mask_unreached(labels: np.ndarray, source: np.ndarray) -> np.ndarray:
    """Return labels with 255 where a scan never came near: a truth's walls are thick.

    Args:
        labels: uint8 [X, Y, Z] of a truth.
        source: uint8 [X, Y, Z] of the scene as it was opened; cells that were reached, and those
            beside one, count.
    """
    near = binary_dilation(source != UNSEEN, np.ones((3, 3, 3), bool))
    return np.where(near, labels, np.uint8(UNKNOWN))


def check_suffix(name: str) -> str:
    """Return the suffix of a file to compare with.

    Raises:
        InputError: it is of no kind that is read.
    """
    suffix = Path(name).suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(name[:80], "not an occupancy file; use .npz, .npy or .json")
    return suffix

"""Resampling of another occupancy of the same room, such as a prediction, to a document's cells.

From the two label arrays, the page computes the added, removed and changed cells and the IoU.
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
    """Return the labels of an occupancy file in the cells of a scene, as uint8 [X, Y, Z].

    Each cell gets the label at its centre, or 255 outside the extent of the file. The ids may be
    those of EmbodiedOcc, whose 12 is empty.

    Raises:
        InputError: If the file is not an occupancy file.
        UsageError: If the occupancy does not overlap the scene, or if its cells are larger.
    """
    return resample_labels(read_occupancy(path, "auto"), draft)


def find_truth_folder(run: Path, capture: Path | None) -> Path | None:
    """Return the folder with the ground truth of a generated room, or None."""
    for folder in (run / "capture", capture):
        if folder is not None and (folder / "truth.npz").is_file():
            return folder
    return None


def read_truth_labels(folder: Path, draft: SceneDraft, scan_to_room: np.ndarray) -> np.ndarray:
    """Return the ground truth of a generated room in the cells of a scene, as uint8 [X, Y, Z].

    Raises:
        InputError: If the ground truth cannot be read.
    """
    truth = read_truth(folder)
    truth_to_room = scan_to_room @ truth.truth_to_scan
    place = (draft.shape, draft.origin_m, draft.voxel_m)
    return carry_truth(truth.labels, truth.voxel_m, truth.origin_m, truth_to_room, *place)


def mask_unreached(labels: np.ndarray, source: np.ndarray) -> np.ndarray:
    """Return labels in which cells that the scan did not reach are set to 255.

    This excludes the inside of walls, which are thick in a ground truth.

    Args:
        labels: Ground truth labels, uint8 [X, Y, Z].
        source: Labels of the scene as it was first opened, uint8 [X, Y, Z]. Reached cells and their
            neighbours are kept.
    """
    near = binary_dilation(source != UNSEEN, np.ones((3, 3, 3), bool))
    return np.where(near, labels, np.uint8(UNKNOWN))


def check_suffix(name: str) -> str:
    """Return the suffix of the name of a file to compare with.

    Raises:
        InputError: If the file type is not supported.
    """
    suffix = Path(name).suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(
            name[:80], "unsupported file type; use an occupancy file in .npz, .npy or .json format"
        )
    return suffix

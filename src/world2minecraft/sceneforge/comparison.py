"""Resampling of another occupancy of the same room, such as a prediction, to a document's cells.

From the two label arrays, the page computes the added, removed and changed cells and the IoU. Of a
ground truth, the cells and the figures are those of ``w2m evaluate reconstruction`` and the report.
"""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.errors import InputError
from world2minecraft.editing.scene import SceneDraft
from world2minecraft.editing.scene.difference import resample_labels
from world2minecraft.evaluation.metrics.occupancy import OccupancyCounts, count_occupancy
from world2minecraft.evaluation.scoring.score import scored_beyond, scored_labels, see_truth
from world2minecraft.evaluation.scoring.used_frames import truth_of_run, used_frames
from world2minecraft.formats.occupancy_files import read_occupancy

SUFFIXES = (".npz", ".npy", ".json")


@dataclass(frozen=True, eq=False)
class Reference:
    """What a scene is compared with.

    Attributes:
        labels: Labels in the cells of the scene, uint8 [X, Y, Z]; 255 is not compared.
        beyond: Number of further cells of each label outside the scene, which holds nothing there,
            int64 [12].
    """

    labels: np.ndarray
    beyond: np.ndarray = field(default_factory=lambda: np.zeros(CLASS_COUNT, np.int64))

    def counts(self, labels: np.ndarray) -> OccupancyCounts:
        """Return the confusion of the scene's labels uint8 [X, Y, Z], by the report's function."""
        outside = np.repeat(np.arange(CLASS_COUNT, dtype=np.uint8), self.beyond)
        nothing = np.full(len(outside), UNKNOWN, np.uint8)
        return count_occupancy(labels, self.labels) + count_occupancy(nothing, outside)


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


def read_truth(run: Path, folder: Path, draft: SceneDraft, scan_to_room: np.ndarray) -> Reference:
    """Return the ground truth of a generated room in the cells of a scene.

    Cells that are not scored, because no ray of the run's frames reached them, are 255. These are
    the cells that ``w2m evaluate reconstruction`` leaves out. Scored cells outside the scene count
    as it counts them: as missed where they are occupied.

    Args:
        run: The folder of the run that the scene was opened from.
        folder: The folder of the ground truth.
        draft: The scene.
        scan_to_room: The rigid 4x4 transform that the run estimated.

    Raises:
        InputError: If the ground truth cannot be read, or is that of another room.
    """
    truth = truth_of_run(run, folder)
    room = see_truth(truth, used_frames(run, truth), scan_to_room, draft.voxel_m)
    place = (draft.shape, draft.origin_m)
    return Reference(scored_labels(room, *place), scored_beyond(room, *place))


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

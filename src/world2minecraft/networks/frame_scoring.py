"""SSCNet's protocol for one frame: a depth image, saved labels or a run against the true cells.

Completion is scored on the cells that the surface hides, and on these together with the surface, as
later papers do. Classes are scored on hidden and surface cells. All cells lie in the image, and
those with label 255, which is outside the room in NYUv2, are left out.
"""

from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import InputError
from world2minecraft.evaluation.metrics.occupancy import OccupancyCounts
from world2minecraft.evaluation.metrics.protocols import PROTOCOLS, count_frame
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.minecraftocc.cell_predictions import cells_of_room, resample_to_grid
from world2minecraft.minecraftocc.frame_occupancy import Frame
from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet
from world2minecraft.minecraftocc.scene_completion import GridPlace
from world2minecraft.minecraftocc.types import OccSample
from world2minecraft.networks.data.frames import cells_with_masks
from world2minecraft.networks.saved_predictions import SavedPredictions, grid_of_labels

ROOM_FILE = "room.npz"


def frame_scores(
    predicted: Path, truth: ImportedSet, *, colour: Path | None = None, depth_code: str = "auto"
) -> dict[str, Any]:
    """Return the scores of one frame by SSCNet's protocol, as fractions from 0 to 1.

    Args:
        predicted: Depth PNG to complete, saved labels, or the folder of a run of this frame.
        truth: Data set with the frame, which must have depth. With several frames, the one with the
            name of the prediction is used.
        colour: Photo from the camera of a depth PNG.
        depth_code: Encoding of a depth PNG, as in ``Frame``.

    Returns:
        ``frame``, ``completion`` and ``completion_hidden`` with iou, precision, recall and cells,
        ``miou`` (11 classes), ``miou_with_empty`` (12), ``miou_present_classes`` and ``class_iou``.

    Raises:
        InputError: If the frame is missing, or if the prediction has other cells.
        UsageError: If the frame has no depth.
    """
    sample = truth[_key_of(predicted, truth)]
    labels = predicted_labels(predicted, sample, colour=colour, depth_code=depth_code)
    known = cells_with_masks(sample, grid_of_labels(labels, predicted))
    counts = count_frame(PROTOCOLS["ssc"], labels, known)
    figures = counts.classes.figures()
    return {
        "frame": sample.key,
        "completion": _completion(counts.classes),
        "completion_hidden": _completion(counts.geometry),
        "miou": figures["miou"],
        "miou_with_empty": float(counts.classes.class_iou.mean()),
        "miou_present_classes": figures["miou_present_classes"],
        "class_iou": figures["class_iou"],
    }


def predicted_labels(
    predicted: Path, sample: OccSample, *, colour: Path | None = None, depth_code: str = "auto"
) -> np.ndarray:
    """Return the predicted class of each cell of a frame, uint8 [X, Y, Z].

    Takes the same arguments and raises the same exceptions as ``frame_scores``.
    """
    turn = np.eye(4)  # From a world along the axes of the cells to that of the frame.
    turn[:3, :3] = sample.occ.region.region_to_room[:3, :3]
    region_to_world, camera_to_world = (
        turn.T @ one for one in (sample.occ.region.region_to_room, sample.camera_to_room)
    )
    place = GridPlace(region_to_world[:3, 3], camera_to_world)
    if predicted.suffix.lower() == ".png":
        return Frame(predicted, colour, depth_code).from_depth(place).labels
    if (predicted / ROOM_FILE).is_file():
        return _labels_of_run(predicted / ROOM_FILE, sample, place, turn)
    return SavedPredictions(predicted).labels(sample.key)


def _labels_of_run(path: Path, sample: OccSample, place: GridPlace, turn: np.ndarray) -> np.ndarray:
    """Return the labels of a run in the cells of a frame.

    The capture of the run has the world coordinates of the frame, or those of its camera if its
    pose was not known. The run's surface decides: the placement is used in which it covers more of
    the cells that pixels see.
    """
    room, scan_to_room = read_room(path)
    cells, seen = cells_of_room(room), sample.occ.hits > 0
    found = []
    for world_to_scan in (turn, invert_rigid(place.camera_to_world)):
        try:
            labels = resample_to_grid(cells, scan_to_room @ world_to_scan, place).labels
        except InputError:
            continue
        found.append((int((seen & (labels > 0) & (labels != UNKNOWN)).sum()), labels))
    if not found or not max(covered for covered, _ in found):
        raise InputError(path, "shows no part of the frame; score the run of this frame")
    return max(found, key=lambda one: one[0])[1]


def _key_of(predicted: Path, truth: ImportedSet) -> str:
    """Return the key of the frame to score."""
    keys = truth.keys()
    if len(keys) == 1:
        return keys[0]
    if predicted.stem in keys:
        return predicted.stem
    raise InputError(
        truth.path, f"contains {len(keys)} frames and none is named {predicted.stem}; give one file"
    )


def _completion(counts: OccupancyCounts) -> dict[str, float | int]:
    """Return the scores of occupied cells, whatever their class."""
    figures = counts.figures()
    return {name: figures[name] for name in ("iou", "precision", "recall", "cells")}  # type: ignore[misc]

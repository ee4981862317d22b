"""Scoring of another method's result for a capture.

The input is ``labels.npz`` and, in the same folder, ``objects.json``::

    labels        uint8 [X, Y, Z]: class IDs 0 to 11, or 255 for unknown
    voxel_m       the cell size in metres, 0.08 by default
    origin_m      float [3], the minimum corner of cell (0, 0, 0), 0 by default
    grid_to_scan  float [4, 4], from the frame of the grid (z up) to that of the capture's poses
    confidence    float [X, Y, Z], 0 to 1, optional

``labels.npy`` contains only the labels. ``objects.json`` is a list of ``{class, center_m, size_m,
yaw_deg}`` in the frame of the grid, and can be omitted by a method without object detection.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.pose_validation import MAX_NEAR_M, move_like_capture
from world2minecraft.core.classes import UNKNOWN, class_id
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import MALFORMED, DamagedFileError, InputError, UnknownNameError
from world2minecraft.core.files import npz_array_names, read_json, read_npy, read_npz
from world2minecraft.core.types import LayoutObject, OccupancyGrid
from world2minecraft.core.types.checks import floats, positive, transform
from world2minecraft.evaluation.scoring.object_scores import object_counts, object_facts
from world2minecraft.evaluation.scoring.pose_errors import frame_error
from world2minecraft.evaluation.scoring.score import HOW, cell_facts, headline, see_truth
from world2minecraft.evaluation.scoring.truth_files import read_truth
from world2minecraft.evaluation.scoring.used_frames import all_frames, move_truth
from world2minecraft.formats.occupancy_files import DEFAULT_VOXEL_M, labels_grid

LABELS = ("labels.npz", "labels.npy")
OBJECTS = "objects.json"
OPTIONAL = ("voxel_m", "origin_m", "grid_to_scan", "confidence")


@dataclass(frozen=True, eq=False)
class ForeignResult:
    """A result of another method.

    Attributes:
        grid: The labels, shifted so that the origin is a multiple of the cell size.
        scan_to_room: The transform from the capture's poses to the grid, as float64 [4, 4].
        objects: The objects in the frame of the grid.
        tells_confidence: Whether the method provides confidences.
    """

    grid: OccupancyGrid
    scan_to_room: np.ndarray
    objects: tuple[LayoutObject, ...]
    tells_confidence: bool


def foreign_file(place: Path) -> Path | None:
    """Return the label file of another method at a path, or None for a run of this program."""
    if place.is_file():
        return place
    found = (place / name for name in LABELS if (place / name).is_file())
    return None if (place / "scan.json").is_file() else next(found, None)


def read_foreign(path: Path) -> ForeignResult:
    """Read labels, and the objects in the same folder.

    Raises:
        InputError: If the file is missing or not a label array.
        DamagedFileError: If a value is invalid.
    """
    if path.suffix not in (".npz", ".npy"):
        raise InputError(path, f"not a label array; expected {' or '.join(LABELS)}")
    arrays = _arrays(path)
    try:
        voxel_m = positive("voxel_m", float(arrays.get("voxel_m", DEFAULT_VOXEL_M)))
        origin_m = floats("origin_m", arrays.get("origin_m", np.zeros(3)), (3,))
        grid_to_scan = transform("grid_to_scan", arrays.get("grid_to_scan", np.eye(4)))
        # Grids of this program begin at whole cells near the origin, so the frame is moved.
        moved = np.eye(4)
        whole_m = np.round(origin_m / voxel_m) * voxel_m
        if np.abs(origin_m).max() > MAX_NEAR_M:
            whole_m = np.zeros(3)
        moved[:3, 3] = whole_m - origin_m
        grid = labels_grid(arrays["labels"], path, voxel_m, whole_m)
        if "confidence" in arrays:
            stated = np.where(grid.labels == UNKNOWN, 0, arrays["confidence"]).astype(np.float16)
            grid = replace(grid, confidence=stated)
    except MALFORMED as error:
        raise DamagedFileError(path, f"not a valid result ({error})") from error
    objects = tuple(
        replace(item, center_m=item.center_m + moved[:3, 3])
        for item in _objects(path.parent / OBJECTS)
    )
    return ForeignResult(grid, moved @ invert_rigid(grid_to_scan), objects, "confidence" in arrays)


def evaluate_foreign(path: Path, truth: Path) -> dict[str, Any]:
    """Return the scores of another method's labels and objects.

    The scores are those of ``evaluate_reconstruction`` that require no poses, furniture or blocks,
    on the cells that rays of **all** frames reached. Calibration is included if there are
    confidences.

    Args:
        path: The file ``labels.npz`` or ``labels.npy``.
        truth: The folder of ``truth.npz`` and ``truth.json``.

    Raises:
        InputError: If a file is missing or damaged.
    """
    known, made = read_truth(truth), read_foreign(path)
    if made.grid.voxel_m < known.voxel_m:
        raise InputError(
            path,
            f"voxel size of {made.grid.voxel_m:g} m is smaller than the ground truth's "
            f"{known.voxel_m:g} m; resample the result to a coarser grid",
        )
    capture = find_capture(known.capture)
    known = move_truth(known, capture.source_to_scan)
    grid_to_scan = move_like_capture(
        invert_rigid(made.scan_to_room), capture.source_to_scan, made.grid.origin_m
    )
    frames, scan_to_room = all_frames(known, capture), invert_rigid(grid_to_scan)
    room = see_truth(known, frames, scan_to_room, made.grid.voxel_m)
    facts = cell_facts(made.grid, room)
    if not made.tells_confidence:
        del facts["calibration"]
    facts["objects"] = object_facts(object_counts(made.objects, room.objects))
    facts["frame_error"] = frame_error(room.truth_to_room, known.layouts)
    facts |= {"poses": {}, "layout": {}, "world": {}, "voxel_m": made.grid.voxel_m}
    return {"how": HOW, "headline": headline(facts)} | facts


def _arrays(path: Path) -> dict[str, np.ndarray]:
    if path.suffix == ".npy":
        return {"labels": read_npy(path)}
    held = npz_array_names(path)
    return read_npz(path, ("labels", *(name for name in OPTIONAL if name in held)))


def _objects(path: Path) -> tuple[LayoutObject, ...]:
    if not path.is_file():
        return ()
    rows = read_json(path)
    if not isinstance(rows, list):
        raise DamagedFileError(path, "must contain a list of {class, center_m, size_m, yaw_deg}")
    objects = []
    for number, row in enumerate(rows):
        try:
            yaw_deg = float(row.get("yaw_deg", 0.0))
            number_of_class = class_id(str(row["class"]))
            objects.append(LayoutObject(number_of_class, row["center_m"], row["size_m"], yaw_deg))
        except (*MALFORMED, UnknownNameError) as error:
            reason = f"row {number} is not a valid {{class, center_m, size_m, yaw_deg}} ({error})"
            raise DamagedFileError(path, reason) from error
    return tuple(objects)

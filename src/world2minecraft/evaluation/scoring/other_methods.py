"""What another method made of a capture, scored as a run of ours is.

In: ``labels.npz`` and, beside it, ``objects.json``::

    labels        uint8 [X, Y, Z]: class ids 0 to 11, 255 where it knows nothing
    voxel_m       the side of a cell, 0.08 where it is left out
    origin_m      float [3], the minimum corner of cell (0, 0, 0), 0 where it is left out
    grid_to_scan  float [4, 4], from the grid's frame (z up) to that of the capture's poses
    confidence    float [X, Y, Z], 0 to 1, where the method tells one

``labels.npy`` holds the labels alone. ``objects.json`` is a list of ``{class, center_m, size_m,
yaw_deg}`` in the grid's frame; a method that finds none leaves it out.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import UNKNOWN, class_id
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import DamagedFileError, InputError, UnknownNameError
from world2minecraft.core.files import npz_array_names, read_json, read_npy, read_npz
from world2minecraft.core.types import LayoutObject, OccupancyGrid
from world2minecraft.core.types.checks import floats, positive, transform
from world2minecraft.evaluation.scoring.object_scores import object_counts, object_facts
from world2minecraft.evaluation.scoring.pose_errors import frame_error
from world2minecraft.evaluation.scoring.score import HOW, cell_facts, headline, see_truth
from world2minecraft.evaluation.scoring.truth_files import read_truth
from world2minecraft.evaluation.scoring.used_frames import all_frames
from world2minecraft.formats.occupancy_files import DEFAULT_VOXEL_M, labels_grid

LABELS = ("labels.npz", "labels.npy")
OBJECTS = "objects.json"
OPTIONAL = ("voxel_m", "origin_m", "grid_to_scan", "confidence")


@dataclass(frozen=True, eq=False)
class ForeignResult:
    """A grid whose origin is a whole multiple of its cell, and objects in the same frame."""

    grid: OccupancyGrid
    scan_to_room: np.ndarray  # float64 [4, 4]
    objects: tuple[LayoutObject, ...]
    tells_confidence: bool


def foreign_file(place: Path) -> Path | None:
    """Return the labels of another method that lie at a place; None where it is a run of ours."""
    if place.is_file():
        return place
    found = (place / name for name in LABELS if (place / name).is_file())
    return None if (place / "scan.json").is_file() else next(found, None)


def read_foreign(path: Path) -> ForeignResult:
    """Read labels, and the objects beside them.

    Raises:
        InputError: the file is missing or of another kind. DamagedFileError: a value is wrong.
    """
    if path.suffix not in (".npz", ".npy"):
        raise InputError(path, f"is no array of labels; give {' or '.join(LABELS)}")
    arrays = _arrays(path)
    try:
        voxel_m = positive("voxel_m", float(arrays.get("voxel_m", DEFAULT_VOXEL_M)))
        origin_m = floats("origin_m", arrays.get("origin_m", np.zeros(3)), (3,))
        grid_to_scan = transform("grid_to_scan", arrays.get("grid_to_scan", np.eye(4)))
        # Ours begin at whole cells: the frame moves by the rest, and all that is in it.
        moved = np.eye(4)
        whole_m = np.round(origin_m / voxel_m) * voxel_m
        moved[:3, 3] = whole_m - origin_m
        grid = labels_grid(arrays["labels"], path, voxel_m, whole_m)
        if "confidence" in arrays:
            stated = np.where(grid.labels == UNKNOWN, 0, arrays["confidence"]).astype(np.float16)
            grid = replace(grid, confidence=stated)
    except (ValueError, TypeError) as error:
        raise DamagedFileError(path, f"is no result ({error})") from error
    objects = tuple(
        replace(item, center_m=item.center_m + moved[:3, 3])
        for item in _objects(path.parent / OBJECTS)
    )
    return ForeignResult(grid, moved @ invert_rigid(grid_to_scan), objects, "confidence" in arrays)


def evaluate_foreign(path: Path, truth: Path) -> dict[str, Any]:
    """Return the scores of another method's labels and objects.

    They are those of ``evaluate_reconstruction`` that need neither poses nor furniture nor blocks,
    on the cells that rays of **all** frames came to. Calibration is there where a confidence is.

    Args:
        path: ``labels.npz`` or ``labels.npy``.
        truth: the folder of ``truth.npz`` and ``truth.json``.

    Raises:
        InputError: a file is missing or damaged.
    """
    known, made = read_truth(truth), read_foreign(path)
    if made.grid.voxel_m < known.voxel_m:
        raise InputError(
            path, f"has cells of {made.grid.voxel_m:g} m, finer than the truth's {known.voxel_m:g}"
        )
    room = see_truth(known, all_frames(known), made.scan_to_room, made.grid.voxel_m)
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
        raise DamagedFileError(path, "must hold a list of {class, center_m, size_m, yaw_deg}")
    objects = []
    for number, row in enumerate(rows):
        try:
            yaw_deg = float(row.get("yaw_deg", 0.0))
            number_of_class = class_id(str(row["class"]))
            objects.append(LayoutObject(number_of_class, row["center_m"], row["size_m"], yaw_deg))
        except (KeyError, TypeError, ValueError, AttributeError, UnknownNameError) as error:
            reason = f"row {number} is no {{class, center_m, size_m, yaw_deg}} ({error})"
            raise DamagedFileError(path, reason) from error
    return tuple(objects)

"""Scores of a finished run against its ground truth.

Only the cells that a noise-free ray of a used frame reached or crossed are scored, because the
others cannot be observed. The ground truth is converted to occupancy in the estimated frame by
SSCNet's rule. The error of the frame itself is reported separately.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, CLASS_NAMES, UNKNOWN
from world2minecraft.core.coordinates import apply, cell_centers_m, invert
from world2minecraft.core.types import OBSERVED, OccupancyGrid
from world2minecraft.core.whole_reads import unchanged
from world2minecraft.evaluation.metrics.calibration import count_calibration
from world2minecraft.evaluation.metrics.occupancy import count_occupancy
from world2minecraft.evaluation.metrics.surface_scores import (
    SurfaceCounts,
    count_surface,
    free_space_recall,
)
from world2minecraft.evaluation.metrics.truth_resampling import carry_truth
from world2minecraft.evaluation.scoring.object_scores import (
    TrueObjects,
    in_room,
    layout_facts,
    name_facts,
    object_counts,
    object_facts,
    true_objects,
)
from world2minecraft.evaluation.scoring.observed_cells import CROSSED, Reached, reached_cells
from world2minecraft.evaluation.scoring.opening_scores import opening_facts
from world2minecraft.evaluation.scoring.pose_errors import frame_error, pose_facts
from world2minecraft.evaluation.scoring.truth_files import Truth
from world2minecraft.evaluation.scoring.used_frames import UsedFrame, truth_of_run, used_frames
from world2minecraft.formats.layout import read_layouts
from world2minecraft.formats.objects_and_placements import read_objects
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.formats.world_labels import Scene, read_scene

NEAR = np.array(list(np.ndindex(3, 3, 3))) - 1

HOW = (
    "Scored on the cells that a noise-free ray of a used frame reached or crossed. True "
    "occupancy follows SSCNet's rule (4 of 64 sub-cells). Objects match within 0.3 m."
)


def world_facts(out: Path, true_labels: np.ndarray, reached: Reached) -> dict[str, Any]:
    """Return the shares of the seen true surface that blocks represent, if blocks were built.

    ``explained`` is the share of cells within one cell of any block, and ``right_class`` the share
    within one cell of a block of their own class.

    Args:
        out: The folder of the run.
        true_labels: The true labels in the box of ``reached``, as uint8 [X, Y, Z].
        reached: The cells that rays reached. Only those in which a ray met a surface are used.
    """
    if not (out / "build" / "scene.json").is_file():
        return {}
    scene = read_scene(out / "build")
    cells = np.argwhere(reached.met & (true_labels > 0) & (true_labels != UNKNOWN))
    if not len(cells):
        return {"explained": 1.0, "right_class": 1.0}
    wanted = true_labels[tuple(cells.T)]
    centers_m = cell_centers_m(cells, reached.low * reached.voxel_m, reached.voxel_m)
    explained, right = np.zeros(len(cells), bool), np.zeros(len(cells), bool)
    for step in NEAR:
        block = class_at(scene, centers_m + step * reached.voxel_m)
        explained |= block > 0
        right |= block == wanted
    return {"explained": float(explained.mean()), "right_class": float(right.mean())}


def class_at(scene: Scene, points_m: np.ndarray) -> np.ndarray:
    """Return the class of the block at each room point [N, 3], or 0 without a block."""
    blocks = np.floor(apply(invert(scene.block_to_room), points_m) - scene.corner + 1e-9)
    inside = np.asarray(((blocks >= 0) & (blocks < scene.semantic.shape)).all(axis=1))
    at = np.where(inside[:, None], blocks, 0).astype(np.int64)
    return np.where(inside, scene.semantic[tuple(at.T)], 0)


@dataclass(frozen=True, eq=False)
class TrueRoom:
    """The ground truth in the estimated frame, in a box of cells that contains all of it.

    Attributes:
        truth: The ground truth.
        frames: The frames used.
        truth_to_room: The transform to the estimated frame as float64 [4, 4].
        reached: The cells that rays reached.
        labels: The true labels as uint8 of the shape of ``reached.flags``.
        objects: The true objects in the estimated frame.
    """

    truth: Truth
    frames: tuple[UsedFrame, ...]
    truth_to_room: np.ndarray
    reached: Reached
    labels: np.ndarray
    objects: TrueObjects


def evaluate_reconstruction(out: Path, truth: Path) -> dict[str, Any]:
    """Return the scores of a finished run, with a headline of the most important ones.

    Args:
        out: The folder of the run.
        truth: The folder of the capture with ``truth.npz`` and ``truth.json``.

    Raises:
        InputError: If a file of the run or of the ground truth is missing or damaged.
        ConflictError: If another process is changing the run or the capture.
    """
    with unchanged(out), unchanged(truth):
        known = truth_of_run(out, truth)
        grid, scan_to_room = read_room(out / "room.npz")
        seen = see_truth(known, used_frames(out, known), scan_to_room, grid.voxel_m)
        return score_run(out, seen)


def see_truth(
    truth: Truth, frames: Sequence[UsedFrame], scan_to_room: np.ndarray, voxel_m: float
) -> TrueRoom:
    """Transform the ground truth to an estimated frame.

    Args:
        truth: The ground truth.
        frames: The frames used, whose rays determine the observable cells.
        scan_to_room: The rigid 4x4 transform that the run estimated.
        voxel_m: The cell size in metres.
    """
    truth_to_room = scan_to_room @ truth.truth_to_scan
    reached = reached_cells(truth, frames, truth_to_room, voxel_m)
    x, y, z = reached.flags.shape
    labels = carry_truth(
        truth.labels,
        truth.voxel_m,
        truth.origin_m,
        truth_to_room,
        (x, y, z),
        reached.low * voxel_m,
        voxel_m,
    )
    objects = true_objects(truth, truth_to_room, reached)
    return TrueRoom(truth, tuple(frames), truth_to_room, reached, labels, objects)


def score_run(out: Path, room: TrueRoom) -> dict[str, Any]:
    """Return the scores of a run, given the ground truth in its frame."""
    grid, _ = read_room(out / "room.npz")
    facts = cell_facts(grid, room)
    instances = read_objects(out / "objects.json", grid)
    facts["objects"] = object_facts(object_counts(instances, room.objects))
    if names := name_facts(instances, room.objects):
        facts["names"] = names
    facts["frame_error"] = frame_error(room.truth_to_room, room.truth.layouts)
    facts["poses"] = pose_facts(out, room.truth, room.frames)
    true_rooms = in_room(room.truth.layouts, room.truth_to_room)
    facts["layout"] = layout_facts(out, grid, true_rooms, room.objects)
    if (out / "layout.json").is_file() and room.truth.layouts:
        rooms = read_layouts(out / "layout.json")
        facts["openings"] = opening_facts(
            rooms, room.truth.layouts, room.truth_to_room, room.reached
        )
    facts["world"] = world_facts(out, room.labels, room.reached)
    return {"how": HOW, "headline": headline(facts)} | facts


def cell_facts(grid: OccupancyGrid, room: TrueRoom) -> dict[str, Any]:
    """Return the scores of the cells of a grid."""
    labels = placed(grid.labels, grid, room.reached, UNKNOWN)
    source = placed(grid.source, grid, room.reached, 0)
    confidence = placed(grid.confidence, grid, room.reached, 0)
    true, flags = room.labels, room.reached.flags
    scored = room.reached.scored & (true != UNKNOWN)
    # What lies behind a scanned surface is unknown, so cells found there are not false.
    judged = true != UNKNOWN if room.truth.is_partial else np.ones(true.shape, bool)
    found_here, true_here = (labels > 0) & (labels != UNKNOWN), (true > 0) & (true != UNKNOWN)
    surface = count_surface(
        found_here,
        true_here,
        found_mask=(source == OBSERVED) & judged,
        true_mask=room.reached.met,
    )
    if not room.truth.is_partial:  # What was found beyond the truth's box is near nothing true.
        beyond = int((grid.occupied & (grid.source == OBSERVED)).sum()) - surface.found
        surface += SurfaceCounts(found=beyond)
    observed = scored & (source == OBSERVED)
    return {
        "surface_within_one_voxel": {"precision": surface.precision, "recall": surface.recall},
        "free_recall": free_space_recall(labels == 0, true == 0, flags == CROSSED),
        "occupancy": count_occupancy(labels, true, scored).figures(),
        "errors": error_facts(labels, true, scored),
        "calibration": {
            name: _calibration(confidence[cells], (labels == true)[cells])
            for name, cells in (("all", observed), ("occupied", observed & found_here))
        },
    }


def error_facts(labels: np.ndarray, true: np.ndarray, scored: np.ndarray) -> dict[str, Any]:
    """Return the number of missed and added cells, in total and by class.

    A missed cell is occupied but was predicted as free or unknown. An added cell is empty but was
    predicted as occupied.

    Args:
        labels: The predicted labels as uint8 [X, Y, Z].
        true: The true labels as uint8 [X, Y, Z].
        scored: The cells to score as bool [X, Y, Z].
    """
    missed = scored & (true > 0) & ((labels == 0) | (labels == UNKNOWN))
    added = scored & (true == 0) & (labels > 0) & (labels != UNKNOWN)
    return {
        "called_free": int((missed & (labels == 0)).sum()),
        "left_unknown": int((missed & (labels == UNKNOWN)).sum()),
        "called_occupied": int(added.sum()),
        "missed_by_class": _by_class(true[missed]),
        "added_by_class": _by_class(labels[added]),
    }


def _by_class(labels: np.ndarray) -> dict[str, int]:
    """Return the number of labels of each class, without absent classes."""
    counts = np.bincount(labels, minlength=CLASS_COUNT)
    return {CLASS_NAMES[n]: int(counts[n]) for n in range(1, CLASS_COUNT) if counts[n]}


def _calibration(confidence: np.ndarray, right: np.ndarray) -> dict[str, Any]:
    counts = count_calibration(confidence, right)
    return {"error": counts.error, "cells": int(counts.cells.sum()), "bins": counts.rows()}


def placed(values: np.ndarray, grid: OccupancyGrid, reached: Reached, fill: int) -> np.ndarray:
    """Copy values of a grid to the box of ``reached``.

    Cells of the grid outside the box are dropped, because no ray reached them.

    Args:
        values: The values of the grid's cells as [X, Y, Z].
        grid: The grid.
        reached: The cells that rays reached, which define the box.
        fill: The value for cells of the box outside the grid.
    """
    start = np.round(grid.origin_m / grid.voxel_m).astype(np.int64) - reached.low
    return _copied(values, start, reached.flags.shape, fill)


def scored_labels(room: TrueRoom, shape: tuple[int, int, int], origin_m: np.ndarray) -> np.ndarray:
    """Return the true labels of the scored cells in the cells of a grid.

    Args:
        room: The ground truth in the frame of the grid, with the cell size of the grid.
        shape: The shape [X, Y, Z] of the grid.
        origin_m: The minimum corner of the grid, as float [3].

    Returns:
        The labels as uint8 of shape ``shape``; cells that no ray reached are 255.
    """
    labels = np.where(room.reached.scored, room.labels, np.uint8(UNKNOWN))
    start = room.reached.low - np.round(origin_m / room.reached.voxel_m).astype(np.int64)
    return _copied(labels, start, shape, UNKNOWN)


def scored_beyond(room: TrueRoom, shape: tuple[int, int, int], origin_m: np.ndarray) -> np.ndarray:
    """Return how many scored cells outside a grid have each true label, as int64 [12].

    They count as missed, or as rightly empty, since a grid holds nothing outside its bounds.

    Args:
        room: The ground truth in the frame of the grid, with the cell size of the grid.
        shape: The shape [X, Y, Z] of the grid.
        origin_m: The minimum corner of the grid, as float [3].
    """
    every = room.labels[room.reached.scored & (room.labels != UNKNOWN)]
    inside = scored_labels(room, shape, origin_m)
    return np.bincount(every, minlength=CLASS_COUNT) - np.bincount(
        inside[inside != UNKNOWN], minlength=CLASS_COUNT
    )


def _copied(values: np.ndarray, start: np.ndarray, shape: tuple[int, ...], fill: int) -> np.ndarray:
    """Copy a box of cells [X, Y, Z] whose first cell has index ``start`` in the result."""
    result = np.full(shape, fill, values.dtype)
    first, last = np.maximum(start, 0), np.minimum(start + values.shape, result.shape)
    if (first < last).all():
        inside = tuple(slice(a, b) for a, b in zip(first, last, strict=True))
        source = tuple(slice(a, b) for a, b in zip(first - start, last - start, strict=True))
        result[inside] = values[source]
    return result


def headline(facts: dict[str, Any]) -> dict[str, str]:
    """Return the most important scores as text."""
    surface, occupancy, objects = (
        facts[name] for name in ("surface_within_one_voxel", "occupancy", "objects")
    )
    shown = {
        "precision within one voxel": f"{surface['precision']:.3f}",
        "recall within one voxel": f"{surface['recall']:.3f}",
        "IoU": f"{occupancy['iou']:.2f}",
        "mIoU of the classes present": f"{occupancy['miou_present_classes']:.2f}",
    }
    if objects["true"]:
        shown["object F1"] = f"{objects['f1']:.2f}"
    if objects["orientation_asked"]:
        shown["correct orientation"] = f"{objects['orientation_right']:.2f}"
    return shown

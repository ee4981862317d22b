"""Losses of each reconstruction stage, measured by inserting ground truth after it.

After **alignment**, the poses, depth scales and room frame are true. After **fusion**, the geometry
is true, with votes from the real label images. After **labels**, the labels of these cells are
true. After **instances**, the cells and boxes of objects are true. After **templates**, furniture
has the true boxes and orientations. The later stages run normally. The loss of a stage is the
difference of scores with ground truth inserted after it and after the preceding stage.
"""

import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.capture import open_scan
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import MALFORMED, DamagedFileError, UsageError
from world2minecraft.core.files import read_json
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Scan, View
from world2minecraft.evaluation.scoring.oracle_stages import (
    put_true_labels,
    put_true_objects,
    put_true_placements,
    true_evidence,
)
from world2minecraft.evaluation.scoring.score import TrueRoom, cell_facts, score_run, see_truth
from world2minecraft.evaluation.scoring.truth_files import Truth
from world2minecraft.evaluation.scoring.used_frames import truth_of_run, used_frames
from world2minecraft.formats.layout import write_layouts
from world2minecraft.formats.run_arrays import read_room, write_evidence
from world2minecraft.formats.scan_record import write_scan
from world2minecraft.reconstruction.file_stages import FILE_STAGES
from world2minecraft.reconstruction.fusion import fuse_views
from world2minecraft.reconstruction.occupancy import predictor
from world2minecraft.reconstruction.parameters import Parameters

AFTER = ("alignment", "fusion", "labels", "instances", "templates")


def recorded_parameters(out: Path) -> Parameters:
    """Return the recorded parameters of a run, with defaults for missing ones.

    Raises:
        InputError: If the manifest is missing.
        DamagedFileError: If the manifest contains no valid parameters.
    """
    path = out / "manifest.json"
    try:
        return _restored(Parameters(), read_json(path)["parameters"])
    except (*MALFORMED, UsageError) as error:
        raise DamagedFileError(path, f"does not contain valid parameters ({error})") from error


def _restored(default: Any, stated: dict[str, Any]) -> Any:
    """Return a dataclass with the values from JSON data, including nested ones."""
    changes = {}
    for entry in fields(default):
        if entry.name in stated:
            old, value = getattr(default, entry.name), stated[entry.name]
            if is_dataclass(old):
                value = _restored(old, value)
            elif isinstance(old, tuple):
                value = tuple(value)
            changes[entry.name] = value
    return replace(default, **changes)


@dataclass(eq=False)
class TrueViews:
    """The views of a capture with their true poses and depth scales."""

    views: Any
    truth: Truth

    def __len__(self) -> int:
        """Return the number of views."""
        return len(self.views)

    def __iter__(self) -> Iterator[View]:
        """Iterate over the views from the first one."""
        poses, scales = self.truth.camera_to_truth or {}, self.truth.depth_scale or {}
        for view in self.views:
            true = poses.get(view.name)
            pose = view.camera_to_scan if true is None else self.truth.truth_to_scan @ true
            depth_m = view.depth_m
            if depth_m is not None:
                depth_m = depth_m / np.float32(scales.get(view.name, 1.0))
            yield replace(view, camera_to_scan=pose, depth_m=depth_m)


def stage_losses(out: Path, truth: Path, *, progress: Progress = no_progress) -> dict[str, Any]:
    """Return the scores of a run with ground truth inserted after each stage.

    Args:
        out: The folder of a finished run, which is not modified.
        truth: The folder of the capture with its ground truth.
        progress: Called with the stage ``truth``.

    Returns:
        The results of ``score_run`` by the stage after which the ground truth was inserted.

    Raises:
        InputError: If a file of the run or of the ground truth is missing or damaged.
    """
    case = open_case(out, truth)
    facts = {}
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        for done, stage in enumerate(AFTER):
            progress("truth", done, len(AFTER), stage)
            _PUT_IN[stage](case, work)
            facts[stage] = score_run(work, case.room)
    progress("truth", len(AFTER), len(AFTER))
    return facts


def allowed_cells(out: Path, truth: Path) -> dict[str, Any]:
    """Return the cell scores that a run's labelling stage achieves with true geometry.

    The result equals that of ``stage_losses`` after fusion, without running the stages after
    labels.
    """
    case = open_case(out, truth)
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        _write_true_evidence(case, work)
        FILE_STAGES["label"](work, case.parameters)
        grid, _ = read_room(work / "room.npz")
    return cell_facts(grid, case.room)


@dataclass(frozen=True, eq=False)
class Case:
    """A run prepared for the insertion of ground truth.

    Attributes:
        parameters: The parameters of the run.
        scan: The scan in the true frame.
        room: The ground truth.
    """

    parameters: Parameters
    scan: Scan
    room: TrueRoom


def open_case(out: Path, truth: Path) -> Case:
    """Open the capture of a run in the true frame.

    Raises:
        InputError: If a file of the run or of the ground truth is missing or damaged.
    """
    known = truth_of_run(out, truth)
    parameters = recorded_parameters(out)
    frames = used_frames(out, known)
    scan_to_room = invert_rigid(known.truth_to_scan)
    scan = open_scan(known.capture, voxel_m=parameters.voxel_m, options=parameters.capture)
    true_scan = replace(
        scan,
        views=TrueViews(scan.views, known),
        scan_to_room=scan_to_room,
        room_size_m=_true_size(known, scan.room_size_m),
        frames_used=tuple(frame.name for frame in frames),
    )
    room = see_truth(known, frames, scan_to_room, parameters.voxel_m)
    return Case(parameters, true_scan, room)


def _true_size(truth: Truth, otherwise: np.ndarray) -> np.ndarray:
    """Return the size of the box around all true rooms, from the origin of the frame."""
    if not truth.layouts:
        return otherwise
    corners = np.concatenate([layout.floor_polygon_m for layout in truth.layouts])
    top = max(layout.floor_z_m + layout.wall_height_m for layout in truth.layouts)
    return np.array([*corners.max(axis=0), top])


def _after_alignment(case: Case, work: Path) -> None:
    views = predictor(case.parameters.predictor, case.parameters.occupy).predict(case.scan)
    write_scan(work / "scan.json", case.scan)
    write_evidence(work / "evidence.npz", fuse_views(views, case.scan, case.parameters.fuse))
    _go_on(case, work, "label")


def _after_fusion(case: Case, work: Path) -> None:
    _write_true_evidence(case, work)
    _go_on(case, work, "label")


def _write_true_evidence(case: Case, work: Path) -> None:
    write_scan(work / "scan.json", case.scan)
    evidence = true_evidence(case.room, case.scan.views, case.scan.scan_to_room)
    write_evidence(work / "evidence.npz", evidence)


def _after_labels(case: Case, work: Path) -> None:
    put_true_labels(work, case.room)
    write_layouts(work / "layout.json", case.room.truth.layouts)
    _go_on(case, work, "find")


def _after_instances(case: Case, work: Path) -> None:
    put_true_objects(work, case.room)
    _go_on(case, work, "furnish")


def _after_templates(case: Case, work: Path) -> None:
    put_true_placements(work)
    _go_on(case, work, "build")


# Each continues after the one before it, so truth after a stage includes that of earlier ones.
_PUT_IN: dict[str, Callable[[Case, Path], None]] = {
    "alignment": _after_alignment,
    "fusion": _after_fusion,
    "labels": _after_labels,
    "instances": _after_instances,
    "templates": _after_templates,
}


def _go_on(case: Case, work: Path, first: str) -> None:
    """Run the real stages, starting with ``first``."""
    names = list(FILE_STAGES)
    for name in names[names.index(first) :]:
        FILE_STAGES[name](work, case.parameters)

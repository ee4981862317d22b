"""Truth put in after each stage: what it must then score, and that the rest is the real way."""

import numpy as np
import pytest

from world2minecraft.capture import open_scan
from world2minecraft.evaluation.scoring import evaluate_reconstruction
from world2minecraft.evaluation.scoring.oracle_stages import true_evidence
from world2minecraft.evaluation.scoring.stage_losses import (
    AFTER,
    TrueViews,
    allowed_cells,
    open_case,
    recorded_parameters,
    stage_losses,
)
from world2minecraft.evaluation.scoring.truth_files import read_truth
from world2minecraft.evaluation.scoring.used_frames import used_frames
from world2minecraft.reconstruction.fusion import extract_grid
from world2minecraft.reconstruction.parameters import Parameters, with_settings
from world2minecraft.reconstruction.pipeline import reconstruct


@pytest.fixture(scope="module")
def run(tmp_path_factory, capture):
    out = tmp_path_factory.mktemp("run")
    reconstruct(capture, out, Parameters(labeller="votes"))
    return out


@pytest.fixture(scope="module")
def stages(run, capture):
    return stage_losses(run, capture)


def test_every_stage_is_there_in_order_with_every_score(run, capture, stages):
    assert tuple(stages) == AFTER
    found = evaluate_reconstruction(run, capture)
    for facts in stages.values():
        assert facts.keys() == found.keys()
        assert facts["layout"] and facts["world"], "the run went on to its end"


def test_truth_put_in_scores_full_marks_from_there_on(stages):
    for name in AFTER[2:]:
        assert stages[name]["occupancy"]["iou"] == 1.0
        assert stages[name]["occupancy"]["label_accuracy"] == 1.0
        assert stages[name]["openings"]["f1"] == 1.0
    for name in AFTER[3:]:
        assert stages[name]["objects"]["f1"] == 1.0
        assert stages[name]["objects"]["orientation_right"] == 1.0
    for name in AFTER:
        error = stages[name]["frame_error"]
        assert max(abs(value) for value in error.values()) < 1e-6


def test_true_evidence_reads_out_as_the_truth(run, capture):
    case = open_case(run, capture)
    evidence = true_evidence(case.room, case.scan.views, case.scan.scan_to_room)
    grid = extract_grid(evidence)
    known = case.room.reached.scored & (case.room.labels != 255)
    assert np.array_equal(grid.labels != 255, known)
    assert np.array_equal((grid.labels > 0)[known], (case.room.labels > 0)[known])
    # The label images are right, so that votes are, but where cells hold two classes.
    occupied = known & (case.room.labels > 0)
    assert (grid.labels == case.room.labels)[occupied].mean() > 0.9
    assert (evidence.hits > 0)[occupied].all()
    inside = np.abs(evidence.offset_sum / np.maximum(evidence.hits, 1)[..., None])
    assert inside.max() < evidence.voxel_m


def test_what_geometry_allows_is_what_truth_after_fusion_scores(run, capture, stages):
    allowed = allowed_cells(run, capture)
    assert allowed["occupancy"] == stages["fusion"]["occupancy"]


def test_the_run_is_left_as_it_is(run, capture):
    before = {path: path.stat().st_mtime_ns for path in run.rglob("*") if path.is_file()}
    allowed_cells(run, capture)
    assert {path: path.stat().st_mtime_ns for path in run.rglob("*") if path.is_file()} == before


def test_true_views_undo_poses_and_scales(capture):
    truth = read_truth(capture)
    scan = open_scan(capture)
    wrong = type(truth)(
        **{**truth.__dict__, "depth_scale": {name: 1.25 for name in truth.camera_to_truth or ()}}
    )
    views = TrueViews(scan.views, wrong)
    assert len(views) == len(scan.views)
    for stated, true in zip(scan.views, views, strict=True):
        assert np.allclose(true.depth_m * 1.25, stated.depth_m)
        assert np.allclose(true.camera_to_scan, stated.camera_to_scan, atol=1e-9)


def test_parameters_of_a_run_are_read_back(tmp_path, run):
    from world2minecraft.core.files import write_json

    chosen = with_settings(Parameters(labeller="votes"), ["find.cluster_radius=3", "voxel_m=0.1"])
    write_json(tmp_path / "manifest.json", {"parameters": chosen.as_json()})
    assert recorded_parameters(tmp_path) == chosen
    assert recorded_parameters(run) == Parameters(labeller="votes")


def test_frames_are_those_of_the_run(run, capture):
    frames = used_frames(run, read_truth(capture))
    assert [frame.name for frame in frames] == [f"f{n}" for n in range(5)]

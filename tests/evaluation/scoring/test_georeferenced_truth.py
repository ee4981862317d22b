"""Ground truth and results in the coordinates of a georeferenced capture move with it."""

import json
import shutil

import numpy as np
import pytest

from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.files import npz_array_names, read_npz, write_npz
from world2minecraft.evaluation.scoring import evaluate_reconstruction, read_truth
from world2minecraft.evaluation.scoring.other_methods import evaluate_foreign
from world2minecraft.evaluation.scoring.used_frames import move_truth
from world2minecraft.formats.run_arrays import read_room

SURVEY = np.eye(4)
SURVEY[:3, 3] = 450_000.0, 5_400_000.0, 100.0


@pytest.fixture(scope="module")
def survey(capture, tmp_path_factory):
    """The capture in the coordinates of a survey."""
    far = tmp_path_factory.mktemp("survey") / "far"
    shutil.copytree(capture, far)
    path = far / "capture.json"
    stated = json.loads(path.read_text())
    for frame in stated["frames"]:
        pose = np.reshape(frame["camera_to_world"], (4, 4))
        frame["camera_to_world"] = (SURVEY @ pose).tolist()
    path.write_text(json.dumps(stated))
    path = far / "truth.npz"
    arrays = read_npz(path, npz_array_names(path))
    arrays["truth_room_to_scan"] = SURVEY @ arrays["truth_room_to_scan"]
    write_npz(path, arrays)
    return far


def test_a_run_of_a_survey_has_the_scores_of_a_near_one(perfect, capture, survey, tmp_path):
    run = tmp_path / "run"
    shutil.copytree(perfect, run)
    stated = json.loads((run / "scan.json").read_text())
    stated["source_to_scan"] = invert_rigid(SURVEY).tolist()
    (run / "scan.json").write_text(json.dumps(stated))
    near, far = evaluate_reconstruction(perfect, capture), evaluate_reconstruction(run, survey)
    assert near["occupancy"]["iou"] > 0.99
    assert far["headline"] == pytest.approx(near["headline"], abs=1e-3)


@pytest.mark.parametrize("is_corner_far", [False, True])
def test_labels_of_others_move_too(is_corner_far, perfect, capture, survey, tmp_path):
    grid, scan_to_room = read_room(perfect / "room.npz")
    to_survey, origin_m = SURVEY @ invert_rigid(scan_to_room), grid.origin_m
    if is_corner_far:  # The frame of the grid is the survey turned.
        to_survey, origin_m = to_survey.copy(), origin_m + to_survey[:3, :3].T @ to_survey[:3, 3]
        to_survey[:3, 3] = 0
    scores = []
    for place, to_scan, corner_m in (
        (capture, invert_rigid(scan_to_room), grid.origin_m),
        (survey, to_survey, origin_m),
    ):
        write_npz(
            tmp_path / "labels.npz",
            {"labels": grid.labels, "voxel_m": np.array(grid.voxel_m), "origin_m": corner_m,
             "grid_to_scan": to_scan},
        )  # fmt: skip
        scores.append(evaluate_foreign(tmp_path / "labels.npz", place))
    near, far = scores
    assert near["occupancy"]["iou"] > 0.9
    assert far["headline"] == pytest.approx(near["headline"], abs=1e-3)


def test_a_truth_of_moved_poses_is_not_moved(capture, survey):
    known, to_scan = read_truth(capture), invert_rigid(SURVEY)
    moved = move_truth(read_truth(survey), to_scan)
    np.testing.assert_allclose(moved.truth_to_scan, known.truth_to_scan, atol=1e-6)
    for one, by in ((known, to_scan), (moved, to_scan), (known, np.eye(4))):
        np.testing.assert_array_equal(move_truth(one, by).truth_to_scan, one.truth_to_scan)

"""The benchmark for any method: captures apart from their truths, and results scored by name."""

import json
from dataclasses import replace

import numpy as np
import pytest
from benchmarks import scan_benchmark

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.files import read_json
from world2minecraft.evaluation.metrics.truth_resampling import carry_truth
from world2minecraft.evaluation.scoring import read_truth
from world2minecraft.procgen.benchmark_trials import find_trial

NAME, VOXEL_M = "noise-500", 0.08


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """One tuning trial, with few frames, as ``write`` leaves it."""
    place = tmp_path_factory.mktemp("benchmark")
    scan_benchmark.write_captures([replace(find_trial(NAME), frames=8)], place)
    return place


def write_result(place, truth, **arrays):
    """Write the truth itself as another method would: a grid of its own, and its objects."""
    place.mkdir(parents=True)
    shape = tuple(-(-side // 4) + 1 for side in truth.labels.shape)
    labels = carry_truth(
        truth.labels, truth.voxel_m, truth.origin_m, np.eye(4), shape, truth.origin_m, VOXEL_M
    )
    made = {"labels": labels, "origin_m": truth.origin_m, "grid_to_scan": truth.truth_to_scan}
    np.savez(place / "labels.npz", **made | arrays)
    stated = read_json(truth.folder / "truth.json")["objects"]
    keys = ("class", "center_m", "size_m", "yaw_deg")
    (place / "objects.json").write_text(json.dumps([{k: o[k] for k in keys} for o in stated]))


def test_a_capture_holds_nothing_of_its_truth(folder):
    capture = folder / "captures" / NAME
    names = {path.name for path in capture.rglob("*") if path.is_file()}
    assert not {"truth.npz", "truth.json", "layout.json"} & names
    assert len(find_capture(capture).frames) == 8
    assert sorted(path.name for path in (folder / "truth" / NAME).iterdir()) == [
        "truth.json", "truth.npz",
    ]  # fmt: skip
    assert read_truth(folder / "truth" / NAME).capture.resolve() == capture.resolve()
    assert sorted(path.name for path in folder.iterdir()) == ["captures", "truth"]


def test_what_is_there_is_not_made_again(folder, monkeypatch):
    monkeypatch.setattr(scan_benchmark, "write_trial", lambda *words: pytest.fail("made again"))
    scan_benchmark.write_captures([find_trial(NAME)], folder)


def test_the_truth_given_as_a_result_scores_about_one(folder, tmp_path, capsys):
    truth = read_truth(folder / "truth" / NAME)
    write_result(tmp_path / NAME, truth)
    assert (
        scan_benchmark.main(
            ["score", str(folder), str(tmp_path), "--json", str(tmp_path / "scores.json")]
        )
        == 0
    )
    (row,) = read_json(tmp_path / "scores.json")
    assert (row["trial"], row["difficulty"], row["labels"]) == (NAME, "noise", "given")
    assert row["surface_within_one_voxel"] == {"precision": 1.0, "recall": 1.0}
    assert row["occupancy"]["iou"] > 0.98 and row["free_recall"] > 0.99
    assert row["objects"]["f1"] == 1.0 and row["objects"]["orientation_right"] == 1.0
    assert row["voxel_m"] == VOXEL_M and "calibration" not in row
    assert "noise (1)" in capsys.readouterr().out


def test_the_phase_of_the_grid_is_free_a_wrong_frame_is_not(folder, tmp_path):
    """The same cells, said in a frame that is a quarter turn and some centimetres away."""
    truth = read_truth(folder / "truth" / NAME)
    write_result(tmp_path / "plain" / NAME, truth)
    held = dict(np.load(tmp_path / "plain" / NAME / "labels.npz"))
    shift = np.eye(4)
    shift[:3, 3] = [0.031, -0.5, 0.007]
    moved = {
        "origin_m": held["origin_m"] + shift[:3, 3],
        "grid_to_scan": held["grid_to_scan"] @ invert_rigid(shift),
        "confidence": np.full(held["labels"].shape, 0.75),
    }
    write_result(tmp_path / "moved" / NAME, truth, **moved)
    rows = json.loads((tmp_path / "moved" / NAME / "objects.json").read_text())
    for one in rows:
        one["center_m"] = (np.array(one["center_m"]) + shift[:3, 3]).tolist()
    (tmp_path / "moved" / NAME / "objects.json").write_text(json.dumps(rows))
    (plain,) = scan_benchmark.score_results(folder, tmp_path / "plain")
    (other,) = scan_benchmark.score_results(folder, tmp_path / "moved")
    for name in ("iou", "miou"):
        assert other["occupancy"][name] == pytest.approx(plain["occupancy"][name], abs=0.02)
    assert other["objects"]["f1"] == 1.0
    # All that it is sure of to three quarters is right.
    assert other["calibration"]["all"]["error"] == pytest.approx(0.25, abs=0.03)
    write_result(tmp_path / "wrong" / NAME, truth, grid_to_scan=np.eye(4))
    (wrong,) = scan_benchmark.score_results(folder, tmp_path / "wrong")
    assert wrong["occupancy"]["iou"] < 0.3 and wrong["objects"]["f1"] < 0.3


@pytest.mark.parametrize(
    ("arrays", "objects", "message"),
    [
        ({"labels": np.full((2, 2, 2), 12)}, "[]", "does not contain a valid grid of class ids"),
        ({"labels": np.zeros((2, 2))}, "[]", "does not contain a valid grid of class ids"),
        ({"grid_to_scan": np.eye(4) * 2}, "[]", "grid_to_scan must be a rotation and a transl"),
        ({"origin_m": np.zeros(2)}, "[]", "origin_m"),
        ({"voxel_m": 0.0}, "[]", "voxel_m"),
        ({"voxel_m": 0.01}, "[]", "voxel size of 0.01 m is smaller than the ground truth's 0.02"),
        ({}, "{}", "must contain a list of {class, center_m, size_m, yaw_deg}"),
        (
            {},
            '[{"class": "chiar"}]',
            "row 0 is not a valid {class, center_m, size_m, yaw_deg} (no class is",
        ),
    ],
)
def test_a_result_that_is_none_is_told_in_one_line(
    folder, tmp_path, capsys, arrays, objects, message
):
    result = tmp_path / NAME
    result.mkdir()
    np.savez(result / "labels.npz", **{"labels": np.zeros((2, 2, 2), np.uint8)} | arrays)
    (result / "objects.json").write_text(objects)
    assert scan_benchmark.main(["score", str(folder), str(tmp_path)]) == 3
    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1


def test_what_is_lacking_is_named(folder, tmp_path, capsys):
    assert scan_benchmark.main(["score", str(tmp_path), str(tmp_path)]) == 3
    assert "make them: python -m benchmarks.scan_benchmark write" in capsys.readouterr().err
    assert scan_benchmark.main(["score", str(folder), str(tmp_path)]) == 3
    assert f"holds no result; {NAME}/labels.npz would be one" in capsys.readouterr().err
    (tmp_path / NAME).mkdir()
    np.save(tmp_path / NAME / "labels.npy", np.zeros((2, 2, 2), np.uint8))
    assert scan_benchmark.main(["score", str(folder), str(tmp_path), "--stages"]) == 2
    assert "is no run of w2m reconstruct; leave --stages out" in capsys.readouterr().err

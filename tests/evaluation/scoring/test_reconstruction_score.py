"""Scores of runs whose scores are known: a perfect one, shifted ones, one that lost an object."""

import shutil
from dataclasses import replace

import numpy as np
import pytest
from true_rooms import OBJECTS, VOXEL_M, write_capture, write_perfect

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.files import read_json, read_npz, write_json, write_npz
from world2minecraft.evaluation.scoring import evaluate_reconstruction
from world2minecraft.formats.objects_and_placements import read_objects, write_objects
from world2minecraft.formats.run_arrays import read_room, write_room


def copied(run, tmp_path):
    return shutil.copytree(run, tmp_path / "run")


def test_a_perfect_reconstruction_scores_one(perfect, capture):
    facts = evaluate_reconstruction(perfect, capture)
    assert facts["occupancy"]["iou"] == 1.0
    assert facts["occupancy"]["miou_present_classes"] == 1.0
    assert facts["surface_within_one_voxel"] == {"precision": 1.0, "recall": 1.0}
    assert facts["free_recall"] == 1.0
    assert facts["objects"]["f1"] == 1.0 and facts["objects"]["orientation_right"] == 1.0
    assert facts["calibration"]["all"]["error"] == 0.0
    error = facts["frame_error"]
    assert max(abs(value) for value in error.values()) < 1e-5
    assert facts["poses"]["stated"]["mean_mm"] < 1e-6
    assert facts["headline"]["object F1"] == "1.00"
    assert facts["layout"] == {} and facts["world"] == {}, "it was neither furnished nor built"


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_frame_off_by_a_centimetre_costs_exact_iou_alone(capture, tmp_path, axis):
    shift = np.zeros(3)
    shift[axis] = 0.012
    facts = evaluate_reconstruction(write_perfect(tmp_path, capture, shift), capture)
    assert facts["occupancy"]["iou"] < 0.95
    assert facts["surface_within_one_voxel"] == {"precision": 1.0, "recall": 1.0}
    moved = [facts["frame_error"][name] for name in ("walls_x_m", "walls_y_m", "floor_m")]
    assert moved == pytest.approx(shift, abs=1e-6)


def test_a_frame_turned_by_a_quarter_is_no_error(perfect, capture, tmp_path):
    out = copied(perfect, tmp_path)
    grid, scan_to_room = read_room(out / "room.npz")
    turn = np.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    turned = {
        name: np.rot90(getattr(grid, name), 1, axes=(0, 1)).copy()
        for name in ("labels", "confidence", "colour", "source", "instance")
    }
    far_y = grid.origin_m[1] + grid.shape[1] * VOXEL_M
    origin_m = np.round(np.array([-far_y, *grid.origin_m[[0, 2]]]) / VOXEL_M) * VOXEL_M
    again = replace(grid, **turned, origin_m=origin_m)
    write_room(out / "room.npz", again, turn @ scan_to_room)
    facts = evaluate_reconstruction(out, capture)
    # A ray along the edge of two cells may fall to either side.
    assert facts["occupancy"]["iou"] > 0.995
    assert max(facts["frame_error"]["tilt_deg"], facts["frame_error"]["yaw_deg"]) < 1e-5


def test_what_was_found_beyond_the_truth_costs_precision(perfect, capture, tmp_path):
    out = copied(perfect, tmp_path)
    grid, scan_to_room = read_room(out / "room.npz")
    padded = {
        name: np.pad(getattr(grid, name), [(0, 40), (0, 0), (0, 0)])
        for name in ("labels", "confidence", "source", "instance")
    }
    padded["colour"] = np.pad(grid.colour, [(0, 40), (0, 0), (0, 0), (0, 0)])
    padded["labels"][-40:] = 255
    padded["labels"][-1, :10, 0], padded["source"][-1, :10, 0] = 3, 1
    write_room(out / "room.npz", replace(grid, **padded), scan_to_room)
    before = evaluate_reconstruction(perfect, capture)
    facts = evaluate_reconstruction(out, capture)
    found = int((grid.occupied).sum())
    precision = facts["surface_within_one_voxel"]["precision"]
    assert precision == pytest.approx(found / (found + 10))
    assert facts["occupancy"] == before["occupancy"]


def test_errors_are_counted_where_they_are(perfect, capture, tmp_path):
    out = copied(perfect, tmp_path)
    grid, scan_to_room = read_room(out / "room.npz")
    labels, source = grid.labels.copy(), grid.source.copy()
    for class_id, wrong, count in ((8, 0, 5), (3, 255, 4), (0, 11, 3)):
        cells = np.argwhere(grid.labels == class_id)[:count]
        labels[tuple(cells.T)], source[tuple(cells.T)] = wrong, wrong != 255
    write_room(out / "room.npz", replace(grid, labels=labels, source=source), scan_to_room)
    errors = evaluate_reconstruction(out, capture)["errors"]
    assert errors == {
        "called_free": 5,
        "left_unknown": 4,
        "called_occupied": 3,
        "missed_by_class": {"wall": 4, "table": 5},
        "added_by_class": {"objs": 3},
    }


def test_objects_are_counted_by_class_and_turn(perfect, capture, tmp_path):
    out = copied(perfect, tmp_path)
    grid, _ = read_room(out / "room.npz")
    desk, chair = read_objects(out / "objects.json", grid)
    write_objects(out / "objects.json", (replace(chair, yaw_deg=90.0),))
    objects = evaluate_reconstruction(out, capture)["objects"]
    assert (objects["found"], objects["true"], objects["matched"]) == (1, len(OBJECTS), 1)
    assert objects["f1"] == pytest.approx(2 / 3) and objects["recall"] == 0.5
    assert objects["orientation_asked"] == 1 and objects["orientation_hits"] == 0
    assert objects["by_class"]["table"] == {"found": 0, "true": 1, "matched": 0, "f1": 0.0}
    assert desk.class_id == 8


def test_an_object_that_no_ray_met_is_not_asked_for(perfect, capture, tmp_path):
    """The truth gets a third object, within the table, where nobody can see it."""
    hidden = shutil.copytree(capture, tmp_path / "capture")
    stated = read_json(hidden / "truth.json")
    row = dict(stated["objects"][0], id=3, **{"class": "objs"})
    write_json(hidden / "truth.json", stated | {"objects": [*stated["objects"], row]})
    facts = evaluate_reconstruction(perfect, hidden)
    assert facts["objects"]["true"] == 2 and facts["objects"]["f1"] == 1.0


def test_true_poses_score_and_old_truths_use_stated_ones(tmp_path):
    """Stated poses are off by 10 cm; a truth without true poses believes them."""
    off = write_capture(tmp_path / "off", pose_off_m=0.1)
    run = write_perfect(tmp_path / "run", off)
    facts = evaluate_reconstruction(run, off)
    assert facts["occupancy"]["iou"] == 1.0
    assert facts["poses"]["stated"]["mean_mm"] == pytest.approx(100)
    assert facts["poses"]["stated"]["apart_mm"] == pytest.approx(0, abs=1e-6)
    names = ("labels", "instance", "voxel_m", "origin_m", "truth_room_to_scan")
    write_npz(off / "truth.npz", read_npz(off / "truth.npz", names))
    old = evaluate_reconstruction(run, off)
    assert old["poses"] == {}
    assert old["occupancy"]["cells"] != facts["occupancy"]["cells"]


def test_corrected_poses_are_told_beside_the_stated(perfect, capture, tmp_path):
    out = copied(perfect, tmp_path)
    change = np.repeat(np.eye(4)[None], 5, axis=0)
    change[:, 2, 3] = [0.01, -0.01, 0.01, -0.01, 0.0]
    write_npz(
        out / "poses.npz",
        {
            "names": np.array([f"f{n}" for n in range(5)]),
            "pose_change": change,
            "depth_scale": np.array([1.0, 1.02, 0.98, 1.0, 1.0]),
        },
    )
    poses = evaluate_reconstruction(out, capture)["poses"]
    assert poses["corrected"]["mean_mm"] == pytest.approx(8.0)
    assert poses["corrected"]["scale_rms_percent"] == pytest.approx(100 * np.sqrt(2 * 4e-4 / 5))
    assert poses["stated"]["scale_rms_percent"] == 0.0


def test_files_that_do_not_belong_together_are_named(perfect, capture, tmp_path):
    out = copied(perfect, tmp_path)
    stated = read_json(out / "scan.json")
    write_json(out / "scan.json", stated | {"frames_used": ["f0", "f99"]})
    with pytest.raises(
        DamagedFileError, match=r"scan\.json: frame 'f99' was used, but .* does not contain it"
    ):
        evaluate_reconstruction(out, capture)
    with pytest.raises(InputError, match=r"truth\.npz: ground truth not found"):
        evaluate_reconstruction(perfect, tmp_path)

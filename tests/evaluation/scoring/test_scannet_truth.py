"""A ScanNet scene becomes a truth: against the room that it was written from, and damaged."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scannet_scenes as scenes
from scipy import ndimage
from true_rooms import FINE_M, fine_room, write_capture

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.cli import run as w2m
from world2minecraft.core.classes import CLASS_COUNT, STRUCTURE_CLASSES
from world2minecraft.core.files import write_json
from world2minecraft.core.types import OBSERVED, UNSEEN, ObjectInstance, OccupancyGrid
from world2minecraft.evaluation.metrics.truth_resampling import carry_truth
from world2minecraft.evaluation.scoring import Truth, evaluate_reconstruction, read_truth
from world2minecraft.evaluation.scoring.observed_cells import reached_cells
from world2minecraft.evaluation.scoring.scannet.labelled_mesh import (
    LabelledMesh,
    read_labelled_mesh,
)
from world2minecraft.evaluation.scoring.scannet.scannet_truth import seen_free, surface_voxels
from world2minecraft.evaluation.scoring.truth_files import read_instances
from world2minecraft.evaluation.scoring.used_frames import all_frames
from world2minecraft.formats.objects_and_placements import write_objects
from world2minecraft.formats.run_arrays import write_room

VOXEL_M = 0.08
NAME, CUBE = scenes.NAME, np.ones((3, 3, 3), bool)


@pytest.fixture(scope="module")
def room():
    return scenes.small_room()


@pytest.fixture(scope="module")
def scene(tmp_path_factory, room):
    return scenes.write_scene(tmp_path_factory.mktemp("scans") / NAME, room)


@pytest.fixture(scope="module")
def truth_folder(tmp_path_factory, scene):
    folder = tmp_path_factory.mktemp("truths")
    assert w2m(["evaluate", "scannet", str(scene.parent), "--out", str(folder)]) == 0
    return folder / NAME


@pytest.fixture(scope="module")
def found(truth_folder):
    """What the truth says of each voxel of the room: labels, instances."""
    truth = read_truth(truth_folder)
    # Both grids are of 2 cm, and the alignment moves by whole voxels, but for the floor's height.
    moved = np.linalg.inv(truth.truth_to_scan) @ scenes.room_to_scan(scenes.SEED)
    np.testing.assert_allclose(moved[:3, :3], np.eye(3), atol=1e-5)
    np.testing.assert_allclose(moved[:3, 3], [*scenes.LIFT_M[:2], 0], atol=1e-4)
    return truth, read_instances(truth), moved[:3, 3]


def in_room(values, truth, moved, room, fill):
    """Values of the truth's voxels in the room's grid; ``fill`` where the truth has none."""
    start = np.round((room.origin_m + moved - truth.origin_m) / 0.02).astype(int)
    cells = np.argwhere(np.ones(room.labels.shape, bool)) + start
    inside = ((cells >= 0) & (cells < values.shape)).all(axis=1)
    result = np.full(len(cells), fill, values.dtype)
    result[inside] = values[tuple(cells[inside].T)]
    return result.reshape(room.labels.shape)


def test_the_truth_is_the_rooms_own_within_one_voxel(room, found):
    truth, _, moved = found
    labels = in_room(truth.labels, truth, moved, room, 255)
    touched = (skin(room) != 255) & (room.labels > 0)
    assert set(np.unique(labels[labels != 255])) == set(np.unique(room.labels))
    for number in range(1, CLASS_COUNT):
        said, true = labels == number, room.labels == number
        assert not (said & ~ndimage.binary_dilation(true, CUBE)).any()
        assert not (true & touched & ~ndimage.binary_dilation(said, CUBE)).any()
    assert (labels == room.labels)[touched].mean() > 0.99


def test_only_cells_seen_through_are_free(room, found):
    truth, _, moved = found
    labels = in_room(truth.labels, truth, moved, room, 255)
    air = room.labels == 0
    assert not (labels == 0)[~air].any()
    assert (labels[air] == 0).mean() > 0.7
    deep = ~ndimage.binary_dilation(air, CUBE, iterations=2)
    assert deep.any() and (labels[deep] == 255).all()


def test_objects_are_boxes_around_what_was_scanned_of_each(room, found):
    truth, instance, moved = found
    by_name = {}
    for n, item in enumerate(truth.objects, start=1):
        cells = np.argwhere(instance == n)
        low, high = (truth.origin_m + 0.02 * c for c in (cells.min(axis=0), cells.max(axis=0) + 1))
        assert np.abs(item.center_m - (low + high) / 2).max() < 0.021
        by_name.setdefault(item.name, []).append(item)
    wanted = [item for item in room.objects if item.class_id not in STRUCTURE_CLASSES]
    wanted = [item for item in wanted if not item.name.startswith("door")]
    assert len(wanted) == len(truth.objects) > 5
    for item in wanted:
        places = [one.center_m - moved for one in by_name[item.name]]
        assert min(np.linalg.norm(place - item.center_m) for place in places) < 0.15


def skin(room):
    """The room's labels where air touches matter; what lies deeper is unknown."""
    air = room.labels == 0
    touched = ~air & ndimage.binary_dilation(air, ndimage.generate_binary_structure(3, 1))
    return np.where(air | touched, room.labels, 255).astype(np.uint8)


def write_run(out, room, *, fine=None, shift_cells=0, swap=False):
    """Write the run that knows the generated room, inside of walls and all, or ``fine`` of it."""
    shape = tuple(-(-side // 4) + 2 for side in room.labels.shape)
    origin_m = np.floor(room.origin_m / VOXEL_M) * VOXEL_M
    place = (np.eye(4), shape, origin_m, VOXEL_M)
    fine = room.labels if fine is None else fine
    labels = carry_truth(fine, room.voxel_m, room.origin_m, *place)
    labels = np.roll(labels, shift_cells, axis=0)
    if swap:
        chairs, tables = labels == 5, labels == 8
        labels[chairs], labels[tables] = 8, 5
    known = labels != 255
    grid = OccupancyGrid(
        labels, known.astype(np.float16), np.zeros((*shape, 3), np.uint8),
        np.where(known, OBSERVED, UNSEEN).astype(np.uint8), np.zeros(shape, np.uint16),
        VOXEL_M, origin_m,
    )  # fmt: skip
    out.mkdir()
    write_room(out / "room.npz", grid, np.linalg.inv(scenes.room_to_scan(scenes.SEED)))
    write_json(out / "scan.json", {"frames_used": [f"{n:06d}" for n in range(30)]})
    objects = [item for item in room.objects if not item.name.startswith("door")]
    cell = np.zeros((1, 3), np.int32)
    rows = [
        ObjectInstance(n, one.class_id, one.center_m, one.size_m, one.yaw_deg, cell, 1.0)
        for n, one in enumerate(objects, start=1)
        if one.class_id not in STRUCTURE_CLASSES
    ]
    write_objects(out / "objects.json", tuple(rows))
    return out


def test_the_room_itself_scores_about_one(room, truth_folder, tmp_path):
    facts = evaluate_reconstruction(write_run(tmp_path / "out", room), truth_folder)
    assert facts["surface_within_one_voxel"] == {"precision": 1.0, "recall": 1.0}
    assert facts["occupancy"]["iou"] > 0.999 and facts["free_recall"] > 0.999
    assert facts["objects"]["f1"] > 0.95
    assert facts["objects"]["orientation_asked"] == 0, "nobody knows which way things look"
    assert facts["frame_error"]["tilt_deg"] < 0.01 and abs(facts["frame_error"]["floor_m"]) < 1e-3
    assert "openings" not in facts and facts["poses"] == {}


def test_its_surface_has_the_classes_too(room, truth_folder, tmp_path):
    """Of the solid room, a cell that two classes share goes to the one with more volume."""
    solid = evaluate_reconstruction(write_run(tmp_path / "solid", room), truth_folder)
    out = write_run(tmp_path / "skin", room, fine=skin(room))
    facts = evaluate_reconstruction(out, truth_folder)
    assert facts["occupancy"]["miou_present_classes"] > 0.97
    assert facts["occupancy"]["label_accuracy"] > 0.99 > solid["occupancy"]["label_accuracy"] > 0.9


def test_a_wrong_reconstruction_does_not(room, truth_folder, tmp_path):
    right = evaluate_reconstruction(write_run(tmp_path / "right", room), truth_folder)
    moved = evaluate_reconstruction(
        write_run(tmp_path / "moved", room, shift_cells=3), truth_folder
    )
    assert moved["occupancy"]["iou"] < 0.6
    assert moved["surface_within_one_voxel"]["precision"] < 0.9
    assert moved["surface_within_one_voxel"]["recall"] < 0.9
    swapped = evaluate_reconstruction(
        write_run(tmp_path / "swapped", room, swap=True), truth_folder
    )
    assert swapped["occupancy"]["iou"] == right["occupancy"]["iou"]
    assert swapped["occupancy"]["class_iou"]["chair"] == 0.0
    assert right["occupancy"]["class_iou"]["chair"] > 0.9


def test_what_the_mesh_lacks_and_the_sensor_saw_is_not_free(tmp_path):
    truth = read_truth(write_capture(tmp_path))
    labels, instance = fine_room()
    table = instance == 1
    surface = (labels > 0) & ~table
    partial = replace(truth, labels=np.where(surface, labels, 255), surface=surface)
    free = seen_free(partial)
    assert free[labels == 0].mean() > 0.5 and not free[surface].any()
    # Nearer to what the rays end at, the two may differ by as much as the sensor errs.
    far = table & (ndimage.distance_transform_edt(~surface) * FINE_M > 0.2)
    assert not free[far].any()
    blind = reached_cells(
        partial, all_frames(partial, find_capture(partial.capture)), np.eye(4), FINE_M
    )
    start = np.round(truth.origin_m / FINE_M).astype(int) - blind.low
    box = tuple(slice(a, a + side) for a, side in zip(start, labels.shape, strict=True))
    assert blind.flags[box][far].any(), "rays of the mesh alone pass where the table stands"


def box_mesh(turned: bool) -> LabelledMesh:
    """A floor and a wall, their faces between two voxels."""
    floor = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 0, 0), (1, 1, 0), (0, 1, 0)]
    wall = [(0, 0, 0), (0, 1, 0), (0, 1, 1), (0, 0, 0), (0, 1, 1), (0, 0, 1)]
    places = np.array(floor + wall, np.float64)
    corners = np.arange(12).reshape(-1, 3)
    classes = np.repeat(np.array([2, 3], np.uint8), 6)
    corners = corners[:, ::-1] if turned else corners
    return LabelledMesh("a", places, corners, classes, np.zeros(12, np.uint16), (), np.eye(4))


@pytest.mark.parametrize("turned", [False, True])
def test_a_face_between_two_voxels_fills_the_one_with_the_matter(turned):
    voxels = surface_voxels(box_mesh(turned), FINE_M)
    cells = np.argwhere(voxels.surface) + np.round(voxels.origin_m / FINE_M).astype(int)
    labels = voxels.labels[voxels.surface]
    floor, wall = cells[labels == 2], cells[labels == 3]
    assert (floor[:, 2] == -1).all() and (wall[:, 0] == -1).all()
    assert len(floor) == len(wall) == 50 * 50, "every voxel of the face, and none besides"


def tiny_scene(folder, labels=(2, 2, 2), **files):
    """One triangle and one group, or whatever ``files`` holds instead; None leaves one out."""
    folder.mkdir()
    places, faces = np.eye(3), np.array([[0, 1, 2]])
    scenes.write_ply(folder / f"{NAME}_vh_clean_2.labels.ply", places, faces, np.array(labels))
    texts = {
        "txt": "axisAlignment = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n",
        "segments": json.dumps({"segIndices": [4, 4, 4]}),
        "groups": json.dumps({"segGroups": [{"segments": [4], "label": "chair"}]}),
    } | files
    suffix = {
        "txt": ".txt",
        "segments": "_vh_clean_2.0.010000.segs.json",
        "groups": ".aggregation.json",
    }
    for kind, text in texts.items():
        if text is not None:
            (folder / f"{NAME}{suffix[kind]}").write_text(text)
    return folder


@pytest.mark.parametrize(
    ("files", "message"),
    [
        ({"txt": None}, f"{NAME}.txt: axisAlignment not found; scenes of the train and val splits"),
        ({"txt": "axisAlignment = 1 2 3\n"}, "axisAlignment must contain 16 numbers"),
        ({"txt": "axisAlignment = -1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"}, "must contain 16 numbers"),
        ({"segments": None}, "--type _vh_clean_2.0.010000.segs.json"),
        ({"segments": "[]"}, "the list segIndices is missing; copy the file again"),
        (
            {"segments": '{"segIndices": [1, 2]}'},
            ("segIndices has 2 entries, but the mesh has 3 vertices"),
        ),
        ({"segments": '{"segIndices": "abc"}'}, "segment IDs must be integers"),
        (
            {"groups": None},
            ("not found; download it with download-scannet.py --type .aggregation.json"),
        ),
        ({"groups": '{"segGroups": 3}'}, "the list segGroups is missing; copy the file again"),
        ({"groups": '{"segGroups": [{"label": "a"}]}'}, "group 0 has no segments"),
        ({"groups": '{"segGroups": [{"segments": [7]}]}'}, "group 0 refers to segments that"),
        ({"labels": (900, 2, 2)}, "put scannetv2-labels.combined.tsv beside the scene"),
        ({}, f"no frames found; add {NAME}.sens, or the exported folders color, depth and pose"),
    ],
)
def test_what_is_damaged_or_missing_is_named_in_one_line(tmp_path, capsys, files, message):
    folder = tiny_scene(tmp_path / NAME, **files)
    assert w2m(["evaluate", "scannet", str(folder), "--out", str(tmp_path / "truth")]) == 3
    error = capsys.readouterr().err
    lines = [line for line in error.splitlines() if message in line]
    assert len(lines) == 1, error
    assert not (tmp_path / "truth").exists()


def test_a_mesh_cut_short_and_a_folder_without_scenes_are_named(tmp_path, capsys):
    folder = tiny_scene(tmp_path / NAME)
    mesh = folder / f"{NAME}_vh_clean_2.labels.ply"
    mesh.write_bytes(mesh.read_bytes()[:-4])
    assert w2m(["evaluate", "scannet", str(folder)]) == 3
    assert "is truncated or damaged" in capsys.readouterr().err
    (tmp_path / "empty").mkdir()
    assert w2m(["evaluate", "scannet", str(tmp_path / "empty")]) == 3
    assert "give a ScanNet scene, or a folder of scenes" in capsys.readouterr().err


def test_raw_ids_are_read_through_the_table(tmp_path):
    folder = tiny_scene(tmp_path / NAME, labels=(900, 900, 1163))
    table = "id\traw_category\tnyu40id\n900\tchair\t5\n1163\tmat\t40\n"
    (tmp_path / "scannetv2-labels.combined.tsv").write_text(table)
    mesh = read_labelled_mesh(folder)
    assert mesh.classes.tolist() == [5, 5, 11]
    assert [(item.class_id, item.name) for item in mesh.objects] == [(5, "chair")]
    assert mesh.instance.tolist() == [1, 1, 1]


@pytest.mark.parametrize("name", ["door", "closet doors", "doorframe", "windows"])
def test_openings_are_no_objects(tmp_path, name):
    group = json.dumps({"segGroups": [{"segments": [4], "label": name}]})
    folder = tiny_scene(tmp_path / NAME, labels=(8, 8, 8), groups=group)
    assert read_labelled_mesh(folder).objects == ()


def test_a_truth_whose_surface_lacks_a_classed_voxel_is_refused():
    nowhere, labels = np.zeros((2, 2, 2), bool), np.full((2, 2, 2), 3, np.uint8)
    with pytest.raises(ValueError, match="surface must include every cell that has a class"):
        Truth(Path(), labels, 0.02, np.zeros(3), np.eye(4), (), surface=nowhere)

"""Predictions of other networks through the whole program, alone and beside depth."""

import json
from dataclasses import replace

import numpy as np
import pytest
from tests.reconstruction.occupancy.predicted_room import (
    ROOM,
    labels_at,
    scene_labels,
    views_of,
    write_predictions,
)

import world2minecraft as w2m
from world2minecraft.capture import write_plain
from world2minecraft.cli import run as cli
from world2minecraft.core.coordinates import apply, cell_centers_m, rotation_about_z
from world2minecraft.core.errors import UsageError
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.reconstruction.occupancy import PredictionParameters
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import manifest, reconstruct

ROOM_TO_SCAN = rotation_about_z(20.0)
ROOM_TO_SCAN[:3, 3] = [1.0, 2.0, 0.4]


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A capture with depth, one without, and predictions for both."""
    folder = tmp_path_factory.mktemp("predictions")
    views = views_of(10, ROOM_TO_SCAN, depth=True)
    write_plain(folder / "depth", views)
    bare = [replace(view, depth_m=None, depth_camera=None) for view in views]
    write_plain(folder / "photos", bare)
    for convention in ("monoscene", "embodiedocc"):
        write_predictions(folder / convention, views, ROOM_TO_SCAN, convention)
    labels, origin_m = scene_labels()
    ids = np.where(labels == 0, 12, np.where(labels == 255, 0, labels))
    np.savez(folder / "scene.npz", labels=ids, origin_m=origin_m, voxel_m=0.08,
             scan_to_room=np.linalg.inv(ROOM_TO_SCAN))  # fmt: skip
    return folder


def agreement(out) -> tuple[float, float]:
    """Return the share of right occupied cells, and of right classes among them."""
    grid, scan_to_room = read_room(out / "room.npz")
    cells = np.argwhere(grid.occupied)
    centers_m = cell_centers_m(cells, grid.origin_m, grid.voxel_m)
    to_true = np.linalg.inv(ROOM_TO_SCAN) @ np.linalg.inv(scan_to_room)
    true = labels_at(apply(to_true, centers_m))
    solid = (true > 0) & (true < 255)
    same = grid.labels[tuple(cells.T)] == true
    return float(solid.mean()), float(same[solid].mean())


def test_views_alone_become_a_world(place, tmp_path):
    """Photos with poses and the files of MonoScene: a room of the true size, class by class."""
    words = ["reconstruct", str(place / "photos"), "-o", str(tmp_path / "OUT")]
    assert cli([*words, "--predictions", str(place / "monoscene")]) == 0
    report = json.loads((tmp_path / "OUT" / "report.json").read_text())
    assert any(
        "10 of 10 views have predictions (monoscene" in note for note in report["scan"]["notes"]
    )
    solid, classes = agreement(tmp_path / "OUT")
    assert solid > 0.85 and classes > 0.9  # Turned grids: half cells at every surface.
    run = w2m.load(tmp_path / "OUT")
    size_m = json.loads((tmp_path / "OUT" / "scan.json").read_text())["room_size_m"]
    np.testing.assert_allclose(sorted(size_m), sorted(ROOM.size_m), atol=0.2)
    assert {one.class_name for one in run.objects} >= {"table"}
    assert (tmp_path / "OUT" / "build" / "world" / "level.dat").is_file()


def test_the_grid_of_a_scene_alone_keeps_its_labels(place, tmp_path):
    """Its cells are those of the room, so that fusion changes no label that it states."""
    chosen = Parameters(predictions=PredictionParameters(path=str(place / "scene.npz")))
    reconstruct(place / "photos", tmp_path / "OUT", chosen, until="label")
    solid, classes = agreement(tmp_path / "OUT")
    assert solid > 0.97 and classes > 0.95


def test_beside_depth_they_complete_and_name_what_it_shows(place, tmp_path):
    chosen = Parameters(labeller="votes")
    reconstruct(place / "depth", tmp_path / "plain", chosen, until="label")
    rules = PredictionParameters(path=str(place / "embodiedocc"))
    chosen = replace(chosen, predictions=rules)
    reconstruct(place / "depth", tmp_path / "both", chosen, until="label")
    solid, classes = agreement(tmp_path / "both")
    assert solid > 0.85 and classes > 0.95
    grids = [read_room(tmp_path / name / "room.npz")[0] for name in ("plain", "both")]
    counts = [int(grid.occupied.sum()) for grid in grids]
    assert counts[1] > 1.02 * counts[0], "what no ray reached is there too"


def test_the_manifest_knows_the_files_and_their_rules(place, tmp_path):
    ids = tmp_path / "ids.yaml"
    ids.write_text("[empty, wall]")
    with_files = Parameters(
        predictions=PredictionParameters(path=str(place / "monoscene"), classes=str(ids))
    )
    facts = manifest(place / "photos", None, with_files)
    assert facts["predictions"] and len(facts["networks"]) == 1
    assert facts["parameters"]["predictions"]["path"] == str(place / "monoscene")
    assert manifest(place / "photos", None, Parameters())["predictions"] is None
    other = Parameters(predictions=PredictionParameters(path=str(place / "embodiedocc")))
    assert manifest(place / "photos", None, other)["predictions"] != facts["predictions"]


def test_options_that_describe_no_predictions_are_refused(place, tmp_path):
    for options, message in (
        ({"convention": "iso"}, "classes and convention describe predictions; add some"),
        ({"predictions": place / "monoscene", "follow": True}, "follow cannot be combined with "),
        ({"predictions": place / "monoscene", "convention": "kitti"}, "no convention is named"),
        ({"predictions": place / "monoscene", "classes": "nyu21"}, "no class set is named 'nyu21'"),
    ):
        with pytest.raises(UsageError, match=message):
            w2m.reconstruct(place / "photos", tmp_path / "OUT", **options)
    assert not (tmp_path / "OUT").exists()


def test_poses_without_a_scale_cannot_place_grids(place, tmp_path):
    views = views_of(3, ROOM_TO_SCAN, depth=False)
    write_plain(tmp_path / "cap", views, stated={"scale": "unknown"})
    words = ["reconstruct", str(tmp_path / "cap"), "-o", str(tmp_path / "OUT")]
    assert cli([*words, "--predictions", str(place / "monoscene")]) == 3


def test_build_reads_the_ids_of_a_foreign_grid(tmp_path, capsys):
    labels, _ = scene_labels()
    ids = np.where(labels == 0, 12, np.where(labels == 255, 0, labels)).astype(np.uint8)
    np.save(tmp_path / "ours.npy", labels)
    np.save(tmp_path / "theirs.npy", ids)
    assert cli(["build", str(tmp_path / "theirs.npy"), "-o", str(tmp_path / "no")]) == 3
    assert "12, which is empty in EmbodiedOcc; set classes to embodied" in capsys.readouterr().err
    words = ["build", str(tmp_path / "theirs.npy"), "-o", str(tmp_path / "A")]
    assert cli([*words, "--classes", "embodied"]) == 0
    assert cli(["build", str(tmp_path / "ours.npy"), "-o", str(tmp_path / "B")]) == 0
    a, b = (read_room(tmp_path / one / "room.npz")[0] for one in "AB")
    assert np.array_equal(a.labels, b.labels) and np.array_equal(a.labels, labels)
    assert w2m.load(tmp_path / "A").blocks.states.any()
    assert cli(["build", str(tmp_path / "A"), "-o", str(tmp_path / "C"), "--classes", "nyu12"]) == 2

"""Another occupancy is laid on the document's cells, and nothing else is compared with."""

import io
from dataclasses import replace

import numpy as np
import pytest
from forge_serving import client, served, small_editor

from world2minecraft.editing.scene.scene_draft import ARRAYS
from world2minecraft.evaluation.scoring import evaluate_reconstruction
from world2minecraft.evaluation.scoring.score import (
    cell_facts,
    scored_beyond,
    scored_labels,
    see_truth,
)
from world2minecraft.evaluation.scoring.used_frames import truth_of_run, used_frames
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.sceneforge.array_messages import HEADER
from world2minecraft.sceneforge.comparison import Reference, read_file_labels
from world2minecraft.sceneforge.editor import Editor


def test_the_truth_is_masked_as_in_evaluate(small_run):
    editor = Editor.open(small_run)
    scored = evaluate_reconstruction(small_run, small_run / "capture")["occupancy"]
    found = editor.ask("compare", path="truth")
    assert found["iou"] == round(scored["iou"], 4)
    assert found["class_iou"] == {name: round(x, 4) for name, x in scored["class_iou"].items()}
    editor.close()


def test_true_cells_outside_the_scene_are_missed(small_run):
    truth = truth_of_run(small_run, small_run / "capture")
    grid, scan_to_room = read_room(small_run / "room.npz")
    room = see_truth(truth, used_frames(small_run, truth), scan_to_room, grid.voxel_m)
    cut = replace(grid, **{name: getattr(grid, name)[:, :-12] for name in ARRAYS})
    place = (cut.shape, cut.origin_m)
    reference = Reference(scored_labels(room, *place), scored_beyond(room, *place))
    assert reference.beyond[1:].sum() > 0
    scored = cell_facts(cut, room)["occupancy"]
    assert reference.counts(cut.labels).figures() == scored


def npy(labels) -> bytes:
    stream = io.BytesIO()
    np.save(stream, labels)
    return stream.getvalue()


def test_a_file_is_compared_over_http(tmp_path):
    editor = small_editor(folder=tmp_path / "OUT")
    labels = editor.draft.labels.copy()
    labels[3, 3, 3] = 8
    with served(editor, home=tmp_path / "home") as server, client(server) as script:
        assert script.get("/api/compare").json() == {"name": "", "has_truth": False, "beyond": []}
        assert "no comparison is open" in script.get("/api/compare/labels").json()["error"]
        sent = script.post("/api/upload/compare?name=a/pred.npy", content=npy(labels))
        assert sent.json() == {"name": "pred.npy", "has_truth": False, "beyond": [0] * 12}
        body = script.get("/api/compare/labels").content
        assert np.array_equal(np.frombuffer(body[HEADER.size :], np.uint8), labels.ravel())
        assert script.delete("/api/compare").json()["name"] == ""
        assert "only generated rooms" in script.post("/api/compare/truth").json()["error"]


def test_a_grid_of_embodiedocc_is_compared_by_its_own_ids(tmp_path):
    editor = small_editor(folder=tmp_path / "OUT")
    labels = editor.draft.labels
    theirs = np.where(labels == 0, 12, np.where(labels == 255, 0, labels))
    np.save(tmp_path / "theirs.npy", theirs)
    assert np.array_equal(read_file_labels(tmp_path / "theirs.npy", editor.draft), labels)


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("a.exe", b"x", "a.exe: unsupported file type"),
        ("a.npz", b"x", "a.npz: is not a readable .npz"),
        ("a.json", b"[" * 100_000, "a.json: is not JSON"),
        ("a.npy", npy(np.full((2, 2, 2), 77)), "a.npy: does not contain a valid grid of class ids"),
        (
            "a.npy",
            npy(np.full((2, 2, 2), 0.5)),
            "a.npy: does not contain a valid grid of class ids",
        ),
    ],
)
def test_files_that_are_none_say_so(tmp_path, name, data, words):
    with served(small_editor(), home=tmp_path) as server, client(server) as script:
        answer = script.post("/api/upload/compare", params={"name": name}, content=data)
    assert answer.status_code == 400 and answer.json()["error"].startswith(words)


def test_the_truth_is_offered_where_there_is_one(small_run, tmp_path):
    with served(Editor.open(small_run), home=tmp_path) as server, client(server) as script:
        assert script.get("/api/compare").json()["has_truth"]
        assert script.post("/api/compare/truth").json()["name"] == "truth"
        assert script.get("/api/compare/labels").status_code == 200

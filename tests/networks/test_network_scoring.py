"""Scores of networks, ONNX files and saved predictions; scenes by vote; the two verbs."""

import json
import pickle

import numpy as np
import pytest
from tests.networks import toy_network
from tests.networks.toy_sets import toy_samples, toy_set, write_toy_store
from tests.reconstruction.occupancy.tiny_network import write_network

from world2minecraft.cli import run as w2m
from world2minecraft.core.errors import DamagedFileError, InputError, UsageError
from world2minecraft.core.files import write_npz
from world2minecraft.formats.sscnet import encode_bin
from world2minecraft.networks import training
from world2minecraft.networks.config import GRIDS
from world2minecraft.networks.data.frames import cells_with_masks
from world2minecraft.networks.saved_predictions import SavedPredictions
from world2minecraft.networks.scene_voting import SceneFrame, scene_scores
from world2minecraft.networks.scoring import SCENES, PredictedFrame, keys_to_score, protocol_scores

FINE = GRIDS["0.08"]
SAMPLES = list(toy_samples(6, 3))


def said_of(sample, said=None):
    known = cells_with_masks(sample, FINE)
    labels = np.where(known.labels == 255, 0, known.labels) if said is None else said
    return PredictedFrame(
        sample.scene_id, labels.astype(np.uint8), known, sample.occ.region.region_to_room
    )


def test_the_truth_scores_full_by_every_protocol_and_scenes_too():
    scores = protocol_scores((said_of(one) for one in SAMPLES), 0.08)
    assert not scores["left_out"]
    for name, found in scores["protocols"].items():
        assert found["micro"]["iou"] == 1 or name == "ssc", name
        assert found["micro"]["recall"] == 1
    assert scores["protocols"]["ssc"]["micro"]["miou_present_classes"] == 1
    assert scores["protocols"][SCENES]["scenes"] == 3
    assert scores["protocols"]["monoscene"]["frames"] == 6


def test_unknown_truth_is_what_iso_and_monoscene_differ_in():
    full = [said_of(one, np.full((60, 60, 36), 3, np.uint8)) for one in SAMPLES]
    found = protocol_scores(full, 0.08, ["monoscene", "iso"])["protocols"]
    assert found["iso"]["micro"]["precision"] < found["monoscene"]["micro"]["precision"]
    assert found["iso"]["cells"] == 6 * 129_600 > found["monoscene"]["cells"]


def test_what_a_set_cannot_answer_is_left_out_or_refused():
    dark = [said_of(one) for one in SAMPLES]
    dark = [one._replace(known=type(one.known)(one.known.labels)) for one in dark]
    scores = protocol_scores(dark, 0.08)
    assert set(scores["left_out"]) == {"ssc", "visible"}
    assert set(scores["protocols"]) == {"monoscene", "iso", "embodied"}
    with pytest.raises(UsageError, match="protocol visible requires seen, free"):
        protocol_scores(dark, 0.08, ["visible"])
    with pytest.raises(UsageError, match="no frames to evaluate"):
        protocol_scores([], 0.08)


def scene_frame(said, first=(0, 0, 0), in_view=True, truth=None):
    grid_to_room = np.eye(4)
    grid_to_room[:3, 3] = np.array(first) * 0.08
    said = np.array(said, np.uint8).reshape(-1, 1, 1)
    mask = np.broadcast_to(np.array(in_view).reshape(-1, 1, 1), said.shape)
    truth = said if truth is None else np.array(truth, np.uint8).reshape(said.shape)
    return SceneFrame("a", said, truth, np.packbits(mask), grid_to_room)


def test_frames_of_a_scene_vote_where_they_look():
    frames = [
        scene_frame([2, 2, 3], truth=[2, 2, 2]),
        scene_frame([3, 2, 0], (1, 0, 0), truth=[2, 2, 0]),
        scene_frame([2, 3, 0], (1, 0, 0), [True, False, True], truth=[2, 2, 0]),
    ]
    (scene,), reason = scene_scores(frames, 0.08)
    assert not reason
    # Cells: 2; 2, 3, 2 -> 2; 3 against 2 -> 2 by its lower id; 0 and 0 -> 0.
    assert scene.counts.geometry.cells == 4
    assert scene.counts.classes.table[2, 2] == 3 and scene.counts.classes.table[0, 0] == 1


def test_a_scene_is_the_same_however_its_boxes_are_turned():
    turned = np.eye(4)
    turned[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    turned[:3, 3] = [0.08, 0, 0]
    along_y = scene_frame([2, 5, 0])._replace(grid_to_room=turned)
    said = np.array([2, 5, 0], np.uint8).reshape(1, 3, 1)
    straight = SceneFrame("a", said, said, np.packbits(np.ones(3, bool)), np.eye(4))
    (scene,), _ = scene_scores([along_y, straight], 0.08)
    assert scene.counts.geometry.cells == 3
    assert np.diag(scene.counts.classes.table)[[0, 2, 5]].tolist() == [1, 1, 1]


def test_boxes_off_the_lattice_make_no_scene():
    found, reason = scene_scores([scene_frame([2]), scene_frame([2], (0.5, 0, 0))], 0.08)
    assert not found and "not on a common lattice of 0.08 m" in reason
    turn = np.eye(4)
    turn[:2, :2] = [[0.8, -0.6], [0.6, 0.8]]
    found, reason = scene_scores([scene_frame([2])._replace(grid_to_room=turn)], 0.08)
    assert not found and "not aligned with the room axes" in reason


LABELS = SAMPLES[0].occ.labels


def test_saved_predictions_of_all_kinds_are_read_as_ours(tmp_path):
    write_npz(tmp_path / "plain.npz", {"labels": LABELS})
    np.save(tmp_path / "nyu.npy", LABELS.transpose(0, 2, 1))
    theirs = np.where(LABELS == 0, 12, np.where(LABELS == 255, 0, LABELS))
    scores = np.eye(13, dtype=np.float32)[theirs]
    np.save(tmp_path / "scores.npy", np.moveaxis(scores, -1, 0)[None])
    write_npz(tmp_path / "ours.npz", {"logits": np.eye(12, dtype=np.float32)[LABELS % 12]})
    with open(tmp_path / "embodied.pkl", "wb") as file:
        pickle.dump({"pred": theirs.astype(np.uint8)}, file)
    saved = SavedPredictions(tmp_path)
    for key in ("plain", "nyu", "scores"):
        np.testing.assert_array_equal(saved.labels(key), LABELS, err_msg=key)
    np.testing.assert_array_equal(saved.labels("ours"), LABELS % 12)
    with pytest.raises(DamagedFileError, match="set classes to embodied"):
        saved.labels("embodied")
    embodied = SavedPredictions(tmp_path / "embodied.pkl", classes="embodied")
    np.testing.assert_array_equal(embodied.labels("any"), LABELS)
    turned = SavedPredictions(tmp_path / "plain.npz", order="yxz").labels("any")
    np.testing.assert_array_equal(turned, LABELS.transpose(1, 0, 2))


def test_what_cannot_be_read_is_named(tmp_path):
    with pytest.raises(InputError, match="not found"):
        SavedPredictions(tmp_path / "no.npz")
    with pytest.raises(InputError, match="contains no KEY.npz"):
        SavedPredictions(tmp_path)
    write_npz(tmp_path / "all.npz", {"room_0-t0-00000": LABELS})
    saved = SavedPredictions(tmp_path / "all.npz")
    truth = toy_set(tmp_path, 6, 3)
    assert keys_to_score(saved, truth, None) == ["room_0-t0-00000"]
    with pytest.raises(InputError, match="contains no predictions for"):
        keys_to_score(saved, truth, "test")
    write_npz(tmp_path / "one.npz", {"labels": LABELS})
    with pytest.raises(InputError, match="contains a single frame, but the data set has 6"):
        keys_to_score(SavedPredictions(tmp_path / "one.npz"), truth, None)


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    return write_toy_store(tmp_path_factory.mktemp("sets") / "toy")


def told(words, capsys):
    code = w2m([str(word) for word in words])
    return code, capsys.readouterr()


def test_train_and_evaluate_from_the_command_line(store, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(training, "make_network", toy_network.make_toy)
    run, cache = tmp_path / "RUN", ("--cache", tmp_path / "c", "--device", "cpu")
    words = ["train", "toy", "--data", store, "--out", run, "--preset", "smoke", "--steps", "4",
             "--image", "40x30", "--val-share", "0.34", "--threads", "1", *cache]  # fmt: skip
    code, out = told(words, capsys)
    assert code == 0 and f"next: w2m evaluate occupancy {run}" in out.out
    scores = json.loads((run / "scores.json").read_text())
    assert scores["split"] == "test" and scores["protocols"]["monoscene"]["frames"] == 2
    figures, rows = tmp_path / "s.json", tmp_path / "r.tex"
    code, out = told(
        ["evaluate", "occupancy", run, store, "--json", figures, "--latex", rows, *cache], capsys
    )
    assert code == 0
    again = json.loads(figures.read_text())
    assert again["protocols"] == scores["protocols"]
    assert "monoscene" in out.out and "ceiling" in out.out
    assert rows.read_text().startswith("% method & IoU")
    code, out = told(["train", "toy", "--data", store, "--out", run, "--cache", "off"], capsys)
    assert code == 3 and "contains a run with other settings" in out.err


def test_onnx_files_and_saved_predictions_from_the_command_line(store, tmp_path, capsys):
    net = write_network(tmp_path / "net.onnx")
    found = tmp_path / "s.json"
    words = ["evaluate", "occupancy", net, store, "--protocol", "monoscene", "--json", found]
    code, _ = told([*words, "--split", "all", "--cache", tmp_path / "c"], capsys)
    assert code == 0
    assert json.loads(found.read_text())["protocols"]["monoscene"]["frames"] == 8
    saved = tmp_path / "saved"
    for sample in toy_samples():
        write_npz(saved / f"{sample.key}.npz", {"labels": sample.occ.labels})
    words = ["evaluate", "occupancy", saved, store, "--json", found]
    code, out = told(words, capsys)
    assert code == 0 and "100.00" in out.out
    assert "…" not in out.out  # All fits 80 columns.
    code, out = told([*words, "--split", "all"], capsys)
    assert code == 0 and "95 % intervals over 4 scenes" in out.out and "…" not in out.out
    told(words, capsys)
    scores = json.loads(found.read_text())
    assert scores["split"] == "test" and SCENES in scores["protocols"]
    assert scores["protocols"]["embodied"]["micro"]["iou"] == 1
    words = ["evaluate", "occupancy", saved, store, "--json"]
    code, out = told(words, capsys)
    assert code == 0 and json.loads(out.out)["protocols"] == scores["protocols"]


def test_single_files_and_folders_of_bins_are_scored(tmp_path, capsys):
    """SSCNet's own layout: any folder of .bin and depth, its split in its name, no pictures."""
    folder = tmp_path / "NYUCADtest"
    folder.mkdir()
    for sample in SAMPLES[:2]:
        region, turned = sample.occ.region, sample.occ.labels.transpose(0, 2, 1)
        pose = np.linalg.inv(region.region_to_room) @ sample.camera_to_room
        (folder / f"{sample.key}.bin").write_bytes(encode_bin(turned, np.zeros(3), pose))
        write_npz(tmp_path / "said" / f"{sample.key}.npz", {"labels": turned, "confidence": turned})
    one, found = SAMPLES[0].key, tmp_path / "s.json"
    words = ["evaluate", "occupancy", tmp_path / "said" / f"{one}.npz", folder / f"{one}.bin"]
    code, out = told([*words, "--json", found], capsys)
    assert code == 0 and "ssc skipped" in out.out  # There is no depth beside it.
    micro = json.loads(found.read_text())["protocols"]["monoscene"]["micro"]
    assert (micro["iou"], micro["miou_present_classes"]) == (1, 1)
    code, out = told(["evaluate", "occupancy", tmp_path / "said", folder, "--json", found], capsys)
    scores = json.loads(found.read_text())
    assert code == 0 and scores["split"] == "test"
    assert scores["protocols"]["monoscene"]["scenes"] == 2


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        (["train"], 2, "no network given; name one, as in w2m train monoscene --data DIR"),
        (["train", "monoscene"], 2, "no training data; add a data set"),
        (["train", "x", "--data", "d", "--image", "big"], 2, "--image must be WIDTHxHEIGHT"),
        (["train", "x", "--data", "d", "--preset", "8"], 2, "no preset is named '8'"),
        (["evaluate", "occupancy", "gone", "."], 3, "gone: not found"),
    ],
)
def test_command_line_mistakes_are_reported(words, code, text, capsys):
    assert w2m(words) == code
    assert text in capsys.readouterr().err

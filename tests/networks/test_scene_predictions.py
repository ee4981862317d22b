"""Saved grids of whole scenes, byte by byte as others write them: read, put in order, scored."""

import struct

import numpy as np
import pytest

from world2minecraft.cli import run as w2m
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.formats.safe_pickle import dump_pickle
from world2minecraft.minecraftocc.importers.embodied import open_scenes
from world2minecraft.networks.saved_predictions import SavedPredictions
from world2minecraft.networks.scoring import SCENES, saved_scene_scores, scenes_to_score

SHAPE = (6, 13, 4)  # A side of 13, as many as their channels are.
NAMES = ("scene0000_00", "scene0001_00")


def npy(values: np.ndarray) -> bytes:
    """The .npy file of an array, by the format's own description."""
    kind = {"uint8": "|u1", "int64": "<i8", "float32": "<f4"}[values.dtype.name]
    head = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {values.shape}, }}"
    head += " " * (-(len(head) + 11) % 64) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + values.tobytes()


@pytest.fixture
def truth(tmp_path):
    """Two scenes, one to train and one to test, each with two frames that see a half of it."""
    rng = np.random.default_rng(0)
    packages = tmp_path / "data" / "scene_occ"
    (packages / "global_occ_package").mkdir(parents=True)
    (tmp_path / "data" / "occscannet" / "gathered_data").mkdir(parents=True)
    labels = {}
    for name, split in zip(NAMES, ("train", "test"), strict=True):
        folder = packages / "streme_occ_new_package" / split
        folder.mkdir(parents=True)
        held = labels[name] = rng.integers(0, 12, SHAPE).astype(np.uint8)
        held[0, 0] = 255
        centres = np.moveaxis(np.indices(SHAPE), 0, -1).astype(np.float32) * 0.08
        package = {
            "scene_dim": list(SHAPE),
            "global_labels": held,
            "global_pts": centres,
            "global_mask": np.ones(SHAPE, bool),
            "valid_img_paths": [f"posed_images/{name}/{n:05d}.jpg" for n in range(2)],
        }
        (packages / "global_occ_package" / f"{name}.pkl").write_bytes(dump_pickle(package))
        for n in range(2):
            mask = np.zeros(SHAPE, bool)
            mask[n : n + 2] = True
            frame = {"local_label": np.zeros((60, 60, 36), np.uint8), "mask_in_global": mask}
            (folder / f"{name}_{n:05d}_new.pkl").write_bytes(dump_pickle(frame))
    return tmp_path / "data", labels


def theirs(labels):
    """EmbodiedOcc's own classes: 0 is ignored, 12 is empty."""
    return np.where(labels == 0, 12, np.where(labels == 255, 0, labels))


def forms(labels):
    """Every form in which a scene may have been saved: file name's end to bytes, and classes."""
    scores = np.eye(13, dtype=np.float32)[theirs(labels)]
    flat = scores.reshape(-1, 13)
    return {
        "labels": (".npy", npy(labels), ""),
        "labels of theirs": (".npy", npy(theirs(labels).astype(np.int64)), "embodied"),
        "pickled": (".pkl", dump_pickle({"pred": labels}), ""),
        "a list of cells": (".npy", npy(labels.reshape(-1)), ""),
        "a batch of lists": (".npy", npy(labels.reshape(1, -1)), ""),
        "scores, last": (".npy", npy(scores), ""),
        "scores, first": (".npy", npy(np.ascontiguousarray(np.moveaxis(scores, -1, 0))), ""),
        "a list of scores": (".npy", npy(flat), ""),
        "a batch of scores": (".npy", npy(np.ascontiguousarray(flat.T)[None]), ""),
    }


@pytest.mark.parametrize("form", forms(np.zeros(SHAPE, np.uint8)))
def test_each_form_is_the_same_scene(form, truth, tmp_path):
    _, labels = truth
    suffix, data, classes = forms(labels[NAMES[1]])[form]
    (tmp_path / "saved").mkdir()
    (tmp_path / "saved" / (NAMES[1] + suffix)).write_bytes(data)
    saved = SavedPredictions(tmp_path / "saved", classes=classes)
    np.testing.assert_array_equal(saved.scene_labels(NAMES[1], SHAPE), labels[NAMES[1]])


def test_counted_is_what_any_frame_has_in_view(truth):
    scenes = open_scenes(truth[0])
    assert scenes.splits == dict(zip(NAMES, ("train", "test"), strict=True))
    package = scenes.read(NAMES[0])
    np.testing.assert_array_equal(package.labels, truth[1][NAMES[0]])
    assert package.seen[:3].all() and not package.seen[3:].any()


def test_a_scene_is_scored_by_its_own_arithmetic(truth, tmp_path):
    folder, labels = truth
    said = labels[NAMES[1]].copy()
    said[3:] = 7  # Nobody looked there.
    said[1, 1, 1] = 0 if said[1, 1, 1] else 5
    (tmp_path / f"{NAMES[1]}.npy").write_bytes(npy(said))
    saved, scenes = SavedPredictions(tmp_path / f"{NAMES[1]}.npy"), open_scenes(folder)
    assert scenes_to_score(saved, scenes, "test") == [NAMES[1]]
    assert scenes_to_score(saved, scenes, "train") == []
    found = saved_scene_scores(saved, scenes, [NAMES[1]])["protocols"][SCENES]
    true = labels[NAMES[1]][:3]
    known = true != 255
    mine, real = (said[:3] > 0) & known, (true > 0) & known
    wanted = (mine & real).sum() / (mine | real).sum()
    assert wanted < 1
    assert found["micro"]["iou"] == pytest.approx(wanted)


def test_what_a_memory_ignores_counts_as_occupied(truth, tmp_path):
    """As EmbodiedOcc counts: its class 0 becomes 255, which is not empty."""
    folder, labels = truth
    (tmp_path / f"{NAMES[0]}.npy").write_bytes(npy(np.zeros(SHAPE, np.int64)))
    saved = SavedPredictions(tmp_path / f"{NAMES[0]}.npy", classes="embodied")
    found = saved_scene_scores(saved, open_scenes(folder), [NAMES[0]])["protocols"][SCENES]
    seen = labels[NAMES[0]][:3]
    occupied = ((seen > 0) & (seen != 255)).sum()
    assert found["micro"]["recall"] == 1
    assert found["micro"]["precision"] == pytest.approx(occupied / (seen != 255).sum())
    assert found["micro"]["miou"] == 0


def test_other_cells_are_refused(truth, tmp_path):
    (tmp_path / f"{NAMES[0]}.npy").write_bytes(npy(np.zeros((5, 13, 4), np.uint8)))
    saved = SavedPredictions(tmp_path / f"{NAMES[0]}.npy")
    with pytest.raises(DamagedFileError, match="scene0000_00 has 5x13x4 cells, expected 6x13"):
        saved.scene_labels(NAMES[0], SHAPE)
    with pytest.raises(InputError, match="no scene found that has both a global_occ_package"):
        open_scenes(tmp_path)


def test_scenes_are_scored_from_the_command_line(truth, tmp_path, capsys):
    folder, labels = truth
    (tmp_path / "saved").mkdir()
    for name in NAMES:
        data = npy(theirs(labels[name]).astype(np.uint8))
        (tmp_path / "saved" / f"{name}.npy").write_bytes(data)
    words = ["evaluate", "occupancy", str(tmp_path / "saved"), str(folder)]
    assert w2m([*words, "--classes", "embodied", "--split", "all"]) == 0
    said = capsys.readouterr().out
    assert SCENES in said and "100.00" in said
    assert w2m([*words, "--classes", "embodied", "--protocol", "iso"]) == 2
    expected = "complete scenes; use the protocol embodied (--protocol embodied)"
    assert expected in capsys.readouterr().err

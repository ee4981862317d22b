"""Folders of label images: the classes that ``labels.json`` states."""

import json
import shutil

import numpy as np
import pytest
from PIL import Image

from world2minecraft.capture import write_plain
from world2minecraft.capture.label_images import write_label_facts
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.validation import validate_capture
from world2minecraft.capture.view_stream import read_view
from world2minecraft.core.coordinates import look_at
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import Camera, View
from world2minecraft.core.vocabulary import label_id_names, label_id_of

IDS = np.array([[0, 1, 2, 5], [14, 22, 32, 40]], np.uint8).repeat(24, 0).repeat(16, 1)


@pytest.fixture
def capture(tmp_path):
    """One frame, and a folder with its label image."""
    camera = Camera(64, 48, 50.0, 50.0, 32.0, 24.0)
    pose = look_at(np.array([0, 0, 1.5]), np.array([0, 2, 1.2]))
    write_plain(tmp_path / "cap", [View("0", pose, np.zeros((48, 64, 3), np.uint8), camera)])
    (tmp_path / "labels").mkdir()
    Image.fromarray(IDS).save(tmp_path / "labels" / "0.png")
    return tmp_path


def labels_of(folder):
    judged = validate_capture(folder / "cap", ScanOptions(), folder / "labels")
    return read_view(judged.frames[0], judged.encoding).labels


def test_nyu40_ids_become_classes(capture):
    write_label_facts(capture / "labels", "nyu")
    table, chair, furniture = 8, 5, 10
    found = labels_of(capture)[::24, ::16].tolist()
    assert found == [[255, 3, 2, chair], [table, 1, furniture, 11]]


def test_without_a_statement_ids_are_classes(capture):
    with pytest.raises(CaptureError, match="class ids from 0 to 11, or 255; got 14"):
        labels_of(capture)
    facts = capture / "labels" / "labels.json"
    facts.write_text(json.dumps({"classes": "nyu12"}))
    Image.fromarray(np.minimum(IDS, 11)).save(capture / "labels" / "0.png")
    assert (labels_of(capture) == np.minimum(IDS, 11)).all()


@pytest.mark.parametrize("stated", [{"classes": "ade20k"}, ["nyu40"], {"classes": [1]}])
def test_unknown_classes_are_refused(stated, capture):
    (capture / "labels" / "labels.json").write_text(json.dumps(stated))
    with pytest.raises(
        CaptureError, match='must state the "classes" nyu12 or nyu40, or the name of each id'
    ):
        labels_of(capture)


def view_of(folder, labels=True):
    judged = validate_capture(folder / "cap", ScanOptions(), folder / "labels" if labels else None)
    return read_view(judged.frames[0], judged.encoding)


NAMED = {"0": "sky", "1": "wall", "2": "floor", "5": "armchair", "14": "desk", "22": "gizmo",
         "32": "toilet", "300": "lamp"}  # fmt: skip


def test_named_ids_become_classes_and_names(capture):
    (capture / "labels" / "labels.json").write_text(json.dumps({"classes": NAMED}))
    ids = IDS.astype(np.uint16)
    ids[ids == 40] = 300
    Image.fromarray(ids).save(capture / "labels" / "0.png")
    found = view_of(capture)
    assert found.labels is not None and found.label_ids is not None
    names = [[label_id_names()[n] for n in row] for row in found.label_ids[::24, ::16]]
    assert names == [["", "wall", "floor", "armchair"], ["desk", "", "toilet", "lamp"]]
    assert found.labels[::24, ::16].tolist() == [[255, 3, 2, 5], [8, 255, 11, 11]]


def test_labels_in_the_capture_are_named_too(capture):
    shutil.copytree(capture / "labels", capture / "cap" / "labels")
    facts = capture / "cap" / "labels" / "labels.json"
    facts.write_text(json.dumps({"classes": NAMED}))
    found = view_of(capture, labels=False)
    assert found.label_ids is not None and "toilet" in label_id_names()[found.label_ids.max()]


def test_written_label_ids_come_back(tmp_path):
    camera = Camera(64, 48, 50.0, 50.0, 32.0, 24.0)
    ids = np.full((48, 64), label_id_of("washing machine"), np.uint16)
    ids[:, :9] = 0
    image = np.zeros((48, 64, 3), np.uint8)
    write_plain(tmp_path / "cap", [View("0", np.eye(4), image, camera, label_ids=ids)])
    found = view_of(tmp_path, labels=False)
    assert found.label_ids is not None and (found.label_ids == ids).all()


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ({"a": "wall"}, "ids from 0 to 65535 as keys, got 'a'"),
        ({"70000": "wall"}, "ids from 0 to 65535 as keys, got '70000'"),
        ({"1": 3}, "must state a name for the id 1, got '3'"),
        ({"1": "gizmo", "2": "sky"}, "states no known name; use names such as"),
    ],
)
def test_wrong_names_of_ids_are_refused(names, said, capture):
    (capture / "labels" / "labels.json").write_text(json.dumps({"classes": names}))
    with pytest.raises(CaptureError, match=said):
        labels_of(capture)


def test_names_that_are_not_known_are_told(capture):
    names = {"1": "wall", "2": "zzwall", "5": "toillet", "14": "sky"}
    (capture / "labels" / "labels.json").write_text(json.dumps({"classes": names}))
    judged = validate_capture(capture / "cap", ScanOptions(), capture / "labels")
    assert [note for note in judged.notes if "labels.json" in note] == [
        "labels.json has names that are not known, whose pixels count as unlabelled: "
        "toillet (did you mean toilet?), zzwall (did you mean wall?)"
    ]
    known = {"classes": {"1": "wall", "14": "sky"}}
    (capture / "labels" / "labels.json").write_text(json.dumps(known))
    judged = validate_capture(capture / "cap", ScanOptions(), capture / "labels")
    assert not [note for note in judged.notes if "labels.json" in note]

"""``--method paper`` keeps its figures: what version 0.1 gave on a generated room, to the cell.

The frame of the room is the one that version 0.1 found. Present versions estimate it better, and
half a degree moves hundreds of cells.
"""

import json
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from world2minecraft.cli import run as w2m
from world2minecraft.procgen import generate_room, scan_room

CELLS = {1: 552, 2: 2546, 3: 5606, 4: 267, 5: 553, 8: 419, 10: 689, 11: 1093}  # By class id.
OBJECTS = {"objs": 12, "chair": 7, "table": 1, "furn": 1}
TEMPLATES = {
    "box": 10, "chair": 6, "stool": 1, "coffee_table": 1, "bookcase": 1, "plant": 1, "lamp": 1,
}  # fmt: skip
IOU = [
    0.7273, 0.72, 0.7686, 0.6269, 0.4821, 0.5913, 0.4483, 0.6585, 0.3225, 0.95, 0.88, 0.6333,
    0.6701, 0.7222, 0.7308, 0.9388, 0.7059, 0.9856, 0.2537, 0.6868, 0.4893,
]  # fmt: skip
ALIGNMENT = {
    "scan_to_room": [
        [0.13086005, -0.988586222, -0.074652052, -1.95255168],
        [0.911282053, 0.149597972, -0.383647581, 5.32206292],
        [0.390436509, -0.017824933, 0.92045728, 2.22080628],
        [0, 0, 0, 1],
    ],
    "room_size_m": [3.4773164, 4.39706128, 2.50106185],
}


@pytest.fixture(scope="module")
def out(tmp_path_factory) -> Path:
    """The paper's method on a dining room in 16 small frames with label images."""
    folder = tmp_path_factory.mktemp("paper")
    room = generate_room(3, kind="dining")
    scan_room(room, folder / "scan", frames=16, seed=3, width=320, height=240, with_labels=True)
    words = ["reconstruct", str(folder / "scan"), "--out", str(folder / "OUT"), "--method", "paper"]
    assert w2m(words) == 0
    aligned = folder / "OUT" / "scan.json"
    aligned.write_text(json.dumps(json.loads(aligned.read_text()) | ALIGNMENT))
    assert w2m([*words, "--from", "fuse"]) == 0
    return folder / "OUT"


def test_cells_of_each_class(out):
    labels = np.load(out / "room.npz")["labels"]
    counted = Counter(labels[(labels > 0) & (labels < 12)].tolist())
    assert counted.keys() == CELLS.keys()
    assert [counted[k] for k in CELLS] == pytest.approx(list(CELLS.values()), rel=0.002)


def test_centers_and_their_clusters(out):
    centers = np.load(out / "centers.npz")
    assert len(centers["candidates"]) == pytest.approx(2578, rel=0.002)
    assert centers["cluster"].max() == 20


def test_objects_and_their_templates(out):
    objects = json.loads((out / "objects.json").read_text())
    placements = json.loads((out / "placements.json").read_text())
    assert Counter(one["class"] for one in objects) == OBJECTS
    assert Counter(one["template"] for one in placements) == TEMPLATES
    assert [one["iou"] for one in placements] == pytest.approx(IOU, abs=0.01)

"""``--method paper`` keeps its figures: what version 0.1 gave on a generated room.

Frame and occupancy are those of version 0.1: both methods share the stages that estimate them.
"""

import json
import shutil
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from world2minecraft.reconstruction.file_stages import FILE_STAGES
from world2minecraft.reconstruction.parameters import Parameters, with_method
from world2minecraft.reconstruction.pipeline import reconstruct

ROOM = Path(__file__).parent / "data" / "paper_room.npz"

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
def out(dining_scan, tmp_path_factory) -> Path:
    """The paper's method on a dining room in 16 small frames with label images."""
    capture, out = dining_scan, tmp_path_factory.mktemp("paper") / "OUT"
    paper = with_method(Parameters(), "paper")
    reconstruct(capture, out, paper, until="register")
    aligned = out / "scan.json"
    aligned.write_text(json.dumps(json.loads(aligned.read_text()) | ALIGNMENT))
    reconstruct(capture, out, paper, start="fuse", until="label")
    shutil.copy(ROOM, out / "room.npz")
    for stage in ("find", "furnish"):
        FILE_STAGES[stage](out, paper)
    return out


def test_centers_and_their_clusters(out):
    centers = np.load(out / "centers.npz")
    assert len(centers["candidates"]) == 2578
    assert centers["cluster"].max() == 20


def test_objects_and_their_templates(out):
    objects = json.loads((out / "objects.json").read_text())
    placements = json.loads((out / "placements.json").read_text())
    assert Counter(one["class"] for one in objects) == OBJECTS
    assert Counter(one["template"] for one in placements) == TEMPLATES
    assert [one["iou"] for one in placements] == pytest.approx(IOU, abs=0.01)

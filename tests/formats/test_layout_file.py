"""``layout.json``: rooms there and back, and what is refused."""

import json
from dataclasses import replace

import numpy as np
import pytest

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.types import Layout, Opening
from world2minecraft.formats.layout import read_layouts, write_layouts

ROOM = Layout(
    np.array([[0, 0], [3.2, 0], [3.2, 4.12345], [0, 4.12345]]),
    2.4,
    (Opening("doorway", np.array([0.5, 0]), np.array([1.4, 0]), 0.0, 2.04),),
    floor_z_m=2.8,
    name="room 1",
)


def test_rooms_there_and_back(tmp_path):
    path = tmp_path / "layout.json"
    write_layouts(path, (ROOM, ROOM))
    first, second = read_layouts(path)
    assert np.allclose(first.floor_polygon_m, ROOM.floor_polygon_m, atol=1e-4)
    assert (first.floor_z_m, first.wall_height_m, first.name) == (2.8, 2.4, "room 1")
    assert first.openings[0].kind == "doorway" and first.openings[0].head_m == 2.04
    assert np.array_equal(second.openings[0].end_m, [1.4, 0])
    again = tmp_path / "again.json"
    write_layouts(again, (first, second))
    assert again.read_bytes() == path.read_bytes()


@pytest.mark.parametrize(
    "rows, words",
    [
        ({}, "must contain a list"),
        ([{"name": "hall"}], "row 0 is not valid"),
        ([3], "row 0 is not valid"),
    ],
)
def test_what_is_no_layout_is_refused(tmp_path, rows, words):
    path = tmp_path / "layout.json"
    path.write_text(json.dumps(rows))
    with pytest.raises(DamagedFileError, match=words):
        read_layouts(path)


def test_a_missing_file_is_told(tmp_path):
    with pytest.raises(InputError):
        read_layouts(tmp_path / "layout.json")


def test_doors_keep_their_hinge_and_whether_they_are_open(tmp_path):
    path = tmp_path / "layout.json"
    ends = np.array([0.5, 0]), np.array([1.4, 0])
    doors = (Opening("door", *ends, 0, 2, "right", True), Opening("door", *ends, 0, 2))
    write_layouts(path, (replace(ROOM, openings=doors),))
    rows = json.loads(path.read_text())[0]["openings"]
    assert (rows[0]["hinge"], rows[0]["open"]) == ("right", True)
    assert not {"hinge", "open"} & rows[1].keys()
    read = read_layouts(path)[0].openings
    assert [(one.hinge, one.is_open) for one in read] == [("right", True), (None, False)]


@pytest.mark.parametrize(
    "more",
    [{"hinge": "up"}, {"open": "yes"}, {"kind": "doorway", "hinge": "left"}, {"hinge": ["left"]}],
)
def test_a_door_that_makes_no_sense_is_refused(tmp_path, more):
    path = tmp_path / "layout.json"
    opening = replace(ROOM.openings[0], kind="door", hinge="left")
    write_layouts(path, (replace(ROOM, openings=(opening,)),))
    rows = json.loads(path.read_text())
    rows[0]["openings"][0].update(more)
    path.write_text(json.dumps(rows))
    with pytest.raises(DamagedFileError, match="row 0 is not valid"):
        read_layouts(path)

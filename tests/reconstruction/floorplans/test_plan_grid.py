"""RoomPlan's JSON: read back from Apple's published structure, and refused where it is damaged."""

import copy
import json
import zipfile

import numpy as np
import pytest

from roomplans import captured_room, session_of, surface, thing
from world2minecraft.core.coordinates import apply
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.core.types import Layout, LayoutObject, Opening
from world2minecraft.formats.roomplan import find_roomplan, read_roomplan
from world2minecraft.reconstruction.floorplans import layouts_of, straighten_plan
from world2minecraft.reconstruction.floorplans.room_outlines import move_plan

ELL = np.array([[0, 0], [4, 0], [4, 2], [2.5, 2], [2.5, 3.2], [0, 3.2]], float)


def layout(polygon=ELL):
    return Layout(
        polygon,
        2.4,
        openings=(
            Opening("door", [0.4, 0], [1.2, 0], 0.0, 2.0),
            Opening("window", [4, 0.5], [4, 1.5], 0.9, 2.1),
            Opening("doorway", [0, 1.0], [0, 2.0], 0.0, 2.1),
        ),
        objects=(
            LayoutObject(7, [1.25, 2.7, 0.4], [0.9, 2.0, 0.8], 270.0, "sofa"),
            LayoutObject(8, [1.2, 1.2, 0.37], [0.8, 1.4, 0.74], 0.0, "dining_table"),
            LayoutObject(5, [2.0, 1.2, 0.45], [0.5, 0.45, 0.9], 180.0, "chair"),
        ),
        name="room 1",
    )


@pytest.fixture
def document():
    return captured_room(layout(), session_of(21.0, (3.0, -1.4, 0.7)))


def written(tmp_path, document, name="Room.json"):
    path = tmp_path / name
    path.write_text(json.dumps(document))
    return path


@pytest.mark.parametrize("turn_deg", [0.0, 21.0, 90.0, 200.0, -137.0])
@pytest.mark.parametrize("floors", [True, False])
def test_a_layout_comes_back_wherever_the_session_began(tmp_path, turn_deg, floors):
    """Up to a quarter turn: a plan does not say which of its walls is the first."""
    session = session_of(turn_deg, (3.0, -1.4, 0.7))
    plan = read_roomplan(written(tmp_path, captured_room(layout(), session, floors)))
    (found,) = layouts_of(straighten_plan(plan))
    assert found.wall_height_m == pytest.approx(2.4, abs=1e-6)
    assert found.floor_z_m == pytest.approx(0, abs=1e-6)
    assert found.floor_polygon_m.min(axis=0) == pytest.approx([0, 0], abs=1e-6)
    assert any(
        np.allclose(sorted(turned(found.floor_polygon_m, turns)), sorted(ELL.tolist()), atol=1e-6)
        for turns in range(4)
    )
    kinds = sorted((o.kind, round(o.sill_m, 3), round(o.head_m, 3)) for o in found.openings)
    assert kinds == [("door", 0.0, 2.0), ("doorway", 0.0, 2.1), ("window", 0.9, 2.1)]
    assert [item.class_id for item in found.objects] == [7, 8, 5]
    assert found.objects[0].size_m == pytest.approx([0.9, 2.0, 0.8])


def turned(polygon, turns):
    for _ in range(turns):
        polygon = np.column_stack([-polygon[:, 1], polygon[:, 0]])
        polygon = polygon - polygon.min(axis=0)
    return np.round(polygon, 6).tolist()


def test_nothing_is_mirrored_and_fronts_follow(tmp_path, document):
    """Undoing the session's pose gives each thing its true place and front."""
    session = session_of(21.0, (3.0, -1.4, 0.7))
    plan = read_roomplan(written(tmp_path, document))
    back = np.linalg.inv(session) @ plan.plan_to_session
    (found,) = layouts_of(move_plan(plan, np.round(back, 9)))
    for item, true in zip(found.objects, layout().objects, strict=True):
        assert item.center_m == pytest.approx(true.center_m, abs=1e-6)
        assert (item.yaw_deg - true.yaw_deg + 180) % 360 - 180 == pytest.approx(0, abs=1e-6)
    assert found.openings[0].start_m == pytest.approx([0.4, 0], abs=1e-6)


def test_the_session_stays_known_through_every_move(tmp_path, document):
    """The plan's own corner, carried to the session, is where the JSON says."""
    plan = straighten_plan(read_roomplan(written(tmp_path, document)))
    wall = plan.rooms[0].walls[0]
    foot = np.array([*(wall.start_m + wall.end_m) / 2, (wall.bottom_m + wall.top_m) / 2])
    true = document["walls"][0]["transform"][12:15]
    assert apply(plan.plan_to_session, foot) == pytest.approx(true, abs=1e-6)


def test_words_instead_of_objects_and_columns_instead_of_a_row(tmp_path, document):
    plain = copy.deepcopy(document)
    for name in ("walls", "doors", "windows", "openings", "objects", "floors"):
        for item in plain[name]:
            item["category"] = next(iter(item["category"]))
            item["confidence"] = next(iter(item["confidence"]))
            row = item["transform"]
            item["transform"] = [row[n : n + 4] for n in range(0, 16, 4)]
    one = layouts_of(read_roomplan(written(tmp_path, document)))[0]
    other = layouts_of(read_roomplan(written(tmp_path, plain, "plain.json")))[0]
    assert other.floor_polygon_m == pytest.approx(one.floor_polygon_m)
    assert [o.name for o in other.objects] == [o.name for o in one.objects]


def test_a_door_that_stood_open_is_a_doorway(tmp_path, document):
    document["doors"][0]["category"] = {"door": {"isOpen": True}}
    plan = read_roomplan(written(tmp_path, document))
    assert [one.kind for one in plan.rooms[0].openings] == ["doorway", "window", "doorway"]


def test_a_structure_holds_its_rooms(tmp_path, document):
    second = captured_room(layout(ELL + np.array([5.0, 0.0])), session_of(21.0, (3.0, -1.4, 0.7)))
    second["sections"] = [{"label": {"livingRoom": {}}, "story": 0}]
    path = written(tmp_path, {"identifier": "x", "rooms": [document, second], "walls": []})
    plan = read_roomplan(path)
    assert [room.name for room in plan.rooms] == ["dining room", "living room"]


def test_it_is_found_in_folders_and_zips(tmp_path, document):
    inner = tmp_path / "export" / "data"
    inner.mkdir(parents=True)
    (inner / "info.json").write_text('{"app": "scanner"}')
    path = written(inner, {"capturedRoom": document}, "room.json")
    assert find_roomplan(tmp_path / "export") == path
    with zipfile.ZipFile(tmp_path / "export.zip", "w") as archive:
        archive.write(path, "scan/room.json")
    held = find_roomplan(tmp_path / "export.zip")
    assert held is not None
    assert len(read_roomplan(held).rooms[0].walls) == 6
    assert find_roomplan(inner / "info.json") is None
    assert find_roomplan(tmp_path / "nothing") is None


def test_curves_and_leaning_surfaces_are_told(tmp_path, document):
    document["walls"][0]["curve"] = {"radius": 2.0}
    leaning = thing(session_of(), [0, 0, 0], [1, 1, 1], 0, "table")["transform"]
    document["walls"][1]["transform"] = [*leaning[:4], *leaning[8:12], *leaning[4:8], *leaning[12:]]
    document["walls"][1]["transform"][4:7] = (-np.array(leaning[8:11])).tolist()
    document["walls"][1]["transform"][8:11] = leaning[4:7]
    notes = read_roomplan(written(tmp_path, document)).notes
    assert "a curved wall was replaced by its chord" in notes
    assert "a surface that is not vertical was skipped" in notes


def damage(document, how):
    if how == "short transform":
        document["walls"][0]["transform"] = document["walls"][0]["transform"][:12]
    elif how == "not a number":
        document["objects"][0]["dimensions"][1] = "wide"
    elif how == "a mirror":
        document["doors"][0]["transform"][0:3] = [0.0, 0.0, 0.0]
    elif how == "millimetres":
        document["walls"][2]["dimensions"] = [4000.0, 2400.0, 0.0]
    elif how == "too many":
        document["objects"] = document["objects"] * 4000
    elif how == "far away":
        document["windows"][0]["transform"][12] = 1e6
    elif how == "no list":
        document["windows"] = {"a": 1}
    elif how == "empty":
        document["walls"], document["floors"] = [], []
    return document


@pytest.mark.parametrize(
    ("how", "text"),
    [
        ("short transform", r"walls\[0\].transform must be 16 numbers"),
        ("not a number", r"objects\[0\].dimensions must be 3 numbers"),
        ("a mirror", r"doors\[0\].transform must be a rigid transform in column-major order"),
        ("millimetres", r"walls\[2\] measures 4000 m; export the plan in metres"),
        ("too many", r"12,000 objects; the limit is 10,000"),
        ("far away", r"windows\[0\] is over 1000 m away"),
        ("no list", "windows must be a list, got dict"),
        ("empty", "contains neither walls nor floors"),
    ],
)
def test_damaged_plans_are_refused_in_one_line(tmp_path, document, how, text):
    path = written(tmp_path, damage(document, how))
    with pytest.raises(InputError, match=text) as caught:
        read_roomplan(path)
    assert isinstance(caught.value, (DamagedFileError, LimitError))
    assert "\n" not in str(caught.value)


def test_a_cut_off_file_and_another_json_are_refused(tmp_path, document):
    path = written(tmp_path, document)
    path.write_text(path.read_text()[:-200])
    with pytest.raises(InputError):
        read_roomplan(path)
    assert find_roomplan(path) is None
    with pytest.raises(DamagedFileError, match="is not a RoomPlan capture"):
        read_roomplan(written(tmp_path, {"walls": 3}))


def test_open_walls_are_boxed_and_that_is_told(tmp_path, document):
    document["floors"], document["walls"] = [], document["walls"][:2]
    (found,) = layouts_of(straighten_plan(read_roomplan(written(tmp_path, document))))
    assert len(found.floor_polygon_m) == 4


def test_a_surface_of_the_helper_is_what_apple_describes():
    """A wall of 4 m along x, 2.4 m high: its middle is half way up, y is up."""
    item = surface(session_of(), [0, 0], [4, 0], 0.0, 2.4, {"wall": {}})
    assert item["transform"][12:15] == pytest.approx([2.0, 1.2, 0.0])
    assert item["transform"][4:7] == pytest.approx([0.0, 1.0, 0.0])
    assert item["dimensions"] == pytest.approx([4.0, 2.4, 0.0])

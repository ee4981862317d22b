"""The same bedroom in three forms is one scene; what others write wrong is said."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from made_layouts import gpt_record, placed, shell, vlm_task, write

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UnknownNameError
from world2minecraft.paper.layouts.compared_scene import SCENE_FILE, read_scene, write_scene
from world2minecraft.paper.layouts.importers import How, read_layouts_of

# A bed with its head at the south wall, looking north; a chair at the east wall, looking west.
BED = ((1.2, 1.0, 0.25), (2.0, 1.6, 0.5), 90.0)
CHAIR = ((3.7, 2.0, 0.45), (0.5, 0.45, 0.9), 180.0)


def as_gpt(folder, unit="px"):
    # top runs down the page: y = 3 - top. A front at 0 looks along top, to the south.
    told = gpt_record(
        [
            ("double_bed", 1.2, 2.0, 0.25, 1.6, 2.0, 0.5, 180.0),
            ("chair", 3.7, 1.0, 0.45, 0.45, 0.5, 0.9, -90.0),
        ],
        unit=unit,
    )
    return write(folder / "gpt4.json", [told])


def as_idesign(folder):
    told = [
        *shell(),
        placed("double_bed_1", (1.2, 1.0, 0.25), (1.6, 2.0, 0.5), 0.0),
        placed("chair_1", (3.7, 2.0, 0.45), (0.45, 0.5, 0.9), 270.0),
    ]
    return write(folder / "idesign" / "scene_graph.json", told)


def as_layoutvlm(folder):
    task = vlm_task({"aa-0": ("double bed", 1.6, 2.0, 0.5), "bb-0": ("Chair", 0.45, 0.5, 0.9)})
    write(folder / "vlm" / "room.json", task)
    told = {
        "double_bed-0": {"position": [1.2, 1.0, 0.25], "rotation": [0.0, 0.0, 90.0]},
        "chair-0": {"position": [3.7, 2.0, 0.45], "rotation": [0.0, 0.0, -180.0]},
    }
    return write(folder / "vlm" / "layout.json", told)


@pytest.mark.parametrize(
    "make",
    [as_gpt, lambda folder: as_gpt(folder, "m"), as_idesign, as_layoutvlm],
    ids=["LayoutGPT px", "LayoutGPT m", "I-Design", "LayoutVLM"],
)
def test_one_bedroom_in_every_form(make, tmp_path):
    (scene,) = read_layouts_of(make(tmp_path))
    (room,) = scene.rooms
    assert room.floor_polygon_m == pytest.approx(
        np.array([[0, 0], [4, 0], [4, 3], [0, 3]]), abs=1e-4
    )
    assert [item.class_id for item in scene.objects] == [SemanticClass.BED, SemanticClass.CHAIR]
    for item, (center, size, yaw) in zip(scene.objects, (BED, CHAIR), strict=True):
        assert item.center_m == pytest.approx(center, abs=1e-4)
        assert item.size_m == pytest.approx(size, abs=1e-4)
        assert item.yaw_deg == pytest.approx(yaw)
    assert not scene.skipped and not scene.unplaced


def test_the_height_of_a_room_is_known_only_where_it_is_said(tmp_path):
    (gpt,) = read_layouts_of(as_gpt(tmp_path))
    (idesign,) = read_layouts_of(as_idesign(tmp_path))
    assert not gpt.is_height_stated and gpt.rooms[0].wall_height_m == pytest.approx(2.6)
    assert idesign.is_height_stated and idesign.rooms[0].wall_height_m == pytest.approx(2.5)


def test_a_scene_is_written_and_read_again(tmp_path):
    (scene,) = read_layouts_of(as_gpt(tmp_path))
    write_scene(tmp_path / "built" / SCENE_FILE, scene)
    again = read_layouts_of(tmp_path / "built")[0]
    assert (again.name, again.method, again.collided) == (scene.name, scene.method, None)
    for one, other in zip(again.objects, scene.objects, strict=True):
        assert one.center_m == pytest.approx(other.center_m, abs=1e-6)
        assert (one.class_id, one.name) == (other.class_id, other.name)
    assert read_scene(tmp_path / "built" / SCENE_FILE).is_height_stated is False


def test_what_a_solver_found_no_place_for_is_unplaced(tmp_path):
    lost = placed("rug_1", (0, 0, 0), (1, 1, 1))
    del lost["position"]
    path = write(tmp_path / "scene_graph.json", [*shell(), lost])
    (scene,) = read_layouts_of(path)
    assert scene.unplaced == ("rug_1",) and not scene.objects


def test_layoutvlm_names_assets_of_one_category_by_letters(tmp_path):
    task = vlm_task(
        {
            "x-0": ("lamp", 0.3, 0.3, 0.5),
            "y-0": ("lamp", 0.4, 0.4, 1.5),
            "z-0": ("chair", 0.5, 0.5, 0.9),
            "z-1": ("chair", 0.5, 0.5, 0.9),
        }
    )
    write(tmp_path / "room.json", task)
    here = {"position": [1, 1, 0.5], "rotation": [0, 0, 0]}
    names = ("lamp_A-0", "lamp_B-0", "chair-0", "chair-1")
    told = {name: here for name in names}
    (less,) = read_layouts_of(write(tmp_path / "layout.json", {**told, "chair-1": {}}))
    assert less.skipped == ("chair-1: 'position' is missing",) and not less.unplaced
    del told["chair-1"]
    (none,) = read_layouts_of(write(tmp_path / "layout.json", told))
    assert none.unplaced == ("chair-1",)
    own = {"x-0": here, "y-0": here, "z-0": here}
    (by_own_names,) = read_layouts_of(write(tmp_path / "layout.json", own))
    assert by_own_names.unplaced == ("chair-1",) and len(by_own_names.objects) == 3
    path = write(tmp_path / "layout.json", {name: here for name in names})
    (scene,) = read_layouts_of(path)
    assert [item.size_m[2] for item in scene.objects] == [0.5, 1.5, 0.9, 0.9]
    assert not scene.skipped


def test_layoutvlm_sizes_come_from_the_folder_of_assets(tmp_path):
    write(tmp_path / "room.json", vlm_task({"aa-0": ("bed", 1.6, 2.0, 0.5)}, sizes=False))
    write(
        tmp_path / "assets" / "aa" / "data.json",
        {"assetMetadata": {"boundingBox": {"x": 1.6, "y": 2.0, "z": 0.5}}},
    )
    path = write(
        tmp_path / "layout.json", {"aa-0": {"position": [1, 1, 0.25], "rotation": [0, 0, 0]}}
    )
    (without,) = read_layouts_of(path)
    assert without.skipped == ("aa-0: size is unknown; give the asset folder with --assets",)
    (scene,) = read_layouts_of(path, How(assets=tmp_path / "assets"))
    assert scene.objects[0].size_m == pytest.approx([2.0, 1.6, 0.5])


def test_the_name_of_an_asset_is_no_path(tmp_path):
    write(tmp_path / "secret" / "data.json", {"assetMetadata": {"boundingBox": {}}})
    write(tmp_path / "set" / "room.json", vlm_task({"../secret-0": ("bed", 1, 1, 1)}, sizes=False))
    path = write(
        tmp_path / "set" / "layout.json",
        {"../secret-0": {"position": [1, 1, 0], "rotation": [0, 0, 0]}},
    )
    (scene,) = read_layouts_of(path, How(assets=tmp_path / "set"))
    assert "size is unknown" in scene.skipped[0]


BAD_OBJECTS = [
    (["lamp"], "lamp: expected [category, {length, width, height, left, top, ...}]"),
    ({"lamp": {}}, "object: expected [category, {length, width, height, left, top, ...}]"),
    (["lamp", {"left": 1}], "lamp: 'length' is missing"),
    (["window", {}], "window: 'length' is missing"),
]


@pytest.mark.parametrize(("item", "reason"), BAD_OBJECTS)
def test_what_is_no_object_is_left_out_and_told(item, reason, tmp_path):
    record = gpt_record([("bed", 1, 1, 0.25, 1.6, 2, 0.5, 0)])
    record["object_list"].append(item)
    (scene,) = read_layouts_of(write(tmp_path / "a.json", [record]))
    assert len(scene.objects) == 1 and scene.skipped == (reason,)


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ({"length": 0}, "box side of 0 m is too short"),
        ({"left": 1e9}, "extends farther than 1000 m from the origin"),
        ({"left": True}, "left must be a number, got bool"),
        ({"left": "nan"}, "left must be a finite number"),
        ({"left": "far"}, "left must be a finite number"),
    ],
)
def test_a_wild_number_is_left_out(values, reason, tmp_path):
    record = gpt_record([("bed", 1, 1, 0.25, 1.6, 2, 0.5, 0)], unit="m")
    record["object_list"][0][1].update(values)
    (scene,) = read_layouts_of(write(tmp_path / "a.json", [record]))
    assert scene.skipped == (f"bed: {reason}",)


@pytest.mark.parametrize("unit", ["px", ""])
def test_layoutgpt_in_pixels_that_are_metres(unit, tmp_path):
    """Its script without --normalize: numbers are metres, whatever unit is said behind them."""
    record = gpt_record([("bed", 1, 1, 0.25, 1.6, 2, 0.5, 0)], unit="m")
    record["prompt"] = f"Room Size: max length 4.0{unit}, max width 3.0{unit}\n"
    (scene,) = read_layouts_of(write(tmp_path / "a.json", [record]))
    assert np.ptp(scene.rooms[0].floor_polygon_m, axis=0) == pytest.approx([4, 3])
    assert scene.objects[0].size_m == pytest.approx([2.0, 1.6, 0.5])


def test_layoutgpt_in_metres_of_which_the_shorter_side_is_one(tmp_path):
    """Its script with --unit m --normalize: the same room as in 256 pixels."""
    sizes = {"left": 0.5, "top": 0.5, "depth": 0.1, "length": 0.4, "width": 0.5, "height": 0.2}
    told = {"prompt": "Room Size: max length 1.00m, max width 1.70m", "object_list": []}
    told["object_list"].append(["bed", {**sizes, "orientation": 0}])
    (scene,) = read_layouts_of(write(tmp_path / "a.json", [told]))
    assert np.ptp(scene.rooms[0].floor_polygon_m, axis=0) == pytest.approx([3.5, 5.95])
    assert scene.objects[0].size_m == pytest.approx([1.75, 1.4, 0.7])
    (half,) = read_layouts_of(tmp_path / "a.json", How(px_m=2 / 256))
    assert np.ptp(half.rooms[0].floor_polygon_m, axis=0) == pytest.approx([2, 3.4])


def test_a_turn_may_be_a_plain_number(tmp_path):
    (bedroom,) = read_layouts_of(as_layoutvlm(tmp_path))
    told = json.loads((tmp_path / "vlm/layout.json").read_text())
    plain = {k: {**v, "rotation": v["rotation"][2]} for k, v in told.items()}
    (scene,) = read_layouts_of(write(tmp_path / "vlm/layout.json", plain))
    assert [one.yaw_deg for one in scene.objects] == [one.yaw_deg for one in bedroom.objects]


def test_numbers_may_carry_their_unit(tmp_path):
    record = gpt_record([("bed", 1, 1, 0.25, 1.6, 2, 0.5, 0)])
    told = record["object_list"][0][1]
    record["object_list"][0][1] = {k: f"{v}px" for k, v in told.items() if k != "orientation"}
    (scene,) = read_layouts_of(write(tmp_path / "a.json", [record]))
    assert scene.objects[0].size_m == pytest.approx([2.0, 1.6, 0.5])


@pytest.mark.parametrize(
    ("told", "text"),
    [
        ({"a": 1}, "no layout in a known format found (stored, run, layoutgpt, idesign, "
                   "layoutvlm); name the format with --format"),
        ([{"object_list": [], "prompt": "a bedroom"}],
         "not valid in its format (record 0 has no room size, such as 'max length 270px, max "
         "width 252px')"),
        ([{"object_list": [["dog", [0.5, 0.5, 1.0, 0.9]]], "prompt": "a toilet left of a dog"}],
         "not valid in its format (record 0 is an image layout; room layouts are in "
         "LayoutGPT's llm_output/3D)"),
        ([{"new_object_id": "bed"}],
         "not valid in its format (east_wall is missing, so the room size is unknown)"),
        ({"bed-0": {"position": [0, 0, 0]}},
         "0 scene files with a boundary found beside it; choose one with --task"),
    ],
)  # fmt: skip
def test_what_is_no_layout_is_said(told, text, tmp_path):
    path = write(tmp_path / "a.json", told)
    with pytest.raises(InputError) as error:
        read_layouts_of(path)
    assert str(error.value) == f"{path}: {text}"


def test_a_scene_of_too_many_objects_is_refused(tmp_path):
    record = gpt_record([])
    record["object_list"] = [["bed", {}]] * 1001
    with pytest.raises(DamagedFileError, match="1,001 objects exceed the limit of 1,000"):
        read_layouts_of(write(tmp_path / "a.json", [record]))


def test_other_ways_to_go_wrong(tmp_path):
    with pytest.raises(InputError, match="not found"):
        read_layouts_of(tmp_path / "none")
    (tmp_path / "a.json").write_text("{")
    with pytest.raises(DamagedFileError, match="is not JSON"):
        read_layouts_of(tmp_path / "a.json")
    with pytest.raises(UnknownNameError, match="did you mean 'layoutgpt'"):
        read_layouts_of(as_gpt(tmp_path), name="layoutgtp")
    (tmp_path / SCENE_FILE).write_text(json.dumps({"name": "x"}))
    with pytest.raises(DamagedFileError, match="not a valid scene of w2m compare"):
        read_layouts_of(tmp_path)
    assert issubclass(LimitError, InputError)


def test_another_package_adds_a_format(tmp_path, monkeypatch):
    """By an entry point; its name must be one that packages may use."""
    (bedroom,) = read_layouts_of(as_gpt(tmp_path))

    class Ours:
        def is_mine(self, path, told):
            return path.suffix == ".json" and told == ["mine"]

        def read(self, path, told, how):
            return [bedroom]

    groups = []

    def points_of(group, search_path):
        groups.append(group)
        return (SimpleNamespace(name="mine", load=Ours),)

    monkeypatch.setattr("world2minecraft.core.registry.points_of", points_of)
    assert read_layouts_of(write(tmp_path / "x.json", ["mine"])) == [bedroom]
    assert set(groups) == {"world2minecraft.layout_format"}

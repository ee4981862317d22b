"""glTF and Habitat: by an independent reader (trimesh), and by the laws of bodies."""

import json
import math
import re
import struct
from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.types import AIR, BlockEntity, BlockVolume
from world2minecraft.formats.block_meshes import volume_meshes
from world2minecraft.formats.gltf import (
    GlbWriter,
    gltf_bytes,
    pack_volume,
    read_glb,
    read_gltf,
    texture_side,
    unpack_volume,
    view_bytes,
    write_gltf,
)
from world2minecraft.formats.habitat import (
    semantic_colour,
    semantic_ids,
    write_habitat,
)
from world2minecraft.formats.volume_formats import (
    format_by_name,
    writable_format_names,
    write_volume_formats,
)
from world2minecraft.geometry.colour import linear_to_srgb
from world2minecraft.minecraft.block_colours import colour_of
from world2minecraft.minecraft.entities import block_display
from world2minecraft.minecraft.visual_shapes import visual_boxes

PALETTE = (
    AIR,
    "minecraft:stone",
    "minecraft:red_concrete",
    "minecraft:oak_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]",
    "minecraft:glass_pane[east=true,north=false,south=false,waterlogged=false,west=true]",
    "minecraft:light[level=15,waterlogged=false]",
    "minecraft:sea_lantern",
)


def furnished(**held) -> BlockVolume:
    """An L of wall on a floor; in its corner a chair that looks east, and a window; no symmetry."""
    states = np.zeros((7, 5, 6), np.uint16)
    semantic, instance = np.zeros((2, *states.shape), np.uint16)
    states[:, 0], semantic[:, 0] = 1, 2
    states[0, 1:], states[:, 1:, 0] = 1, 1
    semantic[0, 1:], semantic[:, 1:, 0] = 3, 3
    states[3:5, 2, 0], semantic[3:5, 2, 0] = 4, 4
    states[1, 1, 1], semantic[1, 1, 1], instance[1, 1, 1] = 3, 5, 7
    states[4:6, 1, 2:4], semantic[4:6, 1, 2:4], instance[4:6, 1, 2:4] = 2, 8, 9
    states[2, 4, 2], states[3, 3, 3] = 5, 6
    return BlockVolume(
        states,
        PALETTE,
        semantic.astype(np.uint8),
        instance,
        (-1, 63, -2),
        block_to_room(np.array([0.0, 1.5]), 4.0),
        **held,
    )


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    path = tmp_path_factory.mktemp("glb") / "room.glb"
    write_gltf(furnished(), path, templates={7: "chair"}, names={7: "bar stool"})
    return trimesh.load(path)


def placed(scene, name):
    transform, geometry = scene.graph[name]
    return scene.geometry[geometry].copy().apply_transform(transform)


# What another program reads.


def test_each_object_is_one_mesh(scene):
    assert sorted(scene.graph.nodes_geometry) == [
        "bar_stool_7", "blocks", "floor", "table_9", "wall", "window",
    ]  # fmt: skip
    assert len(scene.geometry) == 6


def test_nodes_say_what_they_are(scene):
    metadata = {
        name: scene.graph.transforms.edge_data["world", name]["metadata"]
        for name in scene.graph.nodes_geometry
    }
    assert metadata["bar_stool_7"] == {
        "class": 5,
        "class_name": "chair",
        "name": "bar stool",
        "nyu40": 5,
        "instance": 7,
        "size_m": [0.25, 0.25, 0.25],
        "template": "chair",
    }
    assert metadata["wall"]["class_name"] == metadata["wall"]["name"] == "wall"
    assert metadata["wall"]["nyu40"] == 1 and "nyu40" not in metadata["blocks"]
    assert metadata["table_9"]["name"] == "table"
    assert metadata["table_9"]["size_m"] == [0.5, 0.25, 0.5]
    assert metadata["blocks"]["class_name"] == "unknown"


def test_metres_with_y_up_from_the_rooms_origin(scene):
    """Cell (1, 1, 1) is block (0, 64, -1): room x 0 to 0.25, y 1.75 to 1.5, z 0 to 0.25."""
    low, high = placed(scene, "bar_stool_7").bounds
    np.testing.assert_allclose(low, [0.0, 0.0, -1.75], atol=1e-6)
    np.testing.assert_allclose(high, [0.25, 0.25, -1.5], atol=1e-6)


def test_a_room_is_not_mirrored(scene):
    """The stairs rise to the east, which is +x."""
    chair = placed(scene, "bar_stool_7")
    top = chair.triangles[np.isclose(chair.triangles[:, :, 1], 0.25).all(axis=1)]
    assert top[..., 0].min() == pytest.approx(0.125)


def test_bodies_are_closed_and_have_the_volume_of_their_boxes(scene):
    volume = furnished()
    boxes = {
        name: visual_boxes(state)
        for name, state in (("bar_stool_7", PALETTE[3]), ("table_9", PALETTE[2]))
    }
    for name, count in (("bar_stool_7", 1), ("table_9", 4)):
        sides = boxes[name][:, 3:] - boxes[name][:, :3]
        wanted = count * float(sides.prod(axis=1).sum()) / volume.blocks_per_metre**3
        assert placed(scene, name).volume == pytest.approx(wanted, rel=1e-5)


def test_colours_are_those_of_the_blocks(scene):
    visual = scene.geometry[scene.graph["table_9"][1]].visual.to_color()
    colours = np.unique(np.asarray(visual.vertex_colors), axis=0)
    assert colours.tolist() == [[*colour_of("minecraft:red_concrete"), 255]]


def test_glass_is_clear_and_a_lantern_glows():
    tree, _ = glb_of(furnished())
    material_of = {
        node["name"]: {p["material"] for p in tree["meshes"][node["mesh"]]["primitives"]}
        for node in tree["nodes"]
    }
    assert material_of["window"] == {1} and material_of["wall"] == {0}
    assert tree["materials"][1]["alphaMode"] == "BLEND"
    assert tree["images"][1]["name"] == "glow"


def test_nothing_that_nobody_sees_has_a_mesh(scene):
    """The light block: the unlabelled body is the lantern alone."""
    low, high = placed(scene, "blocks").bounds
    np.testing.assert_allclose(high - low, [0.25] * 3, atol=1e-6)


def test_displays_belong_to_their_objects(tmp_path):
    box = np.array([-0.5, 0.0, -0.5, 0.5, 0.25, 0.5])
    shown = block_display(
        "minecraft:oak_planks", box, (2.0, 65.0, 1.0), yaw_deg=30, class_id=5, instance=7
    )
    write_gltf(furnished(entities=(shown,)), tmp_path / "a.glb")
    chair = placed(trimesh.load(tmp_path / "a.glb"), "chair_7")
    assert len(chair.split(only_watertight=False)) >= 1
    assert chair.volume == pytest.approx((0.75 + 0.25) / 64, rel=1e-4)
    width = math.cos(math.radians(30)) + math.sin(math.radians(30))
    assert chair.bounds[1][0] == pytest.approx((2 + width / 2) / 4, abs=1e-4)


# The bytes.


def glb_of(volume, **options):
    data = gltf_bytes(volume, **options)
    size = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + size]), data[20 + size + 8 :]


def test_the_file_keeps_to_the_format():
    data = gltf_bytes(furnished())
    magic, version, length = struct.unpack_from("<III", data)
    assert (magic, version, length) == (0x46546C67, 2, len(data))
    tree, numbers = glb_of(furnished())
    assert len(data) % 4 == 0 and tree["asset"]["version"] == "2.0"
    assert tree["buffers"] == [{"byteLength": len(numbers)}]
    for view in tree["bufferViews"]:
        assert view["byteOffset"] % 4 == 0
        assert view["byteOffset"] + view["byteLength"] <= len(numbers)
    for mesh in tree["meshes"]:
        for primitive in mesh["primitives"]:
            counts = {tree["accessors"][a]["count"] for a in primitive["attributes"].values()}
            assert len(counts) == 1
            indices = tree["accessors"][primitive["indices"]]
            view = tree["bufferViews"][indices["bufferView"]]
            raw = numbers[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
            kind = {5123: "<u2", 5125: "<u4"}[indices["componentType"]]
            assert np.frombuffer(raw, kind).max() == counts.pop() - 1
            position = tree["accessors"][primitive["attributes"]["POSITION"]]
            assert len(position["min"]) == len(position["max"]) == 3
    assert tree["scenes"][tree["scene"]]["nodes"] == list(range(len(tree["nodes"])))


def test_the_same_volume_gives_the_same_bytes():
    assert gltf_bytes(furnished()) == gltf_bytes(furnished())


def test_a_volume_without_anything_to_see_is_refused():
    empty = replace(furnished(), states=np.zeros((7, 5, 6), np.uint16))
    with pytest.raises(UsageError, match="contains no visible blocks"):
        gltf_bytes(empty)


@pytest.mark.parametrize(("count", "side"), [(0, 1), (1, 1), (2, 2), (4, 2), (5, 4), (65, 16)])
def test_the_texture_holds_all_colours(count, side):
    assert texture_side(count) == side


def test_the_blocks_come_back(tmp_path):
    held = BlockEntity((0, 64, 0), "minecraft:sign", {"front_text": {"color": "red"}})
    shown = block_display("minecraft:stone", np.array([0, 0, 0, 1, 1, 1]), (0, 64, 0), instance=7)
    volume = furnished(block_entities=(held,), entities=(shown,))
    write_gltf(volume, tmp_path / "a.glb")
    found = read_gltf(tmp_path / "a.glb")
    for name in ("states", "semantic", "instance", "block_to_room"):
        np.testing.assert_array_equal(getattr(found, name), getattr(volume, name))
    for name in ("palette", "corner", "block_entities", "entities"):
        assert getattr(found, name) == getattr(volume, name)


@given(st.data())
def test_a_mutated_file_is_refused_or_read(tmp_path_factory, data):
    raw = bytearray(gltf_bytes(furnished()))
    for _ in range(data.draw(st.integers(1, 5))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    path = tmp_path_factory.mktemp("glb") / "a.glb"
    path.write_bytes(bytes(raw[: data.draw(st.integers(0, len(raw))) or None]))
    with suppress(InputError):
        read_gltf(path)


@pytest.mark.parametrize(
    ("raw", "reason"),
    [
        (b"", "is not a valid binary glTF 2.0 file"),
        (b"glTF" + struct.pack("<II", 1, 20) + bytes(8), "is not a valid binary glTF 2.0 file"),
        (
            b"glTF" + struct.pack("<IIII", 2, 28, 99, 0x4E4F534A) + bytes(8),
            "declares a chunk of 99 bytes but contains fewer",
        ),
        (
            b"glTF" + struct.pack("<IIII", 2, 24, 4, 0x4E4F534A) + b"[1] ",
            "the JSON chunk is not an object",
        ),
    ],
)
def test_what_is_wrong_with_a_file_is_named(raw, reason, tmp_path):
    (tmp_path / "a.glb").write_bytes(raw)
    with pytest.raises(InputError, match=re.escape(reason)):
        read_gltf(tmp_path / "a.glb")


def test_views_stay_within_the_file(tmp_path):
    writer = GlbWriter("test")
    writer.view(b"1234")
    writer.tree["bufferViews"][0]["byteLength"] = 5
    (tmp_path / "a.glb").write_bytes(writer.to_bytes())
    tree, numbers = read_glb(tmp_path / "a.glb")
    with pytest.raises(InputError, match="extends beyond the binary chunk"):
        view_bytes(tree, numbers, 0, "a.glb")
    for index in (1, -1, "x", None):
        with pytest.raises(InputError, match="does not contain buffer view"):
            view_bytes(tree, numbers, index, "a.glb")


def test_a_packed_volume_is_checked():
    with pytest.raises(InputError):
        unpack_volume(pack_volume(furnished())[:-9], "a.glb")


# Bodies.


def test_a_colour_that_no_face_shows_makes_no_body():
    inside = np.ones((3, 3, 3), np.uint16)
    inside[1, 1, 1] = 2
    labels = np.full((3, 3, 3), 10, np.uint8)
    volume = BlockVolume(inside, PALETTE, labels, inside * 0 + 4, (0, 0, 0), np.eye(4))
    bodies, looks = volume_meshes(volume)
    assert [body.name for body in bodies] == ["furniture_4"]
    assert len(bodies[0].looks) == 6
    assert len(looks) == 2


def test_an_unlabelled_volume_is_one_body():
    plain = furnished()
    plain = replace(plain, semantic=plain.semantic * 0, instance=plain.instance * 0)
    assert [body.name for body in volume_meshes(plain)[0]] == ["blocks"]


# Habitat.


def test_habitat_finds_every_file_by_its_config(tmp_path):
    write_habitat(furnished(), tmp_path / "r", name="kitchen")
    dataset = json.loads((tmp_path / "r" / "kitchen.scene_dataset_config.json").read_text())
    stages = tmp_path / "r" / dataset["stages"]["paths"][".json"][0]
    scenes = tmp_path / "r" / dataset["scene_instances"]["paths"][".json"][0]
    scene = json.loads((scenes / "kitchen.scene_instance.json").read_text())
    name = scene["stage_instance"]["template_name"]
    stage = json.loads((stages / f"{name}.stage_config.json").read_text())
    for key in ("render_asset", "semantic_asset", "semantic_descriptor_filename"):
        assert (stages / stage[key]).is_file()
    assert stage["up"] == [0, 1, 0] and stage["units_to_meters"] == 1.0


def test_semantic_colours_lead_to_ids_and_classes(tmp_path):
    """As Habitat does: the colour of a vertex, to sRGB bytes, to a line of the list."""
    write_habitat(furnished(), tmp_path / "r")
    lines = (tmp_path / "r" / "stages" / "room.semantic.txt").read_text().splitlines()
    assert lines[0] == "HM3D Semantic Annotations"
    rows = [re.fullmatch(r'(\d+),([0-9A-F]{6}),"(\w+)",(\d+)', line) for line in lines[1:]]
    kind_of = {row[2]: (int(row[1]), row[3]) for row in rows if row}
    assert len(kind_of) == len(rows) == 6
    tree, numbers = read_glb(tmp_path / "r" / "stages" / "room.semantic.glb")
    for node in tree["nodes"]:
        accessor = tree["accessors"][
            tree["meshes"][node["mesh"]]["primitives"][0]["attributes"]["COLOR_0"]
        ]
        colours = np.frombuffer(view_bytes(tree, numbers, accessor["bufferView"], "a"), "<f4")
        linear = np.unique(colours.reshape(-1, 3), axis=0)
        assert len(linear) == 1
        hexes = "".join(f"{value:02X}" for value in linear_to_srgb(linear)[0])
        number, kind = kind_of[hexes]
        assert kind == node["extras"]["class_name"] and number == node["extras"]["id"]
        assert number == node["extras"]["instance"] or not node["extras"]["instance"]


def test_the_semantic_json_has_the_boxes_of_the_room(tmp_path):
    write_habitat(furnished(), tmp_path / "r")
    held = json.loads((tmp_path / "r" / "stages" / "info_semantic.json").read_text())
    chair = next(row for row in held["objects"] if row["class_name"] == "chair")
    assert chair["id"] == chair["instance"] == 7
    assert chair["oriented_bbox"]["abb"] == {
        "center": [0.125, 1.625, 0.125],
        "sizes": [0.25, 0.25, 0.25],
    }
    assert held["id_to_label"][7] == 5 and held["id_to_label"][1] == -1
    assert {"id": 5, "name": "chair"} in held["classes"]
    assert all(row["class_id"] == held["id_to_label"][row["id"]] for row in held["objects"])


def test_habitat_names_objects(tmp_path):
    write_habitat(furnished(), tmp_path / "r", names={7: 'my "best", chair', 9: "desk"})
    stages = tmp_path / "r" / "stages"
    lines = (stages / "room.semantic.txt").read_text().splitlines()
    assert [line.split(",", 2)[2] for line in lines[1:3]] == ['"my best chair",0', '"desk",0']
    held = json.loads((stages / "info_semantic.json").read_text())["objects"]
    desk = next(row for row in held if row["id"] == 9)
    assert (desk["name"], desk["class_name"], desk["nyu40"]) == ("desk", "table", 14)


def test_ids_have_colours_of_their_own():
    assert len({semantic_colour(number) for number in range(10_001)}) == 10_001


def test_ids_above_the_limit_and_bad_names_are_refused(tmp_path):
    bodies, _ = volume_meshes(replace(furnished(), instance=furnished().instance * 1200))
    with pytest.raises(
        UsageError, match="Habitat supports ids up to 10,000, but the highest object id is 10,8"
    ):
        semantic_ids(bodies)
    with pytest.raises(UsageError, match=r"got '\.\./x'"):
        write_habitat(furnished(), tmp_path, name="../x")


# All forms at once.


def test_forms_are_written_by_name_or_suffix(tmp_path):
    lost = write_volume_formats(tmp_path, furnished(), ["glb", ".schem", "mcfunction", "habitat"])
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "room.glb", "room.habitat", "room.mcfunction", "room.schem",
    ]  # fmt: skip
    assert dict(lost["glb"]) == {}
    assert "labels of blocks (class and object)" in dict(lost[".schem"])


def test_forms_that_are_not_are_named(tmp_path):
    with pytest.raises(UsageError, match="no format is named 'gbl'; did you mean 'glb'"):
        write_volume_formats(tmp_path, furnished(), ["schem", "gbl"])
    assert not list(tmp_path.iterdir())
    assert "world" not in writable_format_names()
    assert format_by_name("nbt").suffix == format_by_name("structure").suffix == ".nbt"

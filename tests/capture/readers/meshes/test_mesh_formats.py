"""Every format, written by others, gives the same room; damaged ones are refused in one line."""

import json
import struct

import mesh_writers as writers
import numpy as np
import pytest
import trimesh
from mesh_rooms import SIZE_M, room_quads

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.options import parse_options
from world2minecraft.capture.readers.meshes.mesh_source import find_mesh_file, load_geometry
from world2minecraft.core.errors import InputError

MESHES = ("room.glb", "room.stl", "room.ply", "room.usdz", "export/room.obj", "room.zip")
CLOUDS = ("room.las", "room.laz", "room.e57", "room.xyz", "room.pts", "room.csv", "cloud.ply")


@pytest.fixture(scope="module")
def exports(tmp_path_factory):
    """The room in all formats."""
    folder, quads = tmp_path_factory.mktemp("exports"), room_quads()
    writers.write_glb(folder / "room.glb", quads)
    writers.write_stl(folder / "room.stl", quads)
    (folder / "room.ply").write_bytes(writers.quad_ply(quads))
    writers.write_usdz(folder / "room.usdz", quads)
    writers.write_obj(folder / "export", quads)
    writers.zipped(folder / "room.zip", folder / "export")
    points, colour, _ = quads.points(apart_m=0.04)
    writers.write_las(folder / "room.las", points, colour)
    writers.write_las(folder / "room.laz", points, colour)
    writers.write_e57(folder / "room.e57", points, colour)
    writers.write_text(folder / "room.xyz", points, colour)
    writers.write_text(folder / "room.pts", points, colour, head=f"{len(points)}\n")
    writers.write_text(folder / "room.csv", points, colour, ",", "X,Y,Z,R,G,B\n")
    vertex = [*writers.places(points), *writers.paints(colour)]
    (folder / "cloud.ply").write_bytes(writers.ply_bytes(">", vertex))
    return folder


def colours_of(capture):
    """The distinct colours that the first views see much of."""
    seen = [frame.colour_path.colour()[::4, ::4].reshape(-1, 3) for frame in capture.frames[:8]]
    colours, counts = np.unique(np.concatenate(seen), axis=0, return_counts=True)
    return colours[counts > 20]


@pytest.mark.parametrize("name", MESHES)
def test_a_mesh_of_any_format_is_the_same_room(exports, name):
    capture = find_capture(exports / name)
    assert capture.depth_kind == "exact" and capture.scale == "metric"
    assert "4.2 x 3.1 m and 2.6 m high" in capture.notes[0]
    depths = np.concatenate([f.depth_path.raw().ravel() for f in capture.frames[:8]])
    assert (depths > 0).all()
    if name != "room.stl":
        found = colours_of(capture).astype(int)
        for colour in ((230, 225, 210), (120, 90, 60), (200, 40, 40)):
            assert np.abs(found - colour).max(axis=1).min() <= 6, name
    else:
        assert capture.frames[0].colour_path is None


@pytest.mark.parametrize("name", CLOUDS)
def test_a_cloud_of_any_format_is_the_same_room(exports, name):
    loaded = load_geometry(exports / name)
    own = loaded.geometry.positions + loaded.offset
    shift = (500_000, 4_000_000, 0) if name.startswith("room.la") else (0, 0, 0)
    np.testing.assert_allclose(own.min(axis=0) - shift, 0, atol=0.002)
    np.testing.assert_allclose(own.max(axis=0) - shift, SIZE_M, atol=0.002)
    counts = {tuple(c) for c in np.unique(loaded.geometry.colour, axis=0).tolist()}
    assert {(230, 225, 210), (120, 90, 60), (200, 40, 40)} <= counts


def test_views_of_a_cloud_are_taken_from_within(exports):
    capture = find_capture(exports / "room.laz")
    assert "4.2 x 3.1 m and 2.6 m high; unit m" in capture.notes[0]
    frame = capture.frames[0]
    assert frame.depth_path.header().size == frame.colour_path.header().size == (480, 360)
    assert (frame.depth_path.raw() > 0).mean() > 0.9


def test_the_same_file_gives_the_same_views(exports):
    one, other = (find_capture(exports / "room.ply").frames[3] for _ in range(2))
    assert (one.camera_to_world == other.camera_to_world).all()
    assert (one.depth_path.raw() == other.depth_path.raw()).all()


@pytest.mark.parametrize("unit, scale", [("cm", 100), ("mm", 1000), ("inch", 39.3701)])
def test_units_are_inferred_from_the_size_or_chosen(tmp_path, unit, scale):
    quads = room_quads()
    scaled = type(quads)(quads.corners * scale, quads.colour, quads.labels)
    (tmp_path / "room.ply").write_bytes(writers.quad_ply(scaled))
    capture = find_capture(tmp_path / "room.ply")
    assert "4.2 x 3.1 m and 2.6 m high" in capture.notes[0]
    assert f"unit {unit} (estimated" in capture.notes[0]
    told = find_capture(tmp_path / "room.ply", parse_options({"unit": unit, "up": "z"}))
    assert f"unit {unit}, as set; up axis z, as set" in told.notes[0]


def test_of_one_mesh_in_several_formats_the_best_is_read(tmp_path):
    folder = tmp_path / "export"
    writers.write_obj(folder, room_quads())
    writers.write_glb(folder / "room.glb", room_quads())
    assert find_mesh_file(folder) == folder / "room.glb"
    writers.write_stl(folder / "chair.stl", room_quads())
    with pytest.raises(
        InputError, match=r"contains 2 meshes or point clouds \(chair, room\); give the path of one"
    ):
        find_capture(folder)


def cut(share):
    return lambda data: data[: int(len(data) * share)]


def gltf_with(**change):
    def damaged(data):
        length = struct.unpack("<I", data[12:16])[0]
        tree = json.loads(data[20 : 20 + length]) | change
        text = json.dumps(tree).encode()
        text += b" " * (-len(text) % 4)
        body = struct.pack("<II", len(text), 0x4E4F534A) + text + data[20 + length :]
        return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body

    return damaged


def with_count(count):
    return lambda data: data[:80] + struct.pack("<I", count) + data[84:]


def noise(data):
    return bytes(np.random.default_rng(1).integers(0, 256, len(data), np.uint8))


HUGE = [{"componentType": 5126, "count": 10**12, "type": "VEC3"}]
DAMAGED = [
    ("room.glb", cut(0.5)),
    ("room.glb", cut(0.001)),
    ("room.glb", noise),
    ("room.glb", gltf_with(accessors=HUGE)),
    ("room.glb", gltf_with(extensionsRequired=["KHR_draco_mesh_compression"])),
    ("room.glb", gltf_with(buffers=[{"byteLength": 9, "uri": "../../secret.bin"}])),
    ("room.stl", cut(0.5)),
    ("room.stl", cut(0.005)),
    ("room.stl", with_count(4_000_000_000)),
    ("room.stl", with_count(0)),
    ("room.stl", lambda data: data[:84] + b"\xff" * (len(data) - 84)),
    ("room.ply", cut(0.5)),
    ("room.ply", lambda data: data.replace(b"element vertex 1", b"element vertex 9999999991")),
    ("room.ply", lambda data: data.replace(b"property float z", b"property float w")),
    ("room.ply", lambda data: data.replace(b"end_header", b"and_header")),
    ("room.ply", lambda data: data[:-16] + b"\x7f" * 16),
    ("cloud.ply", lambda data: data.replace(b"binary_big", b"binary_odd")),
    ("room.usdz", cut(0.5)),
    ("room.usdz", cut(0.01)),
    ("room.usdz", noise),
    ("room.usdz", lambda data: b""),
    ("room.usdz", lambda data: b"#usda 1.0\n" + data[:50]),
    ("room.las", cut(0.5)),
    ("room.las", cut(0.001)),
    ("room.las", noise),
    ("room.las", lambda data: b"LASG" + data[4:]),
    ("room.las", lambda data: b""),
    ("room.laz", cut(0.5)),
    ("room.laz", lambda data: data[:2000] + noise(data[2000:])),
    ("room.e57", cut(0.5)),
    ("room.e57", cut(0.01)),
    ("room.e57", noise),
    ("room.e57", lambda data: b""),
    ("room.e57", lambda data: data[:3000] + bytes(1000) + data[4000:]),
    ("room.xyz", lambda data: b""),
    ("room.xyz", lambda data: data + b"1 2\n"),
    ("room.xyz", lambda data: b"1 2\n3 4\n"),
    ("room.xyz", noise),
    ("room.xyz", lambda data: data + b"one two three 0 0 0\n"),
]


@pytest.mark.parametrize("name, change", DAMAGED)
def test_damaged_files_are_refused_in_one_line(exports, tmp_path, name, change):
    path = tmp_path / name
    path.write_bytes(change((exports / name).read_bytes()))
    with pytest.raises(InputError) as caught:
        find_capture(path)
    assert "\n" not in str(caught.value) and str(path) in str(caught.value)


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace("f 1/1 2/1", "f 1/1 9999999/1"),
        lambda text: "",
        lambda text: "\n".join(line for line in text.splitlines() if line[:2] != "f "),
        lambda text: text.replace("v ", "v nan "),
        lambda text: text[: len(text) // 3],
    ],
)
def test_damaged_obj_files_are_refused_in_one_line(tmp_path, change):
    path = writers.write_obj(tmp_path / "export", room_quads())
    path.write_text(change(path.read_text()))
    with pytest.raises(InputError) as caught:
        find_capture(path)
    assert "\n" not in str(caught.value) and str(path) in str(caught.value)


def test_a_material_outside_the_folder_is_never_opened(tmp_path):
    path = writers.write_obj(tmp_path / "export", room_quads())
    (tmp_path / "room.mtl").write_bytes((tmp_path / "export" / "room.mtl").read_bytes())
    text = path.read_text().replace("mtllib room.mtl", "mtllib ../room.mtl")
    (tmp_path / "export" / "room.mtl").unlink()
    path.write_text(text)
    try:
        capture = find_capture(path)
    except InputError as error:
        assert "outside its folder" in str(error)
    else:
        assert capture.frames[0].colour_path is None


@pytest.mark.parametrize(
    "named", ["-s 1 1 1 paint.png", "C:\\scans\\paint.png", "/home/me/paint.png", "../paint.png"]
)
def test_a_texture_next_to_its_mesh_is_found_by_any_name(tmp_path, named):
    path = writers.write_obj(tmp_path / "export", room_quads())
    materials = tmp_path / "export" / "room.mtl"
    materials.write_text(materials.read_text().replace("map_Kd paint.png", f"map_Kd {named}"))
    assert load_geometry(path).geometry.coloured


def test_files_of_a_gltf_are_named_as_addresses(tmp_path):
    files = trimesh.Scene(writers.as_trimesh(room_quads())).export(file_type="gltf")
    tree = files["model.gltf"]
    held = [name for name in files if name.endswith(".bin")]
    for number, name in enumerate(held):
        (tmp_path / f"my room {number}.bin").write_bytes(files[name])
        tree = tree.replace(name.encode(), f"my%20room%20{number}.bin".encode())
    (tmp_path / "room.gltf").write_bytes(tree)
    assert len(load_geometry(tmp_path / "room.gltf").geometry.faces)
    (tmp_path / "my room 0.bin").unlink()
    with pytest.raises(InputError, match=r"refers to the missing file 'my%20room%200.bin'; copy"):
        load_geometry(tmp_path / "room.gltf")


def test_objects_shells_and_landscapes_are_refused_with_advice(tmp_path):
    boxes = (((0.0, 0.0, 0.0, 0.6, 0.6, 1.0), (90, 60, 30)),)
    chair = room_quads((0.6, 0.6, 1.0), boxes, without=range(6))
    (tmp_path / "chair.ply").write_bytes(writers.quad_ply(chair))
    with pytest.raises(InputError, match=r"not the size of a room; .* set --set capture.unit="):
        find_capture(tmp_path / "chair.ply", parse_options({"unit": "m"}))
    house = room_quads(
        (8.0, 6.0, 3.0), (((0, 0, 0, 8.0, 6.0, 3.0), (9, 9, 9)),), (0, 1, 2, 3, 4, 5)
    )
    (tmp_path / "house.ply").write_bytes(writers.quad_ply(house))
    with pytest.raises(InputError, match=r"seen from outside.*--set capture.inside=x,y,z"):
        find_capture(tmp_path / "house.ply")
    named = find_capture(tmp_path / "house.ply", parse_options({"inside": "4,3,1.5"}))
    assert len(named.frames) >= 40
    with pytest.raises(InputError, match="within 1 m of capture.inside"):
        find_capture(tmp_path / "house.ply", parse_options({"inside": "40,3,1.5"}))
    ground = room_quads((8.0, 6.0, 3.0), (((3, 3, 0, 4, 4, 2), (9, 9, 9)),), (0, 1, 2, 3, 5))
    (tmp_path / "ground.ply").write_bytes(writers.quad_ply(ground))
    with pytest.raises(InputError, match="does not show the inside of a room"):
        find_capture(tmp_path / "ground.ply", parse_options({"unit": "m"}))

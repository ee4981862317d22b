"""Classes: ScanNet's two files, S3DIS's folders, maps beside a file, columns, names of things."""

import json

import mesh_writers as writers
import numpy as np
import pytest
from mesh_rooms import room_quads

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.readers.meshes.colours_and_classes import class_of_name
from world2minecraft.capture.readers.meshes.mesh_source import load_geometry
from world2minecraft.core.errors import CaptureError

NYU40_OF = {1: 22, 2: 2, 3: 1, 8: 7, 10: 3}


def seen_labels(capture):
    return {int(c) for f in capture.frames[:16] for c in np.unique(f.labels_path.raw())}


def numbers_of(quads, table):
    return np.repeat([table[int(label)] for label in quads.labels], 4)


def test_scannet_labels_and_colours_are_read_together(tmp_path, quads):
    painted = type(quads)(quads.corners, quads.colour // 2, quads.labels)
    more = [("label", "u2", numbers_of(quads, NYU40_OF))]
    plain, labelled = (tmp_path / f"scene_vh_clean_2{part}.ply" for part in ("", ".labels"))
    plain.write_bytes(writers.quad_ply(quads))
    labelled.write_bytes(writers.quad_ply(painted, more=more))
    for path in (plain, labelled, tmp_path):
        loaded = load_geometry(path) if path.is_file() else None
        if loaded is not None:
            assert set(np.unique(loaded.geometry.labels)) == {1, 2, 3, 8, 10}
            assert set(map(tuple, loaded.geometry.colour.tolist())) == {
                tuple(c) for c in quads.colour.tolist()
            }
    capture = find_capture(tmp_path)
    assert seen_labels(capture) == {1, 2, 3, 8, 10}
    assert "column label is read as NYU40 labels" in capture.notes
    header = capture.frames[0].labels_path.header()
    assert header.mode == "L" and header.size == (480, 360)


def test_a_class_map_next_to_the_file_is_used(tmp_path, quads):
    table = {1: 900, 2: 7, 3: 31, 8: 77, 10: 500}
    more = [("segment", "i4", numbers_of(quads, table))]
    path = tmp_path / "room.ply"
    path.write_bytes(writers.quad_ply(quads, "a", more))
    assert load_geometry(path).geometry.labels is None
    assert "map them in room.classes.json" in load_geometry(path).notes[0]
    beside = tmp_path / "room.classes.json"
    beside.write_text(json.dumps({"900": "ceiling", "7": "floor", "31": "wall", "77": "desk"}))
    assert set(np.unique(load_geometry(path).geometry.labels)) == {1, 2, 3, 8, 255}
    beside.write_text(json.dumps({"900": "spaceship"}))
    with pytest.raises(
        CaptureError, match=r"unknown class name 'spaceship'; known names: ceiling, floor"
    ):
        load_geometry(path)
    for label in ("nine", "1" * 5000):
        beside.write_text(json.dumps({label: "wall"}))
        with pytest.raises(
            CaptureError, match=f"the label '{label[:20]}'; labels must be integers"
        ):
            load_geometry(path)


def test_labels_of_faces_and_own_ids_are_read(tmp_path, quads):
    path = tmp_path / "room.ply"
    path.write_bytes(
        writers.quad_ply(quads, ">", face_columns=[("class", "u1", quads.labels.tolist())])
    )
    loaded = load_geometry(path)
    assert set(np.unique(loaded.geometry.labels)) == {1, 2, 3, 8, 10}
    assert loaded.notes == ("column class is read as World2Minecraft class ids",)


def test_what_has_classes_but_no_colours_is_tinted_by_them(tmp_path, quads):
    corners = quads.corners.reshape(-1, 3)
    faces = [[4 * q, 4 * q + 1, 4 * q + 2, 4 * q + 3] for q in range(len(quads.corners))]
    vertex = [*writers.places(corners), ("class", "u1", np.repeat(quads.labels, 4))]
    (tmp_path / "room.ply").write_bytes(writers.ply_bytes("<", vertex, faces))
    capture = find_capture(tmp_path / "room.ply")
    assert seen_labels(capture) == {1, 2, 3, 8, 10}
    assert (capture.frames[0].colour_path.colour().reshape(-1, 3) == (43, 160, 4)).all(1).any()


def s3dis_room(folder, quads):
    (folder / "Annotations").mkdir(parents=True)
    points, colour, labels = quads.points(apart_m=0.05)
    names = {1: "ceiling_1", 2: "floor_1", 3: "wall_1", 8: "table_1", 10: "bookcase_1"}
    for label, name in names.items():
        writers.write_text(
            folder / "Annotations" / f"{name}.txt", points[labels == label], colour[labels == label]
        )
    writers.write_text(folder / f"{folder.name}.txt", points, colour)


def test_rooms_of_s3dis_have_the_classes_of_their_files(tmp_path, quads):
    s3dis_room(tmp_path / "office_1", quads)
    capture = find_capture(tmp_path / "office_1")
    assert capture.source == "solid (S3DIS)"
    assert {1, 2, 3, 8, 10} <= seen_labels(capture) <= {1, 2, 3, 8, 10, 255}
    (tmp_path / "office_1" / "Annotations" / "wall_1.txt").write_text("1 2 3 4\n1 2\n")
    with pytest.raises(Exception, match=r"wall_1.txt: has lines without exactly"):
        load_geometry(tmp_path / "office_1")


def test_classes_come_from_object_names():
    expected = {
        "Wall12": 3,
        "office_chair.003": 5,
        "Dining_Table": 8,
        "tv": 9,
        "bookcase_2.txt": 10,
        "Sphere.001": 255,
        "Bed": 6,
        "couch": 7,
        "barstool": 5,
    }
    assert {name: class_of_name(name) for name in expected} == expected


def test_the_thirteen_classes_of_s3dis_are_known_by_their_names():
    structure = {"ceiling": 1, "floor": 2, "wall": 3, "beam": 1, "column": 3, "window": 4}
    things = {"door": 11, "table": 8, "chair": 5, "sofa": 7, "bookcase": 10, "board": 11}
    for name, number in {**structure, **things, "clutter": 11}.items():
        assert class_of_name(f"{name}_1.txt") == number, name


def test_things_of_a_scene_are_classed_by_their_names(tmp_path):
    import trimesh

    scene = trimesh.Scene()
    scene.add_geometry(writers.as_trimesh(room_quads(boxes=())), node_name="Walls_and_so_on")
    box = trimesh.creation.box(
        (0.8, 0.8, 0.7), transform=trimesh.transformations.translation_matrix([2, 1.5, 0.35])
    )
    scene.add_geometry(box, node_name="Table0", geom_name="Table0")
    (tmp_path / "room.glb").write_bytes(scene.export(file_type="glb"))
    assert set(np.unique(load_geometry(tmp_path / "room.glb").geometry.labels)) == {8, 255}

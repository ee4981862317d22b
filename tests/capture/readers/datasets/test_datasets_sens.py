"""ScanNet's .sens, built byte by byte from the layout that ScanNet's repository describes."""

import struct
import tracemalloc
import zlib

import numpy as np
import pytest
from tests.capture.readers.datasets.writing import encoded, millimetres, save, save_text, zipped

from world2minecraft.capture import describe_capture, open_scan
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.core.errors import DamagedFileError

COLOURS = {"plain": 0, "png": 1, "jpeg": 2}
TABLE = "id\traw_category\tnyu40id\n1\twall\t1\n3\tfloor\t2\n1163\tmat\t40\n4\ttable\t7\nx\ty\tz\n"


def intrinsics(camera):
    """ScanNet's pixel centres are whole numbers."""
    matrix = np.eye(4)
    matrix[0, 0], matrix[1, 1] = camera.fx_px, camera.fy_px
    matrix[0, 2], matrix[1, 2] = camera.cx_px - 0.5, camera.cy_px - 0.5
    return matrix


def matrix_bytes(matrix):
    return np.asarray(matrix, "<f4").tobytes()


def head(camera, count, *, colour="jpeg", depth=1, shift=1000.0, depth_to_base=None, **other):
    """What stands before the frames; ``other`` overrides single values."""
    name = b"StructureSensor"
    size = (camera.width_px, camera.height_px)
    values = {
        "version": 4,
        "name_bytes": len(name),
        "colour": COLOURS.get(colour, colour),
        "depth": depth,
    }
    values |= {"sizes": (*size, *size), "count": count} | other
    return b"".join(
        [
            struct.pack("<IQ", values["version"], values["name_bytes"]),
            name,
            matrix_bytes(intrinsics(camera)),
            matrix_bytes(np.eye(4)),
            matrix_bytes(intrinsics(camera)),
            matrix_bytes(np.eye(4) if depth_to_base is None else depth_to_base),
            struct.pack("<ii4IfQ", values["colour"], values["depth"], *values["sizes"], shift,
                        values["count"]),
        ]
    )  # fmt: skip


def frame(view, index, *, colour="jpeg", depth=1, scale=1000, pose=None):
    pixels = view.colour.tobytes() if colour == "plain" else encoded(view.colour, colour)
    values = np.round(view.depth_m * scale).astype("<u2").tobytes()
    values = zlib.compress(values) if depth else values
    times = (33_333 * index, 33_333 * index + 5, len(pixels), len(values))
    pose = view.camera_to_scan if pose is None else pose
    return matrix_bytes(pose) + struct.pack("<4Q", *times) + pixels + values


def write_sens(path, views, *, colour="jpeg", depth=1, lost=(), **options):
    camera = views[0].colour_camera
    parts = [head(camera, len(views), colour=colour, depth=depth, **options)]
    scale = options.get("shift", 1000)
    for index, view in enumerate(views):
        pose = np.full((4, 4), -np.inf) if index in lost else None
        parts.append(frame(view, index, colour=colour, depth=depth, scale=scale, pose=pose))
    path.write_bytes(b"".join(parts) + struct.pack("<Q", 0))  # No frames of the motion sensor.
    return path


@pytest.mark.parametrize(("colour", "depth"), [("jpeg", 1), ("png", 0), ("plain", 1)])
def test_a_scan_gives_the_views_that_were_written(tmp_path, views, same_views, colour, depth):
    path = write_sens(tmp_path / "scene0000_00.sens", views, colour=colour, depth=depth)
    scan = open_scan(path)
    assert scan.source == "scannet_sens"
    assert scan.frames_used[:2] == ("000000", "000001")
    same_views(scan, views, colour_off=60 if colour == "jpeg" else 0)


def test_the_folder_of_a_scene_and_a_zip_of_it_are_the_same_scan(tmp_path, views, same_views):
    scene = tmp_path / "scene0000_00"
    scene.mkdir()
    write_sens(scene / "scene0000_00.sens", views)
    same_views(open_scan(scene), views, colour_off=60)
    same_views(open_scan(zipped(scene, tmp_path / "scene.zip")), views, colour_off=60)


def test_a_large_file_within_a_zip_is_not_held_in_memory(tmp_path, views, refused, monkeypatch):
    (tmp_path / "scene").mkdir()
    write_sens(tmp_path / "scene" / "a.sens", views)
    monkeypatch.setattr(
        "world2minecraft.capture.readers.datasets.embedded_images.MAX_MEMBER_BYTES", 10_000
    )
    refused(
        zipped(tmp_path / "scene", tmp_path / "a.zip"),
        "from a zip archive; unpack the archive first",
    )


def test_times_units_and_lost_frames(tmp_path, views):
    path = write_sens(tmp_path / "a.sens", views, lost=(3, 7), shift=4000.0)
    capture = find_capture(path)
    assert capture.depth_unit == "0.00025"
    assert capture.frames[2].time_s == pytest.approx(0.066666)
    scan = open_scan(path)
    reason = "tracking was lost (the pose is not finite)"
    assert scan.frames_skipped == (("000003", reason), ("000007", reason))
    view = next(iter(scan.views))
    np.testing.assert_allclose(view.depth_m, views[0].depth_m, atol=2e-4)


def test_depth_stands_to_colour_as_the_file_says(tmp_path, views):
    beside = np.eye(4)
    beside[0, 3] = -0.025
    capture = find_capture(write_sens(tmp_path / "a.sens", views, depth_to_base=beside))
    np.testing.assert_allclose(capture.frames[0].depth_to_colour, beside, atol=1e-7)


def test_the_text_of_a_scene_tells_what_is_up(tmp_path, views):
    path = write_sens(tmp_path / "scene0000_00.sens", views)
    assert find_capture(path).world_up is None
    text = "axisAlignment = 0 1 0 -5 -1 0 0 2 0 0 1 0.06 0 0 0 1 \nsceneType = Living room\n"
    save_text(tmp_path / "scene0000_00.txt", text)
    np.testing.assert_array_equal(find_capture(path).world_up, [0, 0, 1])


def test_the_text_of_a_scene_helps_out_with_the_lens(tmp_path, views):
    path = write_sens(tmp_path / "scene0000_00.sens", views)
    data = bytearray(path.read_bytes())
    for offset in (27, 27 + 128):
        data[offset : offset + 64] = matrix_bytes(np.eye(4))
    path.write_bytes(data)
    text = "".join(f"f{a}_{k} = 130.0\n" for a in "xy" for k in ("color", "depth"))
    text += "".join(f"mx_{k} = 79.5\nmy_{k} = 59.5\n" for k in ("color", "depth"))
    save_text(tmp_path / "scene0000_00.txt", text)
    assert find_capture(path).frames[0].colour_camera == views[0].colour_camera


def write_labels(folder, views, values):
    for index in range(len(views)):
        save(folder / f"{index}.png", np.full((120, 160), values[index % len(values)], np.uint16))


def test_published_label_zips_become_classes(tmp_path, views):
    path = write_sens(tmp_path / "scene0000_00.sens", views)
    write_labels(tmp_path / "x" / "label-filt", views, [1, 3, 1163, 4, 0, 999])
    zipped(tmp_path / "x", tmp_path / "scene0000_00_2d-label-filt.zip")
    without = find_capture(path)
    assert without.frames[0].labels_path is None
    assert "put scannetv2-labels.combined.tsv" in without.notes[0]
    save_text(tmp_path / "scannetv2-labels.combined.tsv", TABLE)
    seen = [view.labels for view in open_scan(path).views]
    assert [int(labels[0, 0]) for labels in seen[:6]] == [3, 2, 11, 8, 255, 255]
    assert describe_capture(path).labelled == 12


def test_a_broken_zip_of_labels_is_told_and_stops_nothing(tmp_path, views):
    path = write_sens(tmp_path / "scene0000_00.sens", views[:2])
    (tmp_path / "scene0000_00_2d-label.zip").write_bytes(b"PK\x03\x04" + bytes(50))
    capture = find_capture(path)
    assert len(capture.frames) == 2
    assert capture.notes[0].startswith("ignoring scene0000_00_2d-label.zip: it is ")


def test_a_table_without_its_columns_is_refused(tmp_path, views, refused):
    path = write_sens(tmp_path / "scene0000_00.sens", views)
    write_labels(tmp_path / "label", views, [1])
    save_text(tmp_path / "scannetv2-labels.combined.tsv", "a\tb\n1\t2\n")
    refused(path, "does not contain the columns id and nyu40id")


def test_of_a_file_cut_short_the_whole_frames_are_kept(tmp_path, views):
    path = write_sens(tmp_path / "a.sens", views)
    data = path.read_bytes()
    path.write_bytes(data[: int(0.8 * len(data))])
    scan = open_scan(path)
    assert 8 <= len(scan.frames_used) <= 10
    assert f"a.sens is truncated; {len(scan.frames_used)} of 12 frames are complete" in scan.notes


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"version": 3}, "is not a .sens file of version 4 (version field: 3)"),
        ({"name_bytes": 1 << 60}, "is not a .sens file of version 4"),
        ({"colour": 9}, "has the unsupported compression 9 for colour"),
        ({"sizes": (4_000_000_000, 5, 160, 120)}, "has an invalid image size or depth unit"),
        ({"sizes": (160, 120, 20_000, 20_000)}, "megapixels; the limit is 64"),
        ({"count": 1 << 62}, "contains 4,611,686,018,427,387,904 frames"),
        ({"count": 0}, "contains 0 frames"),
        ({"shift": 0.0}, "has an invalid image size or depth unit"),
    ],
)
def test_headers_that_lie_are_refused_without_taking_memory(
    tmp_path, views, refused, change, words
):
    change = dict(change)
    shift = change.pop("shift", 1000.0)
    camera = views[0].colour_camera
    body = b"".join(frame(view, index) for index, view in enumerate(views[:3]))
    (tmp_path / "a.sens").write_bytes(
        head(camera, change.pop("count", 3), shift=shift, **change) + body
    )
    tracemalloc.start()
    refused(tmp_path / "a.sens", words)
    assert tracemalloc.get_traced_memory()[1] < 30e6
    tracemalloc.stop()


@pytest.mark.parametrize("length", [0, 5, 11, 40, 330, 400])
def test_a_file_that_ends_before_its_first_frame(tmp_path, views, refused, length):
    path = write_sens(tmp_path / "a.sens", views[:2])
    path.write_bytes(path.read_bytes()[:length])
    refused(path, "a.sens: is ")


def test_depth_that_unpacks_to_more_than_its_size_or_not_at_all(tmp_path, views):
    path = write_sens(tmp_path / "a.sens", views)
    bombs = {2: zlib.compress(bytes(50_000_000), 9), 5: b"\x78\x9c" + b"\xff" * 200}
    parts = [head(views[0].colour_camera, 12)]
    for index, view in enumerate(views):
        if index in bombs:
            pixels = encoded(view.colour, "jpeg")
            sizes = struct.pack("<4Q", 0, 0, len(pixels), len(bombs[index]))
            parts.append(matrix_bytes(view.camera_to_scan) + sizes + pixels + bombs[index])
        else:
            parts.append(frame(view, index))
    path.write_bytes(b"".join(parts))
    bomb = find_capture(path).frames[2].depth_path
    tracemalloc.start()
    with pytest.raises(
        DamagedFileError, match="000002 depth: contains 38,401 bytes, expected 38,400"
    ):
        bomb.raw()
    assert tracemalloc.get_traced_memory()[1] < 1e6
    tracemalloc.stop()
    names = [view.name for view in open_scan(path).views]
    assert "000005" not in names
    assert "000002" not in names
    assert len(names) == 10


def test_a_frame_without_its_picture_still_has_depth(tmp_path, views):
    parts = [head(views[0].colour_camera, 12)]
    for index, view in enumerate(views):
        if index == 4:
            depth = zlib.compress(millimetres(view).tobytes())
            sizes = struct.pack("<4Q", 0, 0, 0, len(depth))
            parts.append(matrix_bytes(view.camera_to_scan) + sizes + depth)
        else:
            parts.append(frame(view, index))
    (tmp_path / "a.sens").write_bytes(b"".join(parts))
    read = {view.name: view for view in open_scan(tmp_path / "a.sens").views}
    assert read["000004"].colour is None
    np.testing.assert_allclose(read["000004"].depth_m, views[4].depth_m, atol=6e-4)

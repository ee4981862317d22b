"""Every layout gives the same views, and what is stated is what is read."""

import json
from dataclasses import replace

import numpy as np
import pytest
from layouts import WRITERS, write_nerfstudio, write_seven_scenes
from PIL import Image

from world2minecraft.capture import describe_capture, open_scan, write_plain
from world2minecraft.capture.format_detection import SOURCES, find_capture
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.validation import validate_capture
from world2minecraft.core.errors import CaptureError, UnknownNameError, UsageError
from world2minecraft.core.types import View

NAMES = {"seven_scenes": "frame-{:06d}", "plain": "{:06d}", "nerfstudio": "{:06d}"}


@pytest.fixture(scope="module")
def views(box_room):
    turn = np.eye(4)
    turn[:3, :3] = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    return box_room.views(12, turn)


@pytest.mark.parametrize("layout", list(WRITERS))
def test_a_layout_gives_the_views_that_were_written(tmp_path, views, layout):
    WRITERS[layout](tmp_path, views)
    scan = open_scan(tmp_path)
    assert scan.source == layout
    assert scan.frames_used == tuple(NAMES[layout].format(index) for index in range(12))
    assert len(scan.views) == 12
    for read, view in zip(scan.views, views, strict=True):
        np.testing.assert_allclose(read.camera_to_scan, view.camera_to_scan, atol=1e-9)
        np.testing.assert_allclose(read.depth_m, view.depth_m, atol=6e-4)
        assert read.depth_camera == view.depth_camera
        tolerance = 60 if layout == "seven_scenes" else 0  # JPEG
        off = np.abs(read.colour.astype(int) - view.colour)
        assert np.quantile(off, 0.98) <= tolerance
        np.testing.assert_array_equal(read.depth_to_colour, np.eye(4))
    size = sorted(scan.room_size_m.tolist())
    np.testing.assert_allclose(size, sorted((4.2, 3.1, 2.6)), atol=0.01)


def test_a_stream_can_be_read_again_and_part_way(tmp_path, views):
    write_plain(tmp_path, views)
    stream = open_scan(tmp_path).views
    first = [view.depth_m.tobytes() for view in stream]
    assert next(iter(stream)).name == "000000"
    assert [view.depth_m.tobytes() for view in stream] == first


def test_plain_is_written_the_same_twice_and_keeps_float_depth(tmp_path, views):
    for name in ("a", "b"):
        write_plain(tmp_path / name, views, depth_unit="m", extra={"seed": 3})
    files = sorted(path.relative_to(tmp_path / "a") for path in (tmp_path / "a").rglob("*.*"))
    assert len(files) == 25
    for file in files:
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes()
    read = list(open_scan(tmp_path / "a").views)
    for one, other in zip(read, views, strict=True):
        np.testing.assert_array_equal(one.depth_m, other.depth_m)
        np.testing.assert_array_equal(one.camera_to_scan, other.camera_to_scan)


def test_plain_keeps_cameras_labels_and_cameras_of_frames(tmp_path, views):
    shift = np.eye(4)
    shift[0, 3] = 0.025
    labels = np.where(views[0].colour[..., 0] > 99, 5, 255).astype(np.uint8)
    written = []
    for index, view in enumerate(views):
        focal = replace(view.colour_camera, fx_px=120.0 + index, distortion=(0.1, 0, 0, 0, 0))
        written.append(replace(view, colour_camera=focal, depth_to_colour=shift, labels=labels))
    write_plain(tmp_path, written)
    for read, view in zip(open_scan(tmp_path).views, written, strict=True):
        assert read.colour_camera == view.colour_camera
        np.testing.assert_array_equal(read.depth_to_colour, shift)
        np.testing.assert_array_equal(read.labels, labels)


def test_plain_reads_depth_alone(tmp_path, views):
    write_plain(
        tmp_path,
        [
            View(v.name, v.camera_to_scan, depth_m=v.depth_m, depth_camera=v.depth_camera)
            for v in views
        ],
    )
    assert all(view.colour is None for view in open_scan(tmp_path).views)
    assert "no colour" in " ".join(describe_capture(tmp_path).warnings)


def test_labels_of_another_folder_are_matched_by_name(tmp_path, views):
    write_plain(tmp_path / "capture", views)
    (tmp_path / "masks").mkdir()
    half = np.full((60, 80), 8, np.uint8)
    Image.fromarray(half).save(tmp_path / "masks" / "000003.png")
    scan = open_scan(tmp_path / "capture", labels=tmp_path / "masks")
    assert [view.name for view in scan.views if view.labels is not None] == ["000003"]
    labelled = next(view for view in scan.views if view.labels is not None)
    assert labelled.labels.shape == (120, 160)
    Image.fromarray(half + 40).save(tmp_path / "masks" / "000003.png")
    with pytest.raises(CaptureError, match="class ids from 0 to 11, or 255; got 48"):
        open_scan(tmp_path / "capture", labels=tmp_path / "masks")
    with pytest.raises(CaptureError, match="no label image for any frame"):
        open_scan(tmp_path / "capture", labels=tmp_path / "capture" / "depth" / "..")


def test_true_seven_scenes_names_have_the_published_matrix(tmp_path, views):
    write_seven_scenes(tmp_path, views, colour_suffix=".png", intrinsics=False)
    with pytest.raises(CaptureError, match="principal point"):
        describe_capture(tmp_path)
    capture = find_capture(tmp_path)
    assert capture.frames[0].depth_camera.fx_px == 585.0
    assert "published for 7-Scenes" in capture.notes[0]


def test_seven_scenes_sequences_are_read_together(tmp_path, views):
    write_seven_scenes(tmp_path / "seq-01", views[:6])
    write_seven_scenes(tmp_path / "seq-02", views[6:])
    scan = open_scan(tmp_path)
    assert scan.frames_used[0] == "seq-01.frame-000000"
    assert scan.frames_used[-1] == "seq-02.frame-000005"


def test_depth_of_half_the_size_uses_the_matrix_at_its_size(tmp_path, views):
    halved = [
        replace(v, depth_m=v.depth_m[::2, ::2].copy(), depth_camera=v.depth_camera.resized(80, 60))
        for v in views
    ]
    write_seven_scenes(tmp_path, halved)
    np.savetxt(tmp_path / "camera-intrinsics.txt", views[0].colour_camera.matrix)
    view = next(iter(open_scan(tmp_path).views))
    assert (view.depth_camera.fx_px, view.depth_camera.cx_px) == (65.0, 40.0)
    assert view.colour_camera.fx_px == 130.0


@pytest.mark.parametrize("per_frame", [False, True])
def test_nerfstudio_scale_is_divided_out(tmp_path, views, per_frame):
    write_nerfstudio(tmp_path, views, per_frame=per_frame, scale=0.25)
    for read, view in zip(open_scan(tmp_path).views, views, strict=True):
        np.testing.assert_allclose(read.camera_to_scan, view.camera_to_scan, atol=1e-9)


def test_nerfstudio_reads_fields_of_view_and_bare_names(tmp_path, views):
    write_nerfstudio(tmp_path, views)
    path = tmp_path / "transforms.json"
    stated = json.loads(path.read_text())
    for key in ("w", "h", "fl_x", "fl_y", "cx", "cy", "k1"):
        del stated[key]
    stated["camera_angle_x"] = 2 * np.arctan(80 / 130)
    for frame in stated["frames"]:
        frame["file_path"] = "./" + frame["file_path"].removesuffix(".png")
    path.write_text(json.dumps(stated))
    camera = next(iter(open_scan(path).views)).colour_camera
    assert camera.fx_px == pytest.approx(130)
    assert (camera.cx_px, camera.cy_px) == (80, 60)


def test_every_takes_each_nth_frame_and_wrong_options_are_named(tmp_path, views):
    write_plain(tmp_path, views)
    assert len(open_scan(tmp_path, options={"every": "2"}).views) == 6
    with pytest.raises(UnknownNameError, match="did you mean 'depth_unit'"):
        open_scan(tmp_path, options={"depht_unit": "mm"})
    with pytest.raises(UsageError, match="positive integer, got '0'"):
        open_scan(tmp_path, options={"every": "0"})
    with pytest.raises(UsageError, match="use cells of at least 0.010 m"):
        open_scan(tmp_path, voxel_m=0.002)


def test_progress_never_falls_and_ends_whole(tmp_path, views):
    write_seven_scenes(tmp_path, views)
    calls = []
    open_scan(tmp_path, progress=lambda stage, done, total, note="": calls.append((done, total)))
    assert [done for done, _ in calls] == sorted(done for done, _ in calls)
    assert calls[-1][0] == calls[-1][1]
    assert len({total for _, total in calls}) == 1


def test_the_summary_says_what_to_type(tmp_path, views):
    write_plain(tmp_path, views)
    summary = describe_capture(tmp_path)
    assert (summary.source, summary.frames, summary.usable) == ("plain", 12, 12)
    assert summary.depth_unit == "millimetres"
    assert not summary.depth_unit_guessed
    assert summary.next_command == f"w2m reconstruct {tmp_path} --out OUT"


def test_every_source_says_its_layout():
    for name in SOURCES.names():
        assert SOURCES.load(name)().layout


def test_plain_reads_frames_named_as_photos_are(tmp_path, views):
    names = ["Photo 1 (2)", "Küche.v2", "b" * 180, "0003"]
    named = [replace(view, name=name) for view, name in zip(views, names, strict=False)]
    write_plain(tmp_path, named)
    frames = validate_capture(tmp_path, ScanOptions()).frames
    assert [frame.name for frame in frames] == names
    assert all(frame.colour_path and frame.depth_path for frame in frames)


def test_plain_without_poses_may_lack_its_lens(tmp_path, views):
    write_plain(tmp_path, views)
    path = tmp_path / "capture.json"
    stated = json.loads(path.read_text())
    del stated["colour_camera"], stated["depth_camera"]
    stated["frames"] = [{"name": frame["name"]} for frame in stated["frames"]]
    path.write_text(json.dumps(stated))
    frames = validate_capture(tmp_path, ScanOptions()).frames
    assert len(frames) == len(views)
    assert all(frame.colour_camera is None and frame.depth_camera is None for frame in frames)

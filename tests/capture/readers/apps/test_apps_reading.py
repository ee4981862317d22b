"""What an app wrote is what is read: poses, lenses, depth, trust, from a folder and from a zip."""

import json

import numpy as np
import pytest
from app_writers import (
    DEEP,
    ROOM_TO_ARKIT,
    WIDE,
    WRITERS,
    shots_of,
    stored_lzfse,
    write_arkitscenes,
    write_polycam,
    write_record3d,
    write_scanner_app,
    write_stray,
    zipped,
)
from PIL import Image

from world2minecraft.capture import describe_capture, open_scan
from world2minecraft.capture.format_detection import SOURCES, find_capture
from world2minecraft.capture.images import read_colour, read_header
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.readers.apps.video_frames import VideoDecoder
from world2minecraft.capture.validation import validate_capture
from world2minecraft.capture.view_stream import read_view

ROOM_TO_Z_UP = np.eye(4)
ROOM_TO_Z_UP[:3, 3] = [3.0, -2.0, -0.4]


@pytest.fixture(scope="module")
def shots(box_room):
    return {
        app: shots_of(box_room, 12, ROOM_TO_Z_UP if app == "arkitscenes" else ROOM_TO_ARKIT)
        for app in WRITERS
    }


def views_of(path):
    judged = validate_capture(path, ScanOptions())
    full = judged.capture.full_trust
    return judged.capture, [read_view(frame, judged.encoding, full) for frame in judged.frames]


@pytest.mark.parametrize("app", WRITERS)
def test_an_apps_capture_is_read_as_it_was_written(tmp_path, shots, app):
    WRITERS[app](tmp_path / "room", shots[app])
    judged = validate_capture(tmp_path / "room", ScanOptions())
    assert judged.capture.source == app
    assert judged.complete
    assert not judged.skipped
    assert judged.capture.scale == "metric"
    assert len(judged.frames) == 12
    for frame, shot in zip(judged.frames, shots[app], strict=True):
        view = read_view(frame, judged.encoding, judged.capture.full_trust)
        np.testing.assert_allclose(view.camera_to_scan, shot.pose, atol=1e-5)
        assert view.colour_camera == WIDE
        assert view.depth_camera == DEEP
        np.testing.assert_array_equal(view.depth_to_colour, np.eye(4))
        trusted = np.where(shot.trust > 0, shot.depth_m, 0)
        np.testing.assert_allclose(view.depth_m, trusted, atol=6e-4)
        assert set(np.unique(view.trust)) <= {0, 127, 128, 255}
        np.testing.assert_array_equal(view.trust > 200, shot.trust == 2)
        np.testing.assert_array_equal(view.trust == 0, shot.trust == 0)
        off = np.abs(view.colour.astype(int) - shot.colour)
        assert np.median(off) <= 6  # JPEG and MPEG-4; PNG has none.


@pytest.mark.parametrize("app", WRITERS)
@pytest.mark.parametrize("inside", ["", "2026_11_22/room/"])
def test_a_zip_gives_what_its_folder_gives(tmp_path, shots, app, inside):
    WRITERS[app](tmp_path / "room", shots[app][:3])
    suffix = ".r3d" if app == "record3d" else ".zip"
    archive = zipped(tmp_path / "room", tmp_path / f"capture{suffix}", inside)
    folder, expected = views_of(tmp_path / "room")
    packed, found = views_of(archive)
    assert packed.source == folder.source
    assert packed.folder == archive
    assert describe_capture(archive).next_command == f"w2m reconstruct {archive} --out OUT"
    np.testing.assert_array_equal(packed.world_up, folder.world_up)
    assert [view.name for view in found] == [view.name for view in expected]
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_array_equal(one.camera_to_scan, other.camera_to_scan)
        np.testing.assert_array_equal(one.depth_m, other.depth_m)
        np.testing.assert_array_equal(one.trust, other.trust)
        np.testing.assert_array_equal(one.colour, other.colour)


@pytest.mark.parametrize("app", WRITERS)
def test_a_room_is_found_in_an_apps_capture(tmp_path, box_room, shots, app):
    WRITERS[app](tmp_path / "room", shots[app])
    scan = open_scan(tmp_path / "room")
    sides = scan.room_size_m if scan.room_size_m[0] > scan.room_size_m[1] else None
    found = scan.room_size_m if sides is not None else scan.room_size_m[[1, 0, 2]]
    np.testing.assert_allclose(found, box_room.size_m, atol=0.03)
    up = np.array([0, 0, 1.0] if app == "arkitscenes" else [0, 1.0, 0])
    np.testing.assert_allclose(scan.scan_to_room[:3, :3] @ up, [0, 0, 1], atol=5e-3)
    assert scan.depth_kind == "sensor"


def test_apps_come_before_the_general_sources():
    names = SOURCES.names()
    assert all(names.index(app) < names.index("nerfstudio") for app in WRITERS)


def test_a_long_recording_is_listed_without_decoding(tmp_path, shots, monkeypatch):
    shot = shots["polycam"][0]
    write_polycam(tmp_path, [shot] * 150)
    monkeypatch.setattr(Image.Image, "load", lambda self: pytest.fail("an image was decoded"))
    capture = find_capture(tmp_path)
    assert len(capture.frames) == 150


# Record3D


def test_record3d_as_its_packer_writes_it(tmp_path, shots):
    lzfse = pytest.importorskip("lzfse")
    write_record3d(tmp_path / "one", shots["record3d"][:2], lzfse.compress)
    write_record3d(tmp_path / "two", shots["record3d"][:2], stored_lzfse)
    packed, stored = views_of(tmp_path / "one")[1], views_of(tmp_path / "two")[1]
    for one, other in zip(packed, stored, strict=True):
        np.testing.assert_array_equal(one.depth_m, other.depth_m)
        np.testing.assert_array_equal(one.trust, other.trust)


def test_record3d_with_a_lens_for_each_frame(tmp_path, shots):
    lenses = [[130.0 + index, 131.0 + index, 81.0, 59.0] for index in range(12)]
    write_record3d(tmp_path, shots["record3d"], perFrameIntrinsicCoeffs=lenses)
    frames = validate_capture(tmp_path, ScanOptions()).frames
    camera = frames[3].colour_camera
    assert [camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px] == lenses[3]
    assert frames[3].depth_camera.fx_px == lenses[3][0] / 2


def test_an_old_record3d_states_no_depth_size(tmp_path, shots):
    write_record3d(tmp_path, shots["record3d"][:2])
    stated = json.loads((tmp_path / "metadata").read_text())
    del stated["dw"], stated["dh"]
    (tmp_path / "metadata").write_text(json.dumps(stated))
    assert read_header(find_capture(tmp_path).frames[0].depth_path).size == (80, 60)


def test_the_front_camera_of_record3d_has_no_poses(tmp_path, shots):
    still = [[0, 0, 0, 1, 0, 0, 0]] * 12
    write_record3d(tmp_path, shots["record3d"], poses=still)
    capture = find_capture(tmp_path)
    assert all(frame.camera_to_world is None for frame in capture.frames)
    assert "front camera" in capture.notes[0]


def test_record3d_relative_to_its_first_pose_has_no_known_up(tmp_path, shots):
    first = np.linalg.inv(shots["record3d"][0].pose)
    flip = np.diag([1.0, -1, -1, 1])
    for shot in (moved := [type(s)(**vars(s)) for s in shots["record3d"]]):
        shot.pose = flip @ first @ shot.pose
    write_record3d(tmp_path, moved)
    capture = find_capture(tmp_path)
    assert capture.world_up is None
    assert capture.frames[0].camera_to_world is not None


def test_a_record3d_world_that_leans_has_no_known_up(tmp_path, box_room):
    """Trimmed at its start, a video whose poses are relative does not begin with no turn."""
    from scipy.spatial.transform import Rotation

    lean = np.eye(4)
    lean[:3, :3] = Rotation.from_euler("x", 35, degrees=True).as_matrix()
    write_record3d(tmp_path / "leans", shots_of(box_room, 12, lean @ ROOM_TO_ARKIT))
    assert find_capture(tmp_path / "leans").world_up is None
    scan = open_scan(tmp_path / "leans")
    found = np.sort(scan.room_size_m[:2])[::-1]
    np.testing.assert_allclose([*found, scan.room_size_m[2]], box_room.size_m, atol=0.03)


def test_record3d_exported_as_exr_and_jpg(tmp_path, shots):
    """Depth is written by OpenEXR's own library."""
    OpenEXR = pytest.importorskip("OpenEXR")
    write_record3d(tmp_path, shots["record3d"][:3])
    (tmp_path / "rgbd").rename(tmp_path / "rgb")
    (tmp_path / "metadata").rename(tmp_path / "metadata.json")
    (tmp_path / "depth").mkdir()
    for index, shot in enumerate(shots["record3d"][:3]):
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        with OpenEXR.File(header, {"R": shot.depth_m}) as file:
            file.write(str(tmp_path / "depth" / f"{index}.exr"))
    _, views = views_of(tmp_path)
    for view, shot in zip(views, shots["record3d"], strict=False):
        np.testing.assert_array_equal(view.depth_m, shot.depth_m)
        assert view.trust is None


# Polycam, Stray Scanner


def test_polycams_optimised_poses_are_preferred(tmp_path, shots):
    write_polycam(tmp_path, shots["polycam"][:2])
    write_polycam(tmp_path, [shots["polycam"][5]] * 2, corrected=False)
    capture = find_capture(tmp_path)
    np.testing.assert_allclose(capture.frames[0].camera_to_world, shots["polycam"][0].pose)
    assert "corrected_images" in str(capture.frames[0].colour_path)
    assert capture.notes == ("using the poses optimised by the app",)


def test_a_polycam_scan_too_large_to_optimise(tmp_path, shots):
    write_polycam(tmp_path, shots["polycam"][:2], corrected=False)
    assert find_capture(tmp_path).notes == ("using the poses of ARKit",)


def test_stray_with_pictures_in_files(tmp_path, shots):
    write_stray(tmp_path, shots["stray"][:3], video=False)
    _, views = views_of(tmp_path)
    for view, shot in zip(views, shots["stray"], strict=False):
        np.testing.assert_array_equal(view.colour, shot.colour)


def test_pictures_of_a_video_come_in_any_order(tmp_path, shots):
    write_stray(tmp_path, shots["stray"])
    frames = find_capture(tmp_path).frames
    forward = [read_colour(frame.colour_path) for frame in frames]
    for index in (11, 0, 7, 6, 3, 4, 9, 1):
        np.testing.assert_array_equal(read_colour(frames[index].colour_path), forward[index])


def test_stray_with_a_lens_in_each_row(tmp_path, shots):
    write_stray(tmp_path, shots["stray"][:2], video=False)
    (tmp_path / "camera_matrix.csv").unlink()
    first, *rows = (tmp_path / "odometry.csv").read_text().splitlines()
    lines = [first + ", fx, fy, cx, cy", *(row + ", 130.5, 130.5, 80, 60" for row in rows)]
    (tmp_path / "odometry.csv").write_text("\n".join(lines))
    assert find_capture(tmp_path).frames[1].colour_camera.fx_px == 130.5


# ARKitScenes, 3D Scanner App


def test_arkitscenes_takes_one_image_a_pose(tmp_path, shots):
    write_arkitscenes(tmp_path / "41069021_frames", shots["arkitscenes"])
    capture = find_capture(tmp_path)
    assert len(capture.frames) == 12
    assert capture.notes == ("24 images between the poses of the trajectory are ignored",)
    np.testing.assert_array_equal(capture.world_up, [0, 0, 1])


def test_arkitscenes_poses_are_carried_to_the_images_times(tmp_path, shots):
    """Half way between two poses the camera stands in their middle, turned half as far."""
    pair = shots["arkitscenes"][:2]
    write_arkitscenes(tmp_path, pair, late_s=0.02)
    frames = find_capture(tmp_path).frames
    share = 0.02 / 0.1
    middle = (1 - share) * pair[0].pose[:3, 3] + share * pair[1].pose[:3, 3]
    np.testing.assert_allclose(frames[0].camera_to_world[:3, 3], middle, atol=1e-9)
    from scipy.spatial.transform import Rotation, Slerp

    between = Slerp([0, 1], Rotation.from_matrix([shot.pose[:3, :3] for shot in pair]))
    expected = between(share).as_matrix()
    np.testing.assert_allclose(frames[0].camera_to_world[:3, :3], expected, atol=1e-9)


def test_the_3d_scanner_app_keeps_pictures_of_some_frames(tmp_path, shots):
    write_scanner_app(tmp_path, shots["scanner_app"], pictured_every=3)
    capture = find_capture(tmp_path)
    assert [frame.name for frame in capture.frames] == ["00000", "00003", "00006", "00009"]
    assert capture.notes == ("8 frames without a colour image are ignored",)


def test_notes_report_what_was_found(tmp_path, shots):
    write_polycam(tmp_path, shots["polycam"])
    summary = describe_capture(tmp_path)
    assert (summary.source, summary.frames, summary.usable) == ("polycam", 12, 12)
    assert summary.colour_size_px == (160, 120)
    assert summary.depth_size_px == (80, 60)
    assert not summary.depth_unit_guessed


def test_a_video_whose_pictures_lean_on_later_ones(tmp_path):
    """Open groups with pictures told by both sides, as phones write them, read in any order."""
    av = pytest.importorskip("av")
    if "libx264" not in av.codecs_available:
        pytest.skip("this PyAV cannot write H.264")
    rng = np.random.default_rng(4)
    noise = Image.fromarray(rng.integers(0, 255, (12, 16, 3), np.uint8))
    wide = np.array(noise.resize((128, 48)))
    options = {"g": "8", "bf": "3", "x264-params": "open-gop=1:threads=1"}
    with av.open(str(tmp_path / "rgb.mp4"), "w") as container:
        stream = container.add_stream("libx264", rate=60, options=options)
        stream.width, stream.height, stream.pix_fmt = 64, 48, "yuv420p"
        for index in range(40):
            picture = np.ascontiguousarray(wide[:, index : index + 64])
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        container.mux(stream.encode())
    movie = VideoDecoder(tmp_path / "rgb.mp4")
    assert len(movie.times) == 40
    forward = [movie.picture(index) for index in range(40)]
    for index, picture in enumerate(forward):
        off = np.abs(picture.astype(int) - wide[:, index : index + 64])
        assert np.median(off) < 12
    for index in rng.permutation(40).tolist():
        np.testing.assert_array_equal(movie.picture(index), forward[index])


def test_record3d_frames_numbered_with_zeros(tmp_path, shots):
    write_record3d(tmp_path, shots["record3d"][:3])
    for path in sorted((tmp_path / "rgbd").iterdir()):
        path.rename(path.with_name(f"{int(path.stem):05d}{path.suffix}"))
    frames = find_capture(tmp_path).frames
    assert [frame.name for frame in frames] == ["000000", "000001", "000002"]
    assert all(frame.depth_path and frame.trust_path for frame in frames)

"""NYU depth v2's raw dumps, written from the data set's description: disparities, bytes swapped."""

import numpy as np
import pytest
from tests.capture.readers.datasets.writing import save, zipped

from world2minecraft.capture import open_scan
from world2minecraft.capture.depth_images import DepthEncoding, read_depth
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.readers.datasets.nyu_raw import _depth_to_colour
from world2minecraft.capture.validation import validate_capture
from world2minecraft.core.errors import CaptureError


def disparity(view):
    """What a Kinect counts, by the fit that the toolbox publishes."""
    return np.round(1092.5 - 351.3 / np.maximum(view.depth_m, 0.4)).astype(np.uint16)


def write_nyu(folder, views, late_s=0.012):
    folder.mkdir(parents=True, exist_ok=True)
    names = []
    for index, view in enumerate(views):
        seconds = 1294886362.0 + index / 25
        save(folder / f"r-{seconds:.6f}-{2518684427 + index}.ppm", view.colour)
        values = disparity(view)
        path = folder / f"d-{seconds + late_s:.6f}-{2534681507 + index}.pgm"
        # A PGM keeps the higher byte first; the dump wrote the lower one there.
        body = values.astype("<u2").tobytes()
        path.write_bytes(f"P5 {values.shape[1]} {values.shape[0]} 65535\n".encode() + body)
        (folder / f"a-{seconds:.6f}-{index}.dump").write_bytes(bytes(20))
        names.append(path.name)
    (folder / "INDEX.txt").write_text("\n".join(names) + "\n")


def test_a_scene_is_depth_and_colour_without_poses(tmp_path, views):
    write_nyu(tmp_path, views)
    judged = validate_capture(tmp_path, ScanOptions())
    assert (judged.capture.source, judged.posed, judged.has_depth) == ("nyu_raw", False, True)
    assert len(judged.frames) == 12
    frame = judged.frames[4]
    assert frame.time_s == pytest.approx(1294886362.16)
    assert frame.depth_camera.fx_px == pytest.approx(582.62448 / 4)
    assert frame.colour_camera.distortion[0] == pytest.approx(0.2079662)
    depth = read_depth(frame.depth_path, DepthEncoding("nyu_raw"))
    true = views[4].depth_m
    np.testing.assert_allclose(depth, true, atol=0.5 * true.max() ** 2 / 351.3)
    with pytest.raises(CaptureError, match="contains no poses"):
        open_scan(tmp_path)


def test_a_zip_of_it_is_the_same(tmp_path, views):
    write_nyu(tmp_path / "kitchen_0001a", views)
    capture = find_capture(zipped(tmp_path, tmp_path / "a.zip"))
    assert (capture.source, len(capture.frames)) == ("nyu_raw", 12)


def test_the_colour_lens_is_to_the_right_of_the_depth_lens():
    """The toolbox turns all signs of rotation and shift; what it projects to is held here."""
    listed = -np.array(
        [
            [9.9997798940829263e-01, 5.0518419386157446e-03, 4.3011152014118693e-03],
            [-5.0359919480810989e-03, 9.9998051861143999e-01, -3.6879781309514218e-03],
            [-4.3196624923060242e-03, 3.6662365748484798e-03, 9.9998394948385538e-01],
        ]
    )
    rotation = np.linalg.inv(listed)
    shift = np.array([2.5031875059141302e-02, -2.9342312935846411e-04, 6.6238747008330102e-04])
    points = np.random.default_rng(1).uniform([-1, -1, 1], [1, 1, 4], (50, 3))
    toolbox = points @ rotation.T + shift
    ours = points @ _depth_to_colour()[:3, :3].T + _depth_to_colour()[:3, 3]
    np.testing.assert_allclose(
        ours[:, :2] / ours[:, 2:], toolbox[:, :2] / toolbox[:, 2:], atol=1e-6
    )
    assert _depth_to_colour()[0, 3] < -0.02


def test_images_pair_by_time_each_once(tmp_path, views):
    write_nyu(tmp_path, views)
    sorted(tmp_path.glob("d-*"))[5].unlink()
    frames = find_capture(tmp_path).frames
    assert len(frames) == 11
    assert len({str(frame.depth_path) for frame in frames}) == 11


def far_apart(folder):
    for path in folder.glob("d-*"):
        path.rename(folder / path.name.replace("d-1294", "d-1394"))


def cut(folder):
    for path in folder.glob("d-*"):
        path.write_bytes(path.read_bytes()[:9])


def empty(folder):
    for path in folder.glob("d-*"):
        path.write_bytes(b"")


def holes(folder):
    for path in folder.glob("d-*"):
        path.write_bytes(b"P5 160 120 65535\n" + b"\xff\x07" * (160 * 120))


def huge(folder):
    for path in folder.glob("d-*"):
        path.write_bytes(b"P5 90000 90000 65535\n" + bytes(100))


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (far_apart, "are within 0.05 s"),
        (cut, "frames are damaged"),
        (empty, "is empty"),
        (holes, "median depth of 0 m"),
        (huge, "the limit is 64"),
    ],
)
def test_damaged_dumps(tmp_path, views, refused, damage, words):
    write_nyu(tmp_path, views)
    damage(tmp_path)
    refused(tmp_path, words)


def test_the_shared_frame_is_a_room_deep(tmp_path, shared_data):
    """One real frame of the data set."""
    found = shared_data / "open3d_rgbd_samples" / "RGBD" / "other_formats"
    (tmp_path / "r-1.0-1.ppm").symlink_to(found / "NYU_color.ppm")
    (tmp_path / "d-1.01-2.pgm").symlink_to(found / "NYU_depth.pgm")
    judged = validate_capture(tmp_path, ScanOptions())
    assert 2 < judged.typical_depth_m < 5
    assert judged.frames[0].depth_camera.fx_px == pytest.approx(582.62448)

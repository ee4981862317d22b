"""The real kitchen, measured on frames that alignment did not look at."""

import numpy as np
import pytest

from world2minecraft.capture import describe_capture, open_scan
from world2minecraft.capture.open_scan import ALIGNMENT_FRAMES
from world2minecraft.capture.validation import evenly_spaced
from world2minecraft.core.coordinates import apply, rotation_about_z
from world2minecraft.geometry.unprojection import unproject_depth


@pytest.fixture(scope="module")
def kitchen(shared_data):
    """The scan and the points, in the room, of its frames that were kept apart."""
    scan = open_scan(shared_data / "redkitchen_rgbd")
    looked_at = set(evenly_spaced(scan.frames_used, ALIGNMENT_FRAMES))
    points = []
    for view in scan.views:
        if view.name not in looked_at:
            near = np.where(view.depth_m < 4, view.depth_m, np.float32(0))
            found, _ = unproject_depth(near, view.depth_camera, view.depth_camera_to_scan)
            points.append(apply(scan.scan_to_room, found[::11].astype(np.float64)))
    return scan, np.concatenate(points)


def _plane(points):
    """Return the best plane's normal and middle by RANSAC and an eigenvector."""
    rng = np.random.default_rng(0)
    best = np.zeros(len(points), bool)
    for _ in range(300):
        a, b, c = points[rng.choice(len(points), 3, replace=False)]
        normal = np.cross(b - a, c - a)
        size = np.linalg.norm(normal)
        if size > 0.02 and abs(normal[2]) > 0.9 * size:
            inside = np.abs((points - a) @ normal) < 0.02 * size
            best = inside if inside.sum() > best.sum() else best
    middle = points[best].mean(axis=0)
    normal = np.linalg.eigh(np.cov((points[best] - middle).T))[1][:, 0]
    return normal * np.sign(normal[2]), middle


def test_the_floor_is_level_and_at_zero(kitchen):
    _, points = kitchen
    normal, middle = _plane(points[np.abs(points[:, 2]) < 0.1])
    assert np.degrees(np.arccos(normal[2])) < 0.5
    assert abs(middle[2]) < 0.02


def test_the_table_stands_at_its_height(kitchen):
    _, points = kitchen
    _, middle = _plane(points[(points[:, 2] > 0.6) & (points[:, 2] < 0.82)])
    assert middle[2] == pytest.approx(0.72, abs=0.03)


def test_walls_and_fronts_lie_along_the_axes(kitchen):
    """The plan of walls and cupboards is sharper as it stands than turned by five degrees."""
    _, points = kitchen
    upright = points[(points[:, 2] > 0.1) & ((points[:, 0] < 0.7) | (points[:, 1] > 2.7))]
    sharpness = {}
    for turn in (-5.0, 0.0, 5.0):
        turned = apply(rotation_about_z(turn), upright)
        counts = [np.histogram(turned[:, axis], np.arange(-1, 5, 0.03))[0] for axis in (0, 1)]
        sharpness[turn] = float(np.sum(np.square(counts, dtype=float)))
    assert sharpness[0.0] > 1.1 * max(sharpness[-5.0], sharpness[5.0])


def test_all_frames_are_used_and_the_room_is_described(kitchen):
    scan, _ = kitchen
    assert (len(scan.frames_used), scan.frames_skipped) == (40, ())
    assert (scan.room_size_m > [3.5, 3.0, 1.5]).all()
    assert (scan.room_size_m < [5.0, 4.5, 3.0]).all()


def test_the_world_s_own_frame_does_not_matter(kitchen, shared_data, tmp_path):
    """Every second frame, so that other frames are looked at: the same room within noise."""
    scan, _ = kitchen
    half = open_scan(shared_data / "redkitchen_rgbd", options={"every": "2"})
    lean = np.degrees(np.arccos(min(1.0, half.scan_to_room[2, :3] @ scan.scan_to_room[2, :3])))
    assert lean < 0.5
    np.testing.assert_allclose(half.room_size_m[:2], scan.room_size_m[:2], atol=0.25)


def test_the_summary_of_the_kitchen(shared_data):
    summary = describe_capture(shared_data / "redkitchen_rgbd")
    assert (summary.source, summary.usable, summary.lost_poses) == ("seven_scenes", 40, 0)
    assert summary.depth_size_px == summary.colour_size_px == (640, 480)
    assert "one stated matrix" in " ".join(diagnostic.text for diagnostic in summary.diagnostics)


def test_a_folder_of_another_kind_is_refused(shared_data):
    from world2minecraft.core.errors import CaptureError

    with pytest.raises(CaptureError, match="of an unknown format, which contains .*; supported"):
        open_scan(shared_data / "layoutgpt_outputs")


# Up in the kitchen's world frame and the floor's distance below its origin, measured on other
# frames; good to about 0.4 degrees.
TRUE_UP, FLOOR_BELOW_M = np.array([0.0136, -0.8910, -0.4539]), 1.535


@pytest.mark.parametrize("first", [0, 5, 10, 15, 20])
def test_windows_of_twenty_frames_are_level(shared_data, tmp_path, first):
    """A window sees scraps of the floor, or the table alone; none may tip the room."""
    source = shared_data / "redkitchen_rgbd"
    names = sorted(path.name[:12] for path in (source / "frames").glob("*.pose.txt"))
    (tmp_path / "frames").mkdir()
    (tmp_path / "camera-intrinsics.txt").symlink_to(source / "camera-intrinsics.txt")
    for name in names[first : first + 20]:
        for path in (source / "frames").glob(f"{name}*"):
            (tmp_path / "frames" / path.name).symlink_to(path)
    scan = open_scan(tmp_path)
    up = scan.scan_to_room[2, :3]
    tilt_deg = np.degrees(np.arccos(up @ TRUE_UP / np.linalg.norm(TRUE_UP)))
    assert tilt_deg < 0.9
    assert scan.scan_to_room[2, 3] == pytest.approx(FLOOR_BELOW_M, abs=0.03)
    assert scan.frame_sigmas is not None
    assert tilt_deg < 3 * scan.frame_sigmas.tilt_deg

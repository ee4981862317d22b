"""What the tests of all data set formats share."""

import numpy as np
import pytest

from world2minecraft.capture import describe_capture, open_scan
from world2minecraft.core.errors import InputError


@pytest.fixture(scope="session")
def views(box_room):
    """Twelve exact views, in a world that is turned so that y is up."""
    turn = np.eye(4)
    turn[:3, :3] = [[0, 1, 0], [0, 0, 1], [1, 0, 0]]
    return box_room.views(12, turn)


@pytest.fixture
def refused():
    """Both ways in refuse a path with the same single line, which holds some words."""

    def check(path, *words):
        lines = set()
        for enter in (open_scan, describe_capture):
            with pytest.raises(InputError) as caught:
                enter(path)
            assert caught.value.exit_code == 3
            lines.add(str(caught.value))
        assert len(lines) == 1
        line = lines.pop()
        assert "\n" not in line
        for word in words:
            assert word in line
        return line

    return check


@pytest.fixture
def same_views(box_room):
    """The views that were read are those that were written, and make the room."""

    def check(scan, views, pose_off=1e-6, colour_off=0, depth_off=6e-4):
        assert len(scan.views) == len(views)
        for read, view in zip(scan.views, views, strict=True):
            np.testing.assert_allclose(read.camera_to_scan, view.camera_to_scan, atol=pose_off)
            np.testing.assert_allclose(read.depth_m, view.depth_m, atol=depth_off)
            off = np.abs(read.colour.astype(int) - view.colour)
            assert np.quantile(off, 0.98) <= colour_off
            for camera in (read.depth_camera, read.colour_camera):
                assert camera.fx_px == pytest.approx(view.colour_camera.fx_px, rel=1e-6)
                assert camera.cx_px == pytest.approx(view.colour_camera.cx_px, rel=1e-6)
                assert camera.cy_px == pytest.approx(view.colour_camera.cy_px, rel=1e-6)
        size = sorted(scan.room_size_m.tolist())
        np.testing.assert_allclose(size, sorted(box_room.size_m), atol=0.01)

    return check

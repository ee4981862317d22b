"""Images that lie on their side are turned; what each pixel shows in the world stays the same."""

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from world2minecraft.capture.alignment.image_rotation import (
    RotatedImage,
    find_quarter_turns,
    rotate_camera,
    rotate_frame,
)
from world2minecraft.capture.images import check_whole, read_colour, read_header, read_raw
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.core.coordinates import apply, look_at
from world2minecraft.core.types import Camera
from world2minecraft.geometry.unprojection import project

LENS = Camera(160, 120, 130.0, 128.0, 82.0, 57.0, (0.08, -0.03, 0.004, -0.007, 0.01))
DEPTH_LENS = Camera(80, 60, 66.0, 64.0, 41.0, 29.0)
UP = np.array([0.0, 0.0, 1.0])


def _rolled(turns):
    """A camera whose image must be turned ``turns`` times, counter-clockwise, to be upright."""
    angle = -np.pi / 2 * turns
    roll = np.eye(4)
    roll[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return look_at(np.array([1.0, 2.0, 1.5]), np.array([3.0, 2.5, 1.2])) @ roll


def _frame(pose, **other):
    return FrameFiles("a", pose, colour_camera=LENS, depth_camera=DEPTH_LENS, **other)


@pytest.mark.parametrize("turns", range(4))
def test_the_needed_rotation_is_found(turns):
    assert find_quarter_turns([_frame(_rolled(turns))] * 3, UP) == turns
    upright = rotate_frame(_frame(_rolled(turns)), turns)
    assert find_quarter_turns([upright], UP) == 0
    np.testing.assert_allclose(upright.camera_to_world, _rolled(0), atol=1e-12)


def test_the_majority_decides_and_a_tie_changes_nothing():
    side, right = _frame(_rolled(1)), _frame(_rolled(0))
    assert find_quarter_turns([side, side, right], UP) == 1
    assert find_quarter_turns([side, right, right], UP) == 0
    assert find_quarter_turns([side, right], UP) == 0


def test_cameras_looking_straight_down_do_not_vote():
    down = np.eye(4)
    down[:3, :3] = np.diag([1.0, -1.0, -1.0])
    assert find_quarter_turns([_frame(down)] * 5 + [_frame(_rolled(3))], UP) == 3
    assert find_quarter_turns([_frame(down)], UP) == 0
    assert find_quarter_turns([_frame(None)], UP) == 0


@pytest.mark.parametrize("turns", range(5))
def test_each_pixel_shows_the_same_place_of_the_world(turns):
    """Points seen at a pixel are seen at the turned pixel by the turned camera: both lenses."""
    rng = np.random.default_rng(3)
    depth_to_colour = np.eye(4)
    depth_to_colour[:3, 3] = [0.03, -0.01, 0.002]
    frame = _frame(_rolled(1), depth_to_colour=depth_to_colour)
    turned = rotate_frame(frame, turns)
    points = rng.uniform([-0.5, -0.4, 1], [0.5, 0.4, 3], (200, 3))
    for lens, other, pose, new_pose in (
        (LENS, turned.colour_camera, frame.camera_to_world, turned.camera_to_world),
        (
            DEPTH_LENS,
            turned.depth_camera,
            frame.camera_to_world @ depth_to_colour,
            turned.camera_to_world @ turned.depth_to_colour,
        ),
    ):
        world = apply(pose, points)
        at, size = project(points, lens), (lens.width_px, lens.height_px)
        for _ in range(turns):
            at = np.stack([at[:, 1], size[0] - at[:, 0]], axis=1)
            size = size[::-1]
        assert (other.width_px, other.height_px) == size
        seen = project(apply(np.linalg.inv(new_pose), world), other)
        np.testing.assert_allclose(seen, at, atol=1e-9)


def test_four_quarter_turns_change_nothing():
    frame = _frame(_rolled(2))
    turned = frame
    for _ in range(4):
        turned = rotate_frame(turned, 1)
    np.testing.assert_allclose(turned.camera_to_world, frame.camera_to_world, atol=1e-12)
    assert turned.colour_camera == rotate_camera(LENS, 4) == LENS


def test_all_images_of_a_frame_are_rotated_alike(tmp_path):
    rng = np.random.default_rng(1)
    colour = rng.integers(0, 255, (12, 16, 3), np.uint8)
    depth = rng.integers(1, 60000, (6, 8)).astype(np.uint16)
    Image.fromarray(colour).save(tmp_path / "c.png")
    Image.fromarray(depth).save(tmp_path / "d.png")
    paths = {"colour_path": tmp_path / "c.png", "depth_path": tmp_path / "d.png"}
    paths |= {"trust_path": tmp_path / "d.png", "labels_path": tmp_path / "d.png"}
    frame = rotate_frame(_frame(_rolled(1), **paths), 1)
    assert read_header(frame.colour_path).size == (12, 16)
    np.testing.assert_array_equal(read_colour(frame.colour_path), np.rot90(colour))
    for image in (frame.depth_path, frame.trust_path, frame.labels_path):
        assert isinstance(image, RotatedImage)
        assert (image.stem, image.name, str(image)) == ("d", "d.png", str(tmp_path / "d.png"))
        check_whole(image)
        np.testing.assert_array_equal(read_raw(image), np.rot90(depth))
    half = RotatedImage(tmp_path / "d.png", 2)
    assert read_header(half).size == (8, 6)


def test_a_frame_without_images_or_pose_is_rotated():
    bare = replace(_frame(None), colour_camera=None)
    turned = rotate_frame(bare, 3)
    assert turned.camera_to_world is None
    assert turned.colour_path is None
    assert rotate_frame(bare, 4) is bare

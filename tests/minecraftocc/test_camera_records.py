"""The record of a camera: right by itself, and the paper's printed matrices where asked for."""

import json

import numpy as np
import pytest

from world2minecraft.core.coordinates import (
    apply,
    block_to_room,
    carry_camera,
    invert,
    invert_rigid,
)
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.camera_records import (
    camera_from_record,
    camera_record,
    paper_matrices,
)
from world2minecraft.rendering.views.cameras import GamePose, camera_of

ROOM = block_to_room(np.array([1.0, 5.0]), 4.0)
CAMERA = camera_of(1920, 1129, vertical_fov_deg=70)
POSE = GamePose(10.5, 65.6, -3.25, 30.0, 12.0, "eye")


def record(**words):
    return camera_record(CAMERA, POSE.camera_to_room(ROOM), ROOM, **words)


def test_a_record_is_plain_json_and_comes_back():
    told = json.loads(json.dumps(record(), allow_nan=False))
    camera, camera_to_room = camera_from_record(told)
    assert camera == CAMERA
    np.testing.assert_array_equal(camera_to_room, POSE.camera_to_room(ROOM))
    assert told["vertical_fov_deg"] == pytest.approx(70)
    assert told["distortion"] == [0.0] * 5
    assert set(told["conventions"]) >= {"K", "E", "camera_to_block", "fov", "depth"}


def test_the_pose_is_that_of_the_game():
    pose = record()["game_pose"]
    assert pose["at"] == "eye"
    told = [pose[key] for key in ("x", "y", "z", "yaw", "pitch")]
    assert told == pytest.approx([10.5, 65.6, -3.25, 30.0, 12.0])


def test_blocks_and_rooms_are_seen_at_the_same_pixels():
    """A block's corner by ``camera_to_block``, and the same place of the room by ``E``."""
    told = record()
    k, e, other = (np.array(told[name]) for name in ("K", "E", "camera_to_block"))
    block = np.array([8.0, 64.0, 2.0])
    seen_room = k @ apply(invert_rigid(e), apply(ROOM, block))
    seen_block = k @ apply(invert_rigid(other), block)
    np.testing.assert_allclose(seen_room[:2] / seen_room[2], seen_block[:2] / seen_block[2])
    np.testing.assert_allclose(other, carry_camera(e, invert(ROOM)), atol=1e-12)


@pytest.mark.parametrize("yaw", [0.0, 45.0, -90.0, 133.7])
@pytest.mark.parametrize("pitch", [0.0, 12.0, -30.0])
def test_paper_compat_is_what_the_paper_prints(yaw, pitch):
    pose = GamePose(3.0, 66.0, -7.5, yaw, pitch, "eye")
    told = camera_record(CAMERA, pose.camera_to_room(ROOM), ROOM, paper_compat=True)
    t, p = np.radians([yaw, pitch])
    printed = np.array(
        [
            [-np.cos(t), 0, -np.sin(t)],
            [np.sin(t) * np.sin(p), -np.cos(p), -np.cos(t) * np.sin(p)],
            [-np.sin(t) * np.cos(p), -np.sin(p), np.cos(t) * np.cos(p)],
        ]
    )
    e = np.array(told["E"])
    np.testing.assert_allclose(e[:3, :3], printed, atol=1e-9)
    np.testing.assert_allclose(e[:, 3], [3.0, 66.0, -7.5, 1.0], atol=1e-9)
    np.testing.assert_array_equal(e[3], [0, 0, 0, 1])
    focal = 1920 / (2 * np.tan(np.radians(70) / 2))
    np.testing.assert_allclose(told["K"], [[focal, 0, 960], [0, focal, 564.5], [0, 0, 1]])


def test_the_slips_are_what_the_record_says():
    """Its rotation is the transpose of the right one; its focal length too long by W over H."""
    right, paper = record(), record(paper_compat=True)
    ours, theirs = (np.array(one)[:3, :3] for one in (right["camera_to_block"], paper["E"]))
    np.testing.assert_allclose(theirs, ours.T, atol=1e-9)
    assert paper["K"][0][0] / right["K"][0][0] == pytest.approx(1920 / 1129)
    assert "too large by the factor W / H" in paper["conventions"]["K"]
    assert "world-to-camera" in paper["conventions"]["E"]


def test_errors_say_what_to_do():
    with pytest.raises(UsageError, match="undistort the image first"):
        camera_record(Camera(9, 9, 5.0, 5.0, 4.0, 4.0, (0.1, 0, 0, 0, 0)), np.eye(4), ROOM)
    with pytest.raises(UsageError, match="use a record without paper_compat"):
        camera_from_record(record(paper_compat=True))
    for wrong in (
        {},
        {**record(), "K": [[1]]},
        {**record(), "E": "x"},
        {**record(), "width": None},
    ):
        with pytest.raises(UsageError, match="not a valid camera record"):
            camera_from_record(wrong)


def test_the_matrices_alone():
    k, e = paper_matrices(640, 480, 90.0, np.array([1.0, 2.0, 3.0]), 0.0, 0.0)
    np.testing.assert_allclose(k, [[320, 0, 320], [0, 320, 240], [0, 0, 1]], atol=1e-12)
    np.testing.assert_allclose(
        e, [[-1, 0, 0, 1], [0, -1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]], atol=1e-12
    )

"""Corrections through their file, and files that are none."""

import numpy as np
import pytest

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import write_npz
from world2minecraft.core.types import Corrections
from world2minecraft.formats.scan_record import read_poses, write_poses


def test_corrections_come_back_as_they_were(tmp_path):
    change = np.stack([np.eye(4)] * 2)
    change[1, :3, 3] = [0.1, -0.2, 0.3]
    given = Corrections(("one", "zwei ü"), change, np.array([1.0, 0.97]))
    write_poses(tmp_path / "poses.npz", given)
    found = read_poses(tmp_path / "poses.npz")
    assert found.names == given.names
    np.testing.assert_array_equal(found.pose_change, given.pose_change)
    np.testing.assert_array_equal(found.depth_scale, given.depth_scale)


def test_no_frames_come_back_too(tmp_path):
    write_poses(tmp_path / "poses.npz", Corrections((), np.zeros((0, 4, 4)), np.zeros(0)))
    assert read_poses(tmp_path / "poses.npz").names == ()


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("depth_scale", np.array([0.0]), "depth_scale must be above 0"),
        ("pose_change", np.zeros((1, 4, 4)), "must be a rotation and a translation"),
        ("names", np.array(["a", "a"]), "names must be distinct"),
    ],
)
def test_what_is_no_correction_is_refused(tmp_path, name, value, text):
    arrays = {"names": np.array(["a"]), "pose_change": np.eye(4)[None], "depth_scale": np.ones(1)}
    write_npz(tmp_path / "poses.npz", arrays | {name: value})
    with pytest.raises(
        DamagedFileError, match=f"poses.npz.*does not contain valid corrections.*{text}"
    ):
        read_poses(tmp_path / "poses.npz")

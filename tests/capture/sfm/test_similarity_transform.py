"""Similarities of poses: laws over random ones, robustness, and another sensor's poses."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from world2minecraft.capture.sfm import align_similarity

SEEDS = st.integers(0, 10_000)


def random_poses(rng: np.random.Generator, count: int) -> np.ndarray:
    poses = np.tile(np.eye(4), (count, 1, 1))
    poses[:, :3, :3] = Rotation.random(count, random_state=rng).as_matrix()
    poses[:, :3, 3] = rng.uniform(-2, 2, (count, 3))
    return poses


def carried(poses: np.ndarray, scale: float, rotation: np.ndarray, shift: np.ndarray) -> np.ndarray:
    moved = poses.copy()
    moved[:, :3, :3] = rotation @ poses[:, :3, :3]
    moved[:, :3, 3] = scale * poses[:, :3, 3] @ rotation.T + shift
    return moved


def random_change(rng: np.random.Generator) -> tuple[float, np.ndarray, np.ndarray]:
    rotation = Rotation.random(random_state=rng).as_matrix()
    return float(np.exp(rng.uniform(-3, 3))), rotation, rng.uniform(-5, 5, 3)


@given(SEEDS, st.integers(2, 12))
def test_a_known_similarity_is_found(seed, count):
    rng = np.random.default_rng(seed)
    poses, change = random_poses(rng, count), random_change(rng)
    found = align_similarity(poses, carried(poses, *change))
    assert found.scale == pytest.approx(change[0], rel=1e-8)
    assert np.allclose(found.rotation, change[1], atol=1e-8)
    assert np.allclose(found.poses(poses), carried(poses, *change), atol=1e-7)
    assert found.off_m.max() < 1e-7 and found.off_deg.max() < 1e-5


@given(SEEDS)
def test_there_and_back_is_the_identity(seed):
    rng = np.random.default_rng(seed)
    poses = random_poses(rng, 6)
    other = carried(poses, *random_change(rng))
    there, back = align_similarity(poses, other), align_similarity(other, poses)
    assert there.scale * back.scale == pytest.approx(1, rel=1e-8)
    points = rng.uniform(-3, 3, (5, 3))
    assert np.allclose(back.points(there.points(points)), points, atol=1e-7)


@given(SEEDS)
def test_a_third_of_wrong_poses_changes_little(seed):
    rng = np.random.default_rng(seed)
    poses, change = random_poses(rng, 15), random_change(rng)
    wanted = carried(poses, *change)
    wanted[:5] = random_poses(rng, 5)
    found = align_similarity(poses, wanted)
    assert found.scale == pytest.approx(change[0], rel=1e-3)
    assert np.allclose(found.rotation, change[1], atol=1e-3)


def test_rotations_hold_what_a_straight_path_cannot():
    rng = np.random.default_rng(3)
    poses = random_poses(rng, 10)
    poses[:, 1:3, 3] = 0  # Centres on a line: any turn about it fits them.
    change = random_change(rng)
    assert np.allclose(align_similarity(poses, carried(poses, *change)).rotation, change[1])


@given(SEEDS)
def test_the_mount_of_another_sensor_is_found(seed):
    rng = np.random.default_rng(seed)
    poses, change = random_poses(rng, 12), random_change(rng)
    wanted = carried(poses, *change)
    mount = rng.uniform(-0.1, 0.1, 3)
    wanted[:, :3, 3] += wanted[:, :3, :3] @ mount
    found = align_similarity(poses, wanted, mounted=True)
    assert np.allclose(found.mount_m, mount, atol=1e-6)
    assert found.scale == pytest.approx(change[0], rel=1e-6)


@pytest.mark.parametrize(
    ("given_poses", "wanted", "message"),
    [
        (np.eye(4)[None], np.eye(4)[None], "a similarity requires 2 or more poses, got 1"),
        (
            np.tile(np.eye(4), (3, 1, 1)),
            random_poses(np.random.default_rng(0), 3),
            "all camera positions are identical, so the scale cannot be estimated",
        ),
        (
            random_poses(np.random.default_rng(0), 3),
            random_poses(np.random.default_rng(0), 4),
            "wanted must have shape 3x4x4, got (4, 4, 4)",
        ),
    ],
)
def test_what_cannot_be_aligned(given_poses, wanted, message):
    with pytest.raises(ValueError) as caught:
        align_similarity(given_poses, wanted)
    assert str(caught.value) == message

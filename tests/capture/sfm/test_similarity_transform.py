"""Similarities of poses: laws over random ones, robustness, and poses that turn too far."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from world2minecraft.capture.sfm import align_similarity, align_views

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


@given(SEEDS, st.integers(3, 12))
def test_views_give_a_known_similarity(seed, count):
    rng = np.random.default_rng(seed)
    poses, change = random_poses(rng, count), random_change(rng)
    found = align_views(poses, carried(poses, *change), rng.uniform(1, 4, count))
    assert found.scale == pytest.approx(change[0], rel=1e-6)
    assert np.allclose(found.rotation, change[1], atol=1e-6)
    assert np.allclose(found.poses(poses), carried(poses, *change), atol=1e-5)


@given(SEEDS)
def test_a_third_of_wrong_views_changes_little(seed):
    rng = np.random.default_rng(seed)
    poses, change = random_poses(rng, 15), random_change(rng)
    wanted = carried(poses, *change)
    wanted[:5] = random_poses(rng, 5)
    found = align_views(poses, wanted, np.full(15, 2.0))
    assert found.scale == pytest.approx(change[0], rel=1e-2)
    assert np.allclose(found.rotation, change[1], atol=1e-2)


def test_surface_is_carried_though_stated_poses_turn_too_far():
    """A camera pans; the stated poses turn 8 % too far about the point that it looks at."""
    depth = 2.0
    true, stated = [], []
    for degrees in np.linspace(-30, 30, 13):
        for poses, factor in ((true, 1.0), (stated, 1.08)):
            pose = np.eye(4)
            pose[:3, :3] = Rotation.from_euler("y", factor * degrees, degrees=True).as_matrix()
            pose[:3, 3] = -depth * pose[:3, 2] + [0.3 * np.sin(np.radians(degrees)), 0, 0]
            poses.append(pose)
    true, stated = np.array(true), np.array(stated)

    def surface_error(found) -> float:
        ahead = np.array([0.0, 0.0, depth])
        carried_to = found.points(true[:, :3, :3] @ ahead + true[:, :3, 3])
        there = stated[:, :3, :3] @ (found.scale * ahead) + stated[:, :3, 3]
        return float(np.linalg.norm(carried_to - there, axis=1).mean())

    by_views = align_views(true, stated, np.full(13, depth))
    assert surface_error(by_views) < 0.01
    assert surface_error(by_views) < 0.5 * surface_error(align_similarity(true, stated))
    assert by_views.scale == pytest.approx(1.0, abs=0.02)


def test_depths_must_be_above_zero():
    poses = random_poses(np.random.default_rng(0), 3)
    with pytest.raises(ValueError, match="depths must be above 0, got 0"):
        align_views(poses, poses, np.array([1.0, 0.0, 2.0]))


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

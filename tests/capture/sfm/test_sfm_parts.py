"""The parts of posing, each against a slow reference or its inverse."""

import sys

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter
from tests.capture.sfm.box_room import poses

from world2minecraft.capture.sfm import SfmParameters, find_poses, results
from world2minecraft.capture.sfm import pycolmap_access as pycolmap_session
from world2minecraft.capture.sfm.camera_groups import (
    default_camera,
    from_colmap,
    is_plausible_camera,
    normalise_pixels,
    to_colmap,
)
from world2minecraft.capture.sfm.features import sharpness
from world2minecraft.capture.sfm.incremental_mapping import merge_models
from world2minecraft.capture.sfm.matching import match_descriptors, select_pairs
from world2minecraft.capture.sfm.pose_verification import find_outliers, sampson_errors
from world2minecraft.capture.sfm.progress import ProgressSteps
from world2minecraft.core.errors import CaptureError, MissingExtraError
from world2minecraft.core.types import Camera
from world2minecraft.geometry.unprojection import project

BENT = Camera(640, 480, 500.0, 510.0, 310.0, 250.0, (-0.2, 0.05, 0.001, -0.002, 0.01))


def slow_matches(first: np.ndarray, second: np.ndarray) -> list[list[int]]:
    """Matches as they are defined: nearest both ways, and clearly nearer than the next."""
    angle = np.arccos(np.minimum(first.astype(float) @ second.T.astype(float) / 512**2, 1))
    found = []
    for i, row in enumerate(angle):
        j = int(np.argmin(row))
        near, after = np.sort(row)[:2]
        if near < 0.7 and near < 0.8 * after and int(np.argmin(angle[:, j])) == i:
            found.append([i, j])
    return found


def descriptors(rng: np.random.Generator, count: int) -> np.ndarray:
    values = rng.exponential(size=(count, 128))
    return np.round(512 * values / np.linalg.norm(values, axis=1, keepdims=True)).astype(np.uint8)


def test_matches_are_those_of_the_definition():
    rng = np.random.default_rng(0)
    first = descriptors(rng, 60)
    noisy = first[::-1] + rng.integers(0, 12, first.shape).astype(np.uint8)
    second = np.concatenate([descriptors(rng, 20), noisy])
    found = match_descriptors(first, second).tolist()
    assert len(found) > 40 and found == slow_matches(first, second)


def test_nothing_matches_nothing():
    empty, one = np.zeros((0, 128), np.uint8), descriptors(np.random.default_rng(0), 1)
    assert (
        len(match_descriptors(empty, one))
        == len(match_descriptors(one, empty))
        == len(match_descriptors(one, one))
        == 0
    )


def test_the_most_similar_and_neighbours_are_paired():
    alike = np.zeros((5, 5), np.int64)
    alike[0, 4] = alike[4, 0] = 30
    alike[1, 2] = alike[2, 1] = 5
    chosen = select_pairs(alike, SfmParameters(partners=1, neighbours=1))
    assert chosen == [(0, 4), (1, 2)]


def test_normalising_inverts_lens_distortion():
    rays = np.random.default_rng(0).uniform(-0.5, 0.5, (50, 2))
    pixels = project(np.concatenate([rays, np.ones((50, 1))], axis=1) * 3.0, BENT)
    assert np.allclose(normalise_pixels(BENT, pixels), rays, atol=1e-8)


@pytest.mark.parametrize(
    "camera",
    [
        default_camera(640, 480),
        Camera(640, 480, 500.0, 500.0, 310.0, 250.0, (-0.1, 0.02, 0, 0, 0)),
        Camera(640, 480, 500.0, 505.0, 310.0, 250.0, (-0.1, 0.02, 0.001, 0.002, 0)),
        BENT,
    ],
)
def test_cameras_come_back_from_colmap_and_see_alike(camera):
    with pycolmap_session.pycolmap_session() as pycolmap:
        made = to_colmap(pycolmap, camera, 1, simple=False)
        assert from_colmap(made) == camera
        points = np.random.default_rng(0).uniform([-1, -1, 2], [1, 1, 4], (20, 3))
        assert np.allclose(made.img_from_cam(points), project(points, camera), atol=1e-6)


def test_plausible_cameras():
    assert is_plausible_camera(default_camera(640, 480)) and is_plausible_camera(
        default_camera(640, 480, 0.4)
    )
    assert not is_plausible_camera(default_camera(640, 480, 2.8))
    assert not is_plausible_camera(Camera(640, 480, 512.0, 512.0, 320.0, 240.0, (1.2, 0, 0, 0, 0)))


def test_rays_that_meet_have_no_epipolar_error():
    first, second = poses(2)
    points = np.random.default_rng(0).uniform([2, 2, 0], [4, 3, 2], (30, 3))
    seen = []
    for pose in (first, second):
        local = (points - pose[:3, 3]) @ pose[:3, :3]
        seen.append(local[:, :2] / local[:, 2:])
    change = np.linalg.inv(second) @ first
    assert sampson_errors(seen[0], seen[1], change).max() < 1e-12
    assert np.median(sampson_errors(seen[0], seen[1] + [0, 0.01], change)) > 0.003


def test_outliers_are_far_worse_than_the_rest():
    usual = SfmParameters()
    assert find_outliers({0: 0.5, 1: 0.6, 2: 40.0, 3: 0.7}, 1.0, usual) == {2}
    assert find_outliers({0: 9.0, 1: 8.0, 2: 10.0, 3: 12.0}, 1.0, usual) == set()
    assert find_outliers({0: 0.5, 1: 40.0, 2: 40.0}, 1.0, usual) == set()


def test_blur_is_seen():
    image = np.kron(np.random.default_rng(0).integers(0, 2, (12, 16)) * 200, np.ones((20, 20)))
    crisp, soft = (np.uint8(gaussian_filter(image, sigma)) for sigma in (0.5, 5))
    assert sharpness(crisp) > 3 * sharpness(soft) and sharpness(np.zeros((9, 9), np.uint8)) == 0


def test_models_that_share_photos_are_merged():
    every, camera = poses(10), default_camera(320, 240)
    turned = np.eye(4)
    turned[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    first = {i: (every[i], camera) for i in range(7)}
    second = {}
    for i in range(4, 10):
        pose = turned @ every[i]
        pose[:3, 3] *= 3
        second[i] = (pose, camera)
    whole, count = merge_models([first, second])
    assert count == 1 and sorted(whole) == list(range(10))
    assert np.allclose(whole[9][0], every[9], atol=1e-7)
    apart = {i: second[i] for i in (6, 7, 8, 9)}
    assert merge_models([first, apart]) == (first, 0)


def test_progress_never_falls_and_ends():
    told = []
    steps = ProgressSteps(lambda *a: told.append(a), {"a": 3, "b": 10, "c": 2})
    for _ in range(5):
        steps.done("a")
    steps.done("b", 1, 4)
    steps.done("c")
    steps.done("b", 4, 4)
    steps.end()
    counts = [done for _, done, _, _ in told]
    assert counts == sorted(counts) and told[-1][1] == told[-1][2]


def test_pycolmap_is_optional(monkeypatch):
    monkeypatch.setitem(sys.modules, "pycolmap", None)
    with pytest.raises(MissingExtraError) as caught:
        find_poses([])
    assert str(caught.value) == (
        "pose estimation needs an extra: pip install 'world2minecraft[capture]'"
    )


def test_failures_of_colmap_are_one_line():
    with pytest.raises(CaptureError) as caught, pycolmap_session.pycolmap_session():
        raise RuntimeError("[x.cc:1] Check failed\nand more")
    assert str(caught.value) == (
        "photos: pose estimation failed ([x.cc:1] Check failed); "
        "remove unusual photos and try again"
    )


def test_a_few_placed_photos_are_no_room():
    assert str(results.too_few_error(6, 40)) == (
        "photos: poses were found for only 6 of 40 photos, which is not reliable; move sideways "
        "around the room so that each photo overlaps the next by more than half, and step back "
        "to show furniture and corners"
    )


@pytest.mark.parametrize(
    "bad", [{"working_px": 5}, {"partners": 0}, {"good_px": 0}, {"gates_px": ()}]
)
def test_parameters_are_checked(bad):
    with pytest.raises(ValueError):
        SfmParameters(**bad)

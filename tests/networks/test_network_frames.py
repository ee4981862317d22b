"""Frames of samples: pictures and intrinsics move together, labels by the published rule."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.minecraftocc.exchange.synthetic import sample
from tests.networks.toy_sets import CAMERA, WIDE

from world2minecraft.core.errors import InputError
from world2minecraft.core.types import Camera
from world2minecraft.formats.sscnet import downsample_labels
from world2minecraft.networks.config import GRIDS
from world2minecraft.networks.data.batches import augment_frame, flip_frame, jitter_colour
from world2minecraft.networks.data.frames import FrameRule, make_frame

LARGE = Camera(160, 120, 130.0, 130.0, 80.0, 60.0)
COARSE, FINE = GRIDS["0.16"], GRIDS["0.08"]
SAMPLE = sample(camera=CAMERA)


def projected(frame, voxel_m):
    """The pixels (column, row) and depths of all cells' centres, from the frame's own matrices."""
    centres = (np.moveaxis(np.indices(frame.labels.shape), 0, -1) + 0.5) * voxel_m
    to_camera = np.linalg.inv(frame.camera_to_grid.astype(np.float64))
    points = centres @ to_camera[:3, :3].T + to_camera[:3, 3]
    pixels = points @ frame.intrinsics.astype(np.float64).T
    return pixels[..., :2] / pixels[..., 2:], points[..., 2]


def agreement(frame, voxel_m):
    """Of the pixels whose point lies in the grid, the share that lies in an occupied cell."""
    rows, columns = np.indices(frame.depth_m.shape)
    pixels = np.stack([columns + 0.5, rows + 0.5, np.ones(rows.shape)], axis=-1)
    rays = pixels @ np.linalg.inv(frame.intrinsics.astype(np.float64)).T
    points = rays * (frame.depth_m[..., None] + 0.5 * voxel_m)
    pose = frame.camera_to_grid.astype(np.float64)
    cells = np.floor((points @ pose[:3, :3].T + pose[:3, 3]) / voxel_m).astype(int)
    inside = ((cells >= 0) & (cells < frame.labels.shape)).all(-1) & (frame.depth_m > 0)
    met = frame.labels[tuple(cells[inside].T)]
    return np.mean((met > 0) & (met < 255))


@pytest.mark.parametrize("size", [(160, 120), (80, 60), (120, 120), (160, 60)])
@pytest.mark.parametrize("camera", [LARGE, WIDE])
def test_cells_project_to_their_pixels_after_crop_and_resize(size, camera):
    frame = make_frame(sample(camera=camera), FrameRule(FINE, *size))
    assert frame.image.shape == (size[1], size[0], 3)
    assert agreement(frame, 0.08) > 0.95
    pixels, depth_m = projected(frame, 0.08)
    inside = (pixels >= 0).all(-1) & (pixels < np.array(size)).all(-1) & (depth_m > 0)
    assert np.mean(inside == frame.in_frustum) > 0.9999


def test_wrong_intrinsics_would_be_seen():
    frame = make_frame(SAMPLE, FrameRule(FINE, 40, 30))
    wrong = replace(frame, intrinsics=SAMPLE.camera.matrix.astype(np.float32))
    assert agreement(wrong, 0.08) < 0.7


def test_depth_is_never_mixed_across_an_edge():
    near_and_far = SAMPLE.depth_m.copy()
    near_and_far[:, ::2], near_and_far[::3] = 1.0, 3.0
    near_and_far[5] = 0
    frame = make_frame(replace(SAMPLE, depth_m=near_and_far), FrameRule(FINE, 40, 30))
    assert set(np.unique(frame.depth_m)) <= set(np.unique(near_and_far))


def test_a_picture_of_the_same_size_is_the_same():
    frame = make_frame(SAMPLE, FrameRule(FINE, 80, 60))
    np.testing.assert_array_equal(frame.image, SAMPLE.colour)
    np.testing.assert_array_equal(frame.depth_m, SAMPLE.depth_m)
    np.testing.assert_array_equal(frame.labels, SAMPLE.occ.labels)
    np.testing.assert_array_equal(frame.seen, SAMPLE.occ.visible)
    np.testing.assert_allclose(frame.intrinsics, SAMPLE.camera.matrix)


def test_coarse_labels_and_masks_follow_the_published_rule():
    frame, occ = make_frame(SAMPLE, FrameRule(COARSE, 40, 30)), SAMPLE.occ
    np.testing.assert_array_equal(frame.labels, downsample_labels(occ.labels, 2))
    for i, j, k in ((3, 4, 5), (0, 0, 0), (29, 29, 17), (15, 20, 1)):
        block = np.s_[2 * i : 2 * i + 2, 2 * j : 2 * j + 2, 2 * k : 2 * k + 2]
        assert frame.seen[i, j, k] == occ.visible[block].any()
        free = occ.free[block].any() and frame.labels[i, j, k] == 0 and not frame.seen[i, j, k]
        assert frame.free[i, j, k] == free
    assert not (frame.seen & frame.free).any()
    assert frame.known.seen is frame.seen


def test_what_cannot_be_a_frame_says_why():
    rule = FrameRule(COARSE, 40, 30)
    with pytest.raises(InputError, match="has no image"):
        make_frame(replace(SAMPLE, colour=None), rule)
    bent = replace(SAMPLE.camera, distortion=(0.1, 0.0, 0.0, 0.0, 0.0))
    with pytest.raises(InputError, match="has lens distortion"):
        make_frame(replace(SAMPLE, camera=bent), rule)
    odd = replace(SAMPLE.occ.region, voxel_m=0.1)
    with pytest.raises(InputError, match="0.1 m cannot be converted to 30x30x18 cells"):
        make_frame(replace(SAMPLE, occ=replace(SAMPLE.occ, region=odd)), rule)


FRAME = make_frame(SAMPLE, FrameRule(FINE, 80, 60))
GRIDDED = ("labels", "in_frustum", "seen", "free", "image", "depth_m")


def test_to_flip_twice_is_to_flip_never():
    twice = flip_frame(flip_frame(FRAME, 0.08), 0.08)
    for name in GRIDDED:
        np.testing.assert_array_equal(getattr(twice, name), getattr(FRAME, name))
    np.testing.assert_allclose(twice.intrinsics, FRAME.intrinsics, atol=1e-5)
    np.testing.assert_allclose(twice.camera_to_grid, FRAME.camera_to_grid, atol=1e-5)


def test_a_flipped_frame_is_of_a_mirrored_room():
    mirrored = flip_frame(FRAME, 0.08)
    assert agreement(mirrored, 0.08) == pytest.approx(agreement(FRAME, 0.08), abs=0.003)
    before, depth_before = projected(FRAME, 0.08)
    after, depth_after = projected(mirrored, 0.08)
    np.testing.assert_allclose(depth_after[::-1], depth_before, atol=1e-4)
    seen = FRAME.in_frustum
    np.testing.assert_allclose(80 - after[::-1][seen][:, 0], before[seen][:, 0], atol=1e-2)
    np.testing.assert_allclose(after[::-1][seen][:, 1], before[seen][:, 1], atol=1e-2)
    turn = mirrored.camera_to_grid[:3, :3]
    assert np.linalg.det(turn) == pytest.approx(1, abs=1e-5)
    half = replace(mirrored, labels=FRAME.labels)
    assert agreement(half, 0.08) < 0.95  # A room that is not mirrored with its picture.


@given(st.floats(0, 1), st.integers(0, 2**20))
def test_jitter_keeps_the_size_and_its_seed(strength, seed):
    picture = FRAME.image[::8, ::8]
    one = jitter_colour(picture, strength, np.random.default_rng(seed))
    again = jitter_colour(picture, strength, np.random.default_rng(seed))
    assert one.dtype == np.uint8 and one.shape == picture.shape
    np.testing.assert_array_equal(one, again)


def test_jitter_stays_within_its_bounds():
    rng = np.random.default_rng(0)
    assert jitter_colour(FRAME.image, 0.0, rng) is FRAME.image
    grey = np.full((4, 4, 3), 100, np.uint8)
    values = [jitter_colour(grey, 0.4, np.random.default_rng(n)) for n in range(50)]
    assert min(v.min() for v in values) >= 60 and max(v.max() for v in values) <= 140
    assert len({v[0, 0, 0] for v in values}) > 20


def test_augmentation_flips_about_as_often_as_set():
    flips = [
        augment_frame(FRAME, 0.08, 0.25, 0.0, np.random.default_rng(n)).labels is not FRAME.labels
        for n in range(200)
    ]
    assert 30 <= sum(flips) <= 70

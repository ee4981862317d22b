"""Virtual scans to learn from: their truth, their noise, and that a seed is a seed."""

import numpy as np
import pytest
from scipy import ndimage

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import write_npz
from world2minecraft.networks.completion.augmentation import (
    augment_sample,
    crop_sample,
    rotate_sample,
)
from world2minecraft.networks.completion.samples import (
    crop_input,
    labelled_sample,
    make_samples,
    read_samples,
    training_room,
    write_samples,
)
from world2minecraft.networks.completion.sensor_noise import (
    MAX_LEAN_DEG,
    draw_lost_pixels,
    draw_noise,
    store_depth,
)
from world2minecraft.networks.completion.virtual_views import VirtualScan, fuse_scan, lean_scan
from world2minecraft.procgen.sensors.depth_camera import bend_depth
from world2minecraft.procgen.sensors.photo_rendering import prepare_photos
from world2minecraft.reconstruction.semantics.completion_channels import network_input

SEED = 9_500  # Held out.


@pytest.fixture(scope="module")
def samples():
    return make_samples(SEED)


def channels(sample):
    return network_input(sample.sight)


def test_a_seed_gives_walks_and_single_views(samples):
    assert {sample.kind for sample in samples} >= {"walk", "single"}
    walk = next(sample for sample in samples if sample.kind == "walk")
    assert walk.hinted
    assert 0 < walk.false_share < 0.6
    known = walk.truth != 255
    assert known.mean() > 0.5
    assert set(np.unique(walk.truth)) >= {0, 2, 3, 255}


def test_most_of_the_surface_is_true_and_lies_in_the_room(samples):
    for sample in samples:
        there = sample.truth.reshape(-1)[sample.sight.at]
        assert (there != 255).mean() > 0.8
        assert (there[there != 255] > 0).mean() == pytest.approx(1 - sample.false_share)


def test_what_is_written_is_read(samples, tmp_path):
    write_samples(tmp_path / "1.npz", samples)
    for one, other in zip(samples, read_samples(tmp_path / "1.npz"), strict=True):
        assert (one.kind, one.hinted) == (other.kind, other.hinted)
        assert np.array_equal(one.truth, other.truth)
        assert np.array_equal(channels(one), channels(other))


def test_a_file_without_samples_is_reported(tmp_path):
    path = tmp_path / "1.npz"
    path.write_bytes(b"no archive")
    with pytest.raises(DamagedFileError, match="is not a readable .npz"):
        read_samples(path)
    write_npz(path, {"count": np.array(1)})
    with pytest.raises(DamagedFileError, match="not a valid sample file"):
        read_samples(path)


def test_four_turns_and_two_mirrors_are_none(samples):
    one = samples[0]
    for other in (
        rotate_sample(rotate_sample(one, 1, False), 3, False),
        rotate_sample(rotate_sample(one, 0, True), 0, True),
        rotate_sample(rotate_sample(rotate_sample(one, 1, True), 1, True), 0, False),
    ):
        assert np.array_equal(one.truth, other.truth)
        assert np.array_equal(channels(one), channels(other))


def test_a_turn_moves_truth_and_sight_alike(samples):
    one = samples[0]
    other = rotate_sample(one, 1, False)
    assert np.array_equal(other.truth, np.rot90(one.truth, 1, (0, 1)))
    wanted, told = np.rot90(channels(one), 1, (1, 2)), channels(other)
    x, y = 10, 11  # The channels of the offset along x and y.
    assert np.array_equal(told[:x], wanted[:x])
    assert np.array_equal(told[y + 1 :], wanted[y + 1 :])
    assert np.array_equal(told[x], -wanted[y])
    assert np.array_equal(told[y], wanted[x])


def test_a_window_holds_what_lay_there(samples):
    one, start, shape = samples[0], np.array([-3, 5, -2]), (20, 24, 16)
    part = crop_sample(one, start, shape)
    whole = channels(one)
    assert np.array_equal(channels(part)[:, 3:, :, 2:], whole[:, :17, 5:29, :14])
    assert (part.truth[:3] == 255).all()
    assert part.sight.bottom_m == pytest.approx(one.sight.bottom_m - 2 * 0.08)
    assert not crop_input(one.sight, np.array([500, 0, 0]), shape).log_odds.any()


def test_a_seed_augments_as_a_seed(samples):
    one, other = (
        augment_sample(samples[0], np.random.default_rng(3), (32, 32, 24)) for _ in range(2)
    )
    assert one.truth.shape == (32, 32, 24)
    assert np.array_equal(channels(one), channels(other))
    assert np.array_equal(one.truth, other.truth)


def test_glass_has_no_depth():
    rng = np.random.default_rng(0)
    noise = next(
        n for s in range(99) if (n := draw_noise(np.random.default_rng(s), "walk")).glass == 1
    )
    labels = np.full((48, 64), 3, np.uint8)
    labels[10:20, 10:20] = 4
    assert draw_lost_pixels(noise, labels, np.ones(labels.shape), rng)[10:20, 10:20].all()


def test_frames_lean_and_some_depth_is_stored_in_steps():
    noises = [draw_noise(np.random.default_rng(seed), "single") for seed in range(200)]
    leans = [np.linalg.norm(noise.lean_deg) for noise in noises]
    assert 1.5 < max(leans) <= MAX_LEAN_DEG + 1e-9
    depth_m = np.linspace(0, 5, 48, dtype=np.float32).reshape(6, 8)
    exact = next(noise for noise in noises if not noise.depth_step_m)
    assert np.array_equal(store_depth(exact, depth_m), depth_m)
    stepped = next(noise for noise in noises if noise.depth_step_m)
    steps = store_depth(stepped, depth_m) / stepped.depth_step_m
    assert np.allclose(steps, np.round(steps), atol=1e-3)


def test_the_bend_of_depth_grows_with_its_square():
    depth_m = np.full((24, 32), 2.5, np.float32)
    near, far = (
        bend_depth(scale * depth_m, 0.02, np.random.default_rng(5)) - scale * depth_m
        for scale in (1, 2)
    )
    assert np.abs(near).max() == pytest.approx(0.02, abs=1e-5)
    assert np.allclose(far, 4 * near, atol=1e-5)
    assert not bend_depth(np.zeros((24, 32), np.float32), 0.02, np.random.default_rng(5)).any()


def test_a_leaning_scan_turns_about_the_floor_below_its_cameras():
    poses = np.tile(np.eye(4), (2, 1, 1))
    poses[:, :3, 3] = [[1, 2, 1.5], [3, 2, 1.5]]
    scan = VirtualScan("walk", poses, np.eye(4), True)
    leaning = lean_scan(scan, np.array([1.5, -1.0])).room_to_grid
    assert np.allclose(leaning @ [2, 2, 0, 1], [2, 2, 0, 1])
    assert np.degrees(np.arccos(leaning[2, 2])) == pytest.approx(np.hypot(1.5, 1.0), abs=1e-3)


def test_the_truth_is_empty_beyond_the_room_and_then_unknown(samples):
    for sample in samples:
        room = (sample.truth != 255) & (sample.truth != 0)
        apart = ndimage.distance_transform_edt(~room)
        assert (sample.truth[apart > 60] == 255).all()
    single = next(sample for sample in samples if sample.kind == "single")
    assert (single.truth == 0).mean() > 0.3


def test_a_labelled_frame_is_known_where_its_surface_is():
    room, rng = training_room(SEED), np.random.default_rng(2)
    poses = np.tile(np.eye(4), (1, 1, 1))
    poses[0, :3, :3] = np.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0]])
    poses[0, :3, 3] = [0.6, room.labels.shape[1] * room.voxel_m / 2, 1.5]
    scan = VirtualScan("single", poses, np.eye(4), True)
    evidence = fuse_scan(room, prepare_photos(room), scan, draw_noise(rng, "single"), rng)
    sample = labelled_sample(evidence)
    assert len(sample.sight.at) > 300
    surface = sample.truth.reshape(-1)[sample.sight.at]
    voted = sample.sight.votes.any(axis=1)
    assert (surface[voted] == sample.sight.votes[voted].argmax(axis=1) + 1).all()
    assert (surface[~voted] == 255).all()
    assert (sample.truth[sample.sight.log_odds < 0] == 0).all()
    assert (sample.truth[sample.sight.log_odds == 0] == 255).all()

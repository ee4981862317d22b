"""The sensor model, held against its own figures."""

import numpy as np
import pytest

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.geometry.rotations import rotation_from_vector
from world2minecraft.procgen.sensors.depth_camera import (
    BASELINE_M,
    CLEAN,
    Sensor,
    depth_edges,
    find_sensor,
    jitter_pose,
    quantize_disparity,
    sense_depth,
)

SIZE = (240, 320)
BRIGHT, SQUARE = np.full(SIZE, 200, np.float32), np.ones(SIZE, np.float32)


def sense(model, depth_m, luminance=BRIGHT, cosine=SQUARE, seed=0, fx_px=262.5):
    rng = np.random.default_rng(seed)
    return sense_depth(model, depth_m, cosine, luminance, fx_px, rng)


def flat(depth_m):
    return np.full(SIZE, depth_m, np.float32)


@pytest.mark.parametrize("depth_m", [0.6, 1.5, 3.0, 4.5])
def test_axial_noise_has_the_stated_sigma(depth_m):
    sensed = sense(Sensor(disparity_step_px=0, hole_share=0), flat(depth_m))
    seen = sensed[sensed > 0]
    assert seen.std() == pytest.approx(0.0012 + 0.0019 * (depth_m - 0.4) ** 2, rel=0.02)
    assert seen.mean() == pytest.approx(depth_m, abs=1e-3)


def test_depth_is_quantized_to_eighths_of_a_disparity_pixel():
    sensed = sense(find_sensor("rgbd"), flat(2.0))
    disparity = 525 * BASELINE_M / np.unique(sensed[sensed > 0]).astype(np.float64)
    steps = disparity * 8
    assert np.abs(steps - np.round(steps)).max() < 1e-3
    assert len(steps) > 3


def test_steps_do_not_depend_on_the_size_of_the_picture():
    depth = np.linspace(0.5, 5, 500, dtype=np.float32)
    assert np.array_equal(
        quantize_disparity(Sensor(), depth, 525.0), quantize_disparity(Sensor(), depth, 525.0)
    )
    coarse = sense(Sensor(sigma_m=0, sigma_growth=0, hole_share=0), flat(3.1), fx_px=262.5)
    assert coarse.max() == pytest.approx(quantize_disparity(Sensor(), flat(3.1), 525.0).max())


def test_two_in_a_hundred_pixels_are_holes():
    shares = [(sense(find_sensor("rgbd"), flat(1.5), seed=n) == 0).mean() for n in range(8)]
    assert np.mean(shares) == pytest.approx(0.02, abs=0.002)


def test_one_pixel_on_each_side_of_an_edge_is_lost():
    depth = flat(1.0)
    depth[:, 160:] = 2.0
    lost = sense(Sensor(hole_share=0), depth) == 0
    assert lost[:, 159:161].all()
    assert not lost[:, :159].any()
    assert not lost[:, 161:].any()
    assert not depth_edges(np.linspace(1, 2, 320, dtype=np.float32)[None].repeat(4, axis=0)).any()


def test_dark_and_grazing_surfaces_are_lost():
    model = Sensor(hole_share=0)
    black, grazing = np.full(SIZE, 12, np.float32), np.full(SIZE, 0.08, np.float32)
    assert (sense(model, flat(1.5), luminance=black) == 0).all()
    assert (sense(model, flat(1.5), cosine=grazing) == 0).all()
    half = np.full(SIZE, 27, np.float32)
    assert (sense(model, flat(1.5), luminance=half) == 0).mean() == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("depth_m", [0.0, 0.3, 5.4])
def test_nothing_is_seen_out_of_range(depth_m):
    assert not sense(find_sensor("rgbd"), flat(depth_m)).any()


def test_clean_is_exact():
    depth = np.linspace(0.05, 9, SIZE[0] * SIZE[1], dtype=np.float32).reshape(SIZE)
    black, grazing = np.zeros(SIZE, np.float32), np.zeros(SIZE, np.float32)
    assert np.array_equal(sense(CLEAN, depth, black, grazing), depth)
    pose = np.eye(4)
    assert np.array_equal(jitter_pose(CLEAN, pose, np.random.default_rng(0)), pose)


def test_stated_poses_have_the_jitter_of_the_sensor():
    rng = np.random.default_rng(0)
    stated = np.array([jitter_pose(find_sensor("rgbd"), np.eye(4), rng) for _ in range(4000)])
    assert stated[:, :3, 3].std() == pytest.approx(0.005, rel=0.05)
    angles = np.degrees(stated[:, [2, 0, 1], [1, 2, 0]])
    assert angles.std() == pytest.approx(0.2, rel=0.05)


def test_a_rotation_vector_turns_about_itself_by_its_length():
    turn = rotation_from_vector(np.array([0, 0, np.pi / 2]))
    assert np.allclose(turn, [[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    vector = np.array([0.3, -0.2, 0.5])
    turn = rotation_from_vector(vector)
    assert np.allclose(turn @ vector, vector)
    assert np.allclose(turn @ turn.T, np.eye(3))
    assert np.array_equal(rotation_from_vector(np.zeros(3)), np.eye(3))


def test_an_unknown_sensor_is_refused_by_name():
    with pytest.raises(UnknownNameError, match="no sensor is named 'rgb'; did you mean 'rgbd'"):
        find_sensor("rgb")

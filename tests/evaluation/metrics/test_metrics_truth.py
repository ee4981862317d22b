"""The fine truth in the cells of a reconstruction: SSCNet's rule, in any frame."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.coordinates import apply, invert_rigid, rotation_about_z
from world2minecraft.evaluation.metrics.truth_resampling import carry_truth

FINE_M, COARSE_M = 0.02, 0.08


def slow_truth(fine, origin_m, truth_to_room, shape, grid_origin_m):
    """The rule word by word: 64 samples a cell, one after the other."""
    result = np.empty(shape, np.uint8)
    for cell in np.ndindex(shape):
        labels = []
        for sub in np.ndindex(4, 4, 4):
            point = grid_origin_m + np.array(cell) * COARSE_M + (np.array(sub) + 0.5) * FINE_M
            at = np.floor((apply(invert_rigid(truth_to_room), point) - origin_m) / FINE_M)
            inside = (at >= 0).all() and (at < fine.shape).all()
            labels.append(int(fine[tuple(at.astype(int))]) if inside else 255)
        counts = np.bincount(labels, minlength=256)
        if counts[0] + counts[255] > 0.95 * 64:
            result[cell] = 0 if counts[0] > counts[255] else 255
        else:
            result[cell] = counts[1:12].argmax() + 1
    return result


def random_fine(seed, shape=(12, 8, 8)):
    random = np.random.default_rng(seed)
    labels = random.choice([0, 0, 0, 0, 255, 2, 5, 11], size=shape).astype(np.uint8)
    labels[random.random(shape) < 0.85] = 0
    return labels


@settings(max_examples=15)
@given(st.integers(0, 99), st.floats(-40, 40), st.floats(-0.1, 0.1), st.floats(-0.1, 0.1))
def test_fast_and_slow_agree_in_any_frame(seed, yaw_deg, x_m, z_m):
    fine, origin_m = random_fine(seed), np.array([-0.02, 0.04, 0.0])
    truth_to_room = rotation_about_z(yaw_deg)
    truth_to_room[:3, 3] = [x_m, 0.013, z_m]
    grid_origin_m = np.array([-0.08, 0.0, -0.08])
    found = carry_truth(fine, FINE_M, origin_m, truth_to_room, (4, 3, 3), grid_origin_m, COARSE_M)
    expected = slow_truth(fine, origin_m, truth_to_room, (4, 3, 3), grid_origin_m)
    # A sample on the very edge of a fine cell may fall to either side.
    assert (found != expected).mean() <= (0.1 if abs(yaw_deg) < 1e-3 else 0.0)


def test_four_of_64_make_a_cell_and_three_do_not():
    fine = np.zeros((8, 4, 4), np.uint8)
    fine[0, 0, :4] = 3
    fine[4, 0, :3] = 3
    result = carry_truth(fine, FINE_M, np.zeros(3), np.eye(4), (2, 1, 1), np.zeros(3), COARSE_M)
    assert result.reshape(-1).tolist() == [3, 0]


def test_the_majority_names_a_cell_and_the_lowest_id_a_tie():
    fine = np.zeros((8, 4, 4), np.uint8)
    fine[0:2, 0, :4], fine[2, 0, :4] = 8, 5
    fine[4, 0, :4], fine[5, 0, :4] = 11, 7
    result = carry_truth(fine, FINE_M, np.zeros(3), np.eye(4), (2, 1, 1), np.zeros(3), COARSE_M)
    assert result.reshape(-1).tolist() == [8, 7]


def test_cells_mostly_unknown_or_beyond_truth_are_unknown():
    fine = np.zeros((4, 4, 4), np.uint8)
    fine[:3] = 255
    result = carry_truth(fine, FINE_M, np.zeros(3), np.eye(4), (2, 1, 1), np.zeros(3), COARSE_M)
    assert result.reshape(-1).tolist() == [255, 255]


def test_a_quarter_turn_turns_the_result():
    fine = random_fine(5, (8, 8, 8))
    turn = rotation_about_z(90)
    straight = carry_truth(fine, FINE_M, np.zeros(3), np.eye(4), (2, 2, 2), np.zeros(3), COARSE_M)
    turned = carry_truth(
        fine, FINE_M, np.zeros(3), turn, (2, 2, 2), np.array([-0.16, 0, 0]), COARSE_M
    )
    assert np.array_equal(turned, np.rot90(straight, 1, axes=(0, 1)))


def test_a_truth_of_the_same_cells_comes_through_as_it_is():
    fine = random_fine(9, (5, 4, 3))
    found = carry_truth(fine, 0.08, np.zeros(3), np.eye(4), fine.shape, np.zeros(3), 0.08)
    np.testing.assert_array_equal(found, fine)


def test_a_truth_coarser_than_the_grid_is_refused():
    fine = np.zeros((2, 2, 2), np.uint8)
    with pytest.raises(ValueError, match="voxel_m must be above 0 and at most 0.05"):
        carry_truth(fine, 0.1, np.zeros(3), np.eye(4), (1, 1, 1), np.zeros(3), 0.05)


@settings(max_examples=10)
@given(st.integers(0, 99), st.floats(5, 40), st.floats(5, 40), st.permutations(range(3)))
def test_fast_and_slow_agree_in_a_frame_that_is_tilted_every_way(seed, first_deg, second_deg, axes):
    swap = np.eye(4)
    swap[:3, :3] = np.eye(3)[list(axes)]
    tilt = swap @ rotation_about_z(first_deg) @ swap.T @ rotation_about_z(second_deg)
    tilt = np.roll(np.roll(rotation_about_z(second_deg)[:3, :3], 1, 0), 1, 1) @ tilt[:3, :3]
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = tilt, [0.03, 0.013, -0.02]
    fine, low = random_fine(seed), np.array([-0.08, 0.0, -0.08])
    found = carry_truth(fine, FINE_M, np.zeros(3), pose, (4, 3, 3), low, COARSE_M)
    np.testing.assert_array_equal(found, slow_truth(fine, np.zeros(3), pose, (4, 3, 3), low))


def test_a_truth_of_cells_without_a_size_is_refused():
    fine = np.zeros((2, 2, 2), np.uint8)
    for wrong in (0.0, -0.02):
        with pytest.raises(ValueError, match="voxel_m must be above 0"):
            carry_truth(fine, wrong, np.zeros(3), np.eye(4), (1, 1, 1), np.zeros(3), COARSE_M)

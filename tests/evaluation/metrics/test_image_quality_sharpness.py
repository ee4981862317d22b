import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from tests.evaluation.metrics.photographs import photograph

from world2minecraft.evaluation.metrics.image_quality import laplacian, laplacian_variance, to_grey
from world2minecraft.evaluation.metrics.image_quality.laplacian import KERNEL_SIZES

SIDES = st.integers(4, 40)
pictures = SIDES.flatmap(
    lambda height: SIDES.flatmap(lambda width: arrays(np.uint8, (height, width, 3)))
)


@given(pictures)
def test_grey_is_opencvs_to_the_last_bit(picture):
    assert np.array_equal(to_grey(picture), cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY))


def test_grey_is_opencvs_for_every_red_green_and_some_blues():
    red, green = np.meshgrid(np.arange(256), np.arange(256))
    for blue in range(0, 256, 15):
        picture = np.stack([red, green, np.full_like(red, blue)], axis=-1).astype(np.uint8)
        assert np.array_equal(to_grey(picture), cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY))


@pytest.mark.parametrize("size", KERNEL_SIZES)
@given(picture=pictures)
@settings(max_examples=40)
def test_the_laplacian_is_opencvs_everywhere_borders_included(size, picture):
    grey = to_grey(picture)
    theirs = cv2.Laplacian(grey, cv2.CV_64F, ksize=size)
    assert np.array_equal(laplacian(picture, size), theirs)
    assert laplacian_variance(picture, size) == theirs.var()


# What the reference run gave with OpenCV: variance at ksize 1, 3, 5, 7 would be told by whole
# numbers; the photographs are those of scikit-image 0.26 and scikit-learn 1.9.
@pytest.mark.parametrize(
    ("name", "blur_px", "at_1", "at_5"),
    [
        ("astronaut", 0, 861, 435_918),
        ("coffee", 0, 1541, 344_914),
        ("coffee", 2, 7, 14_498),
        ("china", 0, 5624, 994_701),
        ("flower", 1, 27, 49_998),
    ],
)
def test_photographs_have_the_values_of_the_reference_run(name, blur_px, at_1, at_5):
    picture = photograph(name, blur_px)
    assert round(laplacian_variance(picture, 1)) == at_1
    assert round(laplacian_variance(picture, 5)) == at_5


@pytest.mark.parametrize("size", KERNEL_SIZES)
def test_ramp_is_flat_and_variance_grows_with_contrast_squared(size):
    ramp = np.tile(np.arange(0, 80, 2, dtype=np.uint8), (40, 1))
    assert not laplacian(ramp, size)[8:-8, 8:-8].any()
    picture = np.random.default_rng(1).integers(0, 120, (32, 32)).astype(np.uint8)
    once, twice = laplacian_variance(picture, size), laplacian_variance(2 * picture, size)
    assert twice == pytest.approx(4 * once)


def test_what_it_does_not_take_is_told():
    with pytest.raises(ValueError, match=r"kernel_size must be one of \(1, 3, 5, 7\), got 4"):
        laplacian_variance(np.zeros((8, 8), np.uint8), 4)
    with pytest.raises(ValueError, match="picture must be uint8, got float64"):
        laplacian_variance(np.zeros((8, 8)))
    with pytest.raises(ValueError, match="an image must have at least one pixel, got shape"):
        to_grey(np.zeros((0, 8, 3), np.uint8))

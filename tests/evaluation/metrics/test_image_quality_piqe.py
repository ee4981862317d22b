import importlib.util

import numpy as np
import pytest
from tests.evaluation.metrics.photographs import photograph

from world2minecraft.evaluation.metrics.image_quality import piqe, to_grey
from world2minecraft.evaluation.metrics.image_quality.piqe import block_faults
from world2minecraft.evaluation.metrics.image_quality.scene_statistics import normalise

# pypiqe 1.2's scores, from version 0.1's check_image_quality.py. It stretches a picture to 255
# first, which MATLAB's and the paper's do not; these reach 255 as they are.
PYPIQE = {
    ("astronaut", 0): 33.662,
    ("camera", 0): 40.137,
    ("camera", 1): 45.197,
    ("coffee", 0): 27.911,
    ("rocket", 0): 38.771,
    ("motorcycle_left", 0): 39.929,
    ("moon", 0): 36.679,
    ("china", 0): 50.016,
}
# The same for pictures that do not reach it: the stretch is small, and so is what it changes.
PYPIQE_STRETCHED = {
    ("astronaut", 2): 87.312,
    ("coffee", 1): 46.230,
    ("coffee", 2): 78.734,
    ("flower", 0): 28.331,
    ("chelsea", 0): 34.017,
}


def slow_piqe(picture):
    """The paper's text, one block after the other."""
    grey = to_grey(picture)
    height, width = grey.shape
    padded = np.pad(grey, ((0, -height % 16), (0, -width % 16)), mode="symmetric")
    coefficients, _ = normalise(padded)
    distorted, lively = 0.0, 0
    for y in range(0, padded.shape[0], 16):
        for x in range(0, padded.shape[1], 16):
            block = coefficients[y : y + 16, x : x + 16]
            variance = np.var(block, ddof=1)
            if variance <= 0.1:
                continue
            lively += 1
            rims = (block[0], block[-1], block[:, 0], block[:, -1])
            if any(np.std(rim[n : n + 6], ddof=1) < 0.1 for rim in rims for n in range(11)):
                distorted += 1 - variance
            surround = np.delete(np.delete(block, 7, axis=1), 8, axis=1)
            ratio = np.std(block[:, 7:9], ddof=1) / np.std(surround, ddof=1)
            deviation = np.sqrt(variance)
            if deviation > 2 * abs(deviation - ratio) / max(deviation, ratio):
                distorted += variance
    return 100 * (distorted + 1) / (lively + 1)


@pytest.mark.parametrize("size", [(64, 64), (50, 71), (16, 16)])
@pytest.mark.parametrize("blur_px", [0, 1.5])
def test_it_is_the_slow_reference(size, blur_px):
    picture = photograph("china", blur_px)[100 : 100 + size[0], 200 : 200 + size[1]]
    assert piqe(picture) == pytest.approx(slow_piqe(picture), abs=1e-9)


@pytest.mark.parametrize(("name", "blur_px"), PYPIQE)
def test_it_is_pypiqes_of_photographs(name, blur_px):
    assert piqe(photograph(name, blur_px)) == pytest.approx(PYPIQE[name, blur_px], abs=1e-3)


@pytest.mark.parametrize(("name", "blur_px"), PYPIQE_STRETCHED)
def test_it_is_pypiqes_once_the_picture_is_stretched(name, blur_px):
    grey = to_grey(photograph(name, blur_px))
    stretched = np.round(255 * (grey / grey.max())).astype(np.uint8)
    expected = PYPIQE_STRETCHED[name, blur_px]
    assert piqe(stretched) == pytest.approx(expected, abs=1e-3)
    assert piqe(grey) == pytest.approx(expected, abs=2)


@pytest.mark.skipif(importlib.util.find_spec("pypiqe") is None, reason="pypiqe is not installed")
def test_it_is_pypiqe_where_that_is_installed():
    from pypiqe import piqe as theirs

    grey = to_grey(photograph("china"))
    assert piqe(grey) == pytest.approx(theirs(grey)[0], abs=1e-6)


def test_blur_noise_and_blocks_are_found():
    sharp = photograph("coffee")
    noisy = sharp + np.random.default_rng(0).normal(0, 25, sharp.shape)
    noisy = np.clip(noisy, 0, 255).astype(np.uint8)
    blocky = np.repeat(np.repeat(sharp[::8, ::8], 8, axis=0), 8, axis=1)
    assert piqe(photograph("coffee", 2)) > piqe(photograph("coffee", 1)) > piqe(sharp)
    assert block_faults(noisy).noisy.mean() > 2 * block_faults(sharp).noisy.mean()
    assert block_faults(blocky).blocky.mean() > 2 * block_faults(sharp).blocky.mean()


def test_a_picture_without_a_lively_block_has_100():
    assert piqe(np.full((40, 24, 3), 90, np.uint8)) == 100
    assert piqe(np.zeros((1, 1), np.uint8)) == 100

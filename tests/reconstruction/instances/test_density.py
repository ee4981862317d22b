"""D and C: the convolution against a slow loop, and its bounds."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.reconstruction.instances.density_clustering import (
    candidate_cells,
    density_map,
    object_cells,
)


def _slow_density(binary, kernel):
    reach = kernel // 2
    padded = np.pad(binary, reach)
    density = np.zeros(binary.shape)
    for x, y, z in np.ndindex(binary.shape):
        density[x, y, z] = padded[x : x + kernel, y : y + kernel, z : z + kernel].sum() / kernel**3
    return density


@given(st.integers(0, 2**32 - 1), st.sampled_from([1, 3, 5]), st.tuples(*[st.integers(1, 7)] * 3))
def test_the_density_is_the_share_of_the_kernel_that_is_full(seed, kernel, shape):
    binary = np.random.default_rng(seed).random(shape) < 0.4
    found = density_map(binary, kernel)
    assert found.dtype == np.float32
    np.testing.assert_allclose(found, _slow_density(binary, kernel), atol=1e-7)


@pytest.mark.parametrize(("full", "share"), [(9, 9 / 27), (6, 6 / 27), (3, 3 / 27)])
def test_a_threshold_that_is_met_exactly_is_met(full, share):
    binary = np.zeros((3, 3, 3), bool)
    binary.reshape(-1)[: full - 1] = True
    binary[1, 1, 1] = True
    density = density_map(binary, 3)
    assert [1, 1, 1] in candidate_cells(binary, density, share).tolist()
    assert [1, 1, 1] not in candidate_cells(binary, density, share + 0.01).tolist()


def test_only_object_classes_count():
    labels = np.array([[[0, 1, 2, 3, 4, 5, 11, 255]]], np.uint8)
    assert object_cells(labels).tolist() == [[[False] * 5 + [True, True, False]]]

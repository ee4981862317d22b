"""What an ONNX file of an occupancy network must hold, and what it gives."""

from dataclasses import replace

import numpy as np
import pytest
from tests.reconstruction.occupancy.tiny_network import FACTS, write_network

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.reconstruction.occupancy.onnx_network import OccupancyNetwork

pytest.importorskip("onnx")
IMAGE = np.random.default_rng(1).random((3, 24, 32), dtype=np.float32)
EYES = (np.eye(3), np.eye(4))


def test_it_gives_probabilities_and_the_same_twice(tmp_path):
    path = write_network(tmp_path / "n.onnx")
    network = OccupancyNetwork(path)
    assert network.facts == FACTS
    found = network.probabilities(IMAGE, *EYES)
    assert (found.shape, found.dtype) == ((30, 30, 18, 12), np.float32)
    np.testing.assert_allclose(found.sum(axis=-1), 1, atol=1e-5)
    again = OccupancyNetwork(path)
    assert again.probabilities(IMAGE, *EYES).tobytes() == found.tobytes()
    assert again.digest == network.digest


def test_the_softmax_is_that_of_the_logits_over_the_temperature(tmp_path):
    bias = np.zeros((12, 30, 30, 18))
    bias[8] = 4.0
    facts = replace(FACTS, temperature=2.0)
    network = OccupancyNetwork(write_network(tmp_path / "n.onnx", facts, bias=bias))
    found = network.probabilities(np.zeros((3, 24, 32), np.float32), *EYES)
    np.testing.assert_allclose(found[0, 0, 0, 8], np.exp(2) / (np.exp(2) + 11), rtol=1e-5)


def test_depth_is_an_input_where_the_network_wants_it(tmp_path):
    network = OccupancyNetwork(write_network(tmp_path / "n.onnx", replace(FACTS, wants_depth=True)))
    assert network.facts.wants_depth
    assert network.probabilities(IMAGE, *EYES, np.ones((24, 32))).shape == (30, 30, 18, 12)


def test_a_network_may_do_without_the_camera(tmp_path):
    path = write_network(tmp_path / "n.onnx", inputs={"image": (1, 3, 24, 32)})
    assert OccupancyNetwork(path).probabilities(IMAGE, *EYES).shape == (30, 30, 18, 12)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        (
            {"changes": {"w2m_contract": "other"}},
            "expected the contract 'occupancy-1' in the metadata, got 'other'",
        ),
        ({"changes": {"w2m_classes": "a,b"}}, "must list the classes empty, ceiling"),
        ({"changes": {"w2m_grid_shape": "30,30"}}, "in all, got '30,30'"),
        (
            {"changes": {"w2m_grid_shape": "9,9,9"}},
            r"an output 'logits' of shape \[1, 12, 9, 9, 9\]",
        ),
        (
            {"changes": {"w2m_voxel_m": "wide"}},
            "w2m_voxel_m must be a number or .* got 'wide'",
        ),
        ({"changes": {"w2m_region": "round"}}, "and 'round'"),
        ({"output": "other"}, "expected an output 'logits'"),
        ({"inputs": {"image": (1, 3, "h", "w")}}, "float32 with fixed shape"),
        (
            {"inputs": {"image": (1, 3, 24, 32), "mask": (1, 24, 32)}},
            "unknown network input 'mask'; known: image, intrinsics, camera_to_grid, depth_m",
        ),
    ],
)
def test_what_breaks_the_contract_is_refused_in_one_line(tmp_path, changes, reason):
    path = write_network(tmp_path / "n.onnx", **changes)
    with pytest.raises(DamagedFileError, match=reason) as caught:
        OccupancyNetwork(path)
    assert "\n" not in str(caught.value)
    assert str(caught.value).endswith("docs/reference/onnx-networks.md describes the format")


def test_what_is_no_onnx_file_is_refused(tmp_path):
    (tmp_path / "n.onnx").write_bytes(b"no network")
    with pytest.raises(DamagedFileError, match="is not a valid ONNX file"):
        OccupancyNetwork(tmp_path / "n.onnx")
    with pytest.raises(InputError, match="cannot be read"):
        OccupancyNetwork(tmp_path / "missing.onnx")


def test_values_that_are_no_numbers_are_refused(tmp_path):
    bias = np.full((12, 30, 30, 18), np.nan)
    network = OccupancyNetwork(write_network(tmp_path / "n.onnx", bias=bias))
    with pytest.raises(DamagedFileError, match="returned NaN or infinite values"):
        network.probabilities(IMAGE, *EYES)

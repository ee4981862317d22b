"""Weights stored small: what comes back, which numbers are touched, how far logits move."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("torch")
pytest.importorskip("onnx")

import onnx
from onnx import numpy_helper
from room_frames import SHAPE, VOXEL_M

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.networks.models import make_network
from world2minecraft.networks.onnx_export import (
    _by_name,
    _export_traced,
    _random_inputs,
    compress_weights,
    export_network,
    quantize_weights,
    run_onnx,
)
from world2minecraft.reconstruction.occupancy.onnx_network import NetworkFacts, OccupancyNetwork

FACTS = NetworkFacts("monoscene", SHAPE, VOXEL_M, (96, 72))


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(0, 2), st.floats(-6, 6))
def test_a_rounded_weight_is_off_by_half_a_step_of_its_channel(seed, axis, power):
    rng = np.random.default_rng(seed)
    shape = np.ones(3, int)
    shape[axis] = 4
    spans = 10.0 ** rng.uniform(-3, 3, shape) * 10**power
    values = (rng.standard_normal((4, 4, 4)) * spans).astype(np.float32)
    whole, scales = quantize_weights(values, axis)
    for n in range(4):
        channel, kept = np.take(values, n, axis), np.take(whole, n, axis)
        assert np.abs(kept).max() == 127  # The largest of a channel uses its last step.
        off = np.abs(kept * float(scales[n]) - channel)
        assert off.max() <= 0.5001 * scales[n]


def test_a_channel_of_zeros_stays_so():
    whole, scales = quantize_weights(np.zeros((2, 5), np.float32), 0)
    assert not whole.any() and np.isfinite(scales).all() and (scales > 0).all()


@pytest.fixture(scope="module")
def traced():
    network = make_network("iso", "tiny", grid_shape=SHAPE, voxel_m=VOXEL_M, seed=1).eval()
    example = _random_inputs(FACTS, np.random.default_rng(0))
    return _export_traced(network, example, FACTS), example


def _weights_of(model):
    return {one.name: numpy_helper.to_array(one) for one in model.graph.initializer}


def _slowly_rounded(model):
    """The model with floats that bytes would give, channel by channel in a loop."""
    result = onnx.ModelProto()
    result.CopyFrom(model)
    uses = {node.input[1]: node for node in model.graph.node if len(node.input) > 1}
    for weight in result.graph.initializer:
        node, values = uses.get(weight.name), numpy_helper.to_array(weight).copy()
        if node is None or values.size < 64:
            continue
        turned = any(one.name == "transB" and one.i == 1 for one in node.attribute)
        axes = {"Conv": 0, "ConvTranspose": 1, "MatMul": values.ndim - 1, "Gemm": not turned}
        if node.op_type not in axes:
            continue
        for channel in np.moveaxis(values, int(axes[node.op_type]), 0):
            step = np.abs(channel).max() / 127 or 1.0
            channel[...] = np.rint(channel / step) * step
        weight.CopyFrom(numpy_helper.from_array(values, weight.name))
    return result


def test_int8_weights_predict_as_rounded_weights_do(traced):
    model, example = traced[0], _by_name(traced[1])
    found = run_onnx(compress_weights(model, "int8").SerializeToString(), example)
    wanted = run_onnx(_slowly_rounded(model).SerializeToString(), example)
    whole = run_onnx(model.SerializeToString(), example)
    assert np.abs(found - wanted).max() < 1e-4 < np.abs(found - whole).max()


def test_only_what_multiplies_is_stored_small(traced):
    model, _ = traced
    before, after = _weights_of(model), _weights_of(compress_weights(model, "int8"))
    whole = {name for name in after if name in before}
    for name in whole:
        np.testing.assert_array_equal(after[name], before[name])
    small = {name.removesuffix("_int8") for name in after if name.endswith("_int8")}
    assert small and small | whole == set(before)
    assert all(before[name].ndim > 1 for name in small)
    assert sum(before[name].size for name in whole) < 0.1 * sum(before[n].size for n in small)


def test_a_weight_that_is_read_elsewhere_stays_whole():
    """Bytes of a tensor that is added too would move what is added."""
    weight = numpy_helper.from_array(np.ones((16, 16), np.float32), "both")
    nodes = [
        onnx.helper.make_node("MatMul", ["x", "both"], ["y"]),
        onnx.helper.make_node("Add", ["y", "both"], ["z"]),
    ]
    ends = [onnx.helper.make_tensor_value_info(n, 1, [16, 16]) for n in "xz"]
    graph = onnx.helper.make_graph(nodes, "g", ends[:1], ends[1:], [weight])
    model = onnx.helper.make_model(graph, opset_imports=[onnx.helper.make_opsetid("", 17)])
    assert compress_weights(model, "int8") == model


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(["Conv", "ConvTranspose", "MatMul"]))
def test_widened_bytes_are_the_quantized_weights(seed, kind):
    rng = np.random.default_rng(seed)
    sides, axis = {"Conv": ([8, 5, 3, 3], 0), "ConvTranspose": ([8, 5, 3, 3], 1)}.get(
        kind, ([16, 8], 1)
    )
    values = (rng.standard_normal(sides) * 10.0 ** rng.uniform(-2, 2, sides)).astype(np.float32)
    node = onnx.helper.make_node(kind, ["x", "w"], ["y"])
    shape = [None] * len(sides)
    ends = [onnx.helper.make_tensor_value_info(name, 1, shape) for name in "xy"]
    weight = numpy_helper.from_array(values, "w")
    graph = onnx.helper.make_graph([node], "g", ends[:1], ends[1:], [weight])
    opset = [onnx.helper.make_opsetid("", 17)]
    small = compress_weights(onnx.helper.make_model(graph, opset_imports=opset), "int8")
    assert [one.op_type for one in small.graph.node] == ["Cast", "Mul", kind]
    whole, scales = quantize_weights(values, axis)
    stored = _weights_of(small)
    assert (stored["w_int8"] == whole).all()
    widened = stored["w_int8"].astype(np.float32) * stored["w_scales"]
    shape = [-1 if n == axis else 1 for n in range(values.ndim)]
    np.testing.assert_array_equal(widened, whole * scales.reshape(shape))


def test_nothing_moves_where_weights_are_stored_as_they_are(traced):
    model, _ = traced
    assert compress_weights(model, "float") == model


@pytest.mark.parametrize(("kind", "mean", "most"), [("half", 0.003, 0.05), ("int8", 0.03, 0.4)])
def test_how_far_logits_move(kind, mean, most, tmp_path):
    """Of an untrained network, in spreads of all its logits; measured 0.001, 0.012; 0.017, 0.16."""
    network = make_network("monoscene", "tiny", grid_shape=SHAPE, voxel_m=VOXEL_M, seed=1)
    written = export_network(network, tmp_path / "net.onnx", FACTS, weights=kind)
    assert 0 < written.moved_mean <= mean * written.spread
    assert written.moved <= most * written.spread
    assert written.renamed < 0.05
    whole = 4 * sum(weights.numel() for weights in network.parameters())
    assert written.size < {"half": 0.8, "int8": 0.55}[kind] * whole
    read = OccupancyNetwork(tmp_path / "net.onnx")
    assert np.isfinite(read.probabilities(np.zeros((3, 72, 96)), np.eye(3), np.eye(4))).all()


def test_another_way_is_refused_with_the_nearest(traced):
    with pytest.raises(UnknownNameError, match="int8"):
        compress_weights(traced[0], "int4")

"""Export of trained networks as ONNX files in the format of docs/reference/onnx-networks.md.

A file is written only if its output matches the network: for the same input image, no logit may
differ by more than ``MAX_DIFFERENCE``. The weights can then be compressed. The resulting change of
the logits is measured but not limited; whether it is acceptable must be decided by an evaluation.

Only the weights of convolutions and matrix products are compressed. Biases, norms and grid
constants are not changed. ``int8`` uses one scale for each output channel, so channels with small
weights remain accurate. Activations are never quantized: ONNX Runtime expands the weights when it
loads the file and runs the network in float32.
"""

import importlib.util
import io
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import onnx
import onnxruntime
import torch
from onnx import numpy_helper
from torch import Tensor, nn

from world2minecraft.core.errors import MissingExtraError, OutputError, UnknownNameError
from world2minecraft.core.files import write_bytes
from world2minecraft.networks.batch import OccInput
from world2minecraft.reconstruction.occupancy.onnx_network import OUTPUT, NetworkFacts

KINDS = ("float", "half", "int8")
SMALL = 64  # Smaller weights are not compressed.
MAX_INT8 = 127  # Symmetric: -128 is not used.
# Axis of the output channels in the weights of a node, which are its second input.
_WEIGHTS = {"Conv": 0, "ConvTranspose": 1, "MatMul": -1, "Gemm": -1}
OPSET = 17
MAX_DIFFERENCE = 1e-3
TURN_DEG = 10.0  # Downward pitch of the camera of the test image.


def compress_weights(model: Any, kind: str) -> Any:
    """Compress the weights of an ONNX model.

    Args:
        model: ``onnx.ModelProto`` with float32 weights, which is not modified.
        kind: ``float`` (unchanged), ``half`` (half the size) or ``int8`` (a quarter of the size).

    Returns:
        A model with compressed weights.

    Raises:
        UnknownNameError: If the kind is unknown.
    """
    if kind not in KINDS:
        raise UnknownNameError("weight format", kind, KINDS)
    result = onnx.ModelProto()
    result.CopyFrom(model)
    axes = _axes_of_weights(result.graph)
    widening = []
    for weight in list(result.graph.initializer):
        if kind == "float" or weight.name not in axes:
            continue
        values = numpy_helper.to_array(weight)
        if values.dtype == np.float32 and values.size >= SMALL:
            widen = _store_float16 if kind == "half" else _store_int8
            widening.extend(widen(result.graph, weight, values, axes[weight.name]))
    nodes = [*widening, *result.graph.node]
    del result.graph.node[:]
    result.graph.node.extend(nodes)
    onnx.checker.check_model(result)
    return result


def quantize_weights(values: np.ndarray, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """Quantize weights to int8 with one scale for each channel.

    The error is at most half a scale.

    Args:
        values: Weights, float32.
        axis: Axis of the channels.

    Returns:
        The quantized weights, int8 in the same shape, and the scale of each channel, float32 [C].

    Example:
        >>> whole, scales = quantize_weights(np.float32([[0.5, -1.27], [0.0, 0.0]]), 0)
        >>> whole.tolist(), [round(float(scale), 4) for scale in scales]
        ([[50, -127], [0, 0]], [0.01, 1.0])
    """
    others = tuple(n for n in range(values.ndim) if n != axis % values.ndim)
    largest = np.abs(values).max(axis=others)
    scales = np.where(largest > 0, largest / np.float32(MAX_INT8), np.float32(1)).astype(np.float32)
    whole = np.rint(values / np.expand_dims(scales, others))
    return np.clip(whole, -MAX_INT8, MAX_INT8).astype(np.int8), scales


def _axes_of_weights(graph: Any) -> dict[str, int]:
    """Return the axis of output channels for each tensor that is used only as weights."""
    axes, elsewhere = {}, set()
    for node in graph.node:
        for place, name in enumerate(node.input):
            if node.op_type in _WEIGHTS and place == 1:
                axes[name] = _axis(node)
            else:
                elsewhere.add(name)
    return {name: axis for name, axis in axes.items() if name not in elsewhere}


def _axis(node: Any) -> int:
    turned = any(one.name == "transB" and one.i for one in node.attribute)
    return 0 if turned else _WEIGHTS[node.op_type]


def _store_float16(graph: Any, weight: Any, values: np.ndarray, axis: int) -> list[Any]:
    name = weight.name
    weight.CopyFrom(numpy_helper.from_array(values.astype(np.float16), f"{name}_half"))
    return [onnx.helper.make_node("Cast", [f"{name}_half"], [name], to=onnx.TensorProto.FLOAT)]


def _store_int8(graph: Any, weight: Any, values: np.ndarray, axis: int) -> list[Any]:
    """Store int8 weights, widened by nodes that ONNX Runtime folds when it loads the model.

    It does not fold ``DequantizeLinear``, and widens such weights again in each run.
    """
    name = weight.name
    whole, scales = quantize_weights(values, axis)
    weight.CopyFrom(numpy_helper.from_array(whole, f"{name}_int8"))
    shape = [1] * values.ndim
    shape[axis] = -1
    graph.initializer.append(numpy_helper.from_array(scales.reshape(shape), f"{name}_scales"))
    float_type = onnx.TensorProto.FLOAT
    return [
        onnx.helper.make_node("Cast", [f"{name}_int8"], [f"{name}_whole"], to=float_type),
        onnx.helper.make_node("Mul", [f"{name}_whole", f"{name}_scales"], [name]),
    ]


class ExportReport(NamedTuple):
    """The result of an export, measured on one image.

    Attributes:
        difference: Largest difference between the logits of the network and of the ONNX model with
            uncompressed weights.
        moved: Largest change of a logit when the weights are compressed.
        moved_mean: Mean change of a logit when the weights are compressed.
        spread: Standard deviation of all logits, for comparison with ``moved_mean``.
        renamed: Fraction of cells whose class changes when the weights are compressed.
        size: Size of the file in bytes.
    """

    difference: float
    moved: float
    moved_mean: float
    spread: float
    renamed: float
    size: int


def export_network(
    network: nn.Module,
    path: str | Path,
    facts: NetworkFacts,
    *,
    weights: str = "float",
) -> ExportReport:
    """Write a network as an ONNX file and measure the differences of its output.

    Args:
        network: Network that maps ``OccInput`` to ``OccOutput``. It is run in evaluation mode, and
            its mode is then restored.
        path: Output file.
        facts: Metadata of the file, such as its grid, its image size and whether it requires depth.
        weights: Weight format: ``float``, ``half`` or ``int8``.

    Raises:
        OutputError: If the output of the file differs too much, or if the file cannot be written.
        UnknownNameError: If the weight format is unknown.
        MissingExtraError: If onnx is not installed.
    """
    _check_onnx()

    example = _random_inputs(facts, np.random.default_rng(0))
    trained = network.training
    network.eval()
    try:
        with torch.no_grad():
            logits = network(example).logits.float().cpu().numpy()
            model = _export_traced(network, example, facts)
    finally:
        network.train(trained)
    whole = run_onnx(model.SerializeToString(), _by_name(example))
    difference = float(np.abs(whole - logits).max())
    if not difference <= MAX_DIFFERENCE:  # True for NaN too.
        raise OutputError(
            path,
            f"not written: the ONNX logits differ from the network's by {difference:.3g}, "
            f"the limit is {MAX_DIFFERENCE:g}",
        )
    data = compress_weights(model, weights).SerializeToString()
    stored = whole if weights == "float" else run_onnx(data, _by_name(example))
    if not np.isfinite(stored).all():
        raise OutputError(
            path, f"not written: weights stored as {weights} produce values that are not finite"
        )
    write_bytes(Path(path), data)
    return ExportReport(difference, *_logit_change(whole, stored), len(data))


def _logit_change(whole: np.ndarray, stored: np.ndarray) -> tuple[float, float, float, float]:
    moved = np.abs(stored - whole)
    renamed = stored.argmax(axis=1) != whole.argmax(axis=1)
    return float(moved.max()), float(moved.mean()), float(whole.std()), float(renamed.mean())


class _Named(nn.Module):
    """A wrapper that gives a network the inputs and the output of the ONNX format."""

    def __init__(self, network: nn.Module, facts: NetworkFacts):
        super().__init__()
        self.network, self.facts = network, facts

    def forward(
        self,
        image: Tensor,
        intrinsics: Tensor,
        camera_to_grid: Tensor,
        depth_m: Tensor | None = None,
    ) -> Tensor:
        """Return the class logits, [1, 12, X, Y, Z]."""
        facts = self.facts
        inputs = OccInput(
            image, intrinsics, camera_to_grid, facts.grid_shape, facts.voxel_m, depth_m
        )
        return self.network(inputs).logits.float()


def _check_onnx() -> None:
    if importlib.util.find_spec("onnx") is None:
        raise MissingExtraError("writing ONNX files", "train")


def _export_traced(network: nn.Module, example: OccInput, facts: NetworkFacts) -> Any:
    """Return the traced network as an ``onnx.ModelProto``."""
    import onnx  # noqa: PLC0415

    given = {name: torch.from_numpy(values) for name, values in _by_name(example).items()}
    written: Any = io.BytesIO()  # Its annotation does not allow a stream, although it takes one.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # About sides that become constants, as intended.
        torch.onnx.export(
            _Named(network, facts),
            tuple(given.values()),
            written,
            input_names=list(given),
            output_names=[OUTPUT],
            opset_version=OPSET,
            dynamo=False,
        )
    model = onnx.load_from_string(written.getvalue())
    onnx.helper.set_model_props(model, facts.metadata())
    return model


def run_onnx(data: bytes, given: Mapping[str, np.ndarray]) -> np.ndarray:
    """Run an ONNX model in one thread and return its first output.

    Args:
        data: Content of the file.
        given: Arrays by name. Those that are no input of the model are ignored.
    """
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.log_severity_level = 3
    session: Any = onnxruntime.InferenceSession(data, options, providers=["CPUExecutionProvider"])
    wanted = {entry.name for entry in session.get_inputs()}
    inputs = {name: values for name, values in given.items() if name in wanted}
    return np.asarray(session.run(None, inputs)[0])


def _by_name(example: OccInput) -> dict[str, np.ndarray]:
    tensors = {
        "image": example.image,
        "intrinsics": example.intrinsics,
        "camera_to_grid": example.camera_to_grid,
        "depth_m": example.depth_m,
    }
    return {name: one.cpu().numpy() for name, one in tensors.items() if one is not None}


def _random_inputs(facts: NetworkFacts, rng: np.random.Generator) -> OccInput:
    """Return a random image with a camera at the centre of the near side of the grid."""
    width, height = facts.image_size_px
    lens = np.array([[0.81 * width, 0, width / 2], [0, 0.81 * width, height / 2], [0, 0, 1]])
    sides_m = np.array(facts.grid_shape) * facts.voxel_m
    down = np.deg2rad(TURN_DEG)
    pose = np.eye(4)
    pose[:3, 2] = [0, np.cos(down), -np.sin(down)]
    pose[:3, 1] = [0, -np.sin(down), -np.cos(down)]
    pose[:3, 3] = [sides_m[0] / 2, 0, 0.6 * sides_m[2]]
    depth_m = rng.uniform(0.5, sides_m[1], (1, height, width))
    depth_m[rng.random(depth_m.shape) < 0.1] = 0
    image = rng.random((1, 3, height, width))
    return OccInput(
        _single(image),
        _single(lens[None]),
        _single(pose[None]),
        facts.grid_shape,
        facts.voxel_m,
        _single(depth_m) if facts.wants_depth else None,
    )


def _single(values: np.ndarray) -> Tensor:
    return torch.from_numpy(values).float()

"""Weights of an ONNX model kept small in the file: as bytes or halves, whole again when it is run.

Only what multiplies is kept so: the weights of convolutions and of matrix products. Biases, norms
and what a network knows of its grid stay as they are. ``int8`` has one scale an output channel, so
that a channel of small weights keeps its digits. Activations are never rounded: onnxruntime turns
the weights back as it loads the file, and runs the same float32 network as ever.
"""

from typing import Any

import numpy as np
import onnx
from onnx import numpy_helper

from world2minecraft.core.errors import UnknownNameError

KINDS = ("float", "half", "int8")
SMALL = 64  # Weights of fewer numbers are not worth a node.
MOST = 127  # Symmetric: -128 is not used.
# Which input of a node is weights, and which of its axes counts output channels.
_WEIGHTS = {"Conv": 0, "ConvTranspose": 1, "MatMul": -1, "Gemm": -1}


def with_stored_weights(model: Any, kind: str) -> Any:
    """Return an ONNX model whose weights are stored as one of ``KINDS``.

    Args:
        model: an ``onnx.ModelProto`` with float32 weights; it is left as it was.
        kind: ``float`` changes nothing; ``half`` takes half the room, ``int8`` a quarter.

    Raises:
        UnknownNameError: there is no such kind.
    """
    if kind not in KINDS:
        raise UnknownNameError("way to store weights", kind, KINDS)
    result = onnx.ModelProto()
    result.CopyFrom(model)
    axes = _axes_of_weights(result.graph)
    widening = []
    for weight in list(result.graph.initializer):
        if kind == "float" or weight.name not in axes:
            continue
        values = numpy_helper.to_array(weight)
        if values.dtype == np.float32 and values.size >= SMALL:
            widen = _as_halves if kind == "half" else _as_bytes
            widening.append(widen(result.graph, weight, values, axes[weight.name]))
    nodes = [*widening, *result.graph.node]
    del result.graph.node[:]
    result.graph.node.extend(nodes)
    onnx.checker.check_model(result)
    return result


def rounded(values: np.ndarray, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """Return int8 of the weights' shape, and float32 [C], the scale of each channel.

    Args:
        values: float32 weights.
        axis: of the channels. What comes back times its scale is off by half a scale at most.

    Example:
        >>> whole, scales = rounded(np.float32([[0.5, -1.27], [0.0, 0.0]]), 0)
        >>> whole.tolist(), [round(float(scale), 4) for scale in scales]
        ([[50, -127], [0, 0]], [0.01, 1.0])
    """
    others = tuple(n for n in range(values.ndim) if n != axis % values.ndim)
    most = np.abs(values).max(axis=others)
    scales = np.where(most > 0, most / np.float32(MOST), np.float32(1)).astype(np.float32)
    whole = np.rint(values / np.expand_dims(scales, others))
    return np.clip(whole, -MOST, MOST).astype(np.int8), scales


def _axes_of_weights(graph: Any) -> dict[str, int]:
    """Return the axis of output channels for each tensor that is weights, and nothing else."""
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


def _as_halves(graph: Any, weight: Any, values: np.ndarray, axis: int) -> Any:
    name = weight.name
    weight.CopyFrom(numpy_helper.from_array(values.astype(np.float16), f"{name}_half"))
    return onnx.helper.make_node("Cast", [f"{name}_half"], [name], to=onnx.TensorProto.FLOAT)


def _as_bytes(graph: Any, weight: Any, values: np.ndarray, axis: int) -> Any:
    name = weight.name
    whole, scales = rounded(values, axis)
    weight.CopyFrom(numpy_helper.from_array(whole, f"{name}_int8"))
    graph.initializer.append(numpy_helper.from_array(scales, f"{name}_scales"))
    return onnx.helper.make_node(
        "DequantizeLinear",
        [f"{name}_int8", f"{name}_scales"],
        [name],
        axis=axis % values.ndim,
    )

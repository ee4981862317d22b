"""Occupancy networks of a few weights as ONNX files, drawn by a seed."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.reconstruction.occupancy.onnx_network import NetworkFacts

FACTS = NetworkFacts("tiny", (30, 30, 18), 0.16, (32, 24))


def write_network(
    path: Path,
    facts: NetworkFacts = FACTS,
    *,
    seed: int = 0,
    bias: np.ndarray | None = None,
    changes: dict[str, str] | None = None,
    output: str = "logits",
    inputs: dict[str, tuple] | None = None,
) -> Path:
    """Write a network whose logits are ``bias`` [12, X, Y, Z] plus a little of the picture's mean.

    ``changes`` are made to its metadata; ``inputs`` replaces the shapes of its inputs.
    """
    import onnx
    from onnx import TensorProto, helper, numpy_helper

    wide, high = facts.image_size_px
    shapes = {"image": (1, 3, high, wide), "intrinsics": (1, 3, 3), "camera_to_grid": (1, 4, 4)}
    if facts.wants_depth:
        shapes["depth_m"] = (1, high, wide)
    shapes = shapes if inputs is None else inputs
    rng = np.random.default_rng(seed)
    if bias is None:
        bias = rng.normal(0, 1, (12, *facts.grid_shape))
    weight = rng.normal(0, 0.1, (12, 3, 1, 1)).astype(np.float32)
    held = {
        "weight": weight,
        "bias": bias[None].astype(np.float32),
        "flat": np.array([1, 12, 1, 1, 1], np.int64),
        "axes": np.array([1, 2], np.int64),
    }
    nodes = [
        helper.make_node("GlobalAveragePool", ["image"], ["mean"]),
        helper.make_node("Conv", ["mean", "weight"], ["of_picture"]),
        helper.make_node("Reshape", ["of_picture", "flat"], ["wide"]),
        helper.make_node("Add", ["wide", "bias"], [output]),
    ]
    graph = helper.make_graph(
        nodes,
        "tiny",
        [helper.make_tensor_value_info(n, TensorProto.FLOAT, s) for n, s in shapes.items()],
        [helper.make_tensor_value_info(output, TensorProto.FLOAT, (1, 12, *facts.grid_shape))],
        [numpy_helper.from_array(value, name) for name, value in held.items()],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=9)
    helper.set_model_props(model, facts.metadata() | (changes or {}))
    onnx.save(model, path)
    return path


def sized(shape: tuple[int, int, int], voxel_m: float) -> NetworkFacts:
    return replace(FACTS, grid_shape=shape, voxel_m=voxel_m)

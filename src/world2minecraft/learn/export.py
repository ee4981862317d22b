"""A trained network leaves PyTorch as one ONNX file of the contract in docs/networks-onnx.md.

It is written only where it says what the network says: both are asked about the same picture, and
no logit may differ by more than ``MOST_DIFFERENCE``.
"""

import io
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import onnxruntime
import torch
from torch import Tensor, nn

from world2minecraft.errors import MissingExtraError, OutputError
from world2minecraft.files import write_bytes
from world2minecraft.learn.batch import OccInput
from world2minecraft.occupy.network_file import OUTPUT, NetworkFacts

OPSET = 17
MOST_DIFFERENCE = 1e-3
TURN_DEG = 10.0  # How far the camera of the question looks down.


def export_network(
    network: nn.Module, path: str | Path, facts: NetworkFacts, *, seed: int = 0
) -> float:
    """Write a network as ONNX, and return by how much its logits differ at most.

    Args:
        network: maps ``OccInput`` to ``OccOutput``. It is asked in evaluation, and left as it was.
        path: the file.
        facts: what the file states: its grid, its picture's size, whether it wants depth.
        seed: of the picture that both are asked about.

    Raises:
        OutputError: the file would say something else, or cannot be written.
        MissingExtraError: onnx is not installed.
    """
    example = _question(facts, np.random.default_rng(seed))
    trained = network.training
    network.eval()
    try:
        with torch.no_grad():
            said = network(example).logits.float().cpu().numpy()
            data = _traced(network, example, facts)
    finally:
        network.train(trained)
    difference = float(np.abs(_asked(data, example) - said).max())
    if not difference <= MOST_DIFFERENCE:  # Holds for what is no number too.
        raise OutputError(path, f"the ONNX file's logits would differ by {difference:.3g}")
    write_bytes(Path(path), data)
    return difference


class _Named(nn.Module):
    """The network with the inputs and the output of the contract."""

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
        """Return logits [1, 12, X, Y, Z]."""
        facts = self.facts
        inputs = OccInput(
            image, intrinsics, camera_to_grid, facts.grid_shape, facts.voxel_m, depth_m
        )
        return self.network(inputs).logits.float()


def _traced(network: nn.Module, example: OccInput, facts: NetworkFacts) -> bytes:
    try:
        import onnx  # noqa: PLC0415  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise MissingExtraError("writing ONNX files", "train") from None
    given = _by_name(example)
    written: Any = io.BytesIO()  # It takes a stream, and says that it does not.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # Of sides that become constants, as they are meant to.
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
    return model.SerializeToString()


def _asked(data: bytes, example: OccInput) -> np.ndarray:
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.log_severity_level = 3
    session: Any = onnxruntime.InferenceSession(data, options, providers=["CPUExecutionProvider"])
    wanted = {entry.name for entry in session.get_inputs()}
    given = {name: one.cpu().numpy() for name, one in _by_name(example).items() if name in wanted}
    return np.asarray(session.run([OUTPUT], given)[0])


def _by_name(example: OccInput) -> dict[str, Tensor]:
    given = {
        "image": example.image,
        "intrinsics": example.intrinsics,
        "camera_to_grid": example.camera_to_grid,
    }
    return given if example.depth_m is None else {**given, "depth_m": example.depth_m}


def _question(facts: NetworkFacts, rng: np.random.Generator) -> OccInput:
    """Return a picture of noise by a camera in the middle of the grid's near side."""
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

"""ONNX export of the segmentation network, with its calibration inside and small weights."""

import io
import warnings
from pathlib import Path
from typing import NamedTuple

import numpy as np
import onnx
import torch
from torch import Tensor, nn
from torch.nn import functional

from world2minecraft.core.files import write_bytes
from world2minecraft.networks.onnx_export import compress_weights, run_onnx
from world2minecraft.networks.segmentation.calibration import Calibration
from world2minecraft.networks.segmentation.network import CLASSES, SegmentationNet
from world2minecraft.networks.segmentation.scores import mirror_geometry
from world2minecraft.reconstruction.recognition.segmentation import COLOUR, GEOMETRY, PROBABILITY
from world2minecraft.reconstruction.recognition.segmentation_channels import (
    GEOMETRY_CHANNELS,
    geometry_size,
)

OPSET = 17
TRIAL_SHAPES = ((240, 320), (96, 72))


class SegmentationExport(NamedTuple):
    """The result of an export.

    Attributes:
        difference: Largest difference of a probability between PyTorch and ONNX Runtime, with
            uncompressed weights.
        moved: Mean change of the probabilities by the compression.
        size: Size of the file in bytes.
    """

    difference: float
    moved: float
    size: int


class CalibratedNet(nn.Module):
    """A network that returns calibrated probabilities at the size of the colours.

    They are the mean of those of the image and of its mirror image.
    """

    offset: Tensor
    temperatures: Tensor

    def __init__(self, network: SegmentationNet, calibration: Calibration):
        super().__init__()
        self.network = network.eval()
        self.register_buffer("offset", torch.from_numpy(calibration.offset).view(1, -1, 1, 1))
        self.register_buffer("temperatures", torch.tensor(calibration.temperatures))

    def forward(self, colour: Tensor, geometry: Tensor) -> Tensor:
        """Return probabilities [1, 40, H, W]."""
        # The image and its mirror image are one batch, so that the file holds the weights once.
        pair = self.network(
            torch.cat([colour, colour.flip(3)]), torch.cat([geometry, mirror_geometry(geometry)])
        )
        logits = (pair[:1] + pair[1:].flip(3)) / 2
        both, no_depth, no_colour = self.temperatures
        has_colour = colour.abs().amax() > 0
        temperature = torch.where(geometry.abs().amax() > 0, both, no_depth)
        temperature = torch.where(has_colour, temperature, no_colour)
        logits = (logits + self.offset) / temperature
        fine = functional.interpolate(
            logits, size=colour.shape[2:], mode="bilinear", align_corners=False
        )
        # ONNX Runtime's own softmax over this axis takes longer than the network.
        shares = (fine - fine.amax(dim=1, keepdim=True)).exp()
        return shares / shares.sum(dim=1, keepdim=True)


def export_segmentation(
    network: SegmentationNet,
    calibration: Calibration,
    path: Path,
    about: dict[str, str],
    *,
    weights: str = "half",
) -> SegmentationExport:
    """Write a network with its calibration as ONNX and measure the differences of its output.

    Args:
        network: Network to export.
        calibration: Calibration of the network.
        path: Output file.
        about: Metadata to store in the file.
        weights: Weight format: ``float``, ``half`` or ``int8``.
    """
    calibrated = CalibratedNet(network, calibration).eval()
    model = _onnx_model(calibrated)
    onnx.helper.set_model_props(model, dict(sorted(about.items())))
    whole = model.SerializeToString()
    small = compress_weights(model, weights).SerializeToString()
    difference, moved = 0.0, 0.0
    for shape in TRIAL_SHAPES:
        given = _random_inputs(shape, np.random.default_rng(0))
        with torch.no_grad():
            wanted = calibrated(*(torch.from_numpy(one) for one in given)).numpy()
        inputs: dict[str, np.ndarray] = dict(zip((COLOUR, GEOMETRY), given, strict=True))
        difference = max(difference, float(np.abs(run_onnx(whole, inputs) - wanted).max()))
        moved = max(moved, float(np.abs(run_onnx(small, inputs) - wanted).mean()))
    write_bytes(path, small)
    return SegmentationExport(difference, moved, len(small))


def _onnx_model(network: nn.Module) -> onnx.ModelProto:
    """Return the traced network. The exporter folds its norms into the convolutions."""
    buffer = io.BytesIO()
    axes = {2: "H", 3: "W"}
    given = tuple(
        torch.from_numpy(one) for one in _random_inputs((240, 320), np.random.default_rng(1))
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # About sides that become constants.
        torch.onnx.export(
            network,
            given,
            buffer,  # type: ignore[arg-type]  # It may be a stream.
            dynamo=False,
            opset_version=OPSET,
            input_names=[COLOUR, GEOMETRY],
            output_names=[PROBABILITY],
            dynamic_axes={
                COLOUR: axes,
                GEOMETRY: {2: "H/2", 3: "W/2"},
                PROBABILITY: axes,
            },
        )
    model = onnx.load_from_string(buffer.getvalue())
    for number, side in enumerate((1, CLASSES)):  # Tracing leaves them unknown.
        model.graph.output[0].type.tensor_type.shape.dim[number].dim_value = side
    return model


def _random_inputs(
    shape: tuple[int, int], rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    width, height = geometry_size(shape[1], shape[0])
    colour = rng.standard_normal((1, 3, *shape), np.float32)
    geometry = rng.standard_normal((1, GEOMETRY_CHANNELS, height, width), np.float32)
    return colour, geometry

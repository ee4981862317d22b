"""ONNX export of the completion network in half precision, with a comparison to PyTorch."""

import io
from pathlib import Path

import numpy as np
import onnx
import onnxruntime
import torch
from torch import nn

from world2minecraft.core.files import write_bytes
from world2minecraft.networks.completion.network import CompletionNet
from world2minecraft.networks.onnx_export import SMALL, compress_weights
from world2minecraft.reconstruction.semantics.completion_channels import CHANNELS

OPSET = 17
TRIAL_SHAPE = (24, 16, 24)


def export_completion(network: CompletionNet, path: Path, about: dict[str, str]) -> float:
    """Write a network as ONNX.

    The weights of a copy are first rounded to half precision, so both versions compute the same
    result.

    Args:
        network: Network to export.
        path: Output file.
        about: Metadata to store in the file.

    Returns:
        The largest difference between the logits of PyTorch and ONNX Runtime.
    """
    network = to_half_precision(network).eval()
    data = _store_weights(_onnx_bytes(network), about)
    write_bytes(path, data)
    return parity(network, data)


def to_half_precision(network: CompletionNet) -> CompletionNet:
    """Return a float32 copy of a network with folded norms and half-precision weights."""
    copy = CompletionNet(network.size)
    copy.load_state_dict(network.state_dict())
    copy.eval()
    for module in list(copy.modules()):
        if isinstance(module, nn.Sequential):
            _fold_norms(module)
    with torch.no_grad():
        for parameter in copy.parameters():
            if parameter.numel() >= SMALL:
                parameter.copy_(parameter.half().float())
    return copy


def _fold_norms(layers: nn.Sequential) -> None:
    """Fold each norm that follows a convolution into the convolution."""
    for n in range(len(layers) - 1):
        first, second = layers[n], layers[n + 1]
        if isinstance(first, nn.Conv3d) and isinstance(second, nn.BatchNorm3d):
            layers[n] = nn.utils.fuse_conv_bn_eval(first, second)
            layers[n + 1] = nn.Identity()


def _onnx_bytes(network: nn.Module) -> bytes:
    buffer = io.BytesIO()
    axes = {2: "x", 3: "y", 4: "z"}
    torch.onnx.export(
        network,
        (torch.zeros(1, CHANNELS, *TRIAL_SHAPE),),
        buffer,  # type: ignore[arg-type]  # It may be a stream.
        dynamo=False,
        opset_version=OPSET,
        input_names=["cells"],
        output_names=["logits"],
        dynamic_axes={"cells": axes, "logits": axes},
    )
    return buffer.getvalue()


def _store_weights(data: bytes, about: dict[str, str]) -> bytes:
    """Return a model with metadata and with large weights stored in half precision."""
    model = onnx.load_from_string(data)
    onnx.helper.set_model_props(model, dict(sorted(about.items())))
    return compress_weights(model, "half").SerializeToString()


@torch.no_grad()
def parity(network: nn.Module, data: bytes) -> float:
    """Return the largest difference between the logits of PyTorch and ONNX Runtime."""
    session = onnxruntime.InferenceSession(data, providers=["CPUExecutionProvider"])
    rng = np.random.default_rng(0)
    worst = 0.0
    for shape in (TRIAL_SHAPE, (32, 24, 16)):
        cells = rng.random((1, CHANNELS, *shape), np.float32)
        (logits,) = session.run(None, {"cells": cells})
        wanted = network(torch.from_numpy(cells)).numpy()
        worst = max(worst, float(np.abs(logits - wanted).max()))
    return worst

"""ONNX export of the completion network in half precision, with a comparison to PyTorch.

``restore_export`` loads an exported network to continue its training.
"""

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import onnxruntime
import torch
from onnx import numpy_helper
from torch import Tensor, nn

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_bytes, write_bytes
from world2minecraft.networks.completion.network import CompletionNet
from world2minecraft.networks.onnx_export import SMALL, compress_weights
from world2minecraft.reconstruction.semantics.completion_channels import CHANNELS

OPSET = 17
TRIAL_SHAPE = (24, 16, 24)
MAX_BYTES = 64 << 20


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


def average_exports(first: Path, second: Path, share: float, out: Path) -> None:
    """Write an exported network whose weights lie between those of two others.

    Weights between those of a network and of its continuation on other data often serve both kinds
    of data (Wortsman et al., Robust fine-tuning of zero-shot models, CVPR 2022).

    Args:
        first: File of the network.
        second: File of its continuation, of the same size.
        share: Weight of the second, 0 to 1.
        out: Output file, with the metadata of the second.

    Raises:
        DamagedFileError: If the files do not have the same weights.
    """
    models = [onnx.load_from_string(read_bytes(path, MAX_BYTES)) for path in (first, second)]
    old, new = (
        {entry.name.removesuffix("_half"): entry for entry in model.graph.initializer}
        for model in models
    )
    for name, entry in new.items():
        value = numpy_helper.to_array(entry)
        other = numpy_helper.to_array(old[name]) if name in old else np.zeros(0)
        if other.shape != value.shape:
            raise DamagedFileError(first, f"does not have the weights {name} of {second}")
        if value.dtype.kind == "f":
            mixed = share * value.astype(np.float32) + (1 - share) * other.astype(np.float32)
            entry.CopyFrom(numpy_helper.from_array(mixed.astype(value.dtype), entry.name))
    write_bytes(out, models[1].SerializeToString())


@torch.no_grad()
def restore_export(network: CompletionNet, path: Path, cells: Tensor) -> None:
    """Load the weights of an exported network, to continue its training.

    The norms, which were folded into the convolutions, are set to the statistics of a batch, such
    that the network predicts what the exported one does.

    Args:
        network: Network of the same size, which is changed.
        path: ONNX file from ``export_completion``.
        cells: Batch of inputs, float [B, CHANNELS, X, Y, Z].

    Raises:
        DamagedFileError: If the file does not have the weights of such a network.
    """
    stored = {
        entry.name.removesuffix("_half"): numpy_helper.to_array(entry)
        for entry in onnx.load_from_string(read_bytes(path, MAX_BYTES)).graph.initializer
    }
    folded, state = {}, network.state_dict()
    for name, module in network.named_modules():
        if isinstance(module, nn.Sequential):
            for n in range(len(module) - 1):
                if isinstance(module[n + 1], nn.BatchNorm3d):
                    folded[f"{name}.{n}.bias"] = module[n + 1]
    if missing := [name for name in folded if name not in stored]:
        raise DamagedFileError(path, f"does not have the weights {missing[0]}")
    for name, value in stored.items():
        if name not in folded:
            if name not in state or state[name].shape != value.shape:
                raise DamagedFileError(path, f"has weights {name} that the network does not have")
            state[name].copy_(torch.from_numpy(value.astype(np.float32)))
    hooks = [
        norm.register_forward_pre_hook(
            _keeping_scale(torch.tensor(stored[name], dtype=torch.float32))
        )
        for name, norm in folded.items()
    ]
    network.eval()(cells)
    for hook in hooks:
        hook.remove()


def _keeping_scale(bias: Tensor) -> Callable[[Any, tuple[Tensor, ...]], None]:
    """Return a hook that sets a norm to the statistics of its input such that it adds a bias."""

    def hook(norm: Any, inputs: tuple[Tensor, ...]) -> None:
        variance, mean = torch.var_mean(inputs[0], dim=(0, 2, 3, 4), unbiased=False)
        norm.running_mean.copy_(mean)
        norm.running_var.copy_(variance)
        norm.weight.copy_((variance + norm.eps).sqrt())
        norm.bias.copy_(mean + bias)

    return hook


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

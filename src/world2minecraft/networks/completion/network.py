"""The completion network: a 3D U-Net that works at half resolution and predicts at full resolution.

Its first layer combines 2 x 2 x 2 cells into one, which reduces the computation by a factor of
eight. The last layers see the features and the full-resolution cells; without the latter, the
labels had stripes that were two cells wide.
"""

from dataclasses import dataclass

import torch
from torch import Tensor, nn

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.reconstruction.semantics.completion_channels import (
    CHANNELS,
    HINT,
    KINDS,
    VOTES,
)

TRUST = 2.0  # Initial weight of a geometric label or a full vote for its class.
MULTIPLE = 8  # The sides of the input must be multiples of this.


@dataclass(frozen=True)
class CompletionSize:
    """The numbers of channels of a completion network.

    Attributes:
        half: Channels at half resolution.
        quarter: Channels at a quarter of the resolution.
        eighth: Channels at an eighth of the resolution.
        full: Channels at full resolution.
    """

    half: int = 40
    quarter: int = 72
    eighth: int = 112
    full: int = 16


TINY = CompletionSize(8, 12, 16, 8)


class Block(nn.Module):
    """Two 3x3x3 convolutions with a residual connection."""

    def __init__(self, channels: int, dilation: int = 1):
        super().__init__()
        self.body = nn.Sequential(
            nn.Conv3d(channels, channels, 3, padding=1, bias=False),
            nn.BatchNorm3d(channels, momentum=0.03),
            nn.ReLU(inplace=True),
            nn.Conv3d(channels, channels, 3, padding=dilation, dilation=dilation, bias=False),
            nn.BatchNorm3d(channels, momentum=0.03),
        )

    def forward(self, x: Tensor) -> Tensor:
        """Apply the block. The result has the shape of the input."""
        return torch.relu(x + self.body(x))


class Context(nn.Module):
    """A layer that adds features of the mean over all cells to each cell."""

    def __init__(self, channels: int):
        super().__init__()
        self.mix = nn.Sequential(
            nn.Conv3d(channels, channels, 1),
            nn.ReLU(inplace=True),
            nn.Conv3d(channels, channels, 1),
        )

    def forward(self, x: Tensor) -> Tensor:
        """Apply the layer. The result has the shape of the input."""
        return x + self.mix(x.mean(dim=(2, 3, 4), keepdim=True))


class CompletionNet(nn.Module):
    """The completion network.

    It maps float [B, CHANNELS, X, Y, Z] to logits [B, 12, X, Y, Z]. The sides must be multiples of
    ``MULTIPLE``.
    """

    def __init__(self, size: CompletionSize | None = None):
        super().__init__()
        s = size or CompletionSize()
        self.size = s
        self.enter = _joined(nn.Conv3d(CHANNELS, s.half, 2, stride=2, bias=False), s.half)
        self.half_in = Block(s.half)
        self.to_quarter = _joined(nn.Conv3d(s.half, s.quarter, 2, stride=2, bias=False), s.quarter)
        self.quarter_in = nn.Sequential(Block(s.quarter), Block(s.quarter, 2))
        self.to_eighth = _joined(nn.Conv3d(s.quarter, s.eighth, 2, stride=2, bias=False), s.eighth)
        self.eighth = nn.Sequential(Block(s.eighth), Context(s.eighth), Block(s.eighth, 2))
        self.from_eighth = nn.ConvTranspose3d(s.eighth, s.quarter, 2, stride=2)
        self.quarter_out = Block(s.quarter)
        self.from_quarter = nn.ConvTranspose3d(s.quarter, s.half, 2, stride=2)
        self.half_out = nn.Sequential(Block(s.half), Block(s.half))
        self.from_half = nn.ConvTranspose3d(s.half, s.full, 2, stride=2)
        self.beside = nn.Conv3d(CHANNELS, s.full // 2, 1)
        wide = s.full + s.full // 2
        self.last = nn.Sequential(
            nn.ReLU(inplace=True),
            nn.Conv3d(wide, s.full, 3, padding=1),
            nn.ReLU(inplace=True),
            nn.Conv3d(s.full, CLASS_COUNT, 1),
        )
        self.told = _trusting()

    def forward(self, cells: Tensor) -> Tensor:
        """Return the class logits of each cell, [B, 12, X, Y, Z]."""
        half = self.half_in(self.enter(cells))
        quarter = self.quarter_in(self.to_quarter(half))
        eighth = self.eighth(self.to_eighth(quarter))
        quarter = self.quarter_out(quarter + self.from_eighth(eighth))
        half = self.half_out(half + self.from_quarter(quarter))
        correction = self.last(torch.cat([self.from_half(half), self.beside(cells)], dim=1))
        return correction + self.told(cells)


def _trusting() -> nn.Conv3d:
    """Return a layer that initially reproduces the geometric labels and the votes."""
    layer = nn.Conv3d(CHANNELS, CLASS_COUNT, 1, bias=False)
    with torch.no_grad():
        layer.weight.zero_()
        for kind in range(KINDS):
            layer.weight[kind + 1, [HINT + kind, VOTES + kind]] = TRUST
    return layer


def _joined(layer: nn.Module, channels: int) -> nn.Sequential:
    return nn.Sequential(layer, nn.BatchNorm3d(channels, momentum=0.03), nn.ReLU(inplace=True))

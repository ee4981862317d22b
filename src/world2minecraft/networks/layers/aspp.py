"""Several reaches at once (ASPP), and the head that names the cells."""

import torch
from torch import Tensor, nn

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.networks.layers.norms import Norm, conv3d


class Reaches(nn.Module):
    """Pairs of 3x3x3 kernels of several dilations, summed and added to what came in."""

    def __init__(self, channels: int, norm: Norm, dilations: tuple[int, ...] = (1, 2, 3)):
        super().__init__()
        self.branches = nn.ModuleList(
            nn.Sequential(
                conv3d(channels, channels, norm, dilation=reach),
                nn.ReLU(),
                conv3d(channels, channels, norm, dilation=reach),
            )
            for reach in dilations
        )

    def forward(self, cells: Tensor) -> Tensor:
        """Return [B, C, X, Y, Z] of the same shape."""
        found = cells
        for branch in self.branches:
            found = found + branch(cells)
        return torch.relu(found)


class ClassHead(nn.Module):
    """From features of cells to the logits of the 12 classes."""

    def __init__(self, channels: int, norm: Norm, dilations: tuple[int, ...] = (1, 2, 3)):
        super().__init__()
        self.enter = nn.Conv3d(channels, channels, 3, padding=1)
        self.reaches = Reaches(channels, norm, dilations)
        self.classes = nn.Conv3d(channels, CLASS_COUNT, 3, padding=1)

    def forward(self, cells: Tensor) -> Tensor:
        """Return float [B, 12, X, Y, Z]."""
        return self.classes(self.reaches(torch.relu(self.enter(cells))))

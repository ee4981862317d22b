"""3D blocks: dimensional decomposition residual blocks (DDR, CVPR 2019), ASPP and the class head.

A DDR block replaces a 3x3x3 kernel by three kernels along one axis each: the first along z, the
second along y, the third along x, each with the results of the previous ones as input. Shortcut
connections are the identity if the grid keeps its size; if it is halved, they use pooling and 1x1x1
kernels. The published code also creates such kernels in blocks that do not halve the grid, where
they have no effect; they are omitted here.
"""

from collections.abc import Sequence

import torch
from torch import Tensor, nn

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.networks.layers.normalization import DilatedConv3d, Norm, conv3d, norm3d


class DDRBlock(nn.Module):
    """A DDR bottleneck block: reduction to a quarter of the channels, three axes, and expansion.

    Args:
        channels: Number of input channels.
        norm: Kind of normalization.
        dilation: Dilation of the three kernels.
        halve: Whether to halve the grid and double the channels.
    """

    def __init__(self, channels: int, norm: Norm, *, dilation: int = 1, halve: bool = False):
        super().__init__()
        inner, out_channels = max(channels // 4, 1), channels * (2 if halve else 1)
        self.reduce = conv3d(channels, inner, norm, kernel=1)
        self.along = nn.ModuleList(
            _axis_conv(axis, inner, norm, dilation, 2 if halve else 1) for axis in (2, 1, 0)
        )
        self.expand = conv3d(inner, out_channels, norm, kernel=1)
        self.halve = halve
        if halve:
            self.second = _PooledConv(inner, inner, norm, (False, True, False))
            self.third = _PooledConv(inner, inner, norm, (True, False, False))
            self.fourth = _PooledConv(inner, inner, norm, (True, False, False))
            self.around = _PooledConv(channels, out_channels, norm, (True, True, True))

    def forward(self, cells: Tensor) -> Tensor:
        """Return [B, C, X, Y, Z], or [B, 2 C, ...] with half the sides, rounded up."""
        first, second, third = self.along
        up = first(torch.relu(self.reduce(cells)))
        side = second(torch.relu(up))
        up = self.second(up) if self.halve else up
        side = side + up
        deep = third(torch.relu(side))
        deep = deep + (self.third(up) + self.fourth(side) if self.halve else up + side)
        out = self.expand(torch.relu(deep))
        return torch.relu(out + (self.around(cells) if self.halve else cells))


def ddr_blocks(channels: int, norm: Norm, dilations: tuple[int, ...] = (1, 2, 3)) -> nn.Sequential:
    """Create a sequence of DDR blocks with the given dilations."""
    return nn.Sequential(*(DDRBlock(channels, norm, dilation=reach) for reach in dilations))


class Upsample3d(nn.Module):
    """A layer that doubles the sides of a grid, up to one cell."""

    def __init__(self, channels: int, out_channels: int, norm: Norm):
        super().__init__()
        self.up = nn.ConvTranspose3d(channels, out_channels, 3, stride=2, padding=1)
        self.norm = norm3d(norm, out_channels)

    def forward(self, cells: Tensor, sides: Sequence[int]) -> Tensor:
        """Return [B, C', *sides]. Each side must be twice the input side, or one less."""
        wanted = [int(side) for side in sides]
        return torch.relu(self.norm(self.up(cells, output_size=wanted)))


class _PooledConv(nn.Module):
    """Average pooling by two along some axes with edge padding, and a 1x1x1 convolution."""

    def __init__(self, channels: int, out_channels: int, norm: Norm, axes: tuple[bool, bool, bool]):
        super().__init__()
        self.axes = axes
        self.sides = tuple(2 if halved else 1 for halved in axes)
        self.carry = conv3d(channels, out_channels, norm, kernel=1)

    def forward(self, cells: Tensor) -> Tensor:
        """Average pairs of cells along the halved axes and apply the convolution."""
        odd = [
            int(halved and side % 2)
            for halved, side in zip(self.axes, cells.shape[2:], strict=True)
        ]
        if any(odd):
            cells = nn.functional.pad(cells, (0, odd[2], 0, odd[1], 0, odd[0]), mode="replicate")
        return self.carry(nn.functional.avg_pool3d(cells, self.sides, self.sides))


def _axis_conv(axis: int, channels: int, norm: Norm, dilation: int, stride: int) -> nn.Sequential:
    def only(value: int, other: int) -> tuple[int, int, int]:
        return tuple(value if k == axis else other for k in range(3))  # type: ignore[return-value]

    kind = DilatedConv3d if stride == 1 else nn.Conv3d
    conv = kind(
        channels, channels, only(3, 1), only(stride, 1), only(dilation, 0), only(dilation, 1),
        bias=False,
    )  # fmt: skip
    return nn.Sequential(conv, norm3d(norm, channels))


class ASPP(nn.Module):
    """Pairs of 3x3x3 convolutions with several dilations, added to the input."""

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
        """Apply the layer. The result has the shape of the input."""
        found = cells
        for branch in self.branches:
            found = found + branch(cells)
        return torch.relu(found)


class SegmentationHead(nn.Module):
    """A head that maps cell features to the logits of the 12 classes."""

    def __init__(self, channels: int, norm: Norm, dilations: tuple[int, ...] = (1, 2, 3)):
        super().__init__()
        self.enter = nn.Conv3d(channels, channels, 3, padding=1)
        self.reaches = ASPP(channels, norm, dilations)
        self.classes = nn.Conv3d(channels, CLASS_COUNT, 3, padding=1)

    def forward(self, cells: Tensor) -> Tensor:
        """Return the class logits [B, 12, X, Y, Z]."""
        return self.classes(self.reaches(torch.relu(self.enter(cells))))

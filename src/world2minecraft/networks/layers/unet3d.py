"""The 3D U-Net of MonoScene, with its context prior and its head.

At 60x60x36 cells of 0.08 m the quarter is what the paper calls 1/16: 15x15x9.
"""

from torch import Tensor, nn

from world2minecraft.networks.layers.context_prior import ContextPrior
from world2minecraft.networks.layers.normalization import Norm
from world2minecraft.networks.layers.residual_3d import (
    DDRBlock,
    SegmentationHead,
    Upsample3d,
    ddr_blocks,
)


class UNet3D(nn.Module):
    """From features of cells to their logits.

    Args:
        channels: of the cells that come in; twice and four times as many below.
        shape: of the grid; only the context prior needs it.
        norm: how layers are normalised.
        reaches: the dilations of its blocks and of its head.
        context: whether there is a context prior.
    """

    def __init__(
        self,
        channels: int,
        shape: tuple[int, int, int],
        norm: Norm,
        *,
        reaches: tuple[int, ...] = (1, 2, 3),
        context: bool = True,
    ):
        super().__init__()
        self.down = _downsample(channels, norm, reaches)
        self.down_again = _downsample(2 * channels, norm, reaches)
        quarter = coarsest_shape(shape)
        self.context = ContextPrior(4 * channels, quarter, norm, reaches) if context else None
        self.up = Upsample3d(4 * channels, 2 * channels, norm)
        self.up_again = Upsample3d(2 * channels, channels, norm)
        self.head = SegmentationHead(channels, norm, reaches)

    def forward(self, cells: Tensor) -> tuple[Tensor, Tensor | None]:
        """Return logits [B, 12, X, Y, Z], and those of the relations where they are asked for."""
        half = self.down(cells)
        quarter, relations = self.down_again(half), None
        if self.context is not None:
            quarter, relations = self.context(quarter)
        half = self.up(quarter, half.shape[2:]) + half
        return self.head(self.up_again(half, cells.shape[2:]) + cells), relations


def coarsest_shape(shape: tuple[int, int, int]) -> tuple[int, int, int]:
    """Return the sides of a grid that was halved twice, rounded up each time.

    >>> coarsest_shape((60, 60, 36)), coarsest_shape((30, 30, 18))
    ((15, 15, 9), (8, 8, 5))
    """
    return (-(-shape[0] // 4), -(-shape[1] // 4), -(-shape[2] // 4))


def _downsample(channels: int, norm: Norm, reaches: tuple[int, ...]) -> nn.Sequential:
    blocks = ddr_blocks(channels, norm, reaches)
    return nn.Sequential(blocks, DDRBlock(channels, norm, halve=True))

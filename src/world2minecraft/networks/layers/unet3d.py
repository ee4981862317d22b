"""MonoScene's 3D U-Net with its context prior and its head.

For 60x60x36 cells of 0.08 m, a quarter of the resolution is the level called 1/16 in the paper:
15x15x9.
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
    """A network that maps cell features to class logits.

    Args:
        channels: Number of input channels, which is doubled at each coarser level.
        shape: Shape of the grid, needed only by the context prior.
        norm: Kind of normalization.
        reaches: Dilations of the blocks and the head.
        context: Whether to use a context prior.
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
        """Return class logits [B, 12, X, Y, Z], and relation logits or None."""
        half = self.down(cells)
        quarter, relations = self.down_again(half), None
        if self.context is not None:
            quarter, relations = self.context(quarter)
        half = self.up(quarter, half.shape[2:]) + half
        return self.head(self.up_again(half, cells.shape[2:]) + cells), relations


def coarsest_shape(shape: tuple[int, int, int]) -> tuple[int, int, int]:
    """Return the shape of a grid after halving it twice, rounded up each time.

    >>> coarsest_shape((60, 60, 36)), coarsest_shape((30, 30, 18))
    ((15, 15, 9), (8, 8, 5))
    """
    return (-(-shape[0] // 4), -(-shape[1] // 4), -(-shape[2] // 4))


def _downsample(channels: int, norm: Norm, reaches: tuple[int, ...]) -> nn.Sequential:
    blocks = ddr_blocks(channels, norm, reaches)
    return nn.Sequential(blocks, DDRBlock(channels, norm, halve=True))

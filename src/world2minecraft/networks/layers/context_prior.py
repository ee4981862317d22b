"""MonoScene's context prior: relations between voxels and mega-voxels (CVPR 2022, 3.4).

The coarsest cells are gathered into mega-voxels of 2x2x2. For each relation a matrix states how far
each cell has it with each mega-voxel; by that matrix the mega-voxels' features come to the cells.
The relations are supervised: alike, unlike, both empty, one empty (see ``losses.relation_loss``).
"""

import torch
from torch import Tensor, nn

from world2minecraft.networks.layers.normalization import Norm
from world2minecraft.networks.layers.residual_3d import ASPP, ddr_blocks

RELATIONS = 4


class ContextPrior(nn.Module):
    """Brings to each coarse cell what it is related to.

    Args:
        channels: of the coarsest cells.
        shape: of their grid, which must be known beforehand; sides of 2 or more.
        norm: how layers are normalised.
        reaches: the dilations of what looks around first.
    """

    def __init__(
        self,
        channels: int,
        shape: tuple[int, int, int],
        norm: Norm,
        reaches: tuple[int, ...] = (1, 2, 3),
    ):
        super().__init__()
        self.shape = shape
        self.mega_shape = mega_shape(shape)
        megas = self.mega_shape[0] * self.mega_shape[1] * self.mega_shape[2]
        around = ((shape[0] + 1) % 2, (shape[1] + 1) % 2, (shape[2] + 1) % 2)
        self.reaches = ASPP(channels, norm, reaches)
        self.gather = nn.Conv3d(channels, 2 * channels, 3, stride=2, padding=around)
        self.relations = nn.ModuleList(nn.Conv3d(channels, megas, 1) for _ in range(RELATIONS))
        self.merge = nn.Sequential(
            nn.Conv3d(channels * (2 * RELATIONS + 1), channels, 1, bias=False),
            ddr_blocks(channels, norm, (1,)),
        )

    def forward(self, cells: Tensor) -> tuple[Tensor, Tensor]:
        """Return the cells [B, C, X, Y, Z], and the relations' logits [B, 4, megas, cells]."""
        wide = self.reaches(cells)
        megas = self.gather(wide).flatten(2)  # [B, 2 C, M]
        logits = torch.stack([relation(wide).flatten(2) for relation in self.relations], dim=1)
        brought = megas[:, None] @ torch.sigmoid(logits)  # [B, 4, 2 C, N]
        brought = brought.flatten(1, 2).unflatten(2, self.shape)
        return self.merge(torch.cat([cells, brought], dim=1)), logits


def mega_shape(shape: tuple[int, int, int]) -> tuple[int, int, int]:
    """Return how many mega-voxels of 2x2x2 whole cells a grid has along each axis.

    >>> mega_shape((15, 15, 9))
    (7, 7, 4)
    """
    return (shape[0] // 2, shape[1] // 2, shape[2] // 2)

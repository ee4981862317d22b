"""MonoScene's context prior: relations between voxels and mega-voxels (CVPR 2022, section 3.4).

The coarsest cells are grouped into mega-voxels of 2x2x2 cells. For each kind of relation, a matrix
describes how strongly each cell is related to each mega-voxel, and is used to pass features from
mega-voxels to cells. The relations are supervised: same class, different class, both empty, one
empty (see ``losses.relation_loss``).
"""

import torch
from torch import Tensor, nn

from world2minecraft.networks.layers.normalization import Norm
from world2minecraft.networks.layers.residual_3d import ASPP, ddr_blocks

RELATIONS = 4


class ContextPrior(nn.Module):
    """A layer that adds features of related mega-voxels to each coarse cell.

    Args:
        channels: Number of channels of the coarsest cells.
        shape: Shape of their grid. Each side must be at least 2.
        norm: Kind of normalization.
        reaches: Dilations of the first convolutions.
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
        """Return the cells [B, C, X, Y, Z] and the relation logits [B, 4, megas, cells]."""
        wide = self.reaches(cells)
        megas = self.gather(wide).flatten(2)  # [B, 2 C, M]
        logits = torch.stack([relation(wide).flatten(2) for relation in self.relations], dim=1)
        brought = megas[:, None] @ torch.sigmoid(logits)  # [B, 4, 2 C, N]
        brought = brought.flatten(1, 2).unflatten(2, self.shape)
        return self.merge(torch.cat([cells, brought], dim=1)), logits


def mega_shape(shape: tuple[int, int, int]) -> tuple[int, int, int]:
    """Return the number of complete 2x2x2 mega-voxels along each axis of a grid.

    >>> mega_shape((15, 15, 9))
    (7, 7, 4)
    """
    return (shape[0] // 2, shape[1] // 2, shape[2] // 2)

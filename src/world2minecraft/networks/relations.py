"""The loss of MonoScene's context prior: four relations of coarse cells with mega-voxels."""

import torch
from torch import Tensor

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.networks.layers.context import RELATIONS

FACTOR = 4  # From the grid to its coarsest level.
EMPTY_SHARE = 0.95  # SSCNet's: a coarse cell is empty where more than that is empty or unknown.


def relation_loss(logits: Tensor, labels: Tensor) -> Tensor:
    """Return the binary cross entropy of all relations, each balanced by how rare it is.

    Args:
        logits: float [B, 4, megas, cells], of the grid's quarter.
        labels: int64 [B, X, Y, Z] of the whole grid.

    A pair counts where the cell is known and a cell of the mega-voxel is too; the published code
    takes such pairs for unrelated.
    """
    truth, counted = relations_of(coarse_labels(labels))
    truth, weights = truth.float(), counted.float()
    held = (truth * weights).sum(dim=(0, 2, 3))
    missed = ((1 - truth) * weights).sum(dim=(0, 2, 3))
    balance = torch.where(held > 0, missed / held.clamp(min=1), torch.ones_like(held))
    each = torch.nn.functional.binary_cross_entropy_with_logits(
        logits.float(), truth, pos_weight=balance[:, None, None], reduction="none"
    )
    return (each * weights).sum() / (weights.sum() * RELATIONS).clamp(min=1)


def relations_of(labels: Tensor) -> tuple[Tensor, Tensor]:
    """Return which relations hold, and which pairs are known.

    A relation holds between a cell and a mega-voxel where it holds between the cell and any known
    one of the mega-voxel's eight: both occupied and alike, both occupied and unlike, both empty,
    one of them empty.

    Args:
        labels: int64 [B, X, Y, Z] at the coarsest level.

    Returns:
        bool [B, 4, M, N], and bool [B, 1, M, N].
    """
    eight = _eights(labels)[:, :, :, None]  # [B, M, 8, 1]
    cells = labels.flatten(1)[:, None, None]  # [B, 1, 1, N]
    known = (eight != UNKNOWN) & (cells != UNKNOWN)
    alike, both = eight == cells, (eight != 0) & (cells != 0)
    none = (eight == 0) & (cells == 0)
    held = (alike & both, ~alike & both, none, ~alike & ~both)
    return torch.stack([(one & known).any(dim=2) for one in held], dim=1), known.any(dim=2)[:, None]


def coarse_labels(labels: Tensor, factor: int = FACTOR) -> Tensor:
    """Return labels of blocks of cells by SSCNet's rule, int64, sides rounded up.

    A block is not occupied where more than 95 % of its cells are empty or unknown: then it is what
    more of them are. Else it is the class that most of its occupied cells have. Cells beyond the
    grid are unknown.
    """
    beyond = [(-int(side)) % factor for side in labels.shape[1:]]
    padded = torch.nn.functional.pad(
        labels, (0, beyond[2], 0, beyond[1], 0, beyond[0]), value=UNKNOWN
    )
    kinds = torch.where(padded == UNKNOWN, CLASS_COUNT, padded)
    counts = torch.stack(
        [_pooled((kinds == kind).float(), factor) for kind in range(CLASS_COUNT + 1)], dim=1
    )
    empty, unknown = counts[:, 0], counts[:, CLASS_COUNT]
    best = counts[:, 1:CLASS_COUNT].argmax(dim=1) + 1
    hollow = torch.where(empty > unknown, 0, UNKNOWN)
    return torch.where(empty + unknown > EMPTY_SHARE * factor**3, hollow, best)


def _pooled(values: Tensor, factor: int) -> Tensor:
    sums = torch.nn.functional.avg_pool3d(values[:, None], factor)[:, 0] * factor**3
    return torch.round(sums)


def _eights(labels: Tensor) -> Tensor:
    """Return the eight cells of each whole mega-voxel, [B, M, 8]."""
    x, y, z = (int(side) // 2 * 2 for side in labels.shape[1:])
    blocks = labels[:, :x, :y, :z].reshape(-1, x // 2, 2, y // 2, 2, z // 2, 2)
    return blocks.permute(0, 1, 3, 5, 2, 4, 6).reshape(len(labels), -1, 8)

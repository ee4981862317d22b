"""MonoScene's frustum proportion loss: what each part of the picture holds, hidden or not."""

import torch
from torch import Tensor

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.networks.batch import OccInput
from world2minecraft.networks.layers.projection import sight_of

FRUSTA = 8  # Along each side of the picture.
LEAST = 1e-6


def frustum_loss(logits: Tensor, labels: Tensor, inputs: OccInput) -> Tensor:
    """Return the mean KL divergence of the classes' shares in 8x8 parts of the pictures.

    Shares are of the whole batch: the cells that fall into a part in any of its pictures. Only
    classes that a part truly holds count.

    Args:
        logits: float [B, 12, X, Y, Z].
        labels: int64 [B, X, Y, Z].
        inputs: where the cells lie in the pictures.
    """
    part = frustum_of_cells(inputs)  # [B, N]
    labels = labels.flatten(1)
    counted = (part >= 0) & (labels != UNKNOWN)
    part, labels = part[counted], labels[counted]
    shares = torch.softmax(logits.float(), dim=1).flatten(2).movedim(1, 2)[counted]  # [K, 12]
    said = _sums(part, shares)
    truth = _sums(part, torch.nn.functional.one_hot(labels, CLASS_COUNT).float())
    cells = truth.sum(dim=1, keepdim=True)
    truth, said = truth / cells.clamp(min=1), said / cells.clamp(min=1)
    each = torch.where(
        truth > 0,
        truth * (truth.clamp(min=LEAST).log() - said.clamp(min=LEAST).log()),
        torch.zeros_like(truth),
    )
    return each.sum() / (cells > 0).sum().clamp(min=1)


def frustum_of_cells(inputs: OccInput) -> Tensor:
    """Return the part of the picture that each cell falls into, int64 [B, N], -1 for none."""
    sight = sight_of(inputs)
    height, width = sight.size_px
    column = (sight.pixels[..., 0] * FRUSTA / width).floor().clamp(0, FRUSTA - 1).long()
    row = (sight.pixels[..., 1] * FRUSTA / height).floor().clamp(0, FRUSTA - 1).long()
    return torch.where(sight.inside, row * FRUSTA + column, -1)


def _sums(part: Tensor, values: Tensor) -> Tensor:
    empty = values.new_zeros(FRUSTA * FRUSTA, values.shape[1])
    return empty.index_add(0, part, values)

"""Dilated convolutions of cells, trained as plain ones.

A CPU takes ten times as long for the gradient of a dilated 3x3x3 kernel as for that of a plain one
(43 ms of one core against 4, [4, 32, 30, 30, 18] in bfloat16). Cells that lie a whole number of
dilations apart never meet the others: each such family is a small grid of its own, and over all of
them, laid side by side in the batch, the kernel is a plain one. Same result, same weights.
"""

import torch
from torch import Tensor, nn
from torch.nn import functional


class DilatedConv3d(nn.Conv3d):
    """A convolution of stride 1 that keeps the shape; weights are those of ``nn.Conv3d``."""

    def forward(self, input: Tensor) -> Tensor:
        """Return [B, D, X, Y, Z] for [B, C, X, Y, Z]."""
        if max(self.dilation) == 1 or not (self.training and torch.is_grad_enabled()):
            return super().forward(input)
        sides, steps = input.shape[2:], self.dilation
        kept = [kernel // 2 for kernel in self.kernel_size]
        found = functional.conv3d(families(input, steps), self.weight, self.bias, padding=kept)
        return joined(found, steps, sides)


def families(cells: Tensor, steps: tuple[int, ...]) -> Tensor:
    """Return each family of cells as a grid of its own, [B * i * j * k, C, X / i, Y / j, Z / k].

    Sides that the steps do not divide are filled up with zeros, as a padded convolution does.
    """
    over = [-side % step for side, step in zip(cells.shape[2:], steps, strict=True)]
    cells = functional.pad(cells, (0, over[2], 0, over[1], 0, over[0]))
    batch, channels, *sides = cells.shape
    i, j, k = steps
    x, y, z = (side // step for side, step in zip(sides, steps, strict=True))
    split = cells.view(batch, channels, x, i, y, j, z, k).permute(0, 3, 5, 7, 2, 4, 6, 1)
    return split.reshape(batch * i * j * k, x, y, z, channels).permute(0, 4, 1, 2, 3)


def joined(cells: Tensor, steps: tuple[int, ...], sides: tuple[int, ...]) -> Tensor:
    """Return the grid [B, C, *sides] whose families these are: the inverse of ``families``."""
    i, j, k = steps
    many, channels, x, y, z = cells.shape
    batch = many // (i * j * k)
    split = cells.permute(0, 2, 3, 4, 1).reshape(batch, i, j, k, x, y, z, channels)
    whole = split.permute(0, 4, 1, 5, 2, 6, 3, 7).reshape(batch, x * i, y * j, z * k, channels)
    return whole[:, : sides[0], : sides[1], : sides[2]].permute(0, 4, 1, 2, 3)

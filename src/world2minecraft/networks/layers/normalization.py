"""Normalized 2D and 3D convolutions, with group or batch normalization.

The papers use ``batch`` on many GPUs. ``group`` does not depend on the other items of a batch,
which on two CPU cores contains only one or two images. Its gradient is computed in float32, because
PyTorch's own bfloat16 gradient for channels-last tensors takes three times as long on a CPU and is
less accurate.

Dilated convolutions are trained as ordinary convolutions. On a CPU, the gradient of a dilated 3x3x3
kernel takes ten times as long as that of an ordinary one (43 ms instead of 4 ms on one core for [4,
32, 30, 30, 18] in bfloat16). Cells whose distance is a multiple of the dilation never interact with
other cells, so each such phase is a small grid of its own. If all phases are stacked in the batch,
an ordinary convolution gives the same result with the same weights.
"""

from typing import Any, Literal

import torch
from torch import Tensor, nn
from torch.nn import functional

Norm = Literal["batch", "group"]
GROUPS = 4  # Of channels; the small networks have 8 to 32.


class DilatedConv3d(nn.Conv3d):
    """A 3D convolution that preserves the shape (stride 1), with the weights of ``nn.Conv3d``."""

    def forward(self, input: Tensor) -> Tensor:
        """Return [B, D, X, Y, Z] for [B, C, X, Y, Z]."""
        if max(self.dilation) == 1 or not (self.training and torch.is_grad_enabled()):
            return super().forward(input)
        sides, steps = input.shape[2:], self.dilation
        padding = [kernel // 2 for kernel in self.kernel_size]
        found = functional.conv3d(
            split_phases(input, steps), self.weight, self.bias, padding=padding
        )
        return merge_phases(found, steps, sides)


def split_phases(cells: Tensor, steps: tuple[int, ...]) -> Tensor:
    """Split a grid into its phases, [B * i * j * k, C, X / i, Y / j, Z / k].

    Sides that are not multiples of the steps are padded with zeros, as in a padded convolution.
    """
    over = [-side % step for side, step in zip(cells.shape[2:], steps, strict=True)]
    cells = functional.pad(cells, (0, over[2], 0, over[1], 0, over[0]))
    batch, channels, *sides = cells.shape
    i, j, k = steps
    x, y, z = (side // step for side, step in zip(sides, steps, strict=True))
    split = cells.view(batch, channels, x, i, y, j, z, k).permute(0, 3, 5, 7, 2, 4, 6, 1)
    return split.reshape(batch * i * j * k, x, y, z, channels).permute(0, 4, 1, 2, 3)


def merge_phases(cells: Tensor, steps: tuple[int, ...], sides: tuple[int, ...]) -> Tensor:
    """Merge phases into a grid [B, C, *sides]. This is the inverse of ``split_phases``."""
    i, j, k = steps
    many, channels, x, y, z = cells.shape
    batch = many // (i * j * k)
    split = cells.permute(0, 2, 3, 4, 1).reshape(batch, i, j, k, x, y, z, channels)
    whole = split.permute(0, 4, 1, 5, 2, 6, 3, 7).reshape(batch, x * i, y * j, z * k, channels)
    return whole[:, : sides[0], : sides[1], : sides[2]].permute(0, 4, 1, 2, 3)


class GroupNorm(nn.GroupNorm):
    """``nn.GroupNorm`` with the same weights, but faster training in bfloat16."""

    def forward(self, input: Tensor) -> Tensor:
        """Return a tensor [B, C, ...] of the same shape and dtype as the input."""
        layout, trains = _layout(input), self.training and torch.is_grad_enabled()
        if input.dtype != torch.bfloat16 or layout == torch.contiguous_format or not trains:
            return super().forward(input)
        packed = input.contiguous(memory_format=layout)
        return _GroupNormFunction.apply(packed, self.weight, self.bias, self.num_groups, self.eps)


class _GroupNormFunction(torch.autograd.Function):
    @staticmethod
    def forward(
        ctx: Any, values: Tensor, weight: Tensor, bias: Tensor, groups: int, eps: float
    ) -> Tensor:
        """Normalize the groups and save the values for ``backward``."""
        sizes = _sizes(values)
        found, mean, spread = torch.native_group_norm(values, weight, bias, *sizes, groups, eps)
        ctx.save_for_backward(values, weight, mean, spread)
        ctx.groups = groups
        return found

    @staticmethod
    def backward(ctx: Any, *grads: Tensor) -> tuple[Tensor | None, ...]:
        """Return the gradients of the values, the weight and the bias."""
        values, weight, mean, spread = ctx.saved_tensors
        layout = _layout(values)  # torch would misread a gradient with another layout.
        found = torch.ops.aten.native_group_norm_backward(
            grads[0].float().contiguous(memory_format=layout), values.float(), mean.float(),
            spread.float(), weight.float(), *_sizes(values), ctx.groups, [True, True, True],
        )  # fmt: skip
        of_values, of_weight, of_bias = found
        return of_values.to(values.dtype), of_weight.to(weight.dtype), of_bias, None, None


def _layout(values: Tensor) -> torch.memory_format:
    """Return the memory format of a tensor: channels last, or contiguous."""
    last = {4: torch.channels_last, 5: torch.channels_last_3d}.get(values.ndim)
    return last if last is not None and values.stride(1) == 1 else torch.contiguous_format


def _sizes(values: Tensor) -> tuple[int, int, int]:
    return len(values), values.shape[1], values[0, 0].numel()


def norm2d(kind: Norm, channels: int) -> nn.Module:
    """Create a normalization layer for tensors [B, C, H, W]."""
    return nn.BatchNorm2d(channels) if kind == "batch" else _grouped(channels)


def norm3d(kind: Norm, channels: int) -> nn.Module:
    """Create a normalization layer for tensors [B, C, X, Y, Z]."""
    return nn.BatchNorm3d(channels) if kind == "batch" else _grouped(channels)


def _grouped(channels: int) -> GroupNorm:
    groups = next(count for count in range(min(GROUPS, channels), 0, -1) if channels % count == 0)
    return GroupNorm(groups, channels)


def conv2d(
    in_channels: int, out_channels: int, kind: Norm, *, kernel: int = 3, stride: int = 1
) -> nn.Sequential:
    """Create a 2D convolution with normalization, without an activation."""
    conv = nn.Conv2d(in_channels, out_channels, kernel, stride, kernel // 2, bias=False)
    return nn.Sequential(conv, norm2d(kind, out_channels))


def conv3d(
    in_channels: int, out_channels: int, kind: Norm, *, kernel: int = 3, dilation: int = 1
) -> nn.Module:
    """Create a 3D convolution with normalization, without an activation."""
    around = dilation * (kernel // 2)
    conv = DilatedConv3d(
        in_channels, out_channels, kernel, padding=around, dilation=dilation, bias=False
    )
    return nn.Sequential(conv, norm3d(kind, out_channels))

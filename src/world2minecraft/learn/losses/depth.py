"""The loss of a depth branch: cross entropy of the bin that a pixel's depth falls into."""

import torch
from torch import Tensor

from world2minecraft.learn.networks.parts.depth import bin_of


def depth_loss(logits: Tensor, depth_m: Tensor) -> Tensor:
    """Return the mean over the branch's pixels that have a depth within its bins.

    Args:
        logits: float [B, bins, h, w].
        depth_m: float32 [B, H, W], 0 where there is none. A pixel of the branch is to say the least
            depth of those that it covers, as the nearer hides what is behind.
    """
    near = least_depth(depth_m, (int(logits.shape[-2]), int(logits.shape[-1])))
    bins = int(logits.shape[1])
    wanted, known = bin_of(near, bins)
    each = torch.nn.functional.cross_entropy(logits.float(), wanted, reduction="none")
    return (each * known).sum() / known.sum().clamp(min=1)


def least_depth(depth_m: Tensor, sides: tuple[int, int]) -> Tensor:
    """Return the least depth that is not 0 of each part of a picture, [B, h, w]; 0 for none."""
    far = torch.where(depth_m > 0, depth_m, torch.full_like(depth_m, torch.inf))
    near = -torch.nn.functional.adaptive_max_pool2d(-far[:, None], sides)[:, 0]
    return torch.where(torch.isfinite(near), near, torch.zeros_like(near))

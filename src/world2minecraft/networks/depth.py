"""The loss of a depth branch: cross entropy of the bin that a pixel's depth falls into."""

import math

import torch
from torch import Tensor

from world2minecraft.networks.layers.depth_bins import bin_of, least_depth


def depth_loss(logits: Tensor, depth_m: Tensor) -> Tensor:
    """Return the mean over the branch's pixels that have a depth within its bins.

    Args:
        logits: float [B, bins, ceil(H / s), ceil(W / s)], s a power of two.
        depth_m: float32 [B, H, W], 0 where there is none. A pixel of the branch is to say the least
            depth of those that it covers, as the nearer hides what is behind.
    """
    scale = 2 ** round(math.log2(depth_m.shape[-1] / logits.shape[-1]))
    near = least_depth(depth_m, scale)
    bins = int(logits.shape[1])
    wanted, known = bin_of(near, bins)
    each = torch.nn.functional.cross_entropy(logits.float(), wanted, reduction="none")
    return (each * known).sum() / known.sum().clamp(min=1)

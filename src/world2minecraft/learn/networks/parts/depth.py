"""Depth of pixels in bins that grow linearly (LID), and a branch that says it."""

from itertools import pairwise

import torch
from torch import Tensor

FARTHEST_M = 10.0  # ISO's range for rooms, from 0.


def bin_edges_m(bins: int) -> list[float]:
    """Return the edges of bins from 0 to 10 m, each wider than the last by the same step.

    >>> bin_edges_m(4)
    [0.0, 1.0, 3.0, 6.0, 10.0]
    """
    return [FARTHEST_M * k * (k + 1) / (bins * (bins + 1)) for k in range(bins + 1)]


def bin_place(depth_m: Tensor, bins: int) -> Tensor:
    """Return where depths lie among the bins, as a real number: k at the lower edge of bin k.

    Between edges it grows as the edges' own rule does, so that it is smooth.
    """
    scaled = depth_m.clamp(min=0) * (bins * (bins + 1) / FARTHEST_M)
    return torch.sqrt(scaled + 0.25) - 0.5


def bin_of(depth_m: Tensor, bins: int) -> tuple[Tensor, Tensor]:
    """Return the bin of each depth, int64, and whether it has one: above 0 and below 10 m."""
    known = (depth_m > 0) & (depth_m < FARTHEST_M)
    place = bin_place(torch.where(known, depth_m, torch.zeros_like(depth_m)), bins)
    return place.floor().long().clamp(0, bins - 1), known


def bin_middles_m(bins: int, like: Tensor) -> Tensor:
    """Return the depth in the middle of each bin, [bins], of the type of ``like``."""
    edges = bin_edges_m(bins)
    middles = [(near + far) / 2 for near, far in pairwise(edges)]
    return torch.tensor(middles, device=like.device, dtype=like.dtype)

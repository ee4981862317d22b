"""Depth in linearly increasing bins (LID), and a branch that predicts it."""

from itertools import pairwise

import torch
from torch import Tensor, nn

from world2minecraft.networks.batch import OccInput
from world2minecraft.networks.layers.normalization import Norm, conv2d
from world2minecraft.networks.layers.projection import CellProjection, sample_grid
from world2minecraft.networks.layers.unet2d import ResidualBlock

MAX_DEPTH_M = 10.0  # ISO's range for rooms, from 0.
BEYOND_M = 1e6  # Stands for no depth among depths of which the least is sought.


def bin_edges_m(bins: int) -> list[float]:
    """Return the edges of bins from 0 to 10 m, each wider than the last by the same step.

    >>> bin_edges_m(4)
    [0.0, 1.0, 3.0, 6.0, 10.0]
    """
    return [MAX_DEPTH_M * k * (k + 1) / (bins * (bins + 1)) for k in range(bins + 1)]


def bin_coordinate(depth_m: Tensor, bins: int) -> Tensor:
    """Return where depths lie among the bins, as a real number: k at the lower edge of bin k.

    Between edges it grows as the edges' own rule does, so that it is smooth.
    """
    scaled = depth_m.clamp(min=0) * (bins * (bins + 1) / MAX_DEPTH_M)
    return torch.sqrt(scaled + 0.25) - 0.5


def bin_of(depth_m: Tensor, bins: int) -> tuple[Tensor, Tensor]:
    """Return the bin of each depth, int64, and whether it has one: above 0 and below 10 m."""
    known = (depth_m > 0) & (depth_m < MAX_DEPTH_M)
    place = bin_coordinate(torch.where(known, depth_m, torch.zeros_like(depth_m)), bins)
    return place.floor().long().clamp(0, bins - 1), known


def bin_centers_m(bins: int, like: Tensor) -> Tensor:
    """Return the depth in the middle of each bin, [bins], of the type of ``like``."""
    edges = bin_edges_m(bins)
    middles = [(near + far) / 2 for near, far in pairwise(edges)]
    return torch.tensor(middles, device=like.device, dtype=like.dtype)


def min_pool_depth(depth_m: Tensor, scale: int) -> Tensor:
    """Return the least depth that is not 0 of each block of pixels; 0 where there is none.

    Args:
        depth_m: float32 [B, H, W].
        scale: the side of a block, pixels.

    Returns:
        [B, ceil(H / scale), ceil(W / scale)].
    """
    far = torch.where(depth_m > 0, depth_m, torch.full_like(depth_m, BEYOND_M))
    near = -nn.functional.max_pool2d(-far[:, None], scale, ceil_mode=True)[:, 0]
    return torch.where(near < BEYOND_M, near, torch.zeros_like(near))


class DepthBranch(nn.Module):
    """Says of each pixel of a map how likely its surface lies in each bin.

    It sees the map, the depth that is given (0 where none is), and how wide the camera's pixels
    are, by which it weighs its channels.

    Args:
        given: channels of the map.
        inner: its own channels.
        bins: how many there are from 0 to 10 m.
        scale: of the map.
        norm: how layers are normalised.
        blocks: how many residual blocks it has.
    """

    def __init__(
        self, given: int, inner: int, bins: int, scale: int, norm: Norm, *, blocks: int = 3
    ):
        super().__init__()
        self.scale = scale
        self.enter = nn.Sequential(conv2d(given + 1, inner, norm), nn.ReLU())
        self.camera = nn.Sequential(nn.Linear(1, inner), nn.ReLU(), nn.Linear(inner, inner))
        self.weigh = nn.Sequential(nn.Linear(inner, inner), nn.ReLU(), nn.Linear(inner, inner))
        self.deepen = nn.Sequential(*(ResidualBlock(inner, norm) for _ in range(blocks)))
        self.say = nn.Conv2d(inner, bins, 1)

    def forward(self, values: Tensor, inputs: OccInput) -> Tensor:
        """Return logits [B, bins, h, w] for a map [B, C, h, w]."""
        values = self.enter(torch.cat([values, self.given(values, inputs)], dim=1))
        focal = torch.stack([inputs.intrinsics[:, 0, 0], inputs.intrinsics[:, 1, 1]], dim=-1)
        width = (1000 / focal).square().sum(dim=-1, keepdim=True).sqrt()
        weights = torch.sigmoid(self.weigh(self.camera(width)))
        return self.say(self.deepen(values * weights[:, :, None, None]))

    def given(self, values: Tensor, inputs: OccInput) -> Tensor:
        """Return the depth that is given, [B, 1, h, w], as a share of 10 m; 0 where none is."""
        if inputs.depth_m is None:
            return torch.zeros_like(values[:, :1])
        return min_pool_depth(inputs.depth_m, self.scale)[:, None].to(values.dtype) / MAX_DEPTH_M


def known_depth(logits: Tensor, inputs: OccInput, scale: int) -> Tensor:
    """Return the depth of each pixel of a map, [B, h, w]: what is given, else what is expected."""
    shares = torch.softmax(logits.float(), dim=1)
    middles = bin_centers_m(int(logits.shape[1]), shares)
    expected = (shares * middles[:, None, None]).sum(dim=1)
    if inputs.depth_m is None:
        return expected
    given = min_pool_depth(inputs.depth_m, scale)
    return torch.where(given > 0, given, expected)


def weight_by_depth(shares: Tensor, sight: CellProjection, scale: int) -> Tensor:
    """Return what a depth branch says of each cell, [B, C, N].

    Args:
        shares: [B, C, bins, h, w], any C values of each bin of each pixel.
        sight: where the cells lie.
        scale: of the map.

    Between pixels and bins values are mixed; beyond them they are 0.
    """
    bins = int(shares.shape[2])
    rows, columns = sight.pixels[..., 1] / scale, sight.pixels[..., 0] / scale
    found = sample_grid(
        shares, torch.stack([bin_coordinate(sight.depth_m, bins), rows, columns], dim=-1)
    )
    return found * sight.inside[:, None]

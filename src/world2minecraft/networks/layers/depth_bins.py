"""Linearly increasing depth bins (LID), and a network branch that predicts them."""

from itertools import pairwise

import torch
from torch import Tensor, nn

from world2minecraft.networks.batch import OccInput
from world2minecraft.networks.layers.normalization import Norm, conv2d
from world2minecraft.networks.layers.projection import CellProjection, sample_grid
from world2minecraft.networks.layers.unet2d import ResidualBlock

MAX_DEPTH_M = 10.0  # ISO's range for rooms, from 0.
RESIDUAL_BLOCKS = 3  # Of the depth branch.
BEYOND_M = 1e6  # Represents a missing depth when the minimum is computed.


def bin_edges_m(bins: int) -> list[float]:
    """Return the edges of depth bins from 0 to 10 m, with linearly increasing widths.

    >>> bin_edges_m(4)
    [0.0, 1.0, 3.0, 6.0, 10.0]
    """
    return [MAX_DEPTH_M * k * (k + 1) / (bins * (bins + 1)) for k in range(bins + 1)]


def bin_coordinate(depth_m: Tensor, bins: int) -> Tensor:
    """Return the continuous bin index of each depth, which is k at the lower edge of bin k.

    Between the edges, the index follows the same formula and is therefore smooth.
    """
    scaled = depth_m.clamp(min=0) * (bins * (bins + 1) / MAX_DEPTH_M)
    return torch.sqrt(scaled + 0.25) - 0.5


def bin_of(depth_m: Tensor, bins: int) -> tuple[Tensor, Tensor]:
    """Return the bin of each depth, int64, and whether the depth is between 0 and 10 m."""
    known = (depth_m > 0) & (depth_m < MAX_DEPTH_M)
    place = bin_coordinate(torch.where(known, depth_m, torch.zeros_like(depth_m)), bins)
    return place.floor().long().clamp(0, bins - 1), known


def bin_centers_m(bins: int, like: Tensor) -> Tensor:
    """Return the depth at the centre of each bin in metres, [bins], with the dtype of ``like``."""
    edges = bin_edges_m(bins)
    middles = [(near + far) / 2 for near, far in pairwise(edges)]
    return torch.tensor(middles, device=like.device, dtype=like.dtype)


def min_pool_depth(depth_m: Tensor, scale: int) -> Tensor:
    """Return the minimum non-zero depth of each block of pixels, or 0 if there is none.

    Args:
        depth_m: Depth in metres, float32 [B, H, W].
        scale: Side length of a block in pixels.

    Returns:
        Tensor [B, ceil(H / scale), ceil(W / scale)].
    """
    far = torch.where(depth_m > 0, depth_m, torch.full_like(depth_m, BEYOND_M))
    near = -nn.functional.max_pool2d(-far[:, None], scale, ceil_mode=True)[:, 0]
    return torch.where(near < BEYOND_M, near, torch.zeros_like(near))


class DepthBranch(nn.Module):
    """A branch that predicts the depth bin of each pixel in a feature map.

    Its inputs are the map, the input depth (0 where there is none), and the angular pixel size of
    the camera, which is used to weight its channels.

    Args:
        given: Number of channels of the map.
        inner: Number of internal channels.
        bins: Number of bins from 0 to 10 m.
        scale: Scale of the map.
        norm: Kind of normalization.
    """

    def __init__(self, given: int, inner: int, bins: int, scale: int, norm: Norm):
        super().__init__()
        self.scale = scale
        self.enter = nn.Sequential(conv2d(given + 1, inner, norm), nn.ReLU())
        self.camera = nn.Sequential(nn.Linear(1, inner), nn.ReLU(), nn.Linear(inner, inner))
        self.weigh = nn.Sequential(nn.Linear(inner, inner), nn.ReLU(), nn.Linear(inner, inner))
        self.deepen = nn.Sequential(*(ResidualBlock(inner, norm) for _ in range(RESIDUAL_BLOCKS)))
        self.say = nn.Conv2d(inner, bins, 1)

    def forward(self, values: Tensor, inputs: OccInput) -> Tensor:
        """Return logits [B, bins, h, w] for a map [B, C, h, w]."""
        values = self.enter(torch.cat([values, self.given(values, inputs)], dim=1))
        focal = torch.stack([inputs.intrinsics[:, 0, 0], inputs.intrinsics[:, 1, 1]], dim=-1)
        width = (1000 / focal).square().sum(dim=-1, keepdim=True).sqrt()
        weights = torch.sigmoid(self.weigh(self.camera(width)))
        return self.say(self.deepen(values * weights[:, :, None, None]))

    def given(self, values: Tensor, inputs: OccInput) -> Tensor:
        """Return the input depth as a fraction of 10 m, [B, 1, h, w], or 0 where there is none."""
        if inputs.depth_m is None:
            return torch.zeros_like(values[:, :1])
        return min_pool_depth(inputs.depth_m, self.scale)[:, None].to(values.dtype) / MAX_DEPTH_M


def known_depth(logits: Tensor, inputs: OccInput, scale: int) -> Tensor:
    """Return the input depth of each pixel in a map, else the expected depth, [B, h, w]."""
    shares = torch.softmax(logits.float(), dim=1)
    middles = bin_centers_m(int(logits.shape[1]), shares)
    expected = (shares * middles[:, None, None]).sum(dim=1)
    if inputs.depth_m is None:
        return expected
    given = min_pool_depth(inputs.depth_m, scale)
    return torch.where(given > 0, given, expected)


def weight_by_depth(shares: Tensor, sight: CellProjection, scale: int) -> Tensor:
    """Sample the values of a depth branch at the position of each cell, [B, C, N].

    Values are interpolated between pixels and bins, and are 0 outside them.

    Args:
        shares: Any C values for each bin of each pixel, [B, C, bins, h, w].
        sight: Projection of the cells into the image.
        scale: Scale of the map.
    """
    bins = int(shares.shape[2])
    rows, columns = sight.pixels[..., 1] / scale, sight.pixels[..., 0] / scale
    found = sample_grid(
        shares, torch.stack([bin_coordinate(sight.depth_m, bins), rows, columns], dim=-1)
    )
    return found * sight.inside[:, None]

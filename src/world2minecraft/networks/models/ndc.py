"""A volume of pixels and depths that grows out of a picture (NDC-Scene, ICCV 2023).

Its first axis is depth in bins that grow linearly, its others are the picture's. It begins at 1/32
with an eighth of the bins, taken out of the channels of the coarsest map; each step doubles all
three axes, and lays the picture's map of that scale over the depths at which it belongs.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import torch
from torch import Tensor, nn

from world2minecraft.networks.layers.ddr import AxisBlock, Double
from world2minecraft.networks.layers.depth_bins import along_rays
from world2minecraft.networks.layers.norms import Norm
from world2minecraft.networks.layers.projection import Sight

STEPS = (16, 8, 4)  # The scales after 1/32.


class DepthVolume(nn.Module):
    """From a picture's maps to volumes at 1/32, 1/16, 1/8 and 1/4.

    Args:
        given: channels of the coarsest map.
        beside: channels of the maps at 1/16, 1/8 and 1/4.
        channels: of the volumes at 1/32, 1/16, 1/8 and 1/4.
        bins: of depth at 1/4; an eighth of them at 1/32.
        norm: how layers are normalised.
    """

    def __init__(self, given: int, beside: int, channels: Sequence[int], bins: int, norm: Norm):
        super().__init__()
        self.first = bins // 2 ** len(STEPS)
        self.start = nn.Conv2d(given, channels[0] * self.first, 1)
        self.steps = nn.ModuleList(
            _Step(wide, beside, narrow, norm) for wide, narrow in pairwise(channels)
        )

    def forward(self, coarsest: Tensor, maps: Mapping[int, Tensor]) -> dict[int, Tensor]:
        """Return for each scale a volume [B, C, bins, h, w]."""
        volume = self.start(coarsest).unflatten(1, (-1, self.first))
        found = {32: volume}
        for scale, step in zip(STEPS, self.steps, strict=True):
            volume = step(volume, maps[scale])
            found[scale] = volume
        return found


class VolumeToCells(nn.Module):
    """Reads the volumes of all scales at the cells of the world, and sums them."""

    def __init__(self, channels: Sequence[int], made: int):
        super().__init__()
        scales = (32, *STEPS)
        self.carry = nn.ModuleDict(
            {str(s): nn.Conv1d(given, made, 1) for s, given in zip(scales, channels, strict=True)}
        )

    def forward(
        self, volumes: Mapping[int, Tensor], sight: Sight, shape: tuple[int, int, int]
    ) -> Tensor:
        """Return [B, C, X, Y, Z]; cells out of the picture or beyond the last bin are all alike."""
        found = None
        for scale, volume in volumes.items():
            here = self.carry[str(scale)](along_rays(volume, sight, scale))
            found = here if found is None else found + here
        if found is None:
            raise ValueError("cells are read from one volume or more")
        return found.unflatten(2, shape)


class _Step(nn.Module):
    """Doubles a volume; each pixel then gives its feature to the depths that ask for it."""

    def __init__(self, given: int, beside: int, made: int, norm: Norm):
        super().__init__()
        self.up = Double(given, made, norm)
        self.key, self.value = nn.Conv2d(beside, made, 1), nn.Conv2d(beside, made, 1)
        self.refine = AxisBlock(made, norm)

    def forward(self, volume: Tensor, picture: Tensor) -> Tensor:
        sides = (2 * int(volume.shape[2]), int(picture.shape[2]), int(picture.shape[3]))
        volume = self.up(volume, sides)
        key, value = self.key(picture)[:, :, None], self.value(picture)[:, :, None]
        asks = (volume * key).sum(dim=1, keepdim=True) * volume.shape[1] ** -0.5
        return self.refine(volume + torch.sigmoid(asks) * value)

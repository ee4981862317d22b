"""NDC-Scene (Yao et al., ICCV 2023): a depth volume in camera space that is resampled to cells.

``DepthVolume`` expands the image into a volume of depths and pixels. Its first axis is linearly
increasing depth bins, the others are those of the image. It starts at 1/32 with an eighth of the
bins, computed from the channels of the coarsest map. Each step doubles all three axes and adds the
image features of that scale to the depths where they belong. The cells sample the volumes of four
scales at their camera coordinates. MonoScene's 3D U-Net and context prior follow.

The network is written from the paper alone, with these differences: the encoder is our own or one
from transformers; the depth bins increase linearly up to 10 m; one gate for each pixel assigns
features to depths instead of depth-adaptive attention with several heads; the finest volume is at
1/4 of the image with 128 bins. The published 3D part has 133.5 M parameters, fewer than
MonoScene's; with the same layers, 180 channels are the closest match.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import torch
from torch import Tensor, nn

from world2minecraft.networks.batch import OccInput, OccOutput
from world2minecraft.networks.layers.backbones import NORMS, WIDTHS, make_backbone
from world2minecraft.networks.layers.depth_bins import weight_by_depth
from world2minecraft.networks.layers.normalization import Norm
from world2minecraft.networks.layers.projection import CellProjection, project_cells
from world2minecraft.networks.layers.residual_3d import DDRBlock, Upsample3d
from world2minecraft.networks.layers.unet2d import normalize_image
from world2minecraft.networks.layers.unet3d import UNet3D

STEPS = (16, 8, 4)  # The scales after 1/32.


class DepthVolume(nn.Module):
    """A network that maps image feature maps to volumes at 1/32, 1/16, 1/8 and 1/4.

    Args:
        in_channels: Number of channels of the coarsest map.
        map_channels: Number of channels of the maps at 1/16, 1/8 and 1/4.
        channels: Numbers of channels of the volumes at 1/32, 1/16, 1/8 and 1/4.
        bins: Number of depth bins at 1/4. The volume at 1/32 has an eighth of them.
        norm: Kind of normalization.
    """

    def __init__(
        self, in_channels: int, map_channels: int, channels: Sequence[int], bins: int, norm: Norm
    ):
        super().__init__()
        self.first = bins // 2 ** len(STEPS)
        self.start = nn.Conv2d(in_channels, channels[0] * self.first, 1)
        self.steps = nn.ModuleList(
            _UpsampleStep(wide, map_channels, narrow, norm) for wide, narrow in pairwise(channels)
        )

    def forward(self, coarsest: Tensor, maps: Mapping[int, Tensor]) -> dict[int, Tensor]:
        """Return a volume [B, C, bins, h, w] for each scale."""
        volume = self.start(coarsest).unflatten(1, (-1, self.first))
        found = {32: volume}
        for scale, step in zip(STEPS, self.steps, strict=True):
            volume = step(volume, maps[scale])
            found[scale] = volume
        return found


class VolumeToCells(nn.Module):
    """A layer that samples the volumes of all scales at the positions of cells and sums them."""

    def __init__(self, channels: Sequence[int], out_channels: int):
        super().__init__()
        scales = (32, *STEPS)
        self.carry = nn.ModuleDict(
            {
                str(s): nn.Conv1d(in_channels, out_channels, 1)
                for s, in_channels in zip(scales, channels, strict=True)
            }
        )

    def forward(
        self, volumes: Mapping[int, Tensor], sight: CellProjection, shape: tuple[int, int, int]
    ) -> Tensor:
        """Return cell features [B, C, X, Y, Z], all equal for cells outside the volumes."""
        found = None
        for scale, volume in volumes.items():
            here = self.carry[str(scale)](weight_by_depth(volume, sight, scale))
            found = here if found is None else found + here
        if found is None:
            raise ValueError("volumes must contain at least one volume")
        return found.unflatten(2, shape)


class _UpsampleStep(nn.Module):
    """A step that doubles a volume and adds image features to it with a learned gate."""

    def __init__(self, in_channels: int, map_channels: int, out_channels: int, norm: Norm):
        super().__init__()
        self.up = Upsample3d(in_channels, out_channels, norm)
        self.key, self.value = (
            nn.Conv2d(map_channels, out_channels, 1),
            nn.Conv2d(map_channels, out_channels, 1),
        )
        self.refine = DDRBlock(out_channels, norm)

    def forward(self, volume: Tensor, picture: Tensor) -> Tensor:
        """Double the depth of a volume and add image features weighted by attention."""
        sides = (2 * int(volume.shape[2]), int(picture.shape[2]), int(picture.shape[3]))
        volume = self.up(volume, sides)
        key, value = self.key(picture)[:, :, None], self.value(picture)[:, :, None]
        asks = (volume * key).sum(dim=1, keepdim=True) * volume.shape[1] ** -0.5
        return self.refine(volume + torch.sigmoid(asks) * value)


@dataclass(frozen=True)
class SizeConfig:
    """The hyperparameters of a network size.

    Attributes:
        channels: Number of channels of a cell in the full grid.
        picture: Number of channels of the image feature maps.
        volumes: Numbers of channels of the volumes at 1/32, 1/16, 1/8 and 1/4.
        bins: Number of depth bins at 1/4.
        reaches: Dilations of the 3D blocks.
    """

    channels: int
    picture: int
    volumes: tuple[int, int, int, int]
    bins: int
    reaches: tuple[int, ...] = (1, 2, 3)


SIZE_CONFIGS = {
    "tiny": SizeConfig(16, 12, (12, 12, 8, 8), 16, (2,)),
    "small": SizeConfig(32, 32, (64, 32, 24, 16), 32),
    "full": SizeConfig(180, 200, (256, 128, 96, 64), 128),
}


class NdcScene(nn.Module):
    """The NDC-Scene network, which maps images to depth volumes, cells and classes."""

    def __init__(
        self,
        size: str,
        grid_shape: tuple[int, int, int],
        voxel_m: float,
        backbone: str | None = None,
    ):
        super().__init__()
        chosen, norm = SIZE_CONFIGS[size], NORMS[size]
        self.picture = make_backbone(backbone, size, chosen.picture, STEPS)
        in_channels = WIDTHS[size].taps[4]
        self.volume = DepthVolume(in_channels, chosen.picture, chosen.volumes, chosen.bins, norm)
        self.to_cells = VolumeToCells(chosen.volumes, chosen.channels)
        self.cells = UNet3D(chosen.channels, grid_shape, norm, reaches=chosen.reaches)

    def forward(self, inputs: OccInput) -> OccOutput:
        """Return class logits [B, 12, X, Y, Z] and relation logits."""
        picture = normalize_image(inputs.image)
        taps = self.picture.encoder(picture)
        volumes = self.volume(taps[4], self.picture.decoder(picture, taps))
        cells = self.to_cells(volumes, project_cells(inputs), inputs.grid_shape)
        logits, relations = self.cells(cells)
        return OccOutput(logits, relations=relations)

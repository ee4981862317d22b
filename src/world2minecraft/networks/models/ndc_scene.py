"""NDC-Scene (Yao et al., ICCV 2023): depth is found in the camera's own space, then resampled.

A volume of pixels and depths grows out of the picture (see ``parts.ndc``); cells read it where they
lie in the camera, at four scales; then MonoScene's 3D U-Net and context prior.

What differs from the paper, and written from the paper alone: the encoder is our own or one of
transformers; depth runs in bins that grow linearly to 10 m; pixels give their features to depths by
one gate each, where the paper's depth-adaptive attention has several heads; the finest volume is at
1/4 of the picture with 128 bins. The published 3D part has 133.5 M parameters, fewer than
MonoScene's; 180 channels, with the same layers, come nearest to it.
"""

from dataclasses import dataclass

from torch import nn

from world2minecraft.networks.batch import OccInput, OccOutput
from world2minecraft.networks.layers.backbones import NORMS, WIDTHS, make_backbone
from world2minecraft.networks.layers.projection import sight_of
from world2minecraft.networks.layers.unet2d import normalised
from world2minecraft.networks.layers.unet3d import UNet3D
from world2minecraft.networks.models.ndc import STEPS, DepthVolume, VolumeToCells


@dataclass(frozen=True)
class Choice:
    """What a size decides."""

    channels: int  # of a cell at the full grid
    picture: int  # of the picture's maps
    volumes: tuple[int, int, int, int]  # at 1/32, 1/16, 1/8 and 1/4
    bins: int
    reaches: tuple[int, ...] = (1, 2, 3)  # dilations


CHOICES = {
    "tiny": Choice(16, 12, (12, 12, 8, 8), 16, (2,)),
    "small": Choice(32, 32, (64, 32, 24, 16), 32),
    "full": Choice(180, 200, (256, 128, 96, 64), 128),
}


class NdcScene(nn.Module):
    """Picture to a volume of depths, volume to cells, cells to classes."""

    def __init__(
        self,
        size: str,
        grid_shape: tuple[int, int, int],
        voxel_m: float,
        backbone: str | None = None,
    ):
        super().__init__()
        chosen, norm = CHOICES[size], NORMS[size]
        self.picture = make_backbone(backbone, size, chosen.picture, STEPS)
        given = WIDTHS[size].taps[4]
        self.volume = DepthVolume(given, chosen.picture, chosen.volumes, chosen.bins, norm)
        self.to_cells = VolumeToCells(chosen.volumes, chosen.channels)
        self.cells = UNet3D(chosen.channels, grid_shape, norm, reaches=chosen.reaches)

    def forward(self, inputs: OccInput) -> OccOutput:
        """Return logits [B, 12, X, Y, Z] and those of the relations."""
        picture = normalised(inputs.image)
        taps = self.picture.encoder(picture)
        volumes = self.volume(taps[4], self.picture.decoder(picture, taps))
        cells = self.to_cells(volumes, sight_of(inputs), inputs.grid_shape)
        logits, relations = self.cells(cells)
        return OccOutput(logits, relations=relations)

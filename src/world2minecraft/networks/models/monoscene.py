"""MonoScene (Cao and de Charette, CVPR 2022): features lifted along rays, refined in 3D.

A 2D U-Net gives maps at 1, 1/2, 1/4 and 1/8; each cell takes the sum of what lies at its pixel
(FLoSP); a 3D U-Net with a context prior names the cells.

What differs from the paper: the picture's encoder is our own, or one of transformers, in place of
EfficientNet-B7 (the decoder's widths are the published ones); the kernels of a block run along z,
y, x of a grid with z last, where the published NYU grid has y last; maps are enlarged without
aligning corners. ``small`` and ``tiny`` normalise in groups, as they see few pictures at once.
"""

from dataclasses import dataclass

from torch import nn

from world2minecraft.networks.batch import OccInput, OccOutput
from world2minecraft.networks.layers.backbones import NORMS, make_backbone
from world2minecraft.networks.layers.projection import lift_features, project_cells
from world2minecraft.networks.layers.unet3d import UNet3D

SCALES = (1, 2, 4, 8)


@dataclass(frozen=True)
class SizeConfig:
    """What a size decides."""

    channels: int  # of a cell at the full grid
    reaches: tuple[int, ...] = (1, 2, 3)  # dilations


SIZE_CONFIGS = {"tiny": SizeConfig(16, (2,)), "small": SizeConfig(32), "full": SizeConfig(200)}


class MonoScene(nn.Module):
    """Picture to cells by FLoSP, cells to classes by a 3D U-Net."""

    def __init__(
        self,
        size: str,
        grid_shape: tuple[int, int, int],
        voxel_m: float,
        backbone: str | None = None,
    ):
        super().__init__()
        chosen = SIZE_CONFIGS[size]
        self.picture = make_backbone(backbone, size, chosen.channels, SCALES)
        self.cells = UNet3D(chosen.channels, grid_shape, NORMS[size], reaches=chosen.reaches)

    def forward(self, inputs: OccInput) -> OccOutput:
        """Return logits [B, 12, X, Y, Z] and those of the relations."""
        features = self.picture(inputs.image)
        logits, relations = self.cells(
            lift_features(features, project_cells(inputs), inputs.grid_shape)
        )
        return OccOutput(logits, relations=relations)

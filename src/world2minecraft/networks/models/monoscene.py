"""MonoScene (Cao and de Charette, CVPR 2022): image features lifted along rays and refined in 3D.

A 2D U-Net computes feature maps at 1, 1/2, 1/4 and 1/8. Each cell receives the sum of the features
at its pixel (FLoSP). A 3D U-Net with a context prior predicts the classes of the cells.

Differences from the paper: the image encoder is our own or one from transformers instead of
EfficientNet-B7 (the decoder has the published width); the kernels of a block are applied along z, y
and x of a grid with z last, while the published NYU grid has y last; maps are upsampled without
aligning corners. ``small`` and ``tiny`` use group normalization, because their batches contain few
images.
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
    """The hyperparameters of a network size.

    Attributes:
        channels: Number of channels of a cell in the full grid.
        reaches: Dilations of the 3D blocks.
    """

    channels: int
    reaches: tuple[int, ...] = (1, 2, 3)


SIZE_CONFIGS = {"tiny": SizeConfig(16, (2,)), "small": SizeConfig(32), "full": SizeConfig(200)}


class MonoScene(nn.Module):
    """The MonoScene network: features are lifted to cells with FLoSP and refined by a 3D U-Net."""

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
        """Return class logits [B, 12, X, Y, Z] and relation logits."""
        features = self.picture(inputs.image)
        logits, relations = self.cells(
            lift_features(features, project_cells(inputs), inputs.grid_shape)
        )
        return OccOutput(logits, relations=relations)

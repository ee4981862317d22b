"""ISO (Yu et al., ECCV 2024): MonoScene with image features weighted by predicted depth.

A depth branch predicts for each pixel the probability of 64 depth bins. The feature that a cell
receives from its pixel is weighted by the probability of the cell's depth (dual projection).

Differences from the paper: the input of the depth branch is the depth in the input (from a sensor,
stereo or a network, or none) instead of that of a frozen ZoeDepth inside the model, and the branch
works on the map at 1/4. All other parts are as in ``monoscene``.
"""

from dataclasses import dataclass

import torch
from torch import nn

from world2minecraft.networks.batch import OccInput, OccOutput
from world2minecraft.networks.layers.backbones import NORMS, make_backbone
from world2minecraft.networks.layers.depth_bins import DepthBranch, weight_by_depth
from world2minecraft.networks.layers.projection import lift_features, project_cells
from world2minecraft.networks.layers.unet3d import UNet3D

SCALES = (1, 2, 4, 8)
DEPTH_SCALE = 4


@dataclass(frozen=True)
class SizeConfig:
    """The hyperparameters of a network size.

    Attributes:
        channels: Number of channels of a cell in the full grid.
        depth_channels: Number of channels of the depth branch.
        bins: Number of depth bins.
        reaches: Dilations of the 3D blocks.
    """

    channels: int
    depth_channels: int
    bins: int
    reaches: tuple[int, ...] = (1, 2, 3)


SIZE_CONFIGS = {
    "tiny": SizeConfig(16, 12, 32, (2,)),
    "small": SizeConfig(32, 64, 64),
    "full": SizeConfig(200, 256, 64),
}


class Iso(nn.Module):
    """MonoScene with a depth branch that weights the lifted features."""

    def __init__(
        self,
        size: str,
        grid_shape: tuple[int, int, int],
        voxel_m: float,
        backbone: str | None = None,
    ):
        super().__init__()
        chosen, norm = SIZE_CONFIGS[size], NORMS[size]
        self.picture = make_backbone(backbone, size, chosen.channels, SCALES)
        self.depth = DepthBranch(
            chosen.channels, chosen.depth_channels, chosen.bins, DEPTH_SCALE, norm
        )
        self.cells = UNet3D(chosen.channels, grid_shape, norm, reaches=chosen.reaches)

    def forward(self, inputs: OccInput) -> OccOutput:
        """Return class logits [B, 12, X, Y, Z], relation logits and depth logits."""
        features, sight = self.picture(inputs.image), project_cells(inputs)
        depth_logits = self.depth(features[DEPTH_SCALE], inputs)
        likely = weight_by_depth(torch.softmax(depth_logits, dim=1)[:, None], sight, DEPTH_SCALE)
        lifted = lift_features(features, sight, inputs.grid_shape)
        gated = lifted * likely.unflatten(2, inputs.grid_shape)
        logits, relations = self.cells(lifted + gated)
        return OccOutput(logits, relations=relations, depth_logits=depth_logits)

"""The embodied network: frame after frame adds to the evidence of a scene, which is then read.

Each frame alone says of the cells before it how sure it is that they are occupied (log-odds), what
they are (votes), and features that words have no name for; a gate says how much each cell is worth
of it. All that is added to what came before, by the gate. A second network reads the sums and
answers: it may complete and correct, but what it says is never written back. So nothing is ever
forgotten, and the same frames give the same scene in any order.

It stands in for EmbodiedOcc (Wu et al., 2024) and differs from it throughout: cells in place of
Gaussians, sums in place of a filter whose gain is 0.5, no scene size that must be known by the
network, no compiled operator. There a Gaussian that was refined once is half frozen, and what the
order of frames was shows in the result. Written from the paper alone.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor, nn

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.networks.batch import OccInput, OccOutput
from world2minecraft.networks.layers.backbones import NORMS, make_backbone
from world2minecraft.networks.layers.ddr import axis_blocks
from world2minecraft.networks.layers.depth_bins import DepthBranch, along_rays
from world2minecraft.networks.layers.norms import conv3d
from world2minecraft.networks.layers.projection import lift, sight_of
from world2minecraft.networks.layers.unet3d import UNet3D
from world2minecraft.networks.models.evidence import SceneEvidence

SCALES = (1, 2, 4, 8)
DEPTH_SCALE = 4
MOST_ODDS = 3.0  # Of one frame, in log-odds.


@dataclass(frozen=True)
class Choice:
    """What a size decides."""

    channels: int  # of a cell while a frame is looked at
    features: int  # that are kept of a cell
    reading: int  # channels of the network that reads the scene
    depth_channels: int
    bins: int
    picture: str  # of ``WIDTHS``
    reaches: tuple[int, ...] = (1, 2, 3)  # dilations
    turns: bool = True  # Scenes are read at any quarter turn in training.


CHOICES = {
    "tiny": Choice(16, 12, 16, 12, 32, "tiny", (2,), False),
    "small": Choice(32, 16, 32, 64, 64, "small"),
    "full": Choice(128, 64, 128, 256, 64, "lean"),
}


class Embodied(nn.Module):
    """Frames to evidence, sums of evidence to classes."""

    def __init__(
        self,
        size: str,
        grid_shape: tuple[int, int, int],
        voxel_m: float,
        backbone: str | None = None,
    ):
        super().__init__()
        chosen, norm = CHOICES[size], NORMS[size]
        self.turns, self.features = chosen.turns, chosen.features
        self.picture = make_backbone(backbone, chosen.picture, chosen.channels, SCALES)
        self.depth = DepthBranch(
            chosen.channels, chosen.depth_channels, chosen.bins, DEPTH_SCALE, norm
        )
        self.look = nn.Sequential(
            conv3d(chosen.channels + 3, chosen.channels, norm),
            nn.ReLU(),
            axis_blocks(chosen.channels, norm, chosen.reaches[:2]),
            nn.Conv3d(chosen.channels, 2 + CLASS_COUNT + chosen.features, 1),
        )
        self.enter = nn.Conv3d(2 + CLASS_COUNT + chosen.features, chosen.reading, 1)
        self.read_cells = UNet3D(
            chosen.reading, grid_shape, norm, reaches=chosen.reaches, context=False
        )

    def forward(self, inputs: OccInput, more: Sequence[OccInput] = ()) -> OccOutput:
        """Return what each frame of a batch says, by itself or with others, and its depth.

        Args:
            inputs: the frames.
            more: further frames of their scenes, each with its camera in the same grids.
        """
        evidence, depth_logits = self.observe(inputs)
        for other in more:
            evidence = evidence + self.observe(other)[0]
        turn = self._turn(evidence.values) if self.training and self.turns else 0
        if not turn:
            return OccOutput(self.read(evidence), depth_logits=depth_logits)
        turned = SceneEvidence(torch.rot90(evidence.values, turn, (2, 3)))
        logits = torch.rot90(self.read(turned), -turn, (2, 3))
        return OccOutput(logits, depth_logits=depth_logits)

    def _turn(self, cells: Tensor) -> int:
        quarters = (0, 1, 2, 3) if cells.shape[2] == cells.shape[3] else (0, 2)
        return quarters[int(torch.randint(len(quarters), ()))]

    def observe(self, inputs: OccInput) -> tuple[SceneEvidence, Tensor]:
        """Return the evidence of each frame alone, in its own grid, and its depth logits."""
        features, sight = self.picture(inputs.image), sight_of(inputs)
        depth_logits = self.depth(features[DEPTH_SCALE], inputs)
        shares = torch.softmax(depth_logits, dim=1)
        before = torch.cumsum(shares, dim=1)
        # Of each cell: how likely its pixel's surface is there, nearer, and farther.
        ways = along_rays(torch.stack([shares, before, 1 - before], dim=1), sight, DEPTH_SCALE)
        lifted = lift(features, sight, inputs.grid_shape)
        said = self.look(torch.cat([lifted, ways.unflatten(2, inputs.grid_shape)], dim=1))
        in_view = sight.inside.unflatten(1, inputs.grid_shape)[:, None]
        gate = torch.sigmoid(said[:, :1]) * in_view
        odds = MOST_ODDS * torch.tanh(said[:, 1:2])
        votes = torch.softmax(said[:, 2 : 2 + CLASS_COUNT], dim=1)
        kept = torch.tanh(said[:, 2 + CLASS_COUNT :])
        told = torch.cat([torch.ones_like(gate), odds, votes, kept], dim=1) * gate
        return SceneEvidence(told), depth_logits

    def read(self, evidence: SceneEvidence) -> Tensor:
        """Return logits [B, 12, X, Y, Z] of a box of cells; see ``stream`` for whole scenes."""
        return self.read_cells(self.enter(evidence.readable()))[0]

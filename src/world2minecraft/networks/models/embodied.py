"""The embodied network, which accumulates evidence for a scene from frames and then reads it.

For the cells in front of the camera, each frame predicts how likely they are occupied (log-odds),
their class (votes), and further features; a gate weights each cell. The gated values are added to
the ``SceneEvidence``. A second network predicts the classes from the sums. It can complete and
correct the scene, but its result is never written back. Therefore nothing is forgotten, and the
result does not depend on the order of the frames.

The network is an alternative to EmbodiedOcc (Wu et al., 2024), written from the paper alone. It
uses cells instead of Gaussians and sums instead of a filter with a gain of 0.5, and requires
neither a fixed scene size nor compiled operators. In EmbodiedOcc, Gaussians that were refined once
change only half as much, so the result depends on the order of the frames.

``SceneStream`` adds a stream of frames to the grid of a scene. The window of a frame is in front of
its camera, rotated by quarter turns and aligned with the cells of the scene, so its evidence is
added without resampling.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import torch
from torch import Tensor, nn

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.networks.batch import OccInput, OccOutput
from world2minecraft.networks.layers.backbones import NORMS, make_backbone
from world2minecraft.networks.layers.depth_bins import DepthBranch, weight_by_depth
from world2minecraft.networks.layers.normalization import conv3d
from world2minecraft.networks.layers.projection import lift_features, project_cells
from world2minecraft.networks.layers.residual_3d import ddr_blocks
from world2minecraft.networks.layers.unet3d import UNet3D

ODDS_AT = 1
VOTES_AT = 2
FEATURES_AT = VOTES_AT + CLASS_COUNT
SCALES = (1, 2, 4, 8)
DEPTH_SCALE = 4
MAX_LOG_ODDS = 3.0  # Of one frame.
BELOW_M = 1.6  # Height of a camera above the bottom of its box, as of a person's eyes.


@dataclass(frozen=True)
class SceneEvidence:
    """Sums of gated evidence: weight, log-odds, votes for 12 classes, and learned features.

    Because only sums are stored, the order of the frames does not matter, and no frame removes the
    evidence of another: weights and votes only increase.

    Attributes:
        values: The sums, float [B, 2 + 12 + K, X, Y, Z].
    """

    values: Tensor

    @property
    def weight(self) -> Tensor:
        """Summed weight of each cell, [B, X, Y, Z]; 0 if no frame has observed it."""
        return self.values[:, 0]

    @property
    def log_odds(self) -> Tensor:
        """Summed log-odds that each cell is occupied, [B, X, Y, Z]."""
        return self.values[:, ODDS_AT]

    @property
    def votes(self) -> Tensor:
        """Summed class votes of each cell, [B, 12, X, Y, Z]."""
        return self.values[:, VOTES_AT:FEATURES_AT]

    def __add__(self, other: "SceneEvidence") -> "SceneEvidence":
        """Return the combined evidence for the same cells."""
        return SceneEvidence(self.values + other.values)

    def readable(self) -> Tensor:
        """Return the evidence as channels with a bounded range, for any number of frames."""
        weight = self.values[:, :1]
        odds = torch.tanh(self.values[:, ODDS_AT:VOTES_AT] / 4)
        means = self.values[:, VOTES_AT:] / (weight + 1e-3)
        return torch.cat([weight / (weight + 1), odds, means], dim=1)


@dataclass(frozen=True)
class SizeConfig:
    """The hyperparameters of a network size.

    Attributes:
        channels: Number of channels of a cell while a frame is processed.
        features: Number of features that are stored for each cell.
        reading: Number of channels of the network that reads the scene.
        depth_channels: Number of channels of the depth branch.
        bins: Number of depth bins.
        picture: Size of the image backbone in ``WIDTHS``.
        reaches: Dilations of the 3D blocks.
        turns: Whether scenes are rotated by random quarter turns in training.
    """

    channels: int
    features: int
    reading: int
    depth_channels: int
    bins: int
    picture: str
    reaches: tuple[int, ...] = (1, 2, 3)
    turns: bool = True


SIZE_CONFIGS = {
    "tiny": SizeConfig(16, 12, 16, 12, 32, "tiny", (2,), False),
    "small": SizeConfig(32, 16, 32, 64, 64, "small"),
    "full": SizeConfig(128, 64, 128, 256, 64, "lean"),
}


class Embodied(nn.Module):
    """The embodied network, which maps frames to evidence and sums of evidence to classes."""

    def __init__(
        self,
        size: str,
        grid_shape: tuple[int, int, int],
        voxel_m: float,
        backbone: str | None = None,
    ):
        super().__init__()
        chosen, norm = SIZE_CONFIGS[size], NORMS[size]
        self.turns, self.features = chosen.turns, chosen.features
        self.picture = make_backbone(backbone, chosen.picture, chosen.channels, SCALES)
        self.depth = DepthBranch(
            chosen.channels, chosen.depth_channels, chosen.bins, DEPTH_SCALE, norm
        )
        self.look = nn.Sequential(
            conv3d(chosen.channels + 3, chosen.channels, norm),
            nn.ReLU(),
            ddr_blocks(chosen.channels, norm, chosen.reaches[:2]),
            nn.Conv3d(chosen.channels, 2 + CLASS_COUNT + chosen.features, 1),
        )
        self.enter = nn.Conv3d(2 + CLASS_COUNT + chosen.features, chosen.reading, 1)
        self.read_cells = UNet3D(
            chosen.reading, grid_shape, norm, reaches=chosen.reaches, context=False
        )

    def forward(self, inputs: OccInput, more: Sequence[OccInput] = ()) -> OccOutput:
        """Predict the grids of a batch from their frames, alone or with further frames.

        Args:
            inputs: Frames that define the grids.
            more: Further frames of the same scenes, with camera poses in the same grids.

        Returns:
            The class logits, and the depth logits of ``inputs``.
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
        """Return the evidence of each frame in its own grid, and its depth logits."""
        features, sight = self.picture(inputs.image), project_cells(inputs)
        depth_logits = self.depth(features[DEPTH_SCALE], inputs)
        shares = torch.softmax(depth_logits, dim=1)
        before = torch.cumsum(shares, dim=1)
        # For each cell, the probability that the surface is there, nearer, and farther.
        ways = weight_by_depth(torch.stack([shares, before, 1 - before], dim=1), sight, DEPTH_SCALE)
        lifted = lift_features(features, sight, inputs.grid_shape)
        predicted = self.look(torch.cat([lifted, ways.unflatten(2, inputs.grid_shape)], dim=1))
        in_view = sight.inside.unflatten(1, inputs.grid_shape)[:, None]
        gate = torch.sigmoid(predicted[:, :1]) * in_view
        odds = MAX_LOG_ODDS * torch.tanh(predicted[:, 1:2])
        votes = torch.softmax(predicted[:, 2 : 2 + CLASS_COUNT], dim=1)
        cell_features = torch.tanh(predicted[:, 2 + CLASS_COUNT :])
        evidence = torch.cat([torch.ones_like(gate), odds, votes, cell_features], dim=1) * gate
        return SceneEvidence(evidence), depth_logits

    def read(self, evidence: SceneEvidence) -> Tensor:
        """Return class logits [B, 12, X, Y, Z] for a box; use ``SceneStream`` for scenes."""
        return self.read_cells(self.enter(evidence.readable()))[0]


@dataclass(frozen=True)
class FrameWindow:
    """The box of cells in front of a camera.

    Attributes:
        quarters: Number of counter-clockwise quarter turns seen from above; 0 faces along the y
            axis of the scene.
        low: Minimum corner of the rotated box in scene cells.
        shape: Shape of the box before rotation: right, forward, up.
    """

    quarters: int
    low: tuple[int, int, int]
    shape: tuple[int, int, int]

    def box_to_scene(self, voxel_m: float) -> Tensor:
        """Return the matrix from box coordinates to scene coordinates in metres [4, 4]."""
        right, ahead, _ = self.shape
        matrix = torch.eye(4, dtype=torch.float64)
        cosine, sine = ((1, 0), (0, 1), (-1, 0), (0, -1))[self.quarters]
        matrix[0, :2] = torch.tensor([cosine, -sine])
        matrix[1, :2] = torch.tensor([sine, cosine])
        moved = ((0, 0), (ahead, 0), (right, ahead), (0, right))[self.quarters]
        for axis in range(3):
            cells = self.low[axis] + (moved[axis] if axis < 2 else 0)
            matrix[axis, 3] = cells * voxel_m
        return matrix


def window_in_front(
    camera_to_scene: Tensor, shape: tuple[int, int, int], voxel_m: float
) -> FrameWindow:
    """Return the box of cells in front of a camera.

    Args:
        camera_to_scene: Camera pose relative to the minimum corner of the scene grid in metres [4,
            4].
        shape: Shape of the box: right, forward, up.
        voxel_m: Cell size in metres.
    """
    ahead_x, ahead_y = (float(value) for value in camera_to_scene[:2, 2])
    quarters = round(math.atan2(-ahead_x, ahead_y) / (math.pi / 2)) % 4
    right, ahead, _ = shape
    x, y, z = (float(value) / voxel_m for value in camera_to_scene[:3, 3])
    low = (
        (x - right / 2, y),
        (x - ahead, y - right / 2),
        (x - right / 2, y - ahead),
        (x, y - right / 2),
    )[quarters]
    floor = round(z - BELOW_M / voxel_m)
    return FrameWindow(quarters, (round(low[0]), round(low[1]), floor), shape)


class SceneStream:
    """A stream of frames that adds their evidence to a scene and predicts its classes.

    Args:
        network: Embodied network, which is put into evaluation mode.
        scene_shape: Shape of the scene in cells [X, Y, Z].
        box_shape: Shape of the box in front of each camera in cells: right, forward, up.
        voxel_m: Cell size in metres.
    """

    def __init__(
        self,
        network: Embodied,
        scene_shape: tuple[int, int, int],
        box_shape: tuple[int, int, int],
        voxel_m: float,
    ):
        self.network = network.eval()
        self.box_shape, self.voxel_m = box_shape, voxel_m
        where = next(network.parameters()).device
        self._values = torch.zeros(1, FEATURES_AT + network.features, *scene_shape, device=where)

    @property
    def evidence(self) -> SceneEvidence:
        """Evidence of all frames added so far."""
        return SceneEvidence(self._values)

    @torch.no_grad()
    def add(
        self,
        image: Tensor,
        intrinsics: Tensor,
        camera_to_scene: Tensor,
        depth_m: Tensor | None = None,
    ) -> None:
        """Add the evidence of a frame.

        Args:
            image: RGB image with values from 0 to 1, float32 [3, H, W].
            intrinsics: Camera matrix [3, 3].
            camera_to_scene: Camera pose relative to the minimum corner of the scene grid in metres
                [4, 4].
            depth_m: Depth in metres, float32 [H, W], 0 for none; or None.
        """
        window = window_in_front(camera_to_scene, self.box_shape, self.voxel_m)
        scene_to_box = torch.linalg.inv(window.box_to_scene(self.voxel_m))
        camera_to_box = (scene_to_box @ camera_to_scene.double().cpu()).float()
        inputs = OccInput(
            image[None],
            intrinsics[None].float(),
            camera_to_box[None],
            self.box_shape,
            self.voxel_m,
            None if depth_m is None else depth_m[None],
        ).to(self._values.device)
        evidence, _ = self.network.observe(inputs)
        self._put(torch.rot90(evidence.values, window.quarters, (2, 3)), window.low)

    @torch.no_grad()
    def logits(self) -> Tensor:
        """Return the class logits of the whole scene, float32 [12, X, Y, Z].

        The scene is read in overlapping boxes of the same shape as those of the frames, for which
        the network was trained. Each box overlaps the next by half, and cells near the centre of a
        box have a larger weight.
        """
        sides = [max(w, b) for w, b in zip(self._values.shape[2:], self.box_shape, strict=True)]
        missing = [side - have for side, have in zip(sides, self._values.shape[2:], strict=True)]
        values = nn.functional.pad(self._values, (0, missing[2], 0, missing[1], 0, missing[0]))
        sums = values.new_zeros(CLASS_COUNT, *sides)
        weights = values.new_zeros(sides)
        near = _nearness(self.box_shape).to(values)
        starts = (
            _window_starts(side, box) for side, box in zip(sides, self.box_shape, strict=True)
        )
        for low in product(*starts):
            box = tuple(slice(a, a + n) for a, n in zip(low, self.box_shape, strict=True))
            here = SceneEvidence(values[(slice(None), slice(None), *box)])
            sums[(slice(None), *box)] += self.network.read(here)[0] * near
            weights[box] += near
        x, y, z = self._values.shape[2:]
        return (sums / weights)[:, :x, :y, :z]

    def _put(self, values: Tensor, low: tuple[int, int, int]) -> None:
        scene, box = [], []
        for start, side, whole in zip(low, values.shape[2:], self._values.shape[2:], strict=True):
            first, last = max(start, 0), max(min(start + side, whole), start, 0)
            scene.append(slice(first, last))
            box.append(slice(first - start, last - start))
        self._values[(slice(None), slice(None), *scene)] += values[(slice(None), slice(None), *box)]


def _window_starts(whole: int, side: int) -> list[int]:
    """Return the starts of boxes along an axis, so that neighbours overlap by at least half.

    >>> _window_starts(30, 30), _window_starts(50, 20)
    ([0], [0, 10, 20, 30])
    """
    return sorted({min(start, whole - side) for start in range(0, whole, max(side // 2, 1))})


def _nearness(shape: tuple[int, int, int]) -> Tensor:
    """Return weights for the cells of a box, from 1 at its centre to almost 0 at its border."""
    along = [1 - (torch.arange(side) + 0.5 - side / 2).abs() / (side / 2 + 0.5) for side in shape]
    return along[0][:, None, None] * along[1][:, None] * along[2]

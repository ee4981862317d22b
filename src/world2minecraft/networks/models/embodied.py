"""The embodied network: frame after frame adds to the evidence of a scene, which is then read.

Each frame alone predicts, for the cells before it, how likely they are occupied (log-odds), what
they are (votes), and further features; a gate weighs each cell. All that is added, by the gate, to
the ``SceneEvidence`` so far. A second network reads the sums and answers: it may complete and
correct, but its answer is never written back. So nothing is ever forgotten, and the same frames
give the same scene in any order.

It stands in for EmbodiedOcc (Wu et al., 2024) and differs from it throughout: cells in place of
Gaussians, sums in place of a filter whose gain is 0.5, no scene size that must be known by the
network, no compiled operator. There a Gaussian that was refined once is half frozen, and the order
of frames shows in the result. Written from the paper alone.

``SceneStream`` adds a stream of frames to one scene's grid. The window of cells of a frame lies
before its camera, turned to it by quarter turns, on the scene's own cells: so nothing is resampled
when its evidence is added.
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
MAX_LOG_ODDS = 3.0  # Of one frame, in log-odds.
BELOW_M = 1.6  # How far under a camera its box begins: the floor under a person's eyes.


@dataclass(frozen=True)
class SceneEvidence:
    """Sums of gated evidence: weight, log-odds, votes of 12 classes, and learned features.

    As only sums are kept, the order of frames does not matter, and no frame takes anything away
    that another has given: weights and votes only grow.
    """

    values: Tensor  # float [B, 2 + 12 + K, X, Y, Z]

    @property
    def weight(self) -> Tensor:
        """The summed weight of each cell, [B, X, Y, Z]; 0 where no frame looked."""
        return self.values[:, 0]

    @property
    def log_odds(self) -> Tensor:
        """How sure it is that each cell is occupied, [B, X, Y, Z]."""
        return self.values[:, ODDS_AT]

    @property
    def votes(self) -> Tensor:
        """The class votes of each cell, [B, 12, X, Y, Z]."""
        return self.values[:, VOTES_AT:FEATURES_AT]

    def __add__(self, other: "SceneEvidence") -> "SceneEvidence":
        """Return what both say together, of the same cells."""
        return SceneEvidence(self.values + other.values)

    def readable(self) -> Tensor:
        """Return channels of bounded size, whatever the number of frames."""
        weight = self.values[:, :1]
        odds = torch.tanh(self.values[:, ODDS_AT:VOTES_AT] / 4)
        means = self.values[:, VOTES_AT:] / (weight + 1e-3)
        return torch.cat([weight / (weight + 1), odds, means], dim=1)


@dataclass(frozen=True)
class SizeConfig:
    """What a size decides."""

    channels: int  # of a cell while a frame is processed
    features: int  # that are kept of a cell
    reading: int  # channels of the network that reads the scene
    depth_channels: int
    bins: int
    picture: str  # of ``WIDTHS``
    reaches: tuple[int, ...] = (1, 2, 3)  # dilations
    turns: bool = True  # Scenes are read at any quarter turn in training.


SIZE_CONFIGS = {
    "tiny": SizeConfig(16, 12, 16, 12, 32, "tiny", (2,), False),
    "small": SizeConfig(32, 16, 32, 64, 64, "small"),
    "full": SizeConfig(128, 64, 128, 256, 64, "lean"),
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
        features, sight = self.picture(inputs.image), project_cells(inputs)
        depth_logits = self.depth(features[DEPTH_SCALE], inputs)
        shares = torch.softmax(depth_logits, dim=1)
        before = torch.cumsum(shares, dim=1)
        # Of each cell: how likely its pixel's surface is there, nearer, and farther.
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
        """Return logits [B, 12, X, Y, Z] of a box of cells; see ``SceneStream`` for scenes."""
        return self.read_cells(self.enter(evidence.readable()))[0]


@dataclass(frozen=True)
class FrameWindow:
    """The box of cells before a camera: quarter turns, and where its lowest cell lies."""

    quarters: int  # counter-clockwise from above; 0 looks along the scene's y
    low: tuple[int, int, int]  # cells of the scene: the corner of the turned box
    shape: tuple[int, int, int]  # in the frame's own order: right, forward, up

    def box_to_scene(self, voxel_m: float) -> Tensor:
        """Return 4x4: metres from the box's own minimum corner to metres of the scene."""
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
    """Return the box before a camera [4, 4], metres from the minimum corner of the scene's grid."""
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
    """Adds frames to the evidence of one scene, and reads it.

    Args:
        network: an embodied network; it is put into evaluation.
        scene_shape: X, Y, Z of the scene.
        box_shape: of the box before each camera: cells to the right, forward and up.
        voxel_m: the cells' side, metres.
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
        """The evidence so far."""
        return SceneEvidence(self._values)

    @torch.no_grad()
    def add(
        self,
        image: Tensor,
        intrinsics: Tensor,
        camera_to_scene: Tensor,
        depth_m: Tensor | None = None,
    ) -> None:
        """Look at a frame.

        Args:
            image: float32 [3, H, W], 0 to 1.
            intrinsics: [3, 3].
            camera_to_scene: [4, 4], metres from the minimum corner of the scene's grid.
            depth_m: float32 [H, W], 0 where there is none.
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
        """Return float32 [12, X, Y, Z] of the whole scene.

        It is read in boxes as large as those of the frames, which is what the network knows, each
        overlapping the next by half; the nearer to a middle, the more it counts.
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
    """Return where boxes begin along an axis, so that each overlaps the next by half or more.

    >>> _window_starts(30, 30), _window_starts(50, 20)
    ([0], [0, 10, 20, 30])
    """
    return sorted({min(start, whole - side) for start in range(0, whole, max(side // 2, 1))})


def _nearness(shape: tuple[int, int, int]) -> Tensor:
    """Return how near each cell of a box is to its middle, 1 to almost 0 at the rim."""
    along = [1 - (torch.arange(side) + 0.5 - side / 2).abs() / (side / 2 + 0.5) for side in shape]
    return along[0][:, None, None] * along[1][:, None] * along[2]

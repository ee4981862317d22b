"""Symphonies (Jiang et al., CVPR 2024): instances carry what they see from the image to cells.

Cells of twice the size that the depth says are surface look at the image first (voxel proposal).
Three layers follow: in each, instances look at the image, cells query them, they look at cells.
Each layer gives an answer of its own in training; the last one is that of the network.

What differs from the paper: the instance queries are learned vectors with learned places in the
image, where the paper takes queries, places and maps of a MaskDINO that was trained on COCO, with
its ResNet-50; maps are at 1/4, 1/8 and 1/16 of our own backbone. Depth that is not given comes
from a depth branch like ISO's. Attention of the grid is of three axes; the published code folds z
into x and uses a kernel of two. Any number of images may be in a batch.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor, nn

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.networks.batch import OccInput, OccOutput
from world2minecraft.networks.layers.attention import (
    DeformableAttention,
    FeedForward,
    MultiHeadAttention,
)
from world2minecraft.networks.layers.backbones import NORMS, make_backbone
from world2minecraft.networks.layers.depth_bins import DepthBranch, known_depth
from world2minecraft.networks.layers.projection import (
    cell_centers_m,
    project_cells,
    transform_points,
)
from world2minecraft.networks.layers.residual_3d import ASPP, Upsample3d

SCALES = (4, 8, 16)
DEPTH_SCALE = 4
LAYERS = 3


@dataclass(frozen=True)
class Stage:
    """Where queries and cells stand, the same for all layers.

    Q instance queries, N cells in C order of a grid [X, Y, Z].
    """

    maps: Sequence[Tensor]  # [B, C, h, w] of each level
    query_pixel: Tensor  # [B, Q, 2]: row, column as shares
    query_cell: Tensor  # [B, Q, 3]
    query_mark: Tensor  # [1, Q, C], distinguishes one query from another
    cell_place: Tensor  # [B, N, 3]
    cell_mark: Tensor  # [1, N, C], distinguishes one cell from another
    in_view: Tensor  # bool [B, N]
    shape: tuple[int, int, int]


class SymphonyLayer(nn.Module):
    """Five attentions in turn; the last layer's instances need not look again.

    Args:
        channels: of queries and cells.
        heads: of each attention.
        levels: of the picture's maps.
        points: places per head and map; twice as many in the grid.
        again: whether instances look at the cells and at each other in the end.
    """

    def __init__(self, channels: int, heads: int, levels: int, points: int, *, again: bool):
        super().__init__()
        self.look = DeformableAttention(channels, heads, levels, points, 2)
        self.ask = MultiHeadAttention(channels, heads)
        self.spread = DeformableAttention(channels, heads, 1, 2 * points, 3)
        self.after = nn.ModuleList(FeedForward(channels, widening) for widening in (2, 4, 4))
        self.again = again
        if again:
            self.read = DeformableAttention(channels, heads, 1, 2 * points, 3)
            self.agree = MultiHeadAttention(channels, heads)
            self.after_again = nn.ModuleList(FeedForward(channels, 2) for _ in range(2))

    def forward(self, cells: Tensor, queries: Tensor, stage: Stage) -> tuple[Tensor, Tensor]:
        """Return cells [B, N, C] and queries [B, Q, C]; cells out of view stay as they are."""
        marked = queries + stage.query_mark
        queries = self.after[0](queries, self.look(marked, stage.query_pixel, stage.maps))
        marked = queries + stage.query_mark
        found = self.ask(cells + stage.cell_mark, marked, queries)
        updated = self.after[1](cells, found)
        grid = to_grid(torch.where(stage.in_view[..., None], updated, cells), stage.shape)
        found = self.spread(updated + stage.cell_mark, stage.cell_place, [grid])
        cells = torch.where(stage.in_view[..., None], self.after[2](updated, found), cells)
        if not self.again:
            return cells, queries
        found = self.read(marked, stage.query_cell, [to_grid(cells, stage.shape)])
        queries = self.after_again[0](queries, found)
        marked = queries + stage.query_mark
        return cells, self.after_again[1](queries, self.agree(marked, marked, queries))


def to_grid(cells: Tensor, shape: tuple[int, int, int]) -> Tensor:
    """Return [B, C, X, Y, Z] of cells [B, N, C]."""
    return cells.transpose(1, 2).unflatten(2, shape)


@dataclass(frozen=True)
class SizeConfig:
    """What a size decides."""

    channels: int
    heads: int
    queries: int
    points: int
    depth_channels: int
    bins: int
    picture: str  # of ``WIDTHS``


SIZE_CONFIGS = {
    "tiny": SizeConfig(24, 2, 16, 2, 12, 32, "tiny"),
    "small": SizeConfig(64, 4, 64, 4, 64, 64, "small"),
    "full": SizeConfig(128, 8, 300, 4, 256, 64, "lean"),
}


class Symphonies(nn.Module):
    """Instance queries between a picture and cells."""

    def __init__(
        self,
        size: str,
        grid_shape: tuple[int, int, int],
        voxel_m: float,
        backbone: str | None = None,
    ):
        super().__init__()
        chosen, norm = SIZE_CONFIGS[size], NORMS[size]
        channels = chosen.channels
        self.shape = (-(-grid_shape[0] // 2), -(-grid_shape[1] // 2), -(-grid_shape[2] // 2))
        self.picture = make_backbone(backbone, chosen.picture, channels, SCALES)
        self.depth = DepthBranch(channels, chosen.depth_channels, chosen.bins, DEPTH_SCALE, norm)
        cells = self.shape[0] * self.shape[1] * self.shape[2]
        self.cell_start = nn.Parameter(torch.randn(cells, channels))
        self.cell_marks = nn.ParameterList(torch.randn(side, channels) for side in self.shape)
        self.query_start = nn.Parameter(torch.randn(chosen.queries, channels))
        self.query_marks = nn.Parameter(torch.randn(chosen.queries, channels))
        self.query_places = nn.Parameter(torch.randn(chosen.queries, 2))  # Before a sigmoid.
        levels = len(SCALES)
        self.propose = DeformableAttention(channels, chosen.heads, levels, chosen.points, 2)
        self.proposed = FeedForward(channels)
        self.layers = nn.ModuleList(
            SymphonyLayer(channels, chosen.heads, levels, chosen.points, again=n < LAYERS - 1)
            for n in range(LAYERS)
        )
        self.reaches = ASPP(channels, norm, (1, 2))
        self.up = Upsample3d(channels, channels, norm)
        self.classes = nn.Conv3d(channels, CLASS_COUNT, 1)

    def forward(self, inputs: OccInput) -> OccOutput:
        """Return logits [B, 12, X, Y, Z], those of depth, and in training those of the layers."""
        maps = self.picture(inputs.image)
        depth_logits = self.depth(maps[DEPTH_SCALE], inputs)
        depth_m = known_depth(depth_logits, inputs, DEPTH_SCALE).detach()
        halved = OccInput(
            inputs.image, inputs.intrinsics, inputs.camera_to_grid, self.shape, 2 * inputs.voxel_m
        )
        sight = project_cells(halved)
        stage = self._stage(halved, list(maps.values()), depth_m, sight.inside)
        pixel = (sight.pixels / torch.tensor(sight.size_px[::-1]).to(sight.pixels)).flip(-1)
        cells = self._proposed(stage, pixel.clamp(-1, 2), self._hit(halved, depth_m))
        queries = self.query_start.expand(len(inputs.image), -1, -1)
        answers = []
        for number, layer in enumerate(self.layers):
            cells, queries = layer(cells, queries, stage)
            last = number == len(self.layers) - 1
            if self.training or last:
                answers.append(self._answer(to_grid(cells, self.shape), inputs.grid_shape, last))
        return OccOutput(answers[-1], tuple(answers[:-1]), depth_logits=depth_logits)

    def _answer(self, grid: Tensor, shape: tuple[int, int, int], last: bool) -> Tensor:
        return self.classes(self.up(self.reaches(grid) if last else grid, shape))

    def _stage(
        self, inputs: OccInput, maps: list[Tensor], depth_m: Tensor, in_view: Tensor
    ) -> Stage:
        batch = len(inputs.image)
        x, y, z = self.cell_marks
        marks = (x[:, None, None] + y[:, None] + z).flatten(0, 2)
        pixel = torch.sigmoid(self.query_places).expand(batch, -1, -1)
        sides_m = [side * inputs.voxel_m for side in self.shape]
        size_m = torch.tensor(sides_m, device=depth_m.device, dtype=depth_m.dtype)
        centers = cell_centers_m(self.shape, inputs.voxel_m, inputs.camera_to_grid) / size_m
        return Stage(
            maps,
            pixel,
            (_points_m(inputs, depth_m, pixel.detach()) / size_m).clamp(0, 1),
            self.query_marks[None],
            centers.expand(batch, -1, -1),
            marks[None],
            in_view,
            self.shape,
        )

    def _proposed(self, stage: Stage, pixel: Tensor, hit: Tensor) -> Tensor:
        cells = self.cell_start.expand(len(pixel), -1, -1)
        found = self.propose(cells + stage.cell_mark, pixel, stage.maps)
        return torch.where(hit[..., None], self.proposed(cells, found), cells)

    def _hit(self, inputs: OccInput, depth_m: Tensor) -> Tensor:
        """Return bool [B, N]: the cells that hold the point of a pixel of the depth map."""
        height, width = int(depth_m.shape[1]), int(depth_m.shape[2])
        rows, columns = torch.meshgrid(
            torch.arange(height, device=depth_m.device), torch.arange(width, device=depth_m.device),
            indexing="ij",
        )  # fmt: skip
        middles = torch.stack([rows.flatten(), columns.flatten()], dim=-1) + 0.5
        sides = torch.tensor([height, width], device=depth_m.device)
        pixel = (middles / sides).to(depth_m.dtype).expand(len(depth_m), -1, -1)
        cell = torch.floor(_points_m(inputs, depth_m, pixel) / inputs.voxel_m).long()
        shape = torch.tensor(self.shape, device=cell.device)
        inside = ((cell >= 0) & (cell < shape)).all(dim=-1)
        number = (cell[..., 0] * shape[1] + cell[..., 1]) * shape[2] + cell[..., 2]
        count = self.shape[0] * self.shape[1] * self.shape[2]
        number = torch.where(inside, number, torch.full_like(number, count))
        marked = torch.zeros(len(depth_m), count + 1, device=cell.device)
        return marked.scatter(1, number, 1.0)[:, :-1] > 0


def _points_m(inputs: OccInput, depth_m: Tensor, pixel: Tensor) -> Tensor:
    """Return the points that places of the picture show, in metres from the grid's corner.

    Args:
        inputs: the cameras.
        depth_m: [B, h, w].
        pixel: [B, Q, 2], row and column as shares of the picture.

    Returns:
        [B, Q, 3].
    """
    height, width = int(depth_m.shape[1]), int(depth_m.shape[2])
    row = (pixel[..., 0] * height).floor().clamp(0, height - 1).long()
    column = (pixel[..., 1] * width).floor().clamp(0, width - 1).long()
    depth = depth_m.flatten(1).gather(1, row * width + column)
    lens = inputs.intrinsics
    across = (pixel[..., 1] * inputs.image.shape[-1] - lens[:, None, 0, 2]) / lens[:, None, 0, 0]
    down = (pixel[..., 0] * inputs.image.shape[-2] - lens[:, None, 1, 2]) / lens[:, None, 1, 1]
    in_camera = torch.stack([across, down, torch.ones_like(down)], dim=-1) * depth[..., None]
    turn, place = inputs.camera_to_grid[:, :3, :3], inputs.camera_to_grid[:, :3, 3]
    return transform_points(in_camera, turn) + place[:, None]

"""Symphonies (Jiang et al., CVPR 2024): instance queries that connect image features and cells.

Cells of twice the size that contain a surface according to the depth first attend to the image
(voxel proposal). In each of the three following layers, instances attend to the image, cells attend
to instances, and instances attend to cells. In training, each layer has its own output; the output
of the last layer is that of the network.

Differences from the paper: the instance queries are learned vectors with learned image positions,
instead of the queries, positions and maps of a MaskDINO with ResNet-50 that was trained on COCO;
the maps are those of our own backbone at 1/4, 1/8 and 1/16. If there is no input depth, it is
predicted by a depth branch as in ISO. Attention on the grid uses three axes, while the published
code folds z into x and uses a two-dimensional kernel. A batch can contain any number of images.
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
    """The positions and embeddings of queries and cells, which are the same for all layers.

    There are Q instance queries and N cells of a grid [X, Y, Z] in C order.

    Attributes:
        maps: Feature map of each level, [B, C, h, w].
        query_pixel: Image positions of the queries as fractions (row, column), [B, Q, 2].
        query_cell: Grid positions of the queries as fractions, [B, Q, 3].
        query_mark: Embeddings of the queries, [1, Q, C].
        cell_place: Grid positions of the cells as fractions, [B, N, 3].
        cell_mark: Embeddings of the cells, [1, N, C].
        in_view: Whether each cell is inside the image, bool [B, N].
        shape: Shape of the grid.
    """

    maps: Sequence[Tensor]
    query_pixel: Tensor
    query_cell: Tensor
    query_mark: Tensor
    cell_place: Tensor
    cell_mark: Tensor
    in_view: Tensor
    shape: tuple[int, int, int]


class SymphonyLayer(nn.Module):
    """A Symphonies layer with five attention blocks, of which the last layer omits two.

    Args:
        channels: Number of channels of queries and cells.
        heads: Number of attention heads.
        levels: Number of image feature maps.
        points: Number of sampling positions per head and map. The grid has twice as many.
        again: Whether instances finally attend to the cells and to each other.
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
        """Return updated cells [B, N, C] and queries [B, Q, C].

        Cells outside the image are not changed.
        """
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
    """Reshape cells [B, N, C] to a grid [B, C, X, Y, Z]."""
    return cells.transpose(1, 2).unflatten(2, shape)


@dataclass(frozen=True)
class SizeConfig:
    """The hyperparameters of a network size.

    Attributes:
        channels: Number of channels of queries and cells.
        heads: Number of attention heads.
        queries: Number of instance queries.
        points: Number of sampling positions per head and map.
        depth_channels: Number of channels of the depth branch.
        bins: Number of depth bins.
        picture: Size of the image backbone in ``WIDTHS``.
    """

    channels: int
    heads: int
    queries: int
    points: int
    depth_channels: int
    bins: int
    picture: str


SIZE_CONFIGS = {
    "tiny": SizeConfig(24, 2, 16, 2, 12, 32, "tiny"),
    "small": SizeConfig(64, 4, 64, 4, 64, 64, "small"),
    "full": SizeConfig(128, 8, 300, 4, 256, 64, "lean"),
}


class Symphonies(nn.Module):
    """The Symphonies network, with instance queries between the image and the cells."""

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
        """Return class logits [B, 12, X, Y, Z] and depth logits.

        In training, the logits of the earlier layers are returned too.
        """
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
        """Return whether each cell contains the point of a pixel in the depth map, bool [B, N]."""
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
    """Return the points at image positions in metres relative to the corner of the grid, [B, Q, 3].

    Args:
        inputs: Inputs with the cameras.
        depth_m: Depth in metres, [B, h, w].
        pixel: Image positions as fractions (row, column), [B, Q, 2].
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

"""One layer of Symphonies: instances look at the picture, cells ask them, they look at cells."""

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor, nn

from world2minecraft.networks.layers.attention import (
    AfterAttention,
    Attention,
    DeformableAttention,
)


@dataclass(frozen=True)
class Stage:
    """Where queries and cells stand, the same for all layers.

    Q instance queries, N cells in C order of a grid [X, Y, Z].
    """

    maps: Sequence[Tensor]  # [B, C, h, w] of each level
    query_pixel: Tensor  # [B, Q, 2]: row, column as shares
    query_cell: Tensor  # [B, Q, 3]
    query_mark: Tensor  # [1, Q, C], what tells one query from another
    cell_place: Tensor  # [B, N, 3]
    cell_mark: Tensor  # [1, N, C], what tells one cell from another
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
        self.ask = Attention(channels, heads)
        self.spread = DeformableAttention(channels, heads, 1, 2 * points, 3)
        self.after = nn.ModuleList(AfterAttention(channels, widening) for widening in (2, 4, 4))
        self.again = again
        if again:
            self.read = DeformableAttention(channels, heads, 1, 2 * points, 3)
            self.agree = Attention(channels, heads)
            self.after_again = nn.ModuleList(AfterAttention(channels, 2) for _ in range(2))

    def forward(self, cells: Tensor, queries: Tensor, stage: Stage) -> tuple[Tensor, Tensor]:
        """Return cells [B, N, C] and queries [B, Q, C]; cells out of view stay as they are."""
        marked = queries + stage.query_mark
        queries = self.after[0](queries, self.look(marked, stage.query_pixel, stage.maps))
        marked = queries + stage.query_mark
        found = self.ask(cells + stage.cell_mark, marked, queries)
        told = self.after[1](cells, found)
        grid = as_grid(torch.where(stage.in_view[..., None], told, cells), stage.shape)
        found = self.spread(told + stage.cell_mark, stage.cell_place, [grid])
        cells = torch.where(stage.in_view[..., None], self.after[2](told, found), cells)
        if not self.again:
            return cells, queries
        found = self.read(marked, stage.query_cell, [as_grid(cells, stage.shape)])
        queries = self.after_again[0](queries, found)
        marked = queries + stage.query_mark
        return cells, self.after_again[1](queries, self.agree(marked, marked, queries))


def as_grid(cells: Tensor, shape: tuple[int, int, int]) -> Tensor:
    """Return [B, C, X, Y, Z] of cells [B, N, C]."""
    return cells.transpose(1, 2).unflatten(2, shape)

"""Multi-head attention, and deformable attention on maps and volumes.

Works on maps and volumes alike, by ``sample_grid``, so that no compiled operator is needed. Places
are shares of each axis, 0 to 1, in the order of the axes.
"""

from collections.abc import Sequence

import torch
from torch import Tensor, nn

from world2minecraft.networks.layers.projection import sample_grid


class DeformableAttention(nn.Module):
    """Queries gather values at places of their own choice around a reference.

    Args:
        channels: of queries and values.
        heads: each with its own places; they share the channels out.
        levels: how many maps or volumes there are.
        points: how many places each head picks in each of them.
        axes: 2 for maps, 3 for volumes.
    """

    def __init__(self, channels: int, heads: int, levels: int, points: int, axes: int):
        super().__init__()
        self.heads, self.levels, self.points, self.axes = heads, levels, points, axes
        self.value = nn.Linear(channels, channels)
        self.shift = nn.Linear(channels, heads * levels * points * axes)
        self.weigh = nn.Linear(channels, heads * levels * points)
        self.out = nn.Linear(channels, channels)
        nn.init.zeros_(self.shift.weight)
        nn.init.normal_(self.shift.bias, std=1.0)  # Cells: heads begin by looking elsewhere each.

    def forward(self, queries: Tensor, places: Tensor, values: Sequence[Tensor]) -> Tensor:
        """Return [B, Q, C] for queries [B, Q, C] with places [B, Q, axes] in maps [B, C, ...]."""
        batch, count = int(queries.shape[0]), int(queries.shape[1])
        shape = (batch, count, self.heads, self.levels, self.points)
        weights = self.weigh(queries).view(*shape[:3], -1).softmax(dim=-1).view(shape)
        shifts = self.shift(queries).view(*shape, self.axes)
        found = None
        for level, value in enumerate(values):
            here = self._gathered(value, places, shifts[:, :, :, level], weights[:, :, :, level])
            found = here if found is None else found + here
        if found is None:
            raise ValueError("attention needs one map or more")
        return self.out(found)

    def _gathered(self, value: Tensor, places: Tensor, shifts: Tensor, weights: Tensor) -> Tensor:
        """Return [B, Q, C] of one level; shifts [B, Q, heads, points, axes] are in its cells."""
        batch, count = int(places.shape[0]), int(places.shape[1])
        sides = torch.tensor(value.shape[2:], device=value.device, dtype=places.dtype)
        carried = self.value(value.flatten(2).transpose(1, 2)).transpose(1, 2)
        carried = carried.reshape(batch * self.heads, -1, *value.shape[2:])
        at = (places * sides)[:, :, None, None] + shifts
        at = at.transpose(1, 2).reshape(batch * self.heads, count * self.points, self.axes)
        found = sample_grid(carried, at).unflatten(2, (count, self.points))
        weights = weights.transpose(1, 2).reshape(batch * self.heads, 1, count, self.points)
        found = (found * weights).sum(dim=-1)  # [B heads, C / heads, Q]
        return found.unflatten(0, (batch, self.heads)).flatten(1, 2).transpose(1, 2)


class MultiHeadAttention(nn.Module):
    """Plain attention of several heads over what is not in space."""

    def __init__(self, channels: int, heads: int):
        super().__init__()
        self.heads = heads
        self.query, self.key = (
            nn.Linear(channels, channels),
            nn.Linear(channels, channels, bias=False),
        )
        self.value, self.out = nn.Linear(channels, channels), nn.Linear(channels, channels)

    def forward(self, queries: Tensor, keys: Tensor, values: Tensor) -> Tensor:
        """Return [B, Q, C] for queries [B, Q, C], keys and values [B, K, C]."""
        query, key, value = (
            layer(given).unflatten(2, (self.heads, -1)).transpose(1, 2)
            for layer, given in ((self.query, queries), (self.key, keys), (self.value, values))
        )
        scores = query @ key.transpose(2, 3) * query.shape[-1] ** -0.5
        return self.out((scores.softmax(dim=-1) @ value).transpose(1, 2).flatten(2))


class FeedForward(nn.Module):
    """What follows each attention: added, normalised, and two layers of each query by itself."""

    def __init__(self, channels: int, widening: int = 4):
        super().__init__()
        self.first, self.second = nn.LayerNorm(channels), nn.LayerNorm(channels)
        self.path = nn.Sequential(
            nn.Linear(channels, widening * channels),
            nn.GELU(),
            nn.Linear(widening * channels, channels),
        )

    def forward(self, queries: Tensor, found: Tensor) -> Tensor:
        """Return [B, Q, C] of queries and what their attention found."""
        queries = self.first(queries + found)
        return self.second(queries + self.path(queries))

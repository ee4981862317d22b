"""Multi-head attention, and deformable attention on maps and volumes.

Values are sampled with ``sample_grid``, so no compiled operator is required. Positions are given as
fractions of each axis from 0 to 1, in axis order.
"""

from collections.abc import Sequence

import torch
from torch import Tensor, nn

from world2minecraft.networks.layers.projection import sample_grid


class DeformableAttention(nn.Module):
    """Attention in which each query samples values at learned positions around a reference.

    Args:
        channels: Number of channels of queries and values.
        heads: Number of heads, which share the channels and have their own sampling positions.
        levels: Number of maps or volumes.
        points: Number of sampling positions of each head in each level.
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
        nn.init.normal_(self.shift.bias, std=1.0)  # In cells, so that heads sample different ones.

    def forward(self, queries: Tensor, places: Tensor, values: Sequence[Tensor]) -> Tensor:
        """Attend to maps or volumes.

        Args:
            queries: Queries [B, Q, C].
            places: Reference positions of the queries [B, Q, axes], from 0 to 1.
            values: Maps or volumes [B, C, ...], one for each level.

        Returns:
            Tensor [B, Q, C].
        """
        batch, count = int(queries.shape[0]), int(queries.shape[1])
        shape = (batch, count, self.heads, self.levels, self.points)
        weights = self.weigh(queries).view(*shape[:3], -1).softmax(dim=-1).view(shape)
        shifts = self.shift(queries).view(*shape, self.axes)
        found = None
        for level, value in enumerate(values):
            here = self._gathered(value, places, shifts[:, :, :, level], weights[:, :, :, level])
            found = here if found is None else found + here
        if found is None:
            raise ValueError("attention needs at least one map")
        return self.out(found)

    def _gathered(self, value: Tensor, places: Tensor, shifts: Tensor, weights: Tensor) -> Tensor:
        """Return the sampled values of a level, [B, Q, C], for shifts in cells."""
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
    """Standard multi-head attention without positions."""

    def __init__(self, channels: int, heads: int):
        super().__init__()
        self.heads = heads
        self.query, self.key = (
            nn.Linear(channels, channels),
            nn.Linear(channels, channels, bias=False),
        )
        self.value, self.out = nn.Linear(channels, channels), nn.Linear(channels, channels)

    def forward(self, queries: Tensor, keys: Tensor, values: Tensor) -> Tensor:
        """Return [B, Q, C] for queries [B, Q, C], keys [B, K, C] and values [B, K, C]."""
        query, key, value = (
            layer(given).unflatten(2, (self.heads, -1)).transpose(1, 2)
            for layer, given in ((self.query, queries), (self.key, keys), (self.value, values))
        )
        scores = query @ key.transpose(2, 3) * query.shape[-1] ** -0.5
        return self.out((scores.softmax(dim=-1) @ value).transpose(1, 2).flatten(2))


class FeedForward(nn.Module):
    """The part of a transformer layer after attention: residual, norms and a two-layer MLP."""

    def __init__(self, channels: int, widening: int = 4):
        super().__init__()
        self.first, self.second = nn.LayerNorm(channels), nn.LayerNorm(channels)
        self.path = nn.Sequential(
            nn.Linear(channels, widening * channels),
            nn.GELU(),
            nn.Linear(widening * channels, channels),
        )

    def forward(self, queries: Tensor, found: Tensor) -> Tensor:
        """Return [B, Q, C] for queries and the result of their attention, both [B, Q, C]."""
        queries = self.first(queries + found)
        return self.second(queries + self.path(queries))

"""What an embodied network knows of a scene: sums over frames, cell by cell."""

from dataclasses import dataclass

import torch
from torch import Tensor

from world2minecraft.core.classes import CLASS_COUNT

ODDS_AT = 1
VOTES_AT = 2
FEATURES_AT = VOTES_AT + CLASS_COUNT


@dataclass(frozen=True)
class SceneEvidence:
    """Sums of gated evidence: weight, log-odds, votes of 12 classes, and learned features.

    As only sums are kept, the order of frames does not matter, and no frame takes anything away
    that another has given: weights and votes only grow.
    """

    values: Tensor  # float [B, 2 + 12 + K, X, Y, Z]

    @property
    def weight(self) -> Tensor:
        """How much was said of each cell, [B, X, Y, Z]; 0 where nobody looked."""
        return self.values[:, 0]

    @property
    def log_odds(self) -> Tensor:
        """How sure it is that each cell is occupied, [B, X, Y, Z]."""
        return self.values[:, ODDS_AT]

    @property
    def votes(self) -> Tensor:
        """What each cell was said to be, [B, 12, X, Y, Z]."""
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

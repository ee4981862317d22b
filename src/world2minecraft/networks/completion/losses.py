"""What the completion network is punished for: wrong classes, poor overlap, wrong geometry."""

import torch
from torch import Tensor
from torch.nn import functional

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN

# About the fourth root of how rare a class is in the samples; empty cells are the most by far.
CLASS_WEIGHTS = (0.6, 0.9, 0.8, 0.7, 1.8, 1.9, 1.2, 1.4, 1.6, 2.6, 0.9, 1.3)
SEEN_WEIGHT = 2.0  # Observed surface is named in every room; what lies behind is a guess.
ASKED = 0.5  # The share of cells that is drawn: neighbours say the same, and it halves the time.
JACCARD, GEOMETRY = 1.0, 0.5


def completion_loss(logits: Tensor, truth: Tensor, surface: Tensor) -> dict[str, Tensor]:
    """Return the losses by name; their sum is what is trained.

    Args:
        logits: float [B, 12, X, Y, Z].
        truth: int64 [B, X, Y, Z], 0 to 11 or 255, which counts for nothing.
        surface: bool [B, X, Y, Z], the observed occupied cells.
    """
    chosen = (truth != UNKNOWN) & (torch.rand(truth.shape, device=truth.device) < ASKED)
    flat = logits.permute(0, 2, 3, 4, 1)[chosen].float()
    wanted, seen = truth[chosen], surface[chosen]
    weights = torch.tensor(CLASS_WEIGHTS, device=flat.device)[wanted]
    weights = weights * torch.where(seen & (wanted > 0), SEEN_WEIGHT, 1.0)
    logs = flat.log_softmax(dim=1)
    entropy = -logs.gather(1, wanted[:, None])[:, 0]
    share = logs.exp()
    one_hot = functional.one_hot(wanted, CLASS_COUNT).to(share.dtype)
    return {
        "entropy": (entropy * weights).sum() / weights.sum(),
        "jaccard": JACCARD * _jaccard(share[:, 1:], one_hot[:, 1:]),
        "geometry": GEOMETRY * _jaccard(1 - share[:, :1], 1 - one_hot[:, :1]),
    }


def _jaccard(share: Tensor, wanted: Tensor) -> Tensor:
    """Return one minus the mean soft IoU of the classes that are wanted somewhere."""
    both = (share * wanted).sum(dim=0)
    either = share.sum(dim=0) + wanted.sum(dim=0) - both
    there = wanted.sum(dim=0) > 0
    return 1 - (both / either.clamp(min=1e-6))[there].mean()

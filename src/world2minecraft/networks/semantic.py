"""Losses of the classes of cells: cross entropy, and MonoScene's scene-class affinity (SCAL).

Cells of 255 count in none. Where nothing is left to count, a loss is 0 and its gradients are 0.
"""

import torch
from torch import Tensor

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN

LEAST = 1e-6  # Of a share whose logarithm is taken: a loss of 13.8 at most.


def cross_entropy(logits: Tensor, labels: Tensor, class_weights: Tensor | None = None) -> Tensor:
    """Return the mean over known cells, weighted by their classes.

    Args:
        logits: float [B, 12, X, Y, Z].
        labels: int64 [B, X, Y, Z], 0 to 11 or 255.
        class_weights: float32 [12]; all 1 where left out.
    """
    known = labels != UNKNOWN
    told = torch.where(known, labels, torch.zeros_like(labels))
    each = torch.nn.functional.cross_entropy(logits.float(), told, reduction="none")
    weights = known.float()
    if class_weights is not None:
        weights = weights * class_weights.to(logits.device, torch.float32)[told]
    return (each * weights).sum() / weights.sum().clamp(min=1e-6)


def semantic_affinity(logits: Tensor, labels: Tensor) -> Tensor:
    """Return MonoScene's L_scal over classes: soft precision, recall and specificity of each.

    The mean is over the classes that the batch holds, the empty one among them.
    """
    known = labels != UNKNOWN
    shares = torch.softmax(logits.float(), dim=1).movedim(1, 0)[:, known]  # [12, N]
    truth = (labels[known] == torch.arange(CLASS_COUNT, device=labels.device)[:, None]).float()
    present = (truth.sum(dim=1) > 0).float()
    return (_affinity(shares, truth) * present).sum() / present.sum().clamp(min=1)


def geometric_affinity(logits: Tensor, labels: Tensor) -> Tensor:
    """Return the same of two classes, where only the occupied one is judged: L_scal of geometry."""
    known = labels != UNKNOWN
    full = 1 - torch.softmax(logits.float(), dim=1)[:, 0]
    return _affinity(full[known][None], (labels[known] != 0).float()[None])[0]


def _affinity(shares: Tensor, truth: Tensor) -> Tensor:
    """Return [K] minus log precision, recall and specificity; what has nothing to count is 0."""
    met = (shares * truth).sum(dim=1)
    absent = 1 - truth
    precision = _less_log(met, shares.sum(dim=1), truth.sum(dim=1))
    recall = _less_log(met, truth.sum(dim=1), truth.sum(dim=1))
    specificity = _less_log(
        ((1 - shares) * absent).sum(dim=1), absent.sum(dim=1), absent.sum(dim=1)
    )
    return precision + recall + specificity


def _less_log(part: Tensor, whole: Tensor, counted: Tensor) -> Tensor:
    share = part / whole.clamp(min=LEAST)
    return torch.where(counted > 0, -share.clamp(min=LEAST).log(), torch.zeros_like(share))

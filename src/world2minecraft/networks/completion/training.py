"""Training of the completion network, which can be interrupted and resumed at any step.

The loss is the sum of the cross entropy of the classes, a Jaccard loss of the classes and a Jaccard
loss of the occupancy. The learning rate is constant and decreases to zero in the last part of the
run, so a run can be extended from any state before this part. The result is the running mean of the
weights.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import torch
from torch import Tensor
from torch.nn import functional

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.networks.averaged_training import AveragedTrainer
from world2minecraft.networks.completion.augmentation import CROP
from world2minecraft.networks.completion.export import restore_export
from world2minecraft.networks.completion.network import CompletionNet, CompletionSize
from world2minecraft.networks.completion.sample_pool import REFRESH_EVERY_STEPS, SamplePool
from world2minecraft.networks.validation import autocast

# About the fourth root of how rare a class is in the samples; most cells are empty.
CLASS_WEIGHTS = (0.6, 0.9, 0.8, 0.7, 1.8, 1.9, 1.2, 1.4, 1.6, 2.6, 0.9, 1.3)
SEEN_WEIGHT = 2.0  # Of observed surface, whose class matters more than that of hidden cells.
ASKED = 0.5  # Share of cells that are used; neighbours are alike, and this halves the time.
JACCARD, GEOMETRY = 1.0, 0.5
START_SEED = 1 << 20  # Of the batch from which the norms of restored weights are set.
Report = Callable[[int, dict[str, float], CompletionNet], None]


def completion_loss(logits: Tensor, truth: Tensor, surface: Tensor) -> dict[str, Tensor]:
    """Compute the losses by name. Their sum is minimized.

    Args:
        logits: Class logits, float [B, 12, X, Y, Z].
        truth: Class of each cell, int64 [B, X, Y, Z]; 255 is ignored.
        surface: Mask of observed occupied cells, bool [B, X, Y, Z].
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
    """Return one minus the mean soft IoU of the classes that occur in the ground truth."""
    both = (share * wanted).sum(dim=0)
    either = share.sum(dim=0) + wanted.sum(dim=0) - both
    there = wanted.sum(dim=0) > 0
    return 1 - (both / either.clamp(min=1e-6))[there].mean()


@dataclass(frozen=True)
class CompletionRun:
    """The settings of a training run.

    Attributes:
        steps: Number of steps.
        batch: Number of samples in a batch.
        rate: Maximum learning rate.
        fall: Fraction of the steps in which the learning rate decreases.
        warm_steps: Number of warm-up steps.
        decay: Weight decay.
        mean_of: Decay of the running mean of the weights; 0.99 averages over about 100 steps.
        seed: Random seed.
        crop: Shape of the samples in cells.
        size: Size of the network.
    """

    steps: int = 4000
    batch: int = 4
    rate: float = 3e-3
    fall: float = 0.35
    warm_steps: int = 50
    decay: float = 0.02
    mean_of: float = 0.99
    seed: int = 0
    crop: tuple[int, int, int] = CROP
    size: CompletionSize = field(default_factory=CompletionSize)


class Trainer(AveragedTrainer[CompletionNet]):
    """A training run in progress."""

    def __init__(self, run: CompletionRun, pool: SamplePool):
        self.run, self.pool = run, pool
        torch.manual_seed(run.seed)
        self.network = CompletionNet(run.size)
        self.network.to(memory_format=torch.channels_last_3d)  # type: ignore[call-overload]
        self.mean = CompletionNet(run.size)
        self.mean.load_state_dict(self.network.state_dict())
        self.optimiser = torch.optim.AdamW(
            self.network.parameters(), lr=run.rate, weight_decay=run.decay
        )
        self.step = 0

    def start_from(self, path: Path) -> None:
        """Begin with the weights of a network written by ``export_completion``.

        Raises:
            DamagedFileError: If the file does not have the weights of such a network.
        """
        rng = np.random.default_rng([self.run.seed, START_SEED])
        cells, _, _ = self.pool.batch(rng, self.run.batch, self.run.crop)
        restore_export(self.network, path, cells)
        self.mean.load_state_dict(self.network.state_dict())

    def train(self, until: int, report: Report | None = None, every: int = 50) -> None:
        """Train up to a step.

        Args:
            until: Step to stop at.
            report: Callback that receives the step, the mean losses and the averaged network.
            every: Number of steps between two reports.
        """
        sums: dict[str, float] = {}
        while self.step < min(until, self.run.steps):
            if self.step and self.step % REFRESH_EVERY_STEPS == 0:
                self.pool.refresh()
            for name, value in self._training_step().items():
                sums[name] = sums.get(name, 0.0) + value / every
            self.step += 1
            if report and self.step % every == 0:
                report(self.step, sums, self.mean)
                sums = {}

    def _training_step(self) -> dict[str, float]:
        for group in self.optimiser.param_groups:
            group["lr"] = self.learning_rate_at(self.step)
        rng = np.random.default_rng([self.run.seed, self.step])
        torch.manual_seed(int(rng.integers(1 << 62)))  # For the choice of cells in the loss.
        cells, truth, surface = self.pool.batch(rng, self.run.batch, self.run.crop)
        self.network.train()
        with autocast("auto", cells.device):
            logits = self.network(cells)
        losses = completion_loss(logits, truth, surface)
        self._minimize(torch.stack(list(losses.values())).sum())
        return {name: float(value.detach()) for name, value in losses.items()}

"""Training of the segmentation network, which can be interrupted and resumed at any step.

The learning rate is constant and decreases to zero in the last part of the run, so a run can be
extended from any state before this part, or ended early with fewer steps. The result is the
running mean of the weights.
"""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np
import torch
from torch import Tensor
from torch.nn import functional

from world2minecraft.networks.averaged_training import AveragedTrainer
from world2minecraft.networks.segmentation.augmentation import CROP, Example, draw_example
from world2minecraft.networks.segmentation.frames import IGNORED, LabelledFrame, class_shares
from world2minecraft.networks.segmentation.network import SegmentationNet, SegmentationSize

MOST_WEIGHT = 6.0  # Of a rare class.
BATCHES_AHEAD = 2
Report = Callable[[int, float, SegmentationNet], None]


@dataclass(frozen=True)
class SegmentationRun:
    """The settings of a training run.

    Attributes:
        steps: Number of steps.
        batch: Number of windows in a batch.
        rate: Maximum learning rate.
        encoder_rate: Share of the learning rate that the encoder gets.
        fall: Fraction of the steps in which the learning rate decreases.
        warm_steps: Number of warm-up steps.
        decay: Weight decay.
        mean_of: Decay of the running mean of the weights; 0.998 averages over about 500 steps.
        seed: Random seed.
        crop: Width and height of the windows in pixels of the network.
        size: Size of the network.
    """

    steps: int = 7000
    batch: int = 8
    rate: float = 2.5e-3
    encoder_rate: float = 0.25
    fall: float = 0.5
    warm_steps: int = 200
    decay: float = 0.01
    mean_of: float = 0.998
    seed: int = 0
    crop: tuple[int, int] = CROP
    size: SegmentationSize = field(default_factory=SegmentationSize)


def class_weights(shares: np.ndarray) -> np.ndarray:
    """Return a weight for each class, float32 [40], one over the root of its share.

    The mean over the labelled pixels is 1 before the weights of rare classes are limited. Classes
    that do not occur have the weight 1.

    Args:
        shares: Share of each class among the labelled pixels, [40].
    """
    root = np.sqrt(shares)
    weights = 1 / np.maximum(root * root.sum(), 1e-9)
    return np.where(shares > 0, np.minimum(weights, MOST_WEIGHT), 1).astype(np.float32)


def segmentation_loss(logits: Tensor, labels: Tensor, weights: Tensor) -> Tensor:
    """Compute the weighted cross entropy at the resolution of the labels.

    Args:
        logits: Logits [B, 40, h, w].
        labels: Classes, uint8 [B, H, W]; 39 is ignored.
        weights: Weight of each class, [40].
    """
    fine = functional.interpolate(
        logits, size=labels.shape[1:], mode="bilinear", align_corners=False
    )
    rows = fine.permute(0, 2, 3, 1).reshape(-1, logits.shape[1])
    truth = labels.reshape(-1).long()
    seen = (truth != IGNORED).nonzero()[:, 0]
    truth = truth[seen]
    each = weights[truth]
    entropy = functional.cross_entropy(rows[seen], truth, reduction="none")
    return (entropy * each).sum() / each.sum().clamp(min=1e-6)


class Trainer(AveragedTrainer[SegmentationNet]):
    """A training run in progress."""

    min_rate = 0.005

    def __init__(self, run: SegmentationRun, frames: Sequence[LabelledFrame]):
        self.run, self.frames = run, frames
        torch.manual_seed(run.seed)
        self.network = SegmentationNet(run.size)
        self.network.to(memory_format=torch.channels_last)  # type: ignore[call-overload]
        self.mean = SegmentationNet(run.size)
        self.mean.load_state_dict(self.network.state_dict())
        self.weights = torch.from_numpy(class_weights(class_shares(frames)))
        encoder = list(self.network.encoder.parameters())
        rest = [*self.network.geometry.parameters(), *self.network.decoder.parameters()]
        self.optimiser = torch.optim.AdamW(
            [{"params": rest, "share": 1.0}, {"params": encoder, "share": run.encoder_rate}],
            lr=run.rate,
            weight_decay=run.decay,
        )
        self.step = 0

    def start_from(self, network: SegmentationNet) -> None:
        """Start from the weights of another network of the same size."""
        self.network.load_state_dict(network.state_dict())
        self.mean.load_state_dict(network.state_dict())

    def train(self, until: int, report: Report | None = None, every: int = 50) -> None:
        """Train up to a step. Batches are made ahead by a second thread.

        Args:
            until: Step to stop at.
            report: Callback that receives the step, the mean loss and the averaged network.
            every: Number of steps between two reports.
        """
        total, last = 0.0, min(until, self.run.steps)
        for batch in self._batches(self.step, last):
            total += self._training_step(*batch) / every
            self.step += 1
            if report and self.step % every == 0:
                report(self.step, total, self.mean)
                total = 0.0

    def _batches(self, first: int, last: int) -> Iterator[tuple[Tensor, Tensor, Tensor]]:
        """Yield the batches of the steps, each of which depends on its step alone."""
        with ThreadPoolExecutor(1) as feeder:
            ahead: list[Future[tuple[Tensor, Tensor, Tensor]]] = []
            for step in range(first, last):
                while len(ahead) < BATCHES_AHEAD and step + len(ahead) < last:
                    ahead.append(feeder.submit(self.batch, step + len(ahead)))
                yield ahead.pop(0).result()

    def batch(self, step: int) -> tuple[Tensor, Tensor, Tensor]:
        """Return colours, geometry and labels of a step.

        Frames are drawn without repetition until each was used once.
        """
        run, count = self.run, len(self.frames)
        examples = []
        for place in range(step * run.batch, (step + 1) * run.batch):
            round_, at = divmod(place, count)
            order = np.random.default_rng([run.seed, 1, round_]).permutation(count)
            rng = np.random.default_rng([run.seed, 2, place])
            examples.append(draw_example(self.frames[order[at]], rng, run.crop))
        return collate_examples(examples)

    def _training_step(self, colour: Tensor, geometry: Tensor, labels: Tensor) -> float:
        for group in self.optimiser.param_groups:
            group["lr"] = self.learning_rate_at(self.step) * group["share"]
        torch.manual_seed(self.run.seed * 1_000_003 + self.step)  # Of dropout.
        self.network.train()
        loss = segmentation_loss(self.network(colour, geometry), labels, self.weights)
        self.optimiser.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), 5.0)
        self.optimiser.step()
        self._update_mean()
        return float(loss.detach())

    def _further_state(self) -> dict[str, Tensor]:
        return {"class_weights": self.weights}


def collate_examples(examples: Sequence[Example]) -> tuple[Tensor, Tensor, Tensor]:
    """Return colours, geometry and labels of examples as tensors with channels last."""
    colour, geometry, labels = (
        torch.from_numpy(np.stack([one[n] for one in examples])) for n in range(3)
    )
    last = torch.channels_last
    return colour.contiguous(memory_format=last), geometry.contiguous(memory_format=last), labels

"""Training of the segmentation network, which can be interrupted and resumed at any step.

The learning rate is constant and decreases to zero in the last part of the run, so a run can be
extended from any state before this part, or ended early with fewer steps. The result is the
running mean of the weights.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import torch
from torch import Tensor
from torch.nn import functional
from torch.utils.data import DataLoader, Dataset

from world2minecraft.networks.averaged_training import AveragedTrainer
from world2minecraft.networks.segmentation.augmentation import CROP, Example, draw_example
from world2minecraft.networks.segmentation.frames import IGNORED, LabelledFrame, class_shares
from world2minecraft.networks.segmentation.network import SegmentationNet, SegmentationSize

MAX_WEIGHT = 6.0  # Of a rare class.
Report = Callable[[int, float, SegmentationNet], None]
Batch = tuple[Tensor, Tensor, Tensor]


@dataclass(frozen=True)
class SegmentationRun:
    """The settings of a training run.

    Attributes:
        steps: Number of steps.
        batch: Number of windows in a batch.
        rate: Maximum learning rate.
        encoder_rate: Share of the learning rate that the encoder gets.
        pretraining: Fraction of the steps, at the start, with generated frames only.
        generated_share: Share of generated frames in the batches after that.
        fall: Fraction of the steps in which the learning rate decreases.
        warm_steps: Number of warm-up steps.
        decay: Weight decay.
        mean_of: Decay of the running mean of the weights; 0.999 averages over about 1,000 steps.
        seed: Random seed.
        crop: Width and height of the windows in pixels of the network.
        size: Size of the network.
    """

    steps: int = 6000
    batch: int = 16
    rate: float = 2e-3
    encoder_rate: float = 0.2
    pretraining: float = 0.15
    generated_share: float = 0.2
    fall: float = 0.5
    warm_steps: int = 200
    decay: float = 0.02
    mean_of: float = 0.999
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
    return np.where(shares > 0, np.minimum(weights, MAX_WEIGHT), 1).astype(np.float32)


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


class ExampleBatches(Dataset[Batch]):
    """The batches of a run. Each depends only on the settings, the frames and its step.

    Args:
        run: Settings of the run.
        frames: Real labelled frames.
        generated: Generated labelled frames, if any.
    """

    def __init__(
        self,
        run: SegmentationRun,
        frames: Sequence[LabelledFrame],
        generated: Sequence[LabelledFrame] = (),
    ):
        self.run, self.frames, self.generated = run, frames, generated

    def __len__(self) -> int:
        return self.run.steps

    def __getitem__(self, step: int) -> Batch:
        """Return colours, geometry and labels of a step.

        In a round of as many windows as there are frames, no frame is drawn twice.
        """
        run = self.run
        share = 1.0 if step < run.pretraining * run.steps else run.generated_share
        share = (share if self.frames else 1.0) if self.generated else 0.0
        examples = []
        for place in range(step * run.batch, (step + 1) * run.batch):
            rng = np.random.default_rng([run.seed, 2, place])
            frames = self.generated if rng.random() < share else self.frames
            round_, at = divmod(place, len(frames))
            order = np.random.default_rng([run.seed, 1, round_]).permutation(len(frames))
            examples.append(draw_example(frames[order[at]], rng, run.crop))
        return collate_examples(examples)


class Trainer(AveragedTrainer[SegmentationNet]):
    """A training run in progress.

    Args:
        run: Settings of the run.
        frames: Real labelled frames.
        generated: Generated labelled frames, if any.
        device: Device of PyTorch to train on.
        workers: Number of processes that prepare batches; 0 prepares them in this process.
    """

    min_rate = 0.005

    def __init__(
        self,
        run: SegmentationRun,
        frames: Sequence[LabelledFrame],
        generated: Sequence[LabelledFrame] = (),
        *,
        device: str = "cpu",
        workers: int = 0,
    ):
        self.run, self.device, self.workers = run, torch.device(device), workers
        self.batches = ExampleBatches(run, frames, generated)
        torch.manual_seed(run.seed)
        self.network = SegmentationNet(run.size).to(self.device)
        self.network.to(memory_format=torch.channels_last)  # type: ignore[call-overload]
        self.mean = SegmentationNet(run.size).to(self.device)
        self.mean.load_state_dict(self.network.state_dict())
        shares = class_shares(frames or generated)
        self.weights = torch.from_numpy(class_weights(shares)).to(self.device)
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
        """Train up to a step.

        Args:
            until: Step to stop at.
            report: Callback that receives the step, the mean loss and the averaged network.
            every: Number of steps between two reports.
        """
        losses: list[Tensor] = []
        steps = range(self.step, min(until, self.run.steps))
        batches = DataLoader(
            self.batches,
            batch_size=None,
            sampler=steps,
            num_workers=self.workers,
            pin_memory=self.device.type == "cuda",
        )
        for batch in batches:
            losses.append(self._training_step(*(part.to(self.device) for part in batch)))
            self.step += 1
            if report and self.step % every == 0:
                report(self.step, float(torch.stack(losses).mean()), self.mean)
                losses = []

    def _training_step(self, colour: Tensor, geometry: Tensor, labels: Tensor) -> Tensor:
        for group in self.optimiser.param_groups:
            group["lr"] = self.learning_rate_at(self.step) * group["share"]
        torch.manual_seed(self.run.seed * 1_000_003 + self.step)  # For dropout.
        self.network.train()
        loss = segmentation_loss(self.network(colour, geometry), labels, self.weights)
        self._minimize(loss)
        return loss.detach()

    def _further_state(self) -> dict[str, Tensor]:
        return {"class_weights": self.weights}


def collate_examples(examples: Sequence[Example]) -> Batch:
    """Return colours, geometry and labels of examples as tensors with channels last."""
    colour, geometry, labels = (
        torch.from_numpy(np.stack([one[n] for one in examples])) for n in range(3)
    )
    last = torch.channels_last
    return colour.contiguous(memory_format=last), geometry.contiguous(memory_format=last), labels

"""What a completion network says of held-out samples: quick scores while it is trained."""

import numpy as np
import torch

from world2minecraft.label.channels import network_input
from world2minecraft.learn.completion.augment import cropped
from world2minecraft.learn.completion.network import MULTIPLE, CompletionNet
from world2minecraft.learn.completion.samples import Sample
from world2minecraft.metrics.occupancy import OccupancyCounts, count_occupancy


def padded(sample: Sample) -> Sample:
    """Return a sample whose sides are whole multiples of what the network takes."""
    shape = tuple(-(-side // MULTIPLE) * MULTIPLE for side in sample.truth.shape)
    return cropped(sample, np.zeros(3, np.int64), shape)  # type: ignore[arg-type]


def kept(labels: np.ndarray, logits: np.ndarray, sight) -> np.ndarray:
    """Return labels [X, Y, Z] with the observed surface kept: of its 11 classes the likeliest."""
    surface = sight.log_odds > 0
    result = labels.copy()
    result[surface] = logits[1:].argmax(axis=0)[surface] + 1
    return result


@torch.no_grad()
def logits_of(network: CompletionNet, sample: Sample) -> np.ndarray:
    """Return float32 [12, X, Y, Z] of a padded sample."""
    network.eval()
    cells = torch.from_numpy(network_input(sample.sight))[None]
    with torch.autocast("cpu", torch.bfloat16):
        return network(cells)[0].float().numpy()


def quick_scores(network: CompletionNet, samples: list[Sample]) -> str:
    """Return IoU / mIoU of walks and singles: all cells, observed ones, and the hint's."""
    counts: dict[str, OccupancyCounts] = {}

    def add(name: str, one: OccupancyCounts) -> None:
        counts[name] = counts.get(name, OccupancyCounts()) + one

    for one in samples:
        sample = padded(one)
        logits = logits_of(network, sample)
        labels = logits.argmax(axis=0).astype(np.uint8)
        labels = kept(labels, logits, sample.sight)
        observed = sample.sight.log_odds != 0
        add(f"{one.kind} all", count_occupancy(labels, sample.truth))
        add(f"{one.kind} observed", count_occupancy(labels, sample.truth, observed))
        if sample.sight.hint is not None:
            hint = np.zeros(labels.size, np.uint8)
            hint[sample.sight.at] = np.where(sample.sight.hint, sample.sight.hint, 11)
            hint = hint.reshape(labels.shape)
            add(f"{one.kind} hint observed", count_occupancy(hint, sample.truth, observed))
            add(f"{one.kind} hinted observed", count_occupancy(labels, sample.truth, observed))
    return ", ".join(
        f"{name} {100 * c.iou:.1f}/{100 * c.miou:.1f}" for name, c in sorted(counts.items())
    )

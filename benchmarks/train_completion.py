"""Train the completion network on the samples of ``make_completion_samples``.

``python -m benchmarks.train_completion --samples FOLDER --run FOLDER [--steps 4000]
[--start OLD.onnx --rate 0.001] [--export completion.onnx [--share 0.5]]``

An interrupted run continues from its folder. ``--start`` continues from an exported network. Every
100 steps the losses are printed, and at intervals IoU and mIoU on held-out rooms (seeds below
10,000). ``--export`` writes the averaged weights as ONNX; with ``--share``, weights between those
of ``--start`` and of this run, such as half of each.
"""

import argparse
import time
from pathlib import Path

import numpy as np
import torch
from safetensors.torch import load_file

from world2minecraft.evaluation.metrics.occupancy import OccupancyCounts, count_occupancy
from world2minecraft.networks.completion.augmentation import crop_sample, prepare_evaluation
from world2minecraft.networks.completion.export import average_exports, export_completion
from world2minecraft.networks.completion.network import MULTIPLE, CompletionNet
from world2minecraft.networks.completion.sample_pool import SamplePool
from world2minecraft.networks.completion.samples import FIRST_SEED, Sample, read_samples
from world2minecraft.networks.completion.training import CompletionRun, Trainer
from world2minecraft.networks.validation import autocast
from world2minecraft.reconstruction.semantics.completion_channels import network_input


def padded(sample: Sample) -> Sample:
    """Return a sample whose sides are whole multiples of what the network takes."""
    shape = tuple(-(-side // MULTIPLE) * MULTIPLE for side in sample.truth.shape)
    return crop_sample(sample, np.zeros(3, np.int64), shape)  # type: ignore[arg-type]


def with_observed_surface(labels: np.ndarray, logits: np.ndarray, sight) -> np.ndarray:
    """Return labels [X, Y, Z] with the observed surface occupied, by the most likely class."""
    surface = sight.log_odds > 0
    result = labels.copy()
    result[surface] = logits[1:].argmax(axis=0)[surface] + 1
    return result


@torch.no_grad()
def logits_of(network: CompletionNet, sample: Sample) -> np.ndarray:
    """Return float32 [12, X, Y, Z] of a padded sample."""
    network.eval()
    cells = torch.from_numpy(network_input(sample.sight))[None]
    with autocast("auto", cells.device):
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
        labels = with_observed_surface(labels, logits, sample.sight)
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


def write_onnx(run: Path, out: Path) -> None:
    """Export the averaged weights of a run and print the largest difference from torch."""
    network = CompletionNet()
    network.load_state_dict(load_file(str(run / "mean.safetensors")))
    steps = (run / "step.txt").read_text().strip()
    about = {"steps": steps, "run": (run / "run.txt").read_text().strip()}
    off = export_completion(network, out, about)
    print(f"{out}: {out.stat().st_size / 1e6:.2f} MB after {steps} steps; {off:.1e}")


HELD_OUT_FILES = 6


def main() -> None:
    """Train, print, save."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--samples", type=Path, required=True)
    parser.add_argument("--run", type=Path, required=True)
    parser.add_argument("--steps", type=int, default=4000)
    parser.add_argument("--until", type=int, help="stop before the last step")
    parser.add_argument("--every", type=int, default=100)
    parser.add_argument("--score-every", type=int, default=400)
    parser.add_argument("--batch", type=int, default=4)
    parser.add_argument("--rate", type=float, default=CompletionRun.rate, help="learning rate")
    parser.add_argument("--start", type=Path, help="exported network to begin with")
    parser.add_argument("--share", type=float, help="share of this run beside --start")
    parser.add_argument("--export", type=Path, help="write the trained network as ONNX")
    parser.add_argument("--threads", type=int, default=1)
    chosen = parser.parse_args()
    torch.set_num_threads(chosen.threads)
    trainer = Trainer(
        CompletionRun(steps=chosen.steps, batch=chosen.batch, rate=chosen.rate),
        SamplePool(chosen.samples, range(FIRST_SEED, 1 << 31)),
    )
    if not trainer.resume(chosen.run) and chosen.start:
        trainer.start_from(chosen.start)
    named = [path for path in chosen.samples.glob("*.npz") if path.stem.isdecimal()]
    files = sorted(path for path in named if int(path.stem) < FIRST_SEED)
    held_out = [
        sample
        for path in files[:HELD_OUT_FILES]
        for sample in prepare_evaluation(read_samples(path), int(path.stem))
    ]
    start, before = time.process_time(), trainer.step

    def report(step: int, losses: dict[str, float], network: CompletionNet) -> None:
        told = " ".join(f"{name} {value:.3f}" for name, value in losses.items())
        spent = time.process_time() - start
        rate = spent / max(step - before, 1)
        print(f"{step} {told}; {len(trainer.pool)} rooms, {rate:.2f} CPU s a step", flush=True)
        trainer.save(chosen.run)
        if step % chosen.score_every == 0:
            print(f"    {quick_scores(network, held_out)}", flush=True)

    trainer.train(chosen.until or chosen.steps, report, chosen.every)
    trainer.save(chosen.run)
    if chosen.export:
        write_onnx(chosen.run, chosen.export)
        if chosen.start and chosen.share is not None:
            average_exports(chosen.start, chosen.export, chosen.share, chosen.export)


if __name__ == "__main__":
    main()

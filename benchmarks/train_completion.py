"""Train the completion network on samples that ``make_completion_samples`` made.

``python -m benchmarks.train_completion --samples FOLDER --run FOLDER [--steps 4000]``

A run that was broken off goes on from its folder. Every 100 steps the losses are printed, with IoU
and mIoU on held-out rooms (seeds below 10,000) now and then.
"""

import argparse
import time
from pathlib import Path

import torch

from benchmarks.completion_scores import quick_scores
from world2minecraft.learn.completion.network import CompletionNet
from world2minecraft.learn.completion.pool import SamplePool
from world2minecraft.learn.completion.rooms import FIRST_SEED
from world2minecraft.learn.completion.samples import read_samples
from world2minecraft.learn.completion.training import CompletionRun, Trainer

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
    parser.add_argument("--threads", type=int, default=1)
    chosen = parser.parse_args()
    torch.set_num_threads(chosen.threads)
    trainer = Trainer(
        CompletionRun(steps=chosen.steps, batch=chosen.batch),
        SamplePool(chosen.samples, range(FIRST_SEED, 1 << 31)),
    )
    trainer.resume(chosen.run)
    files = sorted(p for p in chosen.samples.glob("*.npz") if int(p.stem) < FIRST_SEED)
    held_out = [s for path in files[:HELD_OUT_FILES] for s in read_samples(path)]
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


if __name__ == "__main__":
    main()

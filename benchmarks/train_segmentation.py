"""Train the segmentation network on labelled frames of NYUv2.

``python -m benchmarks.train_segmentation --nyu FOLDER --run FOLDER [--backbone FILE.param]
[--steps 7000]``

An interrupted run continues from its folder. At intervals pixel accuracy and mIoU on the
validation frames are printed.
"""

import argparse
import shlex
import sys
import time
from pathlib import Path

import numpy as np
import torch

from world2minecraft.core.files import write_text
from world2minecraft.networks.segmentation.backbone import start_encoder
from world2minecraft.networks.segmentation.frames import read_nyu_folder
from world2minecraft.networks.segmentation.network import SegmentationNet
from world2minecraft.networks.segmentation.scores import score_network
from world2minecraft.networks.segmentation.training import SegmentationRun, Trainer

CURVE_EVERY_PX = 4  # Of the learning curve; the final scores look at every pixel.


def main() -> None:
    """Train, print, save."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--nyu", type=Path, required=True)
    parser.add_argument("--run", type=Path, required=True)
    parser.add_argument("--backbone", type=Path, help="ncnn .param of a ShuffleNetV2 1.0x")
    parser.add_argument("--cache", type=Path, help="folder that keeps the smoothed depth")
    parser.add_argument("--steps", type=int, default=SegmentationRun.steps)
    parser.add_argument("--until", type=int, help="stop before the last step")
    parser.add_argument("--every", type=int, default=50)
    parser.add_argument("--score-every", type=int, default=600)
    parser.add_argument("--threads", type=int, default=1)
    chosen = parser.parse_args()
    torch.set_num_threads(chosen.threads)
    trainer = Trainer(
        SegmentationRun(steps=chosen.steps), read_nyu_folder(chosen.nyu, ["train"], chosen.cache)
    )
    if not trainer.resume(chosen.run) and chosen.backbone:
        network = SegmentationNet(trainer.run.size)
        network.load_state_dict(trainer.network.state_dict())
        start_encoder(network, chosen.backbone)
        trainer.start_from(network)
    chosen.run.mkdir(parents=True, exist_ok=True)
    write_text(chosen.run / "command.txt", f"python {shlex.join(sys.argv)}\n")
    held_out = read_nyu_folder(chosen.nyu, ["validation"], chosen.cache)
    half_undone = (-0.5 * np.log(trainer.weights.numpy())).astype(np.float32)
    start, before = time.process_time(), trainer.step
    scoring = 0.0

    def report(step: int, loss: float, network: SegmentationNet) -> None:
        nonlocal scoring
        spent = time.process_time() - start - scoring
        rate = trainer.learning_rate_at(step)
        each = spent / (step - before)
        print(
            f"{step} loss {loss:.3f} rate {rate:.5f}; {each:.2f} CPU s a step, "
            f"{spent / 60:.1f} CPU min, {time.strftime('%H:%M:%S')}",
            flush=True,
        )
        trainer.save(chosen.run)
        if step % chosen.score_every == 0:
            began = time.process_time()
            scores = score_network(network, held_out, half_undone, CURVE_EVERY_PX)
            print(f"    {step} {scores}", flush=True)
            scoring += time.process_time() - began

    trainer.train(chosen.until or chosen.steps, report, chosen.every)
    trainer.save(chosen.run)


if __name__ == "__main__":
    main()

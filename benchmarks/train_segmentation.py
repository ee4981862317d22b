"""Train the segmentation network on labelled frames of NYUv2.

``python -m benchmarks.train_segmentation --nyu FOLDER --run FOLDER [--backbone FILE.param]
[--sun-rgbd FOLDER] [--steps 7000] [--export segmentation.onnx]``

``--nyu`` takes a folder of frames or ``nyu_depth_v2_labeled.mat``. An interrupted run continues
from its folder; with fewer ``--steps`` it ends earlier, with more it goes on longer. At intervals
pixel accuracy and mIoU on the validation frames are printed. ``--export`` fits the calibration and
writes the averaged weights as ONNX; with ``--until 0`` it does so without training.
"""

import argparse
import shlex
import sys
import time
from pathlib import Path

import torch
from safetensors.torch import load_file

from world2minecraft.core.files import write_text
from world2minecraft.networks.segmentation.backbone import start_encoder
from world2minecraft.networks.segmentation.calibration import fit_calibration, undo_class_weights
from world2minecraft.networks.segmentation.export import export_segmentation
from world2minecraft.networks.segmentation.frames import LabelledFrame, Part, read_nyu_folder
from world2minecraft.networks.segmentation.network import SegmentationNet
from world2minecraft.networks.segmentation.public_sets import (
    find_sun_rgbd,
    read_nyu_mat,
    read_sun_rgbd,
)
from world2minecraft.networks.segmentation.scores import score_network
from world2minecraft.networks.segmentation.training import SegmentationRun, Trainer

CURVE_EVERY_PX = 4  # Of the learning curve; the final scores look at every pixel.


def read_nyu(place: Path, part: Part, cache: Path | None) -> list[LabelledFrame]:
    """Read a part of NYUv2's labelled set, from a folder of frames or from the published file."""
    if place.is_file():
        return read_nyu_mat(place, [part])
    return read_nyu_folder(place, [part], cache)


def write_onnx(run: Path, out: Path, frames: list[LabelledFrame], weights: str) -> None:
    """Calibrate and export the averaged weights of a run."""
    network = SegmentationNet()
    network.load_state_dict(load_file(str(run / "mean.safetensors")))
    shares = load_file(str(run / "optimiser.safetensors"))["class_weights"].numpy()
    calibration = fit_calibration(network, frames, shares)
    steps = (run / "step.txt").read_text().strip()
    about = {
        "run": (run / "run.txt").read_text().strip(),
        "steps": steps,
        "temperatures": " ".join(f"{value:.3f}" for value in calibration.temperatures),
    }
    report = export_segmentation(network, calibration, out, about, weights=weights)
    print(
        f"{out}: {report.size / 1e6:.2f} MB after {steps} steps, temperatures "
        f"{about['temperatures']}; PyTorch and ONNX differ by {report.difference:.1e}, "
        f"{weights} moves probabilities by {report.moved:.1e}"
    )


def parsed() -> argparse.Namespace:
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--nyu", type=Path, required=True)
    parser.add_argument("--sun-rgbd", type=Path, help="labelled frame folders to add")
    parser.add_argument("--run", type=Path, required=True)
    parser.add_argument("--backbone", type=Path, help="ncnn .param of a ShuffleNetV2 1.0x")
    parser.add_argument("--cache", type=Path, help="folder that keeps the smoothed depth")
    parser.add_argument("--steps", type=int, default=SegmentationRun.steps)
    parser.add_argument("--until", type=int, help="stop before the last step")
    parser.add_argument("--every", type=int, default=50)
    parser.add_argument("--score-every", type=int, default=600)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--export", type=Path, help="write the trained network as ONNX")
    parser.add_argument("--weights", default="half", help="format of the exported weights")
    return parser.parse_args()


def main() -> None:
    """Train, print, save, export."""
    chosen = parsed()
    torch.set_num_threads(chosen.threads)
    if chosen.until != 0:
        train(chosen)
    if chosen.export:
        frames = read_nyu(chosen.nyu, "calibration", chosen.cache)
        write_onnx(chosen.run, chosen.export, frames, chosen.weights)


def train(chosen: argparse.Namespace) -> None:
    """Train from where the run folder stands."""
    frames = read_nyu(chosen.nyu, "train", chosen.cache)
    if chosen.sun_rgbd:
        frames += [read_sun_rgbd(folder) for folder in find_sun_rgbd(chosen.sun_rgbd)]
    trainer = Trainer(SegmentationRun(steps=chosen.steps), frames)
    if not trainer.resume(chosen.run) and chosen.backbone:
        network = SegmentationNet(trainer.run.size)
        network.load_state_dict(trainer.network.state_dict())
        start_encoder(network, chosen.backbone)
        trainer.start_from(network)
    chosen.run.mkdir(parents=True, exist_ok=True)
    write_text(chosen.run / "command.txt", f"python {shlex.join(sys.argv)}\n")
    held_out = read_nyu(chosen.nyu, "validation", chosen.cache)
    offset = undo_class_weights(trainer.weights.numpy())
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
            scores = score_network(network, held_out, offset, CURVE_EVERY_PX)
            print(f"    {step} {scores}", flush=True)
            scoring += time.process_time() - began

    trainer.train(chosen.until or chosen.steps, report, chosen.every)
    trainer.save(chosen.run)


if __name__ == "__main__":
    main()

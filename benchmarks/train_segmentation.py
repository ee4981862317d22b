"""Train the segmentation network on labelled frames of NYUv2, of SUN RGB-D and of generated rooms.

``python -m benchmarks.train_segmentation --nyu FOLDER --run FOLDER [--generated FOLDER]
[--backbone FILE.pth] [--sun-rgbd FOLDER] [--device cuda --workers 6] [--export FILE.onnx]``

``--nyu`` takes a folder of frames or ``nyu_depth_v2_labeled.mat``. ``--generated`` takes frames of
generated rooms; with ``--rooms N`` those of N rooms are written there first. An interrupted run
continues from its folder. With fewer ``--steps`` it ends earlier, with more it goes on longer. At
intervals, pixel accuracy and mIoU on the validation frames of ``--nyu`` are printed. ``--export``
fits the calibration and writes the averaged weights as ONNX; with ``--until 0`` it does so without
training.

``--only-generated`` trains on generated frames alone. Those of the last ten rooms are kept for the
calibration. ``--nyu`` is needed all the same, for its validation frames.
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
from world2minecraft.networks.segmentation.generated import (
    FIRST_SEED,
    generate_frames,
    read_frames,
    write_frames,
)
from world2minecraft.networks.segmentation.network import LITE0, LITE2, SegmentationNet
from world2minecraft.networks.segmentation.public_sets import (
    find_sun_rgbd,
    read_nyu_mat,
    read_sun_rgbd,
)
from world2minecraft.networks.segmentation.scores import score_network
from world2minecraft.networks.segmentation.training import SegmentationRun, Trainer

SIZES = {"lite0": LITE0, "lite2": LITE2}
HELD_OUT_ROOMS = 10  # The last ones, for the calibration with --only-generated.
CURVE_EVERY_PX = 4  # Of the learning curve; the final scores look at every pixel.


def read_nyu(place: Path, part: Part, cache: Path | None) -> list[LabelledFrame]:
    """Read a part of NYUv2's labelled set, from a folder of frames or from the published file."""
    if place.is_file():
        return read_nyu_mat(place, [part])
    return read_nyu_folder(place, [part], cache)


def split_rooms(
    frames: list[LabelledFrame],
) -> tuple[list[LabelledFrame], list[LabelledFrame]]:
    """Return the generated frames of all rooms but the last ones, and those of the last ones."""
    rooms = [frame.name.partition("-")[0] for frame in frames]
    kept = set(sorted(set(rooms))[-HELD_OUT_ROOMS:])
    first = [frame for frame, room in zip(frames, rooms, strict=True) if room not in kept]
    last = [frame for frame, room in zip(frames, rooms, strict=True) if room in kept]
    if not first:
        sys.exit(f"--only-generated keeps {HELD_OUT_ROOMS} rooms; generate more with --rooms N")
    return first, last


def write_onnx(run: Path, out: Path, frames: list[LabelledFrame], weights: str, size: str) -> None:
    """Calibrate and export the averaged weights of a run."""
    network = SegmentationNet(SIZES[size])
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
    parser.add_argument("--nyu", type=Path, required=True, help="frames of NYUv2")
    parser.add_argument("--sun-rgbd", type=Path, help="labelled frame folders to add")
    parser.add_argument("--run", type=Path, required=True, help="folder of the run")
    parser.add_argument("--generated", type=Path, help="folder of frames of generated rooms")
    parser.add_argument("--rooms", type=int, help="number of rooms to generate frames of first")
    parser.add_argument("--only-generated", action="store_true", help="train on no real frame")
    parser.add_argument("--size", default="lite2", choices=sorted(SIZES))
    parser.add_argument("--backbone", type=Path, help="published weights of an EfficientNet-Lite")
    parser.add_argument("--device", default="cpu", help="device of PyTorch, such as cuda")
    parser.add_argument("--workers", type=int, default=0, help="processes that prepare batches")
    parser.add_argument("--batch", type=int, default=SegmentationRun.batch, help="windows a step")
    parser.add_argument("--cache", type=Path, help="folder that keeps the smoothed depth")
    parser.add_argument("--steps", type=int, default=SegmentationRun.steps)
    parser.add_argument("--until", type=int, help="stop before the last step")
    parser.add_argument("--every", type=int, default=50)
    parser.add_argument("--score-every", type=int, default=600)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--export", type=Path, help="write the trained network as ONNX")
    parser.add_argument("--weights", default="half", help="format of the exported weights")
    chosen = parser.parse_args()
    if chosen.generated is None and (chosen.rooms or chosen.only_generated):
        parser.error("--rooms and --only-generated need --generated FOLDER")
    return chosen


def main() -> None:
    """Train, print, save, export."""
    chosen = parsed()
    torch.set_num_threads(chosen.threads)
    if chosen.rooms:
        seeds = range(FIRST_SEED, FIRST_SEED + chosen.rooms)
        write_frames(chosen.generated, generate_frames(seeds))
    if chosen.until != 0:
        train(chosen)
    if chosen.export:
        if chosen.only_generated:
            frames = split_rooms(read_frames(chosen.generated))[1]
        else:
            frames = read_nyu(chosen.nyu, "calibration", chosen.cache)
        write_onnx(chosen.run, chosen.export, frames, chosen.weights, chosen.size)


def train(chosen: argparse.Namespace) -> None:
    """Train from the state in the run folder, if there is one."""
    generated = read_frames(chosen.generated) if chosen.generated else []
    frames: list[LabelledFrame] = []
    if chosen.only_generated:
        generated, _ = split_rooms(generated)
    else:
        frames = read_nyu(chosen.nyu, "train", chosen.cache)
        if chosen.sun_rgbd:
            frames += [read_sun_rgbd(folder) for folder in find_sun_rgbd(chosen.sun_rgbd)]
    trainer = Trainer(
        SegmentationRun(steps=chosen.steps, batch=chosen.batch, size=SIZES[chosen.size]),
        frames,
        generated,
        device=chosen.device,
        workers=chosen.workers,
    )
    if not trainer.resume(chosen.run) and chosen.backbone:
        network = SegmentationNet(trainer.run.size)
        network.load_state_dict(trainer.network.state_dict())
        start_encoder(network, chosen.backbone)
        trainer.start_from(network)
    chosen.run.mkdir(parents=True, exist_ok=True)
    write_text(chosen.run / "command.txt", f"python {shlex.join(sys.argv)}\n")
    held_out = read_nyu(chosen.nyu, "validation", chosen.cache)
    offset = undo_class_weights(trainer.weights.cpu().numpy())
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

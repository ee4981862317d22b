"""Whether the votes of a network raise the score of rooms that are built from photos.

``python -m benchmarks.check_network_votes --network NET.onnx``       a monocular network's votes
``python -m benchmarks.check_network_votes --semantics hf:ORG/NAME``  a segmenter's
``python -m benchmarks.check_network_votes --network NET.onnx --alone``  no stereo: the paper's way

Generated rooms that no network was trained on (seeds from 700; ``w2m dataset rooms`` begins at
40,000) are photographed by a virtual phone and reconstructed from colour with poses: by stereo
alone, and with the votes joined (or by the network alone). Printed are, over the cells that rays of
the used frames reached: IoU, mIoU of the classes present and object F1, room by room, and the mean
gain with its 95 % interval over rooms (bootstrap). Votes are worth joining where that interval lies
above 0.
"""

import argparse
import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.photo_inputs import room_inputs
from world2minecraft.evaluate import evaluate_reconstruction
from world2minecraft.occupy import OccupyParameters
from world2minecraft.parameters import Parameters
from world2minecraft.pipeline import reconstruct

FIRST_SEED = 700
COLUMNS = ("IoU", "mIoU", "object F1")
RESAMPLES = 2000


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", default="", help="an ONNX file of docs/networks-onnx.md")
    parser.add_argument("--semantics", default="", help="hf:ORG/NAME or hf:FOLDER")
    parser.add_argument("--alone", action="store_true", help="the network in place of stereo")
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--first", type=int, default=FIRST_SEED)
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("--work", type=Path, default=Path("OUT-votes"))
    chosen = parser.parse_args()
    if not chosen.network and not chosen.semantics:
        parser.error("give --network NET.onnx, --semantics hf:ORG/NAME, or both")
    if chosen.alone:
        if chosen.semantics or not chosen.network:
            parser.error("--alone goes with --network NET.onnx")
        joined = replace(Parameters(), predictor=f"mono:{chosen.network}")
    else:
        votes = OccupyParameters(
            semantics=chosen.semantics, mono_votes=bool(chosen.network), network=chosen.network
        )
        joined = replace(Parameters(), occupy=votes)
    print(f"{'room':12}" + "".join(f"{name:>12}{'network':>10}" for name in COLUMNS))
    rows = [
        report(seed, chosen.work, chosen.frames, joined)
        for seed in range(chosen.first, chosen.first + chosen.seeds)
    ]
    gains = np.array([after - before for before, after in rows])
    for column, name in enumerate(COLUMNS):
        low, high = interval(gains[:, column])
        print(f"{name}: {gains[:, column].mean():+.4f}, 95 % interval {low:+.4f} to {high:+.4f}")


def report(seed: int, work: Path, frames: int, joined: Parameters) -> tuple[np.ndarray, np.ndarray]:
    """Reconstruct one room both ways; print and return the two rows of figures."""
    folder = work / f"room-{seed}"
    room_inputs(seed, folder, frames)
    capture, plain = folder / "posed", folder / "out-plain"
    if not (plain / "objects.json").is_file():
        reconstruct(capture, plain)
    other = folder / "out-joined"
    shutil.rmtree(other, ignore_errors=True)
    if joined.predictor == Parameters().predictor:
        shutil.copytree(plain, other)  # Its depth is the same; only fusion begins anew.
        reconstruct(capture, other, joined, start="fuse")
    else:
        reconstruct(capture, other, joined)
    before, after = figures(plain, capture), figures(other, capture)
    cells = "".join(f"{a:12.4f}{b:10.4f}" for a, b in zip(before, after, strict=True))
    print(f"{seed:<12}{cells}", flush=True)
    return before, after


def figures(out: Path, capture: Path) -> np.ndarray:
    """Return the figures of a finished run, in the order of ``COLUMNS``."""
    facts = evaluate_reconstruction(out, capture)
    (out / "scores.json").write_text(json.dumps(facts, indent=1, default=float))
    occupancy = facts["occupancy"]
    return np.array([occupancy["iou"], occupancy["miou_present_classes"], facts["objects"]["f1"]])


def interval(gains: np.ndarray) -> tuple[float, float]:
    """Return the 95 % interval of the mean gain, by drawing rooms again and again."""
    rng = np.random.default_rng(0)
    means = rng.choice(gains, (RESAMPLES, len(gains))).mean(axis=1)
    low, high = np.percentile(means, [2.5, 97.5])
    return float(low), float(high)


if __name__ == "__main__":
    main()

"""Fusion alone: exact occupancy, time a frame, memory, and linearity in frames.

``python -m benchmarks.check_fusion [TRIAL ...]`` scans the named trials of the tuning split
(``noise-500 noise-500-clean`` where none is named), fuses them, and prints the exact IoU over the
cells that rays could reach, with the mistakes counted by kind.

``python -m benchmarks.check_fusion --capture FOLDER [--repeat N]`` fuses a capture of any size N
times over, as if it had so many frames, and prints processor time a frame in each round, the
memory of the map and the peak of the process.
"""

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np

from world2minecraft.classes import UNKNOWN
from world2minecraft.evaluate.frames import used_frames
from world2minecraft.evaluate.score import see_truth
from world2minecraft.evaluate.truth import read_truth
from world2minecraft.exchange.scan import write_scan
from world2minecraft.fuse import EvidenceMap
from world2minecraft.live import placed_scan
from world2minecraft.occupy.depth import DepthPredictor
from world2minecraft.parameters import Parameters, with_settings
from world2minecraft.rooms.trials import trial_named, write_trial
from world2minecraft.run_folder import peak_memory_mb

DEFAULT = ("noise-500", "noise-500-clean")


def exact_occupancy(capture: Path, out: Path, chosen: Parameters) -> dict[str, float]:
    """Fuse a scan and hold its occupied cells against the truth beside it."""
    scan = placed_scan(capture, chosen)
    write_scan(out / "scan.json", scan)
    map_ = EvidenceMap(scan.scan_to_room, chosen.fuse)
    for item in DepthPredictor().predict(scan):
        map_.add(item)
    fused = map_.fused()
    known = read_truth(capture)
    room = see_truth(known, used_frames(out, known), scan.scan_to_room, chosen.voxel_m)
    found = np.zeros(room.labels.shape, bool)
    start = np.round(fused.origin_m / chosen.voxel_m).astype(int) - room.reached.low
    first, last = np.maximum(start, 0), np.minimum(start + fused.hits.shape, found.shape)
    here = tuple(slice(a, b) for a, b in zip(first, last, strict=True))
    there = tuple(slice(a - s, b - s) for a, b, s in zip(first, last, start, strict=True))
    found[here] = fused.log_odds[there] > 0
    scored = room.reached.scored & (room.labels != UNKNOWN)
    true = room.labels > 0
    right = int((found & true & scored).sum())
    wrong, missed = int((found & ~true & scored).sum()), int((~found & true & scored).sum())
    return {
        "IoU": right / max(right + wrong + missed, 1),
        "right": right,
        "wrong": wrong,
        "missed": missed,
        "missed where met": int((~found & true & scored & room.reached.met).sum()),
        "not asked": int((found & ~scored).sum()),
    }


def speed(capture: Path, repeat: int, chosen: Parameters) -> None:
    """Print time and memory of fusing a capture again and again."""
    scan = placed_scan(capture, chosen)
    map_, lifter = EvidenceMap(scan.scan_to_room, chosen.fuse), DepthPredictor()
    for number in range(1, repeat + 1):
        lifting, adding, frames = 0.0, 0.0, 0
        for view in scan.views:
            begun = time.process_time()
            evidence = lifter.lift(view)
            lifted = time.process_time()
            map_.add(evidence)
            adding += time.process_time() - lifted
            lifting += lifted - begun
            frames += 1
        print(
            f"round {number}: {frames} frames, lifting {1000 * lifting / frames:.1f} ms and fusing "
            f"{1000 * adding / frames:.1f} ms of processor a frame; map "
            f"{map_.memory_mb:.0f} MB, process {peak_memory_mb():.0f} MB at most"
        )
    begun = time.process_time()
    fused = map_.fused()
    print(
        f"settled {'x'.join(map(str, fused.hits.shape))} cells in "
        f"{time.process_time() - begun:.2f} s; process {peak_memory_mb():.0f} MB at most"
    )


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("trials", nargs="*")
    parser.add_argument("--capture", type=Path)
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="a folder for scans, used again")
    parser.add_argument("--set", dest="settings", action="append", default=[])
    chosen = parser.parse_args()
    parameters = with_settings(Parameters(), chosen.settings)
    if chosen.capture:
        speed(chosen.capture, chosen.repeat, parameters)
        return
    base = chosen.keep or Path(tempfile.mkdtemp())
    for name in chosen.trials or DEFAULT:
        folder = base / name
        if not (folder / "truth.json").is_file():
            write_trial(trial_named(name), folder)
        figures = exact_occupancy(folder, base / f"{name}-fused", parameters)
        print(f"{name:18}", *(f"{key} {value:.4g}" for key, value in figures.items()))


if __name__ == "__main__":
    main()

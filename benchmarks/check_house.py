"""A whole house in one run: time a frame, peak memory, and its scores against the truth.

``python -m benchmarks.check_house [--rooms 12 --storeys 2 --frames 3000 --seed 7 --keep FOLDER]``

The house is walked through once; then a quarter, a half and all of the frames are reconstructed,
each in a process of its own, so that the table shows whether time is linear in frames. The capture
takes about 0.7 MB a frame on disk.
"""

import argparse
import json
import os
import tempfile
from pathlib import Path

from rich.console import Console
from rich.table import Table

from benchmarks.bench_pipeline import reconstruct
from world2minecraft.evaluate import evaluate_reconstruction
from world2minecraft.rooms import generate_house, scan_room

SHARES = (4, 2, 1)  # Every fourth, every second, every frame.
MOST_MB = 3000
COLUMNS = ("frames", "seconds", "ms a frame", "peak MB", "fuse s", "all else s")


def main() -> None:
    """Print a row for each number of frames, then the scores of the last."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rooms", type=int, default=12)
    parser.add_argument("--storeys", type=int, default=2)
    parser.add_argument("--frames", type=int, default=3000)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--keep", type=Path)
    chosen = parser.parse_args()
    base = chosen.keep or Path(tempfile.mkdtemp())
    console = Console(width=None if os.isatty(1) else 140)
    capture = base / "capture"
    if not (capture / "truth.json").is_file():
        house = generate_house(chosen.seed, rooms=chosen.rooms, storeys=chosen.storeys)
        scan_room(house, capture, frames=chosen.frames, seed=chosen.seed)
        del house
    table = Table(*COLUMNS, title=f"{chosen.rooms} rooms, {chosen.storeys} storeys")
    peaks = []
    for share in SHARES:
        out = base / f"every{share}"
        words = ["reconstruct", str(capture), "--set", f"capture.every={share}", "--out"]
        seconds, peak_mb = reconstruct(words, out, {})
        frames, stages = len(used_frames(out)), stage_times(out)
        fuse = sum(stages.get(name, 0.0) for name in ("scan", "register", "fuse"))
        cells = (frames, seconds, 1e3 * seconds / frames, peak_mb, fuse, seconds - fuse)
        table.add_row(*(f"{value:.0f}" for value in cells))
        peaks.append(peak_mb)
    console.print(table)
    console.print(f"peak {max(peaks):.0f} MB, {'under' if max(peaks) < MOST_MB else 'OVER'} 3 GB")
    facts = evaluate_reconstruction(base / f"every{SHARES[-1]}", capture)
    console.print_json(json.dumps(facts["headline"]))


def used_frames(out: Path) -> list[str]:
    """Return the names of the frames that a run used."""
    return json.loads((out / "scan.json").read_text())["frames_used"]


def stage_times(out: Path) -> dict[str, float]:
    """Return the seconds of each stage of a run."""
    return json.loads((out / "run.json").read_text())["stage_s"]


if __name__ == "__main__":
    main()

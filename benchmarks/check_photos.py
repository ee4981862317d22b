"""Rooms from colour alone, against the same rooms from depth.

``python -m benchmarks.check_photos KITCHEN``       a 7-Scenes folder that has depth too
``python -m benchmarks.check_photos --seeds 10``    generated rooms, photographed with texture

Each capture is reconstructed from depth (the reference; for generated rooms noise-free depth and
exact poses), from colour with the stated poses, from colour alone, and with OpenCV's StereoSGBM
in place of our stereo. Printed are, within one voxel: precision, recall over all occupied cells,
the share of free cells found free, the share of occupied cells called free, the scale's error,
CPU seconds, wall seconds and peak memory. ``--json FILE`` writes them too.
"""

import argparse
import json
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from benchmarks.photo_inputs import kitchen_inputs, room_inputs
from benchmarks.photo_table import best_similarity, compare, poses_of

COLUMNS = ("precision", "precision where known", "recall", "free found", "wrong free")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kitchen", type=Path, nargs="?")
    parser.add_argument("--seeds", type=int, default=0, help="generated rooms")
    parser.add_argument("--first", type=int, default=510)
    parser.add_argument("--frames", type=int, default=100)
    parser.add_argument("--work", type=Path, default=Path("OUT-photos"))
    parser.add_argument("--ways", default="posed,unposed,posed-sgbm,unposed-sgbm")
    parser.add_argument("--every", type=int, default=1, help="take each n-th frame of the kitchen")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args()
    ways, told = chosen.ways.split(","), {}
    print(" ".join([f"{'capture':24}", *(f"{name[:16]:>16}" for name in COLUMNS)]), end="")
    print(f"{'scale':>9}{'CPU s':>8}{'wall s':>8}{'MB':>7}")
    if chosen.kitchen:
        folder = chosen.work / "kitchen"
        kitchen_inputs(chosen.kitchen, folder, chosen.every)
        told["kitchen"] = report("kitchen", folder, ways)
    rows = []
    for seed in range(chosen.first, chosen.first + chosen.seeds):
        folder = chosen.work / f"room-{seed}"
        room_inputs(seed, folder, chosen.frames)
        told[f"room {seed}"] = report(f"room {seed}", folder, ways)
        rows.append(told[f"room {seed}"])
    for way in ways if rows else ():
        mine = [row[way] for row in rows if way in row]
        mean = {name: float(np.mean([row[name] for row in mine])) for name in COLUMNS}
        told.setdefault("mean", {})[way] = mean
        print(" ".join([f"{'mean, ' + way:24}", *(f"{mean[name]:16.3f}" for name in COLUMNS)]))
    if chosen.json:
        chosen.json.write_text(json.dumps(told, indent=1) + "\n")


def report(name: str, folder: Path, ways: list[str]) -> dict[str, dict[str, float]]:
    """Reconstruct the inputs in a folder in all ways; print and return the figures of each."""
    reference = folder / "out-depth"
    if not (reference / "room.npz").is_file():
        run(["reconstruct", str(folder / "depth"), "--out", str(reference)], "ours")
    true = poses_of(reference / "poses.json") if (reference / "poses.json").is_file() else None
    true = true or json_poses(folder)
    rows = {}
    for way in ways:
        kind, _, stereo = way.partition("-")
        out = folder / f"out-{way}"
        words = ["reconstruct", str(folder / kind), "--out", str(out)]
        cost = run(words, stereo or "ours")
        if cost is None:
            print(f"{name + ', ' + way:24} failed")
            continue
        carry, scale = None, 0.0
        if kind == "unposed":
            found = poses_of(out / "capture" / "capture.json")
            carry = best_similarity(found, true)
            scale = np.linalg.det(carry[:3, :3]) ** (1 / 3)
        row = rows[way] = compare(reference, out, carry)
        cells = " ".join(f"{row[column]:16.3f}" for column in COLUMNS)
        off = f"{100 * (1 / scale - 1):+8.1f}%" if scale else " " * 9
        row |= dict(zip(("CPU s", "wall s", "MB"), cost, strict=True))
        row |= {"scale off": abs(1 / scale - 1)} if scale else {}
        print(f"{name + ', ' + way:24} {cells}{off}{cost[0]:8.0f}{cost[1]:8.0f}{cost[2]:7.0f}")
    return rows


def json_poses(folder: Path) -> dict[str, np.ndarray]:
    """Return the true poses by frame that ``photo_inputs`` wrote."""
    rows = json.loads((folder / "poses.json").read_text())
    return {name: np.array(pose) for name, pose in rows.items()}


def run(words: list[str], stereo: str) -> tuple[float, float, float] | None:
    """Run ``w2m`` in a process of its own; return CPU s, wall s and peak MB, None on failure."""
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    command = [sys.executable, "-m", "benchmarks.photo_runs", stereo, *words]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    wall = time.perf_counter() - begun
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        print(done.stderr.strip().splitlines()[-1])
        return None
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    memory = json.loads((Path(words[words.index("--out") + 1]) / "run.json").read_text())
    return cpu, wall, memory["peak_memory_mb"]


if __name__ == "__main__":
    main()

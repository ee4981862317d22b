"""Make the virtual scans on which the completion network is trained, five samples per room.

``python -m benchmarks.make_completion_samples --out FOLDER [--first 10000 --rooms 500]``

Each room is one file named by its seed; existing files are skipped, so that an interrupted run
continues.
"""

import argparse
import time
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.networks.completion.samples import FIRST_SEED, make_samples, write_samples


def main() -> None:
    """Write the files and say what they are like."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--first", type=int, default=FIRST_SEED)
    parser.add_argument("--rooms", type=int, default=500)
    chosen = parser.parse_args()
    chosen.out.mkdir(parents=True, exist_ok=True)
    false: dict[str, list[float]] = {}
    for seed in range(chosen.first, chosen.first + chosen.rooms):
        path = chosen.out / f"{seed}.npz"
        if path.exists():
            continue
        start = time.process_time()
        try:
            samples = make_samples(seed)
        except World2MinecraftError as error:
            print(f"{seed} left out: {error}", flush=True)
            continue
        write_samples(path, samples)
        for sample in samples:
            false.setdefault(sample.kind, []).append(sample.false_share)
        shares = ", ".join(f"{kind} {np.mean(values):.3f}" for kind, values in false.items())
        print(f"{seed} {time.process_time() - start:.2f} CPU s; false: {shares}", flush=True)


if __name__ == "__main__":
    main()

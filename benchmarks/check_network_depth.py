"""What the jitter of a depth network costs, and what evening it out brings back.

``python -m benchmarks.check_network_depth [TRIAL ...] [--off 0.05]`` takes virtual scans without
noise (``noise-500-clean`` where none is named), makes each frame's depth too large or too small by
up to ``--off``, each frame its own way, and fuses them: as they come, and registered first. Printed
are, against the map of the untouched depth, the share of found cells that lie within one voxel of
a true one, of true cells within one voxel of a found one, and of exact agreement (IoU).
"""

import argparse
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy import ndimage

from world2minecraft.fuse import fuse_views, read_out
from world2minecraft.live import placed_scan
from world2minecraft.occupy import predictor
from world2minecraft.parameters import Parameters
from world2minecraft.register import corrected, register
from world2minecraft.rooms.trials import trial_named, write_trial
from world2minecraft.types import Scan, ViewStream

AROUND = ndimage.generate_binary_structure(3, 3)


@dataclass(eq=False)
class JitteredViews:
    """Views whose depth is off by a factor of each frame's own."""

    views: ViewStream
    factors: np.ndarray

    def __len__(self) -> int:
        return len(self.views)

    def __iter__(self):
        for view, factor in zip(self.views, self.factors, strict=True):
            yield replace(view, depth_m=view.depth_m * np.float32(factor))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("trials", nargs="*", default=["noise-500-clean"])
    parser.add_argument("--off", type=float, default=0.05)
    parser.add_argument("--seeds", type=int, default=3)
    chosen = parser.parse_args()
    print(f"{'trial, seed, way':40}{'precision':>10}{'recall':>10}{'IoU':>10}")
    for name in chosen.trials:
        with tempfile.TemporaryDirectory() as work:
            capture = Path(work) / name
            write_trial(trial_named(name), capture)
            scan = placed_scan(capture, Parameters())
            true = occupied(scan)
            for seed in range(chosen.seeds):
                report(f"{name}, {seed}", jittered(scan, chosen.off, seed), true)


def report(name: str, scan: Scan, true: np.ndarray) -> None:
    """Print the rows of one jitter."""
    rules = Parameters().register.suited("network")
    ways = {"as it comes": scan, "registered": corrected(scan, register(scan, rules).corrections)}
    for way, one in ways.items():
        figures = "".join(f"{value:10.3f}" for value in compared(occupied(one), true))
        print(f"{name + ', ' + way:40}{figures}", flush=True)


def jittered(scan: Scan, off: float, seed: int) -> Scan:
    """Return a scan whose frames are off by -off to +off, evenly, in a random order."""
    rng = np.random.default_rng(seed)
    factors = 1 + off * rng.permutation(np.linspace(-1, 1, len(scan.views)))
    return replace(scan, views=JitteredViews(scan.views, factors), depth_kind="network")


def occupied(scan: Scan) -> np.ndarray:
    """Return the occupied cells of a scan's map, int [N, 3] of the room."""
    rules = Parameters().fuse.suited("network")
    fused = fuse_views(predictor("depth").predict(scan), scan, rules)
    low = np.round(fused.origin_m / fused.voxel_m).astype(int)
    return np.argwhere(read_out(fused).occupied) + low


def compared(found: np.ndarray, true: np.ndarray) -> tuple[float, float, float]:
    """Return precision and recall within one voxel, and exact IoU."""
    low = np.minimum(found.min(axis=0), true.min(axis=0)) - 1
    shape = np.maximum(found.max(axis=0), true.max(axis=0)) - low + 2
    here, there = np.zeros(shape, bool), np.zeros(shape, bool)
    here[tuple((found - low).T)] = True
    there[tuple((true - low).T)] = True
    near_here, near_there = (ndimage.binary_dilation(grid, AROUND) for grid in (here, there))
    iou = (here & there).sum() / (here | there).sum()
    return float(near_there[here].mean()), float(near_here[there].mean()), float(iou)


if __name__ == "__main__":
    main()

"""Exports to NYUv2 and OccScanNet, read back by independent loaders.

``python -m benchmarks.check_exports [DATA] [--json FILE]``

A data set (by default 40 views of four generated houses) is exported and read again by a loader
written only from the published description of the formats
(``tests/minecraftocc/exchange/page_loader.py``): their axis orders, their ``vox2pix``, their
intrinsics. Reported are the cells whose label or projection differs from the store's (the box of
NYUv2 is the region; that of OccScanNet follows the room's axes), and the share of the region's
pixels whose depth leads, by the loader's arithmetic, to the label given by the store's own
geometry. The exit code is 1 if any label differs.
"""

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from tests.minecraftocc.exchange import page_loader

from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.files import read_json, write_json
from world2minecraft.minecraftocc.building import build_dataset
from world2minecraft.minecraftocc.engine import open_engine
from world2minecraft.minecraftocc.exporters import export_samples
from world2minecraft.minecraftocc.formats.label_grids import cells_behind_depth
from world2minecraft.minecraftocc.plan import house_scenes, plan_dataset
from world2minecraft.minecraftocc.store import open_store
from world2minecraft.minecraftocc.types import OccSample

HOUSES, IMAGES = 4, 40
NUDGE_M = 0.02  # Behind a surface, as far as ``cells_behind_depth`` looks.
Load = Callable[[OccSample], page_loader.Loaded]


def count(sample: OccSample, loaded: page_loader.Loaded, matrix: np.ndarray, sums: Counter) -> None:
    """Add up what a loader finds of one sample."""
    occ, same_box = sample.occ, matrix is page_loader.NYU_K
    sums["pictures"] += 1
    if same_box:
        sums["cells"] += occ.labels.size
        sums["labels that differ"] += int((loaded.target != occ.labels).sum())
        sums["cells in view or not, otherwise"] += int((loaded.in_view != occ.in_frustum).sum())
    found = page_loader.first_seen_labels(loaded, matrix, nudge_m=NUDGE_M)
    assert sample.depth_m is not None
    camera_to_region = invert_rigid(occ.region.region_to_room) @ sample.camera_to_room
    pixels, cells = cells_behind_depth(sample.depth_m, sample.camera, occ.region, camera_to_region)
    sums["pixels"] += len(pixels)
    own = occ.labels[tuple(cells.T)]
    sums["pixels with the same label"] += int((found.reshape(-1)[pixels] == own).sum())


def check(name: str, samples: list[OccSample], load: Load, console: Console) -> Counter:
    """Count all samples of one format, print the table; return the counts."""
    sums: Counter = Counter()
    for sample in samples:
        loaded = load(sample)
        count(sample, loaded, loaded.stored.get("K", page_loader.NYU_K), sums)
    table = Table(name, "", box=None)
    for what, number in sums.items():
        table.add_row(what, f"{number:,}")
    console.print(table, "")
    return sums


def main() -> int:
    """Print the tables; return the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("data", nargs="?", type=Path, help="a data set with pictures")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args()
    data = chosen.data
    with tempfile.TemporaryDirectory() as place:
        if data is None:
            data = Path(place) / "DATA"
            with open_engine("pool", 2) as engine:
                build_dataset(data, plan_dataset(house_scenes(HOUSES), IMAGES), engine)
        samples = list(open_store(data).samples())
        nyu, scans = Path(place) / "nyu", Path(place) / "occscannet"
        export_samples(samples, "nyu", nyu)
        export_samples(samples, "occscannet", scans)
        rows = read_json(scans / "names.json")  # scene, frame, ...
        loads: dict[str, Load] = {
            "nyu": lambda sample: page_loader.load_nyu(nyu, sample.split, sample.key),
            "occscannet": lambda sample: page_loader.load_occscannet(
                scans, "gathered_data/{}/{}.pkl".format(*rows[sample.key])
            ),
        }
        console = Console(width=110)
        counts = {name: check(name, samples, load, console) for name, load in loads.items()}
    if chosen.json:
        write_json(chosen.json, counts)
    return int(any(sums["labels that differ"] for sums in counts.values()))


if __name__ == "__main__":
    sys.exit(main())

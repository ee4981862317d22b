"""A block map alone against the truth of generated houses, block by block.

``python -m benchmarks.check_blockmap [--houses 12 --seed 300 --scale 4 --worlds WORLDS]``

The houses are made here, or read from a folder of ``w2m rooms generate --houses``. The map sees
blocks and scale, and nothing of the truth. Blocks that show nothing (light, barriers) are left out,
and those that the truth leaves open, such as gardens.
"""

import argparse
import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from world2minecraft.classes import (
    CLASS_COUNT,
    CLASS_NAMES,
    OBJECT_CLASSES,
    STRUCTURE_CLASSES,
    UNKNOWN,
)
from world2minecraft.dataset.blockmap import BlockMap, classify, load_block_map
from world2minecraft.dataset.source import open_scene_source
from world2minecraft.rooms.worlds.making import generate_world
from world2minecraft.types import BlockVolume

ROOMS = (5, 6, 7, 8)


def main() -> None:
    """Print a row for each house, then precision, recall and IoU of each class over all."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--houses", type=int, default=12)
    parser.add_argument("--seed", type=int, default=300)
    parser.add_argument("--scale", type=float, default=4.0, help="blocks per metre")
    parser.add_argument("--map", default="nyu")
    parser.add_argument("--worlds", type=Path)
    chosen = parser.parse_args()
    rules = load_block_map(chosen.map)
    console = Console(width=None if os.isatty(1) else 120)
    table = Table("house", "blocks a metre", "blocks", "agree", "structure", "objects")
    total = np.zeros((CLASS_COUNT, CLASS_COUNT), np.int64)
    for name, volume in houses(chosen.worlds, chosen.seed, chosen.houses, chosen.scale):
        counts = confusion(volume, rules)
        total += counts
        scale = f"{volume.blocks_per_metre:.0f}"
        table.add_row(name, scale, f"{counts.sum():,}", *(f"{v:.3f}" for v in shares(counts)))
    table.add_row("all", "", f"{total.sum():,}", *(f"{value:.3f}" for value in shares(total)))
    console.print(table)
    console.print(by_class(total))


def houses(
    worlds: Path | None, seed: int, count: int, scale: float
) -> Iterator[tuple[str, BlockVolume]]:
    """Yield the houses with their truth: those of a folder, or made from seeds."""
    if worlds is not None:
        for folder in sorted(worlds.glob("house_*")):
            yield folder.name, open_scene_source(folder).volume()
        return
    for number in range(seed, seed + count):
        rooms, storeys = ROOMS[number % len(ROOMS)], 1 + number % 2
        made = generate_world(number, rooms=rooms, storeys=storeys, blocks_per_metre=scale)
        yield str(number), made.volume


def confusion(volume: BlockVolume, rules: BlockMap) -> np.ndarray:
    """Return how many blocks of each class of the truth, rows, the map says are of each class."""
    told = classify(volume, rules).semantic
    known = (volume.semantic > 0) & (volume.semantic != UNKNOWN)
    counts = np.zeros((CLASS_COUNT, CLASS_COUNT), np.int64)
    np.add.at(counts, (volume.semantic[known], told[known]), 1)
    return counts


def shares(counts: np.ndarray) -> tuple[float, float, float]:
    """Return the share of blocks that agree: of all, of structure, of objects."""
    right = np.diag(counts)
    parts = (slice(None), list(STRUCTURE_CLASSES), list(OBJECT_CLASSES))
    all_, structure, objects = (right[p].sum() / max(counts[p].sum(), 1) for p in parts)
    return float(all_), float(structure), float(objects)


def by_class(counts: np.ndarray) -> Table:
    """Return a table of the classes."""
    table = Table("class", "blocks", "precision", "recall", "IoU", "taken for most")
    for number in (*STRUCTURE_CLASSES, *OBJECT_CLASSES):
        right, truth, told = counts[number, number], counts[number].sum(), counts[:, number].sum()
        others = np.where(np.arange(CLASS_COUNT) == number, 0, counts[number])
        most = CLASS_NAMES[int(others.argmax())] if others.any() else ""
        values = (right / max(told, 1), right / max(truth, 1), right / max(truth + told - right, 1))
        table.add_row(CLASS_NAMES[number], f"{truth:,}", *(f"{v:.3f}" for v in values), most)
    return table


if __name__ == "__main__":
    main()

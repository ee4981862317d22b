"""Names of the labelled surface of real frames: of objects, of votes, and of the segmenter.

``python -m benchmarks.check_surface_names DATA --keep DIR [--frames 22] [--json FILE]``

``DATA`` is the folder of shared inputs. Validation frames of NYUv2 are reconstructed once. A
labelled pixel takes the best name of the object in whose cell it lies, or the class of a cell of
the structure, or of those that touch it if it is empty. Printed is the share of pixels whose NYU40
class is the labelled one, beside those of the class with the most votes in the cell, and of the
segmentation network alone, which sees the same picture. Other props are left out. Classes that
annotators do not separate count as the same with ``--alike``.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.fit_name_confidence import best_names, labelled_surface, run_frame
from benchmarks.real_captures.scenes import NYU_FOLDER, sample_nyu
from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.files import write_json
from world2minecraft.core.types import UNSEEN, OccupancyGrid
from world2minecraft.core.vocabulary import OTHER_NYU40, alike_nyu40, read_vocabulary
from world2minecraft.reconstruction.naming.name_votes import (
    NAME_VOTES,
    NameVotes,
    class_votes,
    read_name_votes,
    votes_of_cells,
)
from world2minecraft.reconstruction.recognition.segmentation import SegmentationModel
from world2minecraft.reconstruction.recognition.segmentation_channels import sample_nearest

NEAR = np.stack(np.meshgrid(*[[-1, 0, 1]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
STRUCTURE = ("ceiling", "floor", "wall", "window")
KINDS = ("names", "votes", "segmenter")


def named_cells(grid: OccupancyGrid, names: dict[int, str]) -> np.ndarray:
    """Return the NYU40 id of the name of each cell, uint8 [X, Y, Z]; 0 where nothing has a name."""
    vocabulary = read_vocabulary().names
    ids = np.zeros(grid.shape, np.uint8)
    for name in STRUCTURE:
        ids[grid.labels == CLASS_NAMES.index(name)] = vocabulary[name].nyu40
    for number, name in names.items():
        ids[grid.instance == number] = vocabulary[name].nyu40
    ids[grid.source == UNSEEN] = 0
    return ids


def voted_cells(grid: OccupancyGrid, votes: NameVotes) -> np.ndarray:
    """Return the NYU40 id with the most votes in each cell, uint8 [X, Y, Z]; 0 without votes."""
    ids = np.zeros(grid.shape, np.uint8)
    cells, rows = votes_of_cells(votes, grid)
    ids[tuple(cells.T)] = class_votes(rows).argmax(axis=1) + 1
    return ids


def names_at(ids: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Return the ids at cells int [N, 3], or the most frequent one that touches an unnamed cell."""
    padded = np.pad(ids, 1)
    near = np.stack([padded[tuple((cells + 1 + step).T)] for step in NEAR], axis=1)
    found = padded[tuple((cells + 1).T)].astype(np.int64)
    for index in np.flatnonzero(found == 0):
        counts = np.bincount(near[index], minlength=2)
        found[index] = counts[1:].argmax() + 1 if counts[1:].any() else 0
    return found


def right_share(found: np.ndarray, true: np.ndarray, *, alike: bool) -> float:
    """Return the share of NYU40 ids that are right, int [N] each."""
    right = found == true
    if alike:
        for number in np.unique(true):
            right |= (true == number) & np.isin(found, list(alike_nyu40(int(number))))
    return float(right.mean())


def frame_shares(data: Path, folder: Path, number: int, *, alike: bool) -> list[float]:
    """Return the share of right pixels of a frame by ``KINDS``."""
    run = run_frame(data, folder, number)
    grid, found = best_names(run)
    surface = labelled_surface(data, folder, number, grid)
    named = named_cells(grid, {one.item.id: one.name for one in found})
    voted = voted_cells(grid, read_name_votes(run / NAME_VOTES))
    view = surface.view
    probability = SegmentationModel().predict(view.colour, view.depth_m, view.depth_camera)
    height, width = view.depth_m.shape
    likely = sample_nearest(probability.argmax(axis=2) + 1, width, height).reshape(-1)
    known = surface.nyu40 != OTHER_NYU40
    kinds = (names_at(named, surface.cells), names_at(voted, surface.cells), likely[surface.pixels])
    return [right_share(one[known], surface.nyu40[known], alike=alike) for one in kinds]


def told(shares: Sequence[float]) -> str:
    """Return the shares of ``KINDS`` in words."""
    return ", ".join(f"{kind} {share:.3f}" for kind, share in zip(KINDS, shares, strict=True))


def main() -> None:
    """Print a row for each frame, and the means."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("data", type=Path)
    parser.add_argument("--keep", type=Path, required=True, metavar="DIR")
    parser.add_argument("--frames", type=int, default=22)
    parser.add_argument("--alike", action="store_true")
    parser.add_argument("--json", type=Path, help="write the means to this file")
    chosen = parser.parse_args()
    rows = []
    for number in sample_nyu(chosen.data / NYU_FOLDER, chosen.frames):
        rows.append(frame_shares(chosen.data, chosen.keep, number, alike=chosen.alike))
        print(f"{number:04d}: {told(rows[-1])}", flush=True)
    means = np.mean(rows, axis=0).tolist()
    print(f"mean: {told(means)}")
    if chosen.json:
        write_json(chosen.json, dict(zip(KINDS, means, strict=True)))


if __name__ == "__main__":
    main()

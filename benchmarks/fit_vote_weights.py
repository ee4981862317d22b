"""Compare weights of the segmentation network's votes on NYUv2 frames kept from its training.

``python -m benchmarks.fit_vote_weights DATA --out DIR [--frames 19]``

``DATA`` is the folder of shared inputs. Each frame is lifted with its depth and fused once without
and once with votes; then its cells are labelled with each set of weights. Printed are the mean
class accuracy of the visible surface and the change in the worst frame beside no votes.
"""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.real_captures.running import score_labelled_frame
from benchmarks.real_captures.scenes import NYU_FOLDER, nyu_scene, read_nyu_classes
from world2minecraft.capture import realign
from world2minecraft.core.types import FusedEvidence, Scan
from world2minecraft.networks.segmentation.frames import nyu_part
from world2minecraft.reconstruction.fusion import (
    close_structure,
    extract_grid,
    fuse_views,
    remove_floaters,
)
from world2minecraft.reconstruction.occupancy import OccupancyParameters, predictor
from world2minecraft.reconstruction.opening import prepare_and_open
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.registration import apply_corrections, register
from world2minecraft.reconstruction.semantics import votes_labeller
from world2minecraft.reconstruction.semantics.completion_labeller import (
    CompletionLabeller,
    CompletionParameters,
)


class Weights(NamedTuple):
    """Weights beside the shares of the votes.

    Attributes:
        structure: Weight of a geometric label of structure.
        thing: Weight of a geometric label of a thing.
        on_wall: Subtracted from the share of objects in cells of walls.
        network: Weight of the completion network's probabilities.
    """

    structure: float
    thing: float
    on_wall: float
    network: float


TRIED = (
    *(Weights(0.5, 0.15, 0.0, network) for network in (0.2, 0.5)),
    *(Weights(structure, 0.05, 0.0, 0.2) for structure in (0.1, 0.2, 0.3)),
    *(Weights(0.1, 0.05, on_wall, 0.2) for on_wall in (0.3, 0.4)),
    *(Weights(0.1, 0.05, 0.4, network) for network in (0.4, 0.6, 0.8)),
    *(Weights(structure, 0.05, 0.6, 0.6) for structure in (0.2, 0.3)),
)


class Frame(NamedTuple):
    """A frame with its evidence without and with votes.

    Attributes:
        number: Number of the frame.
        scan: Registered scan.
        plain: Evidence without votes.
        voted: Evidence with votes.
    """

    number: int
    scan: Scan
    plain: FusedEvidence
    voted: FusedEvidence


def registered_frame(data: Path, out: Path, number: int) -> Scan:
    """Lift a frame with its depth and align it with its floor and walls."""
    chosen = Parameters()
    capture = nyu_scene(number).prepare(data, out / f"capture-{number}")
    scan = prepare_and_open(capture, out / f"run-{number}", chosen)
    found = register(scan, chosen.register.suited(scan.depth_kind))
    return realign(apply_corrections(scan, found.corrections), found.surface)


def fused(scan: Scan, semantics: str) -> FusedEvidence:
    """Fuse a registered frame, with the votes of a segmentation network or ``none``."""
    views = predictor("depth", OccupancyParameters(semantics=semantics)).predict(scan)
    return fuse_views(views, scan, Parameters().fuse.suited(scan.depth_kind))


def fused_frame(data: Path, out: Path, number: int) -> Frame:
    """Register and fuse a frame."""
    scan = registered_frame(data, out, number)
    plain, voted = (fused(scan, name) for name in ("none", "nyu"))
    return Frame(number, replace(scan, scan_to_room=plain.scan_to_room), plain, voted)


@contextmanager
def used(weights: Weights) -> Iterator[CompletionLabeller]:
    """Yield a labeller that uses weights while the context lasts."""
    names = ("NETWORK_STRUCTURE_PRIOR", "NETWORK_OBJECT_PRIOR", "ON_WALL_PENALTY")
    before = {name: getattr(votes_labeller, name) for name in names}
    try:
        for name, value in zip(names, weights, strict=False):
            setattr(votes_labeller, name, value)
        yield CompletionLabeller(CompletionParameters(beside_network=weights.network))
    finally:
        for name, value in before.items():
            setattr(votes_labeller, name, value)


def class_accuracy(
    frame: Frame, evidence: FusedEvidence, labeller: CompletionLabeller, truth: np.ndarray
) -> float:
    """Return the share of the visible surface of a frame that has its true class."""
    clean = Parameters().clean
    grid = remove_floaters(extract_grid(evidence), clean)
    grid = close_structure(labeller.label(grid, evidence), clean)
    return float(score_labelled_frame(truth, grid, frame.scan)["class_accuracy"])


def main() -> None:
    """Label every frame with every set of weights and print the figures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("data", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--frames", type=int, help="the first so many only")
    chosen = parser.parse_args()
    labels = sorted((chosen.data / NYU_FOLDER).glob("*.label40.png"))
    labels = [path for path in labels if nyu_part(int(path.name[:4])) == "calibration"]
    rows = []
    for path in labels[: chosen.frames]:
        frame = fused_frame(chosen.data, chosen.out, int(path.name[:4]))
        truth = read_nyu_classes(path)
        row = [class_accuracy(frame, frame.plain, CompletionLabeller(), truth)]
        for weights in TRIED:
            with used(weights) as labeller:
                row.append(class_accuracy(frame, frame.voted, labeller, truth))
        rows.append(row)
        print(frame.number, " ".join(f"{value:.3f}" for value in row), flush=True)
    table = np.array(rows)
    print(f"no votes {table[:, 0].mean():.3f}")
    for weights, column in zip(TRIED, table.T[1:], strict=True):
        worst = (column - table[:, 0]).min()
        print(f"{weights}: mean {column.mean():.3f}, worst change {worst:+.3f}")


if __name__ == "__main__":
    main()

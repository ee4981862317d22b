"""Sweeps of what decides objects: k, tau, eta, min_samples, min_cells (find), min_iou (furnish).

``python -m benchmarks.sweep_find [--trials 2] [--keep FOLDER] [--image FILE.svg]``

Tuning trials are scanned and reconstructed once for each labeller (with ``--keep`` only where the
folder lacks them); then the stage alone is run again for each value. Printed for each value:

- object F1, and the share of chairs, sofas and beds turned right;
- leftover: the share of the object cells that belong to no object;
- pieces: found objects that match none and lie within a true object of their class (parted too
  much), and merged: true objects that were not found and lie within a found one of their class
  (parted too little), each as a share of the true objects.

The last table puts the paper's steps alone beside all of them.
"""

import argparse
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.check_faithful import LABELLERS, run_trial
from benchmarks.curves import write_curves
from world2minecraft.classes import OBJECT_CLASSES
from world2minecraft.evaluate.frames import used_frames
from world2minecraft.evaluate.objects import TrueObjects, object_counts
from world2minecraft.evaluate.score import see_truth
from world2minecraft.evaluate.truth import read_truth
from world2minecraft.exchange.room import read_room
from world2minecraft.find import FindParameters, find_objects
from world2minecraft.furnish import FurnishParameters, furnish
from world2minecraft.metrics.objects import ObjectCounts, match_objects
from world2minecraft.rooms.trials import DIFFICULTIES, trials
from world2minecraft.types import OccupancyGrid

FIND: dict[str, tuple[float, ...]] = {
    "density_kernel": (1, 3, 5),
    "density_threshold": (0.0, 0.1, 0.2, 0.3, 0.4),
    "cluster_radius": (1.0, 1.5, 2.0, 3.0, 4.0),
    "min_samples": (1, 2, 4, 8, 14),
    "min_cells": (2, 5, 8, 12, 16),
}
MIN_IOU = (0.3, 0.4, 0.5, 0.6)
TITLES = {
    "density_kernel": "k, cells",
    "density_threshold": "tau, share",
    "cluster_radius": "eta, cells",
    "min_samples": "min_samples",
    "min_cells": "min_cells",
}


@dataclass(frozen=True)
class Case:
    """One grid before its objects are found, and the true ones in its frame."""

    labels: str
    grid: OccupancyGrid
    true: TrueObjects


@dataclass(frozen=True)
class Figures:
    """Sums over cases."""

    counts: ObjectCounts
    leftover: int = 0
    cells: int = 0
    pieces: int = 0
    merged: int = 0

    def shares(self) -> dict[str, float]:
        """Return what is printed."""
        true = max(int(self.counts.true.sum()), 1)
        return {
            "F1": self.counts.f1,
            "turned right": self.counts.orientation_right,
            "leftover": self.leftover / max(self.cells, 1),
            "pieces": self.pieces / true,
            "merged": self.merged / true,
        }


def cases(base: Path, count: int) -> Iterator[Case]:
    """Make what is missing and give the cases."""
    for difficulty in DIFFICULTIES:
        for trial in trials("tune", difficulty)[:count]:
            run_trial(trial, base, LABELLERS, [], False)
            for labels in LABELLERS:
                out = base / trial.name / labels
                grid, scan_to_room = read_room(out / "room.npz")
                truth = read_truth(base / trial.name / "capture")
                frames = used_frames(out, truth)
                room = see_truth(truth, frames, scan_to_room, grid.voxel_m)
                yield Case(labels, grid, room.objects)


def found_figures(some: Sequence[Case], chosen: FindParameters) -> Figures:
    """Find the objects of some cases and count."""
    total = Figures(ObjectCounts())
    for case in some:
        found = find_objects(case.grid, chosen)
        true = [o for o, seen in zip(case.true.objects, case.true.seen, strict=True) if seen]
        matches = match_objects(found.instances, true)
        spare = [o for n, o in enumerate(found.instances) if n not in {m for m, _ in matches}]
        missed = [o for n, o in enumerate(true) if n not in {m for _, m in matches}]
        total = Figures(
            total.counts + object_counts(found.instances, case.true),
            total.leftover + found.leftover,
            total.cells + int(np.isin(case.grid.labels, OBJECT_CLASSES).sum()),
            total.pieces + sum(_within(one, true) for one in spare),
            total.merged + sum(_within(one, found.instances) for one in missed),
        )
    return total


def _within(one: Any, others: Sequence[Any]) -> bool:
    """Tell whether the middle of an object lies in the upright box of another of its class."""
    for other in others:
        if other is not one and other.class_id == one.class_id:
            angle = np.radians(other.yaw_deg)
            away = one.center_m - other.center_m
            along = away[0] * np.cos(angle) + away[1] * np.sin(angle)
            aside = away[1] * np.cos(angle) - away[0] * np.sin(angle)
            if (np.abs([along, aside, away[2]]) <= other.size_m / 2).all():
                return True
    return False


def placed_shares(some: Sequence[Case], min_iou: float) -> dict[str, float]:
    """Furnish what was found in some cases: F1 of the placements, and how many are templates."""
    total, templates, placements = ObjectCounts(), 0, 0
    for case in some:
        found = find_objects(case.grid)
        chosen = FurnishParameters(min_iou=min_iou)
        placed = furnish(found.grid, found.instances, chosen)
        total = total + object_counts(placed, case.true)
        templates += sum(one.template != "cells" for one in placed)
        placements += len(placed)
    shares = {"F1": total.f1, "turned right": total.orientation_right}
    return {**shares, "templates": templates / max(placements, 1)}


def sweep(every: Sequence[Case], table: Table) -> list[tuple]:
    """Run all sweeps, fill the table and return the panels of the picture."""
    panels = []
    for name, values in FIND.items():
        curves: dict[str, list[float]] = {}
        for labels in LABELLERS:
            some = [case for case in every if case.labels == labels]
            for value in values:
                kind = type(getattr(FindParameters(), name))
                chosen = replace(FindParameters(), **{name: kind(value)})
                shares = found_figures(some, chosen).shares()
                _row(table, name, value, labels, shares)
                curves.setdefault(f"F1, {labels}", []).append(shares["F1"])
        panels.append((TITLES[name], values, curves, getattr(FindParameters(), name)))
    curves = {}
    for labels in LABELLERS:
        some = [case for case in every if case.labels == labels]
        for value in MIN_IOU:
            shares = placed_shares(some, value)
            _row(table, "min_iou", value, labels, shares)
            curves.setdefault(f"F1, {labels}", []).append(shares["F1"])
            if labels == "votes":
                curves.setdefault("templates, votes", []).append(shares["templates"])
    return [*panels, ("min_iou", MIN_IOU, curves, FurnishParameters().min_iou)]


def _row(table: Table, name: str, value: Any, labels: str, shares: dict[str, float]) -> None:
    keys = ("F1", "turned right", "leftover", "pieces", "merged", "templates")
    cells = (f"{shares[key]:.3f}" if key in shares else "" for key in keys)
    table.add_row(name, f"{value:g}" if not isinstance(value, str) else value, labels, *cells)


def main() -> None:
    """Print a row for each value and labeller, and write the curves."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--trials", type=int, default=2, help="of each difficulty")
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--image", type=Path)
    chosen = parser.parse_args()
    base = chosen.keep or Path(tempfile.mkdtemp())
    every = list(cases(base, chosen.trials))
    heads = ("parameter", "value", "labels", "F1", "turned right", "leftover", "pieces", "merged")
    table = Table(*heads, "templates")
    for labels in LABELLERS:
        some = [case for case in every if case.labels == labels]
        for method in ("paper", "best"):
            steps = FindParameters(paper_compat=method == "paper")
            _row(table, "method", method, labels, found_figures(some, steps).shares())
    panels = sweep(every, table)
    Console(width=120).print(table)
    if chosen.image:
        write_curves(chosen.image, panels)


if __name__ == "__main__":
    main()

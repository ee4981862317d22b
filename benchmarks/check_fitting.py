"""Shape fitting on generated rooms, against plain cubes at their best threshold in the same run.

``python -m benchmarks.check_fitting [--first 2000 --rooms 20 --scales 1,2,4,12.5 --pictures DIR]
[--json FILE]``

Rows: the furniture of a whole room where it stands, from 2 cm voxels and from 8 cm cells; then
every object in its own frame, in its snapped place. ``--pictures`` writes a page for each scale:
the same rooms built of cubes and of the calm set, side by side.
"""

import argparse
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks import fitting_pages
from benchmarks.fitting_rooms import (
    ALL,
    CUBES,
    Score,
    coarse,
    cubes_at,
    fine,
    fit_object,
    fit_room,
    furniture_of,
    judge_room,
    objects_of,
    solid,
)
from world2minecraft.files import write_json
from world2minecraft.rooms import generate_room

THRESHOLDS = (0.1, 0.3, 0.5, None)
EXACT = 12.5
# What was asked for: IoU from 2 cm, from 8 cm, thin recall, IoU of an object.
TARGETS = {
    1.0: (0.37, 0.36, 0.12, 0.19),
    2.0: (0.54, 0.52, 0.30, 0.35),
    4.0: (0.68, 0.62, 0.50, 0.49),
    EXACT: (0.88, 1.0, 0.85, None),
}
Rows = dict[tuple[float, str], list[Score]]


def check_room(seed: int, scales: list[float], rows: Rows) -> None:
    """Add what one room reaches to the rows."""
    room = generate_room(seed)
    truth = solid(furniture_of(room))
    cells = coarse(truth.filled)
    for scale in scales:
        cubes = cubes_at(truth, scale)
        for threshold in THRESHOLDS:
            name = "cubes, volume rule" if threshold is None else f"cubes {threshold}"
            rows[scale, name].append(judge_room(cubes(threshold), CUBES, truth, scale))
        grid, seconds = fit_room(truth, scale)
        rows[scale, "room from 2 cm"].append(judge_room(grid, ALL, truth, scale, seconds))
        grid, seconds = fit_room(cells, scale)
        rows[scale, "room from 8 cm"].append(judge_room(grid, ALL, fine(cells), scale, seconds))
        if scale != EXACT:
            _check_objects(room, scale, rows)


def _check_objects(room, scale: float, rows: Rows) -> None:
    for name, shapes in (("object, cubes", CUBES), ("object, fitted", ALL)):
        scores = [fit_object(one, above, scale, shapes) for one, above in objects_of(room)]
        means = np.mean([(one.iou, one.thin) for one in scores], axis=0)
        sums = np.sum([one[2:] for one in scores], axis=0)
        iou, thin = means.tolist()
        rows[scale, name].append(Score(iou, thin, int(sums[0]), int(sums[1]), float(sums[2])))


def table(rows: Rows) -> Table:
    """Return the means over the rooms; of what is counted, the sums."""
    page = Table("scale", "what", "IoU", "asked", "thin", "asked", "falls", "loose", "CPU s")
    for (scale, name), scores in sorted(rows.items()):
        mean = np.mean(scores, axis=0)
        asked, thin = _asked(scale, name)
        counts = [str(sum(one[index] for one in scores)) for index in (2, 3)]
        cells = [f"{scale:g}", name, f"{mean[0]:.3f}", asked, f"{mean[1]:.2f}", thin, *counts]
        page.add_row(*cells, f"{mean[4]:.2f}" if mean[4] else "")
    return page


def figures(rows: Rows) -> list[dict[str, Any]]:
    """Return the table's figures: means over the rooms; of what is counted, the sums."""
    told = []
    for (scale, name), scores in sorted(rows.items()):
        mean = Score(*np.mean(scores, axis=0).tolist())
        counts = {key: sum(getattr(one, key) for one in scores) for key in ("unstable", "loose")}
        told.append({"scale": scale, "what": name, **mean._asdict(), **counts})
    return told


def _asked(scale: float, name: str) -> tuple[str, str]:
    whole, coarse_iou, thin, single = TARGETS.get(scale, (None,) * 4)
    asked = {
        "room from 2 cm": (whole, thin),
        "room from 8 cm": (coarse_iou, None),
        "object, fitted": (single, None),
    }.get(name, (None, None))
    first, second = ("" if value is None else f"{value:.2f}" for value in asked)
    return first, second


def main() -> None:
    """Print the table; write the pictures where they are asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--first", type=int, default=2000)
    parser.add_argument("--rooms", type=int, default=20)
    parser.add_argument("--scales", default="1,2,4,12.5")
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args()
    scales = [float(text) for text in chosen.scales.split(",")]
    console, rows = Console(width=100), defaultdict(list)
    seeds = range(chosen.first, chosen.first + chosen.rooms)
    for seed in seeds:
        check_room(seed, scales, rows)
        console.print(f"room {seed}", style="dim")
    console.print(table(rows))
    if chosen.json:
        write_json(chosen.json, figures(rows))
    if chosen.pictures:
        for path in fitting_pages.write_pages(chosen.pictures, list(seeds), scales):
            console.print(str(path))


if __name__ == "__main__":
    main()

"""Fidelity of reconstructions: generated rooms are scanned, reconstructed twice and scored.

``python -m benchmarks.check_faithful [--split tune] [--difficulty noise ...] [--trials N]
[--labels both] [--stages] [--keep DIR] [--json FILE] [--figures FILE] [--verbose]``

One table with the label images of the trials (``labels``, a tenth of the pixels wrong) and one
without (``none``), with a row per difficulty (means over its trials) and the targets below;
``--labels votes`` and ``geometric`` select these labellers instead of the default. ``clean`` are
the trials of ``noise`` without noise and jitter. ``--figures`` writes one figure per target: the
mean of its worst difficulty. With ``--keep`` finished trials are not repeated, so that an
interrupted run continues; use a new folder after rooms or stages have changed. Seeds of ``--split
test`` are for final results only: nothing is tuned on them.
"""

import argparse
import math
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from world2minecraft.core.files import read_json, write_json
from world2minecraft.evaluation.scoring import evaluate_reconstruction
from world2minecraft.evaluation.scoring.stage_losses import AFTER, allowed_cells, stage_losses
from world2minecraft.formats.run_arrays import read_evidence, write_evidence
from world2minecraft.procgen.benchmark_trials import DIFFICULTIES, Trial, list_trials, write_trial
from world2minecraft.reconstruction.parameters import Parameters, with_settings
from world2minecraft.reconstruction.pipeline import reconstruct

Row = dict[str, Any]


@dataclass(frozen=True)
class Column:
    """A figure of the table: how it is read from a trial's facts, and how it is printed."""

    name: str
    read: Callable[[Row], float]
    digits: int = 3


def _frame_cm(row: Row) -> float:
    error = row["frame_error"]
    parts = (error["floor_m"], error.get("walls_x_m", 0.0), error.get("walls_y_m", 0.0))
    return 100 * max(abs(part) for part in parts)


def _turned(row: Row) -> float:
    asked = row["objects"]["orientation_asked"]
    return row["objects"]["orientation_right"] if asked else math.nan


def _calibration(row: Row, which: str) -> float:
    return row["calibration"][which]["error"] if "calibration" in row else math.nan


COLUMNS = (
    Column("P", lambda row: row["surface_within_one_voxel"]["precision"]),
    Column("R", lambda row: row["surface_within_one_voxel"]["recall"]),
    Column("free", lambda row: row["free_recall"]),
    Column("IoU", lambda row: row["occupancy"]["iou"]),
    Column("mIoU", lambda row: row["occupancy"]["miou"]),
    Column("of allowed", lambda row: row.get("share_of_allowed", math.nan)),
    Column("F1", lambda row: row["objects"]["f1"]),
    Column("turned", _turned),
    Column("frame cm", _frame_cm, 2),
    Column("tilt deg", lambda row: row["frame_error"]["tilt_deg"], 2),
    Column("yaw deg", lambda row: row["frame_error"]["yaw_deg"], 2),
    Column("openings", lambda row: row.get("openings", {}).get("f1", math.nan)),
    Column("collide", lambda row: row["layout"].get("collisions", math.nan), 2),
    Column("outside", lambda row: row["layout"].get("out_of_bounds", math.nan), 2),
    Column("integrity", lambda row: row["layout"].get("semantic_integrity", math.nan)),
    Column("ECE", lambda row: _calibration(row, "all")),
    Column("ECE occ", lambda row: _calibration(row, "occupied")),
)


_NAMES = ("R", "IoU", "mIoU", "F1", "turned", "collide", "integrity")
STAGE_COLUMNS = (
    *(column for column in COLUMNS if column.name in _NAMES),
    Column("in the world", lambda row: row["world"].get("right_class", math.nan)),
)


@dataclass(frozen=True)
class Target:
    """A line of the issue: a figure of some trials must be at least, or at most, a limit."""

    difficulty: str  # "" = every one
    labels: str  # "" = both
    column: str
    limit: float
    at_least: bool = True


TARGETS = (
    Target("noise", "", "frame cm", 2.0, False),
    Target("noise", "", "tilt deg", 0.3, False),
    Target("noise", "", "yaw deg", 0.3, False),
    Target("noise", "", "P", 0.99),
    Target("noise", "", "R", 0.97),
    Target("noise", "", "IoU", 0.80),
    Target("clean", "", "IoU", 0.95),
    Target("", "labels", "of allowed", 0.85),
    Target("", "labels", "F1", 0.85),
    Target("", "labels", "turned", 0.90),
    Target("", "none", "mIoU", 0.25),
    Target("", "none", "F1", 0.35),
    Target("", "", "outside", 0.0, False),
    Target("", "", "collide", 0.0, False),
    Target("", "", "integrity", 0.95),
    Target("", "", "ECE", 0.05, False),
)


def rows_table(title: str, rows: Sequence[Row], verbose: bool = False) -> Table:
    """Return the table of one labeller: a row for each difficulty, and each trial on request."""
    table = Table(title=title, box=None, pad_edge=False, header_style="bold")
    table.add_column("difficulty")
    for column in COLUMNS:
        table.add_column(column.name, justify="right")
    for name in dict.fromkeys(row["difficulty"] for row in rows):
        mine = [row for row in rows if row["difficulty"] == name]
        if verbose:
            for row in mine:
                table.add_row(row["trial"], *(_text(column, [row]) for column in COLUMNS))
        table.add_row(f"[bold]{name} ({len(mine)})", *(_text(c, mine) for c in COLUMNS))
    return table


def stages_table(title: str, rows: Sequence[Row]) -> Table:
    """Return the means of the scores with truth put in after each stage."""
    table = Table(title=title, box=None, pad_edge=False, header_style="bold")
    for name in ("difficulty", "truth after", *(column.name for column in STAGE_COLUMNS)):
        table.add_column(name, justify="left" if name in ("difficulty", "truth after") else "right")
    for group in dict.fromkeys(row["difficulty"] for row in rows):
        mine = [row for row in rows if row["difficulty"] == group]
        for stage in ("none", *(name for name in AFTER if name in mine[0]["stages"])):
            those = mine if stage == "none" else [row["stages"][stage] for row in mine]
            table.add_row(group, stage, *(_text(column, those) for column in STAGE_COLUMNS))
    return table


def verdicts(labeller: str, rows: Sequence[Row]) -> list[str]:
    """Return a line for each target: the limit, the mean and the worst, met or missed."""
    lines = []
    for target in TARGETS:
        if target.labels not in ("", labeller):
            continue
        column = next(c for c in COLUMNS if c.name == target.column)
        groups = dict.fromkeys(row["difficulty"] for row in rows)
        texts = []
        for name in groups:
            if target.difficulty in ("", name) and (target.difficulty or name != "clean"):
                mine = [row for row in rows if row["difficulty"] == name]
                if not math.isnan(mean(column, mine)):
                    texts.append(f"{name} {_judged(target, column, mine)}")
        if texts:
            sign = ">=" if target.at_least else "<="
            lines.append(f"{target.column} {sign} {target.limit:g}: {', '.join(texts)}")
    return lines


def mean(column: Column, rows: Sequence[Row]) -> float:
    """Return the mean of a column over the trials that have a value; NaN where none has."""
    values = [value for row in rows if not math.isnan(value := column.read(row))]
    return math.fsum(values) / len(values) if values else math.nan


def _text(column: Column, rows: Sequence[Row]) -> str:
    value = mean(column, rows)
    return "-" if math.isnan(value) else f"{value:.{column.digits}f}"


def _judged(target: Target, column: Column, rows: Sequence[Row]) -> str:
    """Return the mean, the worst trial's figure, and whether the mean meets the target."""
    values = [value for row in rows if not math.isnan(value := column.read(row))]
    value, worst = mean(column, rows), min(values) if target.at_least else max(values)
    met = value >= target.limit if target.at_least else value <= target.limit
    verdict = "[green]met[/]" if met else "[red]missed[/]"
    return f"{value:.{column.digits}f} (worst {worst:.{column.digits}f}) {verdict}"


def figures_of(rows: Sequence[Row]) -> dict[str, float]:
    """Return the figure of each target by its name; ValueError where no trial has one."""
    return {name_of(target): figure_of(target, rows) for target in TARGETS}


def name_of(target: Target) -> str:
    """Return a target's name, such as ``noise IoU`` or ``labels F1``."""
    return " ".join(word for word in (target.difficulty, target.labels, target.column) if word)


def figure_of(target: Target, rows: Sequence[Row]) -> float:
    """Return the worst mean of a target's difficulties and ways."""
    column = next(one for one in COLUMNS if one.name == target.column)
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        is_named = target.difficulty == row["difficulty"]
        is_any = not target.difficulty and row["difficulty"] != CLEAN
        if (is_named or is_any) and target.labels in ("", row["labels"]):
            groups.setdefault((row["difficulty"], row["labels"]), []).append(row)
    means = [value for mine in groups.values() if not math.isnan(value := mean(column, mine))]
    if not means:
        raise ValueError(f"no trial of {name_of(target)} is among the rows")
    return min(means) if target.at_least else max(means)


# How a trial is labelled: the labeller, and whether the label images are seen.
WAYS = {
    "labels": ("auto", True),
    "none": ("auto", False),
    "votes": ("votes", True),
    "geometric": ("geometric", False),
}
BOTH = ("labels", "none")
CLEAN = "clean"  # The noise trials, scanned without noise and jitter.


def chosen_trials(split: str, difficulties: Sequence[str], count: int) -> list[Trial]:
    """Return the first trials of each difficulty; ``clean`` are those of noise, made clean."""
    found = []
    for name in difficulties:
        if name == CLEAN:
            found += [trial.clean() for trial in list_trials(split, "noise")[:count]]  # type: ignore[arg-type]
        else:
            found += list_trials(split, name)[:count]  # type: ignore[arg-type]
    return found


def run_trial(
    trial: Trial, base: Path, ways: Sequence[str], settings: Sequence[str], stages: bool
) -> list[dict[str, Any]]:
    """Make what is missing of a trial; return one row of facts for each way to label it."""
    folder = base / trial.name
    capture = folder / "capture"
    begun = time.perf_counter()
    if not (capture / "truth.json").is_file():
        write_trial(trial, capture)
    rows = []
    for way in ways:
        path = folder / f"{way}.json"
        facts = read_json(path) if path.is_file() else {}
        if not facts:
            facts = _made(folder, way, settings)
        if stages and "stages" not in facts:
            facts["stages"] = stage_losses(folder / way, capture)
        if "seconds" not in facts:
            facts["seconds"] = round(time.perf_counter() - begun, 1)
        begun = time.perf_counter()
        write_json(path, facts)
        rows.append({"trial": trial.name, "labels": way, "difficulty": group(trial), **facts})
    return rows


def _made(folder: Path, way: str, settings: Sequence[str]) -> dict[str, Any]:
    """Reconstruct a trial in one way and score it.

    What comes before labels is the same for all ways, and taken from the first.
    """
    (labeller, voted), capture, out = WAYS[way], folder / "capture", folder / way
    chosen = with_settings(Parameters(labeller=labeller), list(settings))
    has_first = way != BOTH[0] and (folder / f"{BOTH[0]}.json").is_file()
    if has_first:
        shutil.copytree(folder / BOTH[0], out, dirs_exist_ok=True)
    else:
        reconstruct(capture, out, chosen)
    if not voted:
        evidence = read_evidence(out / "evidence.npz")
        silent = replace(evidence, votes=np.zeros_like(evidence.votes))
        write_evidence(out / "evidence.npz", silent)
    if has_first or not voted:
        reconstruct(capture, out, chosen, start="label")
    facts = evaluate_reconstruction(out, capture)
    if way == BOTH[0]:
        allowed = allowed_cells(out, capture)["occupancy"]["miou"]
        facts["allowed_miou"] = allowed
        facts["share_of_allowed"] = facts["occupancy"]["miou"] / allowed if allowed else 1.0
    return facts


def group(trial: Trial) -> str:
    """Return the row of the table that a trial belongs to."""
    return CLEAN if trial.name.endswith("-clean") else trial.difficulty


def main(words: Sequence[str]) -> int:
    """Run the trials that ``words`` ask for, print the tables and return the exit code."""
    chosen = _options(words)
    base = chosen.keep or Path(tempfile.mkdtemp())
    ways = BOTH if chosen.labels == "both" else (chosen.labels,)
    todo = chosen_trials(chosen.split, chosen.difficulty or (*DIFFICULTIES, CLEAN), chosen.trials)
    begun = time.perf_counter()
    jobs = [(trial, base, ways, chosen.set or [], chosen.stages) for trial in todo]
    rows: list[dict[str, Any]] = []
    if chosen.jobs > 1:
        with ProcessPoolExecutor(chosen.jobs) as pool:
            for found in pool.map(run_trial, *zip(*jobs, strict=True)):
                rows += found
    else:
        for job in jobs:
            rows += run_trial(*job)
            seconds = sum(row["seconds"] for row in rows[-len(ways) :])
            print(f"{job[0].name}: {seconds:.0f} s", file=sys.stderr, flush=True)
    minutes = (time.perf_counter() - begun) / 60
    console = Console(width=None if sys.stdout.isatty() else 190)
    for way in ways:
        mine = [row for row in rows if row["labels"] == way]
        console.print(rows_table(f"{way}, split {chosen.split}", mine, chosen.verbose))
        for line in verdicts(way, mine):
            console.print(line)
        if chosen.stages:
            console.print(stages_table(f"{way}, what is left to lose", mine))
    console.print(f"{len(todo)} trials in {minutes:.1f} minutes, kept in {base}")
    if chosen.json:
        write_json(chosen.json, rows)
    if chosen.figures:
        write_json(chosen.figures, figures_of(rows))
    return 0


def _options(words: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.check_faithful", description=(__doc__ or "").splitlines()[0]
    )
    parser.add_argument("--split", choices=("tune", "test"), default="tune")
    parser.add_argument("--difficulty", nargs="+", choices=(*DIFFICULTIES, CLEAN))
    parser.add_argument("--trials", type=int, default=10, help="of each difficulty")
    parser.add_argument("--labels", choices=(*WAYS, "both"), default="both")
    parser.add_argument("--jobs", type=int, default=1, help="trials at a time")
    parser.add_argument("--stages", action="store_true", help="what each stage loses, too")
    parser.add_argument("--keep", type=Path, help="the folder to work in, and to go on from")
    parser.add_argument("--json", type=Path, help="write all figures to this file")
    parser.add_argument("--figures", type=Path, help="write one figure per target to this file")
    parser.add_argument("--set", action="append", metavar="KEY=VALUE", help="a parameter")
    parser.add_argument("--verbose", action="store_true", help="a row for each trial")
    return parser.parse_args(words)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""The tables of ``check_faithful``: the columns, their means, and the targets beside them."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from rich.table import Table

from world2minecraft.evaluate.stages import AFTER

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

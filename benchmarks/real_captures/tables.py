"""Tables of the benchmark: one row per scene, and one for all frames of NYUv2."""

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from rich.table import Table

from benchmarks.real_captures.scoring import (
    accuracy_by_class,
    class_accuracy,
    share_not_found,
    wall_share,
)

Row = dict[str, Any]
MISSING = "-"
WINDOW = re.compile(r"kitchen-\d+-\d+")
PHOTOS = ("kitchen-photos-posed", "kitchen-photos")


@dataclass(frozen=True)
class Column:
    """A column of the table.

    Attributes:
        name: Heading.
        read: Function that returns the value of a row, or None.
        form: Format of the value.
    """

    name: str
    read: Callable[[Row], float | None]
    form: str

    def text(self, row: Row) -> str:
        """Return the value of a row as text."""
        value = self.read(row)
        return MISSING if value is None else format(value, self.form)


def _centimetres(row: Row) -> float | None:
    return None if row.get("floor_m") is None else 100 * row["floor_m"]


COLUMNS = (
    Column("tilt deg", lambda row: row.get("tilt_deg"), ".2f"),
    Column("floor cm", _centimetres, "+.1f"),
    Column("class acc.", lambda row: row.get("class_accuracy"), ".3f"),
    Column("objects", lambda row: row.get("objects"), ".4g"),
    Column("wall share", lambda row: row.get("wall_share"), ".3f"),
    Column("stability", lambda row: row.get("stability"), ".3f"),
    Column("CPU s", lambda row: row.get("cpu_s"), ".1f"),
)


def summarize(rows: Sequence[Row]) -> list[Row]:
    """Return one row per group; rows of several scenes are combined.

    Class accuracy and the share of walls of a group are those of the surface of all its scenes.
    Tilt and floor height are medians of absolute values. The number of objects, stability and time
    are means.
    """
    groups: dict[str, list[Row]] = {}
    for row in rows:
        groups.setdefault(row["group"], []).append(row)
    return [_combined(name, members) for name, members in groups.items()]


def _combined(name: str, rows: list[Row]) -> Row:
    if len(rows) == 1 and rows[0]["scene"] == name:
        return rows[0]
    ran = [row for row in rows if row["ran"]]
    reasons = [row["reason"] for row in rows if not row["ran"]]
    counts = np.sum([np.array(row["confusion"]) for row in ran if "confusion" in row], axis=0)
    combined: Row = {
        "scene": f"{name} ({len(rows)} frames)",
        "group": name,
        "ran": not reasons,
        "reason": f"{len(reasons)} of {len(rows)} refused: {_first(reasons)}" if reasons else "",
    }
    for key in ("objects", "stability", "cpu_s"):
        values = [row[key] for row in ran if row.get(key) is not None]
        combined[key] = float(np.mean(values)) if values else None
    for key in ("tilt_deg", "floor_m"):
        values = [abs(row[key]) for row in ran if row.get(key) is not None]
        combined[key] = float(np.median(values)) if values else None
    if np.ndim(counts):
        pixels = [row["pixel_accuracy"] for row in ran if row.get("pixel_accuracy") is not None]
        combined |= {
            "class_accuracy": class_accuracy(counts),
            "pixel_accuracy": float(np.mean(pixels)) if pixels else None,
            "not_found": share_not_found(counts),
            "by_class": accuracy_by_class(counts),
            "wall_share": wall_share(counts),
        }
    return combined


def _first(reasons: list[str]) -> str:
    """Return the most frequent reason."""
    return max(reasons, key=reasons.count)


def status(row: Row) -> str:
    """Return whether a scene ran, or why not."""
    return "ran" if row["ran"] else row["reason"] or "refused"


def terminal_table(rows: Sequence[Row]) -> Table:
    """Return the table for the terminal."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("scene", no_wrap=True)
    for column in COLUMNS:
        table.add_column(column.name, justify="right", no_wrap=True)
    table.add_column("ran, or why not")
    for row in summarize(rows):
        texts = (column.text(row) for column in COLUMNS)
        table.add_row(row["scene"], *texts, status(row))
    return table


def markdown_table(rows: Sequence[Row]) -> str:
    """Return the table in Markdown, with reasons shortened."""
    names = ("scene", *(column.name for column in COLUMNS), "ran, or why not")
    lines = [f"| {' | '.join(names)} |", f"|---|{'--:|' * len(COLUMNS)}---|"]
    for row in summarize(rows):
        why = status(row).partition(";")[0]  # Without the advice.
        texts = (row["scene"], *(column.text(row) for column in COLUMNS), why)
        lines.append(f"| {' | '.join(text.replace('|', '/') for text in texts)} |")
    return "\n".join(lines) + "\n"


def class_lines(rows: Sequence[Row]) -> list[str]:
    """Return one line per group with known classes: the accuracy of each class."""
    return [
        f"{row['scene']}: "
        + ", ".join(f"{name} {share:.2f}" for name, share in row["by_class"].items())
        + f"; not found {row['not_found']:.2f}"
        + (f"; share of pixels {row['pixel_accuracy']:.3f}" if row.get("pixel_accuracy") else "")
        for row in summarize(rows)
        if row.get("by_class")
    ]


def overview(rows: Sequence[Row], date: str, commit: str) -> str:
    """Return one line for the table over time, in Markdown.

    Args:
        rows: Results of all scenes.
        date: Date of the benchmark.
        commit: Commit of the program.

    Returns:
        Date; commit; scenes that ran; median and worst tilt of the kitchen's windows; tilt of its
        photos with and without poses; class accuracy of the cropped kitchen and of NYUv2; mean wall
        share and mean stability of the scenes; objects in the flat.
    """
    combined = {row["group"]: row for row in summarize(rows)}
    windows = [
        row["tilt_deg"]
        for name, row in combined.items()
        if WINDOW.fullmatch(name) and row.get("tilt_deg") is not None
    ]
    ran = sum(row["ran"] for row in rows)
    cells = [
        date,
        f"`{commit}`",
        f"{ran} of {len(rows)}",
        _joined([np.median(windows), np.max(windows)] if windows else [None], ".2f"),
        _joined([combined.get(name, {}).get("tilt_deg") for name in PHOTOS], ".2f"),
        _joined([combined.get(n, {}).get("class_accuracy") for n in ("kitchen-low", "nyuv2")]),
        _joined([_mean(combined.values(), "wall_share")]),
        _joined([_mean(combined.values(), "stability")]),
        _joined([combined.get("flat", {}).get("objects")], "d"),
    ]
    return f"| {' | '.join(cells)} |"


def _joined(values: Sequence[float | None], form: str = ".3f") -> str:
    return ", ".join(MISSING if value is None else format(value, form) for value in values)


def _mean(rows: Iterable[Row], key: str) -> float | None:
    values = [row[key] for row in rows if row.get(key) is not None]
    return float(np.mean(values)) if values else None

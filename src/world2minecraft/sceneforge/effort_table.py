"""The paper's efficiency table for any set of scenes, computed from their effort logs."""

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import MALFORMED, InputError
from world2minecraft.core.files import read_json
from world2minecraft.evaluation.metrics.editing_effort import (
    PAPER_REFINED,
    PAPER_SCRATCH,
    Effort,
    effort_of,
    improvement,
    mean_row,
)
from world2minecraft.sceneforge.document.document_metadata import document_folder, read_identity
from world2minecraft.sceneforge.document.effort_log import read_effort

Row = Mapping[str, float | None]
# The paper's rows: name, title, how far it is indented.
ROWS = (
    ("total_s", "Total time (seconds)", 0),
    ("automatic_s", "Automated process", 1),
    ("manual_s", "Manual refinement", 1),
    ("operations", "Total operations", 0),
    ("add", "Addition actions", 1),
    ("delete", "Deletion actions", 1),
    ("orient", "Orientation adjustments", 1),
)
# What our editor counts beside the paper's three; rows of nothing but zeros are left out.
MORE_ROWS = (
    ("move", "Moves", 1),
    ("relabel", "Class changes", 1),
    ("other", "Other", 1),
    ("undone", "Undo steps (not counted)", 0),
)


def effort_at(place: Path) -> Effort:
    """Return the effort for a scene, given by its ``.forge`` folder or by its source.

    Raises:
        InputError: If the scene was never opened, or if its effort log cannot be read.
    """
    folder = document_folder(place)
    if not folder.is_dir():
        raise InputError(place, "no edits found; open the scene with w2m forge first")
    identity = read_identity(folder)
    return effort_of(identity.name, read_effort(folder), automatic_s(identity.source))


def automatic_s(source: Path) -> float | None:
    """Return the duration of a run's reconstruction in seconds, or None if it was not recorded."""
    try:
        seconds = read_json(source / "run.json", 1 << 20)["stage_s"].values()
        return float(sum(map(float, seconds)))
    except (*MALFORMED, InputError):
        return None


def stats_json(efforts: Sequence[Effort], scratch: Sequence[Effort]) -> dict[str, Any]:
    """Return all scenes, their means, the means from scratch and the paper's values as JSON."""
    return {
        "scenes": [{**asdict(one), "total_s": one.total_s} for one in efforts],
        "mean": mean_row(efforts),
        "scratch": mean_row(scratch) if scratch else None,
        "paper": {"scratch": PAPER_SCRATCH, "refined": PAPER_REFINED},
    }


def stats_csv(efforts: Iterable[Effort]) -> str:
    """Return a CSV table with a header and a line for each scene."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    kinds = ("add", "delete", "orient", "move", "relabel", "other")
    writer.writerow(
        ("scene", "operations", *kinds, "undone", "redone", "cells", "manual_s", "automatic_s")
    )
    for one in efforts:
        automatic = "" if one.automatic_s is None else round(one.automatic_s, 2)
        counts = [one.counted[kind] for kind in kinds]
        times = (round(one.active_s, 2), automatic)
        writer.writerow(
            (one.name, one.operations, *counts, one.undone, one.redone, one.cells, *times)
        )
    return text.getvalue()


def stats_text(efforts: Sequence[Effort], scratch: Sequence[Effort]) -> str:
    """Return the table of means as plain text, beside the values of the paper."""
    ours, nothing = mean_row(efforts), mean_row(scratch)
    scenes = "1 scene" if len(efforts) == 1 else f"{len(efforts)} scenes"
    lines = [
        f"mean of {scenes}" + (f", {len(scratch)} from scratch" if scratch else ""),
        f"{'':<31}{'from':>10}{'':>10}{'':>10}   {'paper: from':>12}{'paper:':>10}",
        f"{'':<31}{'scratch':>10}{'ours':>10}{'less':>10}   {'scratch':>12}{'refined':>10}",
    ]
    for name, title, depth in _rows(ours, nothing):
        cells = (nothing[name], ours[name])
        paper = (PAPER_SCRATCH.get(name), PAPER_REFINED.get(name))
        less = improvement(*cells)
        shown = "--" if less is None else f"{less:.1f}x"
        lines.append(
            f"{'  ' * depth + title:<31}{_figure(cells[0]):>10}{_figure(cells[1]):>10}{shown:>10}"
            f"   {_figure(paper[0]):>12}{_figure(paper[1]):>10}"
        )
    return "\n".join(lines)


def stats_latex(efforts: Sequence[Effort], scratch: Sequence[Effort]) -> str:
    """Return the table of means in the LaTeX layout of the paper."""
    ours, nothing = mean_row(efforts), mean_row(scratch)
    lines = [
        r"\begin{tabular}{l c c c}",
        r"\toprule",
        r"\textbf{Metric Details} & Build from Scratch & \textbf{Ours} & Improvement \\",
        r"\midrule",
    ]
    for name, title, depth in _rows(ours, nothing):
        if name == "operations":
            lines.append(r"\midrule")
        less = improvement(nothing[name], ours[name])
        shown = "--" if less is None else rf"{less:.1f}$\times$"
        words = rf"\quad {title}" if depth else rf"\textbf{{{title}$\downarrow$}}"
        lines.append(rf"{words} & {_figure(nothing[name])} & {_figure(ours[name])} & {shown} \\")
    return "\n".join([*lines, r"\bottomrule", r"\end{tabular}"])


def _rows(*means: Row) -> list[tuple[str, str, int]]:
    """Return the rows of the paper, and our additional rows that are not all zero."""
    more = [row for row in MORE_ROWS if any(mean[row[0]] for mean in means)]
    return [*ROWS, *more]


def _figure(value: float | None) -> str:
    return "--" if value is None else f"{value:.2f}"

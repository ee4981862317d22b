"""The figures of the fidelity benchmark, one a target: the worst mean of its difficulties.

``python -m benchmarks.faithful_figures ROWS.json OUT.json``, where ROWS.json is what
``python -m benchmarks.check_faithful --json ROWS.json`` wrote. A target is a line of what was asked
(``faithful_table.TARGETS``); its figure is the mean over the trials of a difficulty, and of the
difficulties and ways of labelling that it speaks of the one that is worst.
"""

import argparse
import math
from collections.abc import Sequence
from pathlib import Path

from benchmarks.faithful_table import COLUMNS, TARGETS, Row, Target, mean
from world2minecraft.files import read_json, write_json

CLEAN = "clean"  # Asked by name alone.


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


def main() -> None:
    """Write the figures, and print them."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("rows", type=Path)
    parser.add_argument("out", type=Path)
    chosen = parser.parse_args()
    found = figures_of(read_json(chosen.rows))
    write_json(chosen.out, found)
    for name, value in found.items():
        print(f"{name:24} {value:.4f}")


if __name__ == "__main__":
    main()

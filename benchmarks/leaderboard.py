"""The leaderboard of the scan benchmark: its file, checked row by row, and its tables in the docs.

``python -m benchmarks.leaderboard add SCORES.json --method NAME --version V --input depth
--link URL --command WORDS [--note TEXT]`` makes a row of what ``benchmarks.scan_benchmark score``
or ``benchmarks.check_faithful --split test`` wrote with ``--json``, adds it to
``docs/leaderboard.yaml`` and writes the tables anew. Without words the tables alone are written.
"""

import argparse
import datetime
import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.faithful_table import COLUMNS, mean
from benchmarks.leaderboard_file import DATE, INPUTS, Entry, entry_text, read_entries
from benchmarks.leaderboard_page import with_tables
from world2minecraft.errors import DamagedFileError, UsageError, World2MinecraftError
from world2minecraft.exchange.occupancy import DEFAULT_VOXEL_M
from world2minecraft.files import read_bytes, read_json, write_text
from world2minecraft.rooms.trials import DIFFICULTIES, trials

DOCS = Path(__file__).resolve().parents[1] / "docs"
FILE, PAGE = DOCS / "leaderboard.yaml", DOCS / "scan-benchmark.md"
COLUMN_OF = {
    "precision": "P", "recall": "R", "iou": "IoU", "miou": "mIoU", "f1": "F1", "fronts": "turned",
    "calibration": "ECE",
}  # fmt: skip
# Of a file of check_faithful, which holds both ways to label: the one that an input means.
WAY_OF = {"depth+labels": "labels", "depth": "none", "photos": "none"}


def figures_of(path: Path, source: str, way: str | None = None) -> dict[str, dict[str, float]]:
    """Return the means of each difficulty by the leaderboard's names, to three digits.

    Args:
        path: what ``--json`` wrote.
        source: the input of the row, which says which way of several is meant.
        way: one of the ways to label in the file; by ``source`` where it is None.

    Raises:
        InputError: the file is missing. DamagedFileError: it holds no rows of scores, or not those
            of the fifty test scans in cells of 0.08 m.
    """
    rows = read_json(path)
    try:
        ways = sorted({str(row["labels"]) for row in rows})
        chosen = way or (ways[0] if len(ways) == 1 else WAY_OF[source])
        mine = [row for row in rows if row["labels"] == chosen]
        figures = {
            name: _means([r for r in mine if r["difficulty"] == name]) for name in DIFFICULTIES
        }
    except (KeyError, TypeError) as error:
        raise DamagedFileError(
            path, f"holds no scores ({error}); take the file of scan_benchmark score --json"
        ) from error
    _check_trials(path, [str(row["trial"]) for row in mine], chosen, ways)
    other = {row.get("voxel_m", DEFAULT_VOXEL_M) for row in mine} - {DEFAULT_VOXEL_M}
    if other:
        raise DamagedFileError(
            path, f"scores cells of {min(other):g} m; the benchmark's are {DEFAULT_VOXEL_M:g} m"
        )
    return figures


def _means(rows: Sequence[dict[str, Any]]) -> dict[str, float]:
    columns = {column.name: column for column in COLUMNS}
    found = {name: mean(columns[own], rows) for name, own in COLUMN_OF.items()}
    return {name: round(value, 3) for name, value in found.items() if not math.isnan(value)}


def _check_trials(path: Path, names: Sequence[str], way: str, ways: Sequence[str]) -> None:
    if not names:
        raise DamagedFileError(path, f"has no rows labelled {way!r}; it has {', '.join(ways)}")
    wanted = [trial.name for trial in trials("test")]
    lacking = [name for name in wanted if name not in names]
    if lacking or len(set(names)) != len(names):
        held = len(wanted) - len(lacking)
        why = f" ({lacking[0]} is lacking)" if lacking else ", some twice"
        raise DamagedFileError(
            path, f"scores {held} of the {len(wanted)} test scans{why}; a row needs each once"
        )


def add_entry(entry: Entry, file: Path, page: Path) -> None:
    """Append a row to the file and write the tables anew; nothing is written where it is wrong.

    Raises:
        InputError: a file is missing or damaged. UsageError: the row is wrong, or there already.
    """
    old = read_bytes(file, 1 << 20).decode("utf-8")
    text = f"{old.rstrip()}\n\n{entry_text(entry)}"
    entries = read_entries(file, text)
    tables = with_tables(page, entries)
    write_text(file, text)
    write_text(page, tables)


def main(words: Sequence[str]) -> int:
    """Do what ``words`` ask for and return the exit code."""
    chosen = _options(words)
    try:
        if chosen.what == "add":
            add_entry(_entry(chosen), chosen.file, chosen.page)
            print(f"next: look at git diff, commit {chosen.file.name} and {chosen.page.name}")
        else:
            write_text(chosen.page, with_tables(chosen.page, read_entries(chosen.file)))
    except World2MinecraftError as error:
        print(error, file=sys.stderr)
        return error.exit_code
    return 0


def _entry(chosen: argparse.Namespace) -> Entry:
    figures = figures_of(chosen.scores, chosen.input, chosen.way)
    try:
        return Entry(
            method=chosen.method,
            version=chosen.version,
            input=chosen.input,
            date=chosen.date,
            link=chosen.link,
            command=chosen.command,
            note=chosen.note,
            figures=figures,
        )
    except ValueError as error:
        raise UsageError(str(error)) from error


def _options(words: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.leaderboard", description=(__doc__ or "").splitlines()[0]
    )
    parser.add_argument("--file", type=Path, default=FILE, help=argparse.SUPPRESS)
    parser.add_argument("--page", type=Path, default=PAGE, help=argparse.SUPPRESS)
    verbs = parser.add_subparsers(dest="what")
    add = verbs.add_parser("add", help="add a row, made of scores")
    add.add_argument("scores", type=Path, help="what scan_benchmark score --json wrote")
    add.add_argument("--method", required=True, help="its name")
    add.add_argument("--version", required=True, help="of the method")
    add.add_argument("--input", required=True, choices=INPUTS, help="what it saw of the scans")
    add.add_argument("--link", required=True, help="its page, or the commit of its code")
    add.add_argument("--command", required=True, help="what makes these figures again")
    add.add_argument("--note", default="", help="what a reader must know, in a line")
    add.add_argument("--date", default=datetime.date.today().isoformat(), help=DATE)
    add.add_argument("--way", help="of a file with several ways to label: which")
    return parser.parse_args(words)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

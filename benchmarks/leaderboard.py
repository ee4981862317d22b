"""The leaderboard of the scan benchmark: its file, validated by row, and its tables in the docs.

``python -m benchmarks.leaderboard add SCORES.json --method NAME --version V --input depth
--link URL --command WORDS [--note TEXT]`` makes a row from the ``--json`` file of
``benchmarks.scan_benchmark score`` or ``benchmarks.check_faithful --split test``, adds it to
``docs/leaderboard.yaml`` and updates the tables. Without arguments only the tables are updated.

A row has ``method``, ``version``, ``input``, ``date``, ``link``, ``command``, an optional
``note`` and ``figures``: for each difficulty a mapping of ``FIGURES``. Figures that were not
measured are omitted.
"""

import argparse
import datetime
import math
import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import yaml

from benchmarks.check_faithful import COLUMNS, mean
from world2minecraft.core.errors import (
    DamagedFileError,
    UnknownNameError,
    UsageError,
    World2MinecraftError,
)
from world2minecraft.core.files import read_bytes, read_json, write_text
from world2minecraft.formats.occupancy_files import DEFAULT_VOXEL_M
from world2minecraft.procgen.benchmark_trials import DIFFICULTIES, list_trials

INPUTS = ("depth", "depth+labels", "photos")
FIGURES = ("precision", "recall", "iou", "miou", "f1", "fronts", "calibration")
DATE = "year-month-day, such as 2026-11-22"
MAX_BYTES = 1 << 20
MAX_TEXT = 300  # Letters.
LINK = re.compile(r"https?://\S+|[0-9a-f]{7,40}")


@dataclass(frozen=True)
class Entry:
    """A row, checked: every text can stand in a table, every figure is a share."""

    method: str
    version: str
    input: str
    date: str
    link: str
    command: str
    figures: Mapping[str, Mapping[str, float]]
    note: str = ""

    def __post_init__(self):
        for name in ("method", "version", "link", "command", "note"):
            _check_text(name, getattr(self, name), may_be_empty=name == "note")
        if self.input not in INPUTS:
            raise ValueError(f"input must be {', '.join(INPUTS)}, not {self.input!r}")
        if not re.fullmatch(r"\d{4}-\d{2}-\d{2}", str(self.date)) or not _is_date(self.date):
            raise ValueError(f"date must be {DATE}, not {self.date!r}")
        if not LINK.fullmatch(self.link):
            raise ValueError(f"link must be an https:// address or a commit, not {self.link!r}")
        if not isinstance(self.figures, Mapping) or set(self.figures) != set(DIFFICULTIES):
            raise ValueError(f"figures must be of each of {', '.join(DIFFICULTIES)}")
        for difficulty, figures in self.figures.items():
            _check_figures(difficulty, figures)

    @property
    def key(self) -> tuple[str, str, str]:
        """What no two rows share."""
        return self.method, self.version, self.input


def read_entries(path: Path, text: str | None = None) -> tuple[Entry, ...]:
    """Read the rows of a leaderboard.

    Args:
        path: the file.
        text: what it would hold; None for what it holds.

    Raises:
        InputError: it is missing. DamagedFileError: it is no list of rows, or a row is wrong; the
        message says which, and what was expected.
    """
    try:
        raw = yaml.safe_load(read_bytes(path, MAX_BYTES) if text is None else text)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise DamagedFileError(
            path, f"is no YAML ({' '.join(str(error).split())[:120]})"
        ) from error
    if not isinstance(raw, list) or not raw:
        raise DamagedFileError(path, "must be a list of rows, each beginning with '- method:'")
    entries: list[Entry] = []
    for number, row in enumerate(raw, start=1):
        entry = _checked_entry(path, number, row)
        if entry.key in {other.key for other in entries}:
            named = " ".join(entry.key)
            raise DamagedFileError(path, f"row {number}: {named} is there already; say the version")
        entries.append(entry)
    return tuple(entries)


def entry_text(entry: Entry) -> str:
    """Return the YAML of a row, as it stands in the file."""
    words = {f.name: getattr(entry, f.name) for f in fields(entry) if f.name != "figures"}
    lines = [f"{name}: {_quoted(value)}" for name, value in words.items() if value]
    lines.append("figures:")
    for difficulty in DIFFICULTIES:
        told = entry.figures[difficulty]
        values = ", ".join(f"{name}: {told[name]:.3f}" for name in FIGURES if name in told)
        lines.append(f"  {difficulty}: {{{values}}}")
    return "- " + "\n  ".join(lines) + "\n"


def _checked_entry(path: Path, number: int, row: Any) -> Entry:
    if not isinstance(row, dict):
        raise DamagedFileError(path, f"row {number} must be a mapping, not {str(row)[:40]!r}")
    known = {f.name for f in fields(Entry)}
    try:
        for name in row:
            if name not in known:
                raise UnknownNameError("field", str(name), known)
        lacking = sorted(known - {"note"} - set(row))
        if lacking:
            raise ValueError(f"{', '.join(lacking)} {'is' if len(lacking) == 1 else 'are'} missing")
        # YAML reads a bare 2026-11-22 as a date, and 1.0 as a number.
        plain = {k: v if isinstance(v, Mapping) else str(v) for k, v in row.items()}
        return Entry(**plain)
    except (ValueError, UnknownNameError) as error:
        raise DamagedFileError(path, f"row {number}: {error}") from error


def _check_text(name: str, value: str, may_be_empty: bool) -> None:
    if not value and not may_be_empty:
        raise ValueError(f"{name} must not be empty")
    if len(value) > MAX_TEXT or not value.isprintable() or set(value) & set("|<>`"):
        raise ValueError(
            f"{name} must be one line of at most {MAX_TEXT} letters without | < > `, "
            f"not {value[:40]!r}"
        )


def _check_figures(difficulty: str, figures: Any) -> None:
    if not isinstance(figures, Mapping) or not figures:
        raise ValueError(f"{difficulty} must map figures to numbers, such as {{iou: 0.94}}")
    for name, value in figures.items():
        if name not in FIGURES:
            raise UnknownNameError(f"figure of {difficulty}", str(name), FIGURES)
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not is_number or not math.isfinite(value) or not 0 <= value <= 1:
            raise ValueError(f"{name} of {difficulty} must be from 0 to 1, not {value!r}")


def _is_date(text: str) -> bool:
    try:
        datetime.date.fromisoformat(text)
    except ValueError:
        return False
    return True


def _quoted(text: str) -> str:
    """Return a text as YAML on one line, quoted where it would be read as something else."""
    return (
        yaml.safe_dump(str(text), width=10_000, allow_unicode=True).removesuffix("\n...\n").strip()
    )


BEGIN = "<!-- Written by python -m benchmarks.leaderboard from leaderboard.yaml -->"
END = "<!-- The end of the leaderboard -->"
TABLES = (
    (
        "Geometry: precision and recall within one voxel, exact IoU",
        ("precision", "recall", "iou"),
    ),
    ("Classes and objects: mIoU, object F1, fronts right", ("miou", "f1", "fronts")),
    ("Confidence: calibration error", ("calibration",)),
)


def with_tables(page: Path, entries: Sequence[Entry]) -> str:
    """Return the page's text with the tables of some rows in place of what stands there.

    Raises:
        InputError: the page is missing. DamagedFileError: it lacks the two marks.
    """
    text = read_bytes(page, 1 << 20).decode("utf-8")
    before, mark, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not mark or not end:
        raise DamagedFileError(page, f"must hold the lines {BEGIN} and {END}")
    return f"{before}{BEGIN}\n\n{tables(entries)}\n{END}{after}"


def tables(entries: Sequence[Entry]) -> str:
    """Return the tables as Markdown: rows by input, then by exact IoU and F1, best first."""
    ranked = sorted(entries, key=_rank)
    parts = [_figures(title, names, ranked) for title, names in TABLES]
    return "\n".join([*parts, _methods(ranked)])


def _rank(entry: Entry) -> tuple:
    def total(name: str) -> float:
        return sum(entry.figures[difficulty].get(name, 0.0) for difficulty in DIFFICULTIES)

    return INPUTS.index(entry.input), -total("iou"), -total("f1"), entry.key


def _figures(title: str, names: Sequence[str], entries: Sequence[Entry]) -> str:
    told = [e for e in entries if any(n in e.figures[d] for d in DIFFICULTIES for n in names)]
    if not told:
        return ""
    rows = [[f"{e.method} {e.version}", e.input, *_cells(e, names)] for e in told]
    return f"**{title}**\n\n{_table(('method', 'input', *DIFFICULTIES), rows)}"


def _cells(entry: Entry, names: Sequence[str]) -> list[str]:
    def said(value: float | None) -> str:
        return "-" if value is None else f"{value:.3f}"

    return [", ".join(said(entry.figures[d].get(n)) for n in names) for d in DIFFICULTIES]


def _methods(entries: Sequence[Entry]) -> str:
    rows = [
        [f"{e.method} {e.version}", e.input, e.date, _link(e.link), f"`{e.command}`", e.note]
        for e in entries
    ]
    heads = ("method", "input", "date", "code", "command", "note")
    return f"**Methods**\n\n{_table(heads, rows)}"


def _link(link: str) -> str:
    return f"[page]({link})" if link.startswith("http") else f"`{link[:10]}`"


def _table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [heads, ["---"] * len(heads), *rows]
    return "".join(f"| {' | '.join(line)} |\n".replace("|  |", "| |") for line in lines)


DOCS = Path(__file__).resolve().parents[1] / "docs"
FILE, PAGE = DOCS / "leaderboard.yaml", DOCS / "results" / "scan-benchmark.md"
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
    wanted = [trial.name for trial in list_trials("test")]
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

"""``docs/leaderboard.yaml``: a list of rows, each a method on the fifty test scans.

A row is ``method``, ``version``, ``input``, ``date``, ``link``, ``command``, a ``note`` where one
is needed, and ``figures``: of each difficulty a mapping of ``FIGURES``. Figures that were not
measured are left out.
"""

import datetime
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import yaml

from world2minecraft.errors import DamagedFileError, UnknownNameError
from world2minecraft.files import read_bytes
from world2minecraft.rooms.trials import DIFFICULTIES

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
        entry = _entry(path, number, row)
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


def _entry(path: Path, number: int, row: Any) -> Entry:
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

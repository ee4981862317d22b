"""The pages of kept measurements: ``docs/results/NAME.md`` from ``benchmarks/results/NAME.yaml``.

``python -m benchmarks.results`` writes all pages, ``--check`` says which differ from their files.
A file holds ``title``, ``intro`` (Markdown) and ``tables``. Each table states what was measured
(``title``), on what (``data``), with which ``command``, on which ``date`` and at which ``commit``,
its ``columns`` and ``rows``, and optionally a ``note`` (Markdown). ``short`` names what falls short
in a table; the page lists these first. A table whose script is no longer in the repository has
``repeatable: false``: its commit has the script.
"""

import argparse
import re
import sys
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import yaml

from world2minecraft.core.files import write_text

FOLDER = Path(__file__).resolve().parent / "results"
PAGES = Path(__file__).resolve().parents[1] / "docs" / "results"


@dataclass(frozen=True)
class Table:
    """Measured figures with their origin.

    Attributes:
        title: what was measured.
        data: what was measured on, and the machine where it matters.
        command: what repeats it.
        date: ``YYYY-MM-DD``.
        commit: at least seven hexadecimal digits.
        columns: the heads.
        rows: cells of one length.
        note: Markdown below the table.
        short: what falls short, in one sentence; empty where nothing does.
        repeatable: whether the command is in the repository today.

    Raises:
        ValueError: a field is missing or malformed; the message names the table.
    """

    title: str
    data: str
    command: str
    date: str
    commit: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""
    short: str = ""
    repeatable: bool = True

    def __post_init__(self) -> None:
        """Check the fields."""
        if not re.fullmatch(r"\d{4}-\d\d-\d\d", self.date):
            raise ValueError(f"{self.title}: the date is {self.date!r}, not YYYY-MM-DD")
        if not re.fullmatch(r"[0-9a-f]{7,40}", self.commit):
            raise ValueError(f"{self.title}: {self.commit!r} is no commit")
        if not all((self.title, self.data, self.command, self.columns, self.rows)):
            raise ValueError(f"{self.title}: title, data, command, columns and rows are required")
        wrong = [row for row in self.rows if len(row) != len(self.columns)]
        if wrong:
            raise ValueError(f"{self.title}: {len(self.columns)} columns, but the row {wrong[0]}")


@dataclass(frozen=True)
class Page:
    """A page of results: its title, an introduction in Markdown, and its tables."""

    title: str
    intro: str
    tables: tuple[Table, ...]


def read_page(path: Path) -> Page:
    """Return the page that a YAML file describes.

    Raises:
        ValueError: a key is unknown or missing, or a table is malformed.
    """
    raw = yaml.safe_load(path.read_text("utf-8"))
    try:
        tables = tuple(_table(one) for one in raw.pop("tables"))
        return Page(tables=tables, **raw)
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{path.name}: {error}") from error


def _table(raw: dict[str, Any]) -> Table:
    unknown = set(raw) - {field.name for field in fields(Table)}
    if unknown:
        raise ValueError(f"{raw.get('title')}: unknown {', '.join(sorted(unknown))}")
    columns = tuple(map(str, raw["columns"]))
    rows = tuple(tuple(map(str, row)) for row in raw["rows"])
    texts = {name: str(raw[name]) for name in ("date", "commit")}
    return Table(**(raw | texts | {"columns": columns, "rows": rows}))


def page_text(page: Page, source: str) -> str:
    """Return a page as Markdown: what falls short first, then each table with its origin."""
    parts = [f"<!-- Written by python -m benchmarks.results from benchmarks/results/{source}. -->"]
    parts += [f"# {page.title}\n\n{page.intro.strip()}"]
    short = [f"- {one.short.strip()} ([{one.title}](#{_anchor(one.title)}))" for one in page.tables
             if one.short]  # fmt: skip
    if short:
        parts.append("## What falls short\n\n" + "\n".join(short))
    return "\n\n".join([*parts, *map(_section, page.tables)]) + "\n"


def _section(table: Table) -> str:
    rule = "|" + "---|" * len(table.columns)
    lines = [_row(table.columns), rule, *map(_row, table.rows)]
    gone = "" if table.repeatable else " (a script of that commit)"
    origin = f"`{table.command}` on {table.data}; {table.date}, commit {table.commit[:8]}{gone}."
    parts = [f"## {table.title}", "\n".join(lines), f"*Measured with* {origin}"]
    return "\n\n".join([*parts, *([table.note.strip()] if table.note else [])])


def _row(cells: tuple[str, ...]) -> str:
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"


def _anchor(title: str) -> str:
    """Return the anchor that Markdown gives a heading."""
    return re.sub(r"[\s-]+", "-", re.sub(r"[^\w\s-]", "", title.lower()).strip())


def written(folder: Path = FOLDER) -> dict[str, str]:
    """Return the text of each page by the name of its file in ``docs/results``."""
    return {f"{p.stem}.md": page_text(read_page(p), p.name) for p in sorted(folder.glob("*.yaml"))}


def main(arguments: list[str] | None = None) -> int:
    """Write the pages, or name those that differ; return 1 where one does."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.results", description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing, name what differs")
    options = parser.parse_args(arguments)
    texts = written()
    differing = [n for n, text in texts.items() if not _holds(PAGES / n, text)]
    for name in differing:
        if not options.check:
            write_text(PAGES / name, texts[name])
        print(f"{'differs' if options.check else 'written'}: docs/results/{name}")
    return int(options.check and bool(differing))


def _holds(path: Path, text: str) -> bool:
    return path.is_file() and path.read_text("utf-8") == text


if __name__ == "__main__":
    sys.exit(main())

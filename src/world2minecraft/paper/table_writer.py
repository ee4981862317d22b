"""Output of a table with our values as terminal text, Markdown, LaTeX or JSON data.

Cells can contain marks that refer to notes below the table: ``[1]`` marks a contradiction in the
paper, ``[A]`` the data and command of our value, and ``[a]`` a missing value with the command that
produces it.
"""

import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from string import ascii_lowercase, ascii_uppercase
from typing import Any

from world2minecraft.minecraftocc.statistics.tables import escape_latex
from world2minecraft.navigation.running.result_tables import format_markdown
from world2minecraft.paper.table_reader import Ours, PaperRow, PaperTable

CELL_WIDTH = 36  # Longer cells are broken into lines.
PAGE_WIDTH = 100  # Of the whole: what a terminal, a mail and a page in print hold.
GAP = "  "  # Between columns.


@dataclass
class Marks:
    """Notes with their marks, where equal notes share a mark."""

    signs: str
    texts: list[str] = field(default_factory=list)

    def of(self, text: str) -> str:
        """Return the mark of a note, adding the note if it is new."""
        if text not in self.texts:
            self.texts.append(text)
        return f"[{self._sign(self.texts.index(text))}]"

    def lines(self) -> Iterator[str]:
        """Return the notes, each preceded by its mark."""
        return (f"[{self._sign(n)}] {text}" for n, text in enumerate(self.texts))

    def _sign(self, number: int) -> str:
        return self.signs[number] if number < len(self.signs) else str(number + 1)


@dataclass(frozen=True)
class Grid:
    """A table as a grid of cells with titles in the first row.

    Attributes:
        rows: The rows of cells.
        ours: The indices of rows with our values.
        left: The number of leading text columns. The others are numeric.
        notes: The lines below the table.
    """

    rows: list[list[str]]
    ours: frozenset[int]
    left: int
    notes: list[str]


def grid_of(table: PaperTable, ours: Mapping[str, Ours]) -> Grid:
    """Return a table with our values, which are given by row key, as a grid."""
    paper, sources, lacks = Marks(""), Marks(ascii_uppercase), Marks(ascii_lowercase)
    rows, own = [], set()
    for row in table.rows:
        told = ours.get(row.key)
        if row.is_printed:
            rows.append(_printed(table, row, paper))
        if table.is_beside:
            rows[-1] += [told.cells.get(key, "") if told else "" for key in table.our_columns]
            if told is not None:
                rows[-1][-1] += f" {sources.of(told.source)}"
        elif told is not None:
            own.add(len(rows) + 1)
            rows.append(_own(table, row, told, sources, lacks))
        if told is None and not table.is_beside:
            rows[-1][0] += _marks(table, row, lacks)
    titles = _titles(table)
    if table.is_beside and len(sources.texts) == 1:  # One for all: said once, in the title.
        mark = f" {sources.of(sources.texts[0])}"
        rows = [[*row[:-1], row[-1].removesuffix(mark)] for row in rows]
        titles = [
            *titles[: len(table.columns)],
            *(f"{t}{mark}" for t in table.our_columns.values()),
        ]
    notes = list(paper.lines())
    notes += [f"{line.replace('] ', '] ours: ', 1)}" for line in sources.lines()]
    notes += [f"{line.replace('] ', '] needs ', 1)}" for line in lacks.lines()]
    left = len(titles) if table.is_beside else table.stub
    return Grid([titles, *rows], frozenset(own), left, notes)


def lacking(table: PaperTable, ours: Mapping[str, Ours]) -> int:
    """Return the number of cells without a value of ours that are listed as missing."""
    return sum(
        any(lack.covers(row.key, key) for lack in table.lacks)
        and not (row.key in ours and ours[row.key].cells.get(key))
        for row in table.rows
        for key in table.fillable
    )


def _titles(table: PaperTable) -> list[str]:
    return list(table.titles.values())


def _printed(table: PaperTable, row: PaperRow, paper: Marks) -> list[str]:
    cells = [
        f"{cell} {paper.of(row.notes[key])}" if key in row.notes else cell
        for key, cell in zip(table.columns, row.cells, strict=True)
    ]
    return cells if table.is_beside else cells + [""] * len(table.our_columns)


def _own(table: PaperTable, row: PaperRow, told: Ours, sources: Marks, lacks: Marks) -> list[str]:
    """Return a row of our values, labelled "ours" below a published row."""
    stub = ["  ours", *[""] * (table.stub - 1)] if row.is_printed else list(row.cells[: table.stub])
    if told.source:
        stub[0] += f" {sources.of(told.source)}"
    return [
        *stub,
        *(told.cells.get(key) or _lack(table, row, key, lacks) for key in table.fillable),
    ]


def _lack(table: PaperTable, row: PaperRow, key: str, lacks: Marks) -> str:
    """Return the mark of the first entry of missing values that covers a cell, or ""."""
    for lack in table.lacks:
        if lack.covers(row.key, key):
            return lacks.of(f"{lack.what}: {lack.command}")
    return ""


def _marks(table: PaperTable, row: PaperRow, lacks: Marks) -> str:
    """Return the marks of a row without values of ours."""
    found = {_lack(table, row, key, lacks) for key in table.fillable}
    return "".join(f" {mark}" for mark in sorted(found - {""}))


def as_text(table: PaperTable, ours: Mapping[str, Ours]) -> str:
    """Format a table for the terminal, with its title above and its notes below."""
    grid = grid_of(table, ours)
    rows = _indented(grid)
    lines = [line for block in _blocks(rows, grid.left) for line in [*_drawn(*block), ""]]
    notes = [
        textwrap.fill(note, PAGE_WIDTH, subsequent_indent="    ", break_on_hyphens=False)
        for note in grid.notes
    ]
    return "\n".join([_title(table), "", *lines, *notes])


def as_markdown(table: PaperTable, ours: Mapping[str, Ours]) -> str:
    """Format a table as Markdown, with its notes as a list below."""
    grid = grid_of(table, ours)
    notes = [f"- {note}" for note in grid.notes]
    return "\n".join([f"**{_title(table)}**", "", format_markdown(grid.rows), "", *notes])


def as_latex(table: PaperTable, ours: Mapping[str, Ours]) -> str:
    """Format a table as LaTeX for ``booktabs``, with our rows in italics and the notes below."""
    grid = grid_of(table, ours)
    width = len(grid.rows[0])
    kinds = "l" * grid.left + "r" * (width - grid.left)
    kinds = "l" + "p{3cm}" * (width - 1) if table.is_beside else kinds
    lines = [r"\begin{table}", rf"\caption{{{escape_latex(table.about)}}}"]
    lines += [rf"\begin{{tabular}}{{{kinds}}}", r"\toprule"]
    for n, row in enumerate(grid.rows):
        cells = [escape_latex(cell.strip()) for cell in row]
        cells = [rf"\textit{{{cell}}}" if cell and n in grid.ours else cell for cell in cells]
        lines.append(" & ".join(_guarded(cells)) + r" \\")
        lines += [r"\midrule"] if n == 0 else []
    lines += [r"\bottomrule", r"\end{tabular}", ""]
    lines += [rf"{{\footnotesize {escape_latex(note)}\par}}" for note in grid.notes]
    return "\n".join([*lines, r"\end{table}"])


def as_values(table: PaperTable, ours: Mapping[str, Ours]) -> dict[str, Any]:
    """Return a table as JSON data, with the row and column keys that results files use."""
    return {
        "table": table.name,
        "number": table.number,
        "title": table.title,
        "columns": dict(table.titles),
        "results_go_to": list(table.fillable),
        "rows": [
            {
                "row": row.key,
                "printed": dict(zip(table.columns, row.cells, strict=True)),
                "is_printed": row.is_printed,
                "notes": dict(row.notes),
                "ours": _ours_values(ours.get(row.key)),
                "needs": [
                    {"columns": list(lack.columns), "what": lack.what, "command": lack.command}
                    for lack in table.lacks
                    if lack.covers(row.key)
                ],
            }
            for row in table.rows
        ],
    }


def _ours_values(told: Ours | None) -> dict[str, Any] | None:
    if told is None:
        return None
    return {
        "cells": dict(told.cells),
        "data": told.data,
        "command": told.command,
        "page": told.page,
    }


def _title(table: PaperTable) -> str:
    return f"Table {table.number} of the paper. {table.title}"


def _blocks(rows: list[list[str]], left: int) -> list[tuple[list[list[list[str]]], int]]:
    """Split a table into blocks no wider than the page, each with its number of text columns.

    Text columns are wrapped first. If that is not enough, the remaining numeric columns continue in
    a block below, with the same labels.
    """
    whole = _folded(rows)
    if _total(whole) <= PAGE_WIDTH or left == len(rows[0]):
        return [(whole, left)]
    labels, blocks = list(range(left)), []
    taken: list[int] = []
    for column in range(left, len(rows[0])):
        tried = _unfolded(rows, [*labels, *taken, column])
        if taken and _total(tried) > PAGE_WIDTH:
            blocks.append((_unfolded(rows, labels + taken), left))
            taken = []
        taken.append(column)
    return [*blocks, (_unfolded(rows, labels + taken), left)]


def _unfolded(rows: list[list[str]], columns: list[int]) -> list[list[list[str]]]:
    return [[_lines(row[n], CELL_WIDTH) for n in columns] for row in rows]


def _drawn(broken: list[list[list[str]]], left: int) -> list[str]:
    """Return the lines of a block, with text aligned left and numbers aligned right."""
    widths = _widths(broken)
    return [
        GAP.join(
            _line(cell, n).ljust(width) if column < left else _line(cell, n).rjust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in broken
        for n in range(max(len(cell) for cell in row))
    ]


def _folded(rows: list[list[str]]) -> list[list[list[str]]]:
    """Wrap the cells of the widest columns until the table fits the page."""
    limits = [CELL_WIDTH] * len(rows[0])
    firm: set[int] = set()  # Columns as narrow as their longest word.
    while True:
        broken = [
            [_lines(cell, limit) for cell, limit in zip(row, limits, strict=True)] for row in rows
        ]
        widths = _widths(broken)
        firm |= {n for n, width in enumerate(widths) if width > limits[n]}
        loose = [n for n in range(len(widths)) if n not in firm]
        if _total(broken) <= PAGE_WIDTH or not loose:
            return broken
        widest = max(loose, key=lambda n: widths[n])
        limits[widest] = min(limits[widest], widths[widest]) - 1


def _total(broken: list[list[list[str]]]) -> int:
    widths = _widths(broken)
    return sum(widths) + len(GAP) * (len(widths) - 1)


def _lines(cell: str, width: int) -> list[str]:
    width = max(width, 1)
    return textwrap.wrap(cell, width, break_long_words=False, break_on_hyphens=False) or [""]


def _widths(broken: list[list[list[str]]]) -> list[int]:
    return [max(len(line) for row in broken for line in row[n]) for n in range(len(broken[0]))]


def _indented(grid: Grid) -> list[list[str]]:
    """Return the rows with non-breaking indents, so that wrapping keeps them."""
    return [[cell.replace("  ours", "\u00a0\u00a0ours") for cell in row] for row in grid.rows]


def _line(cell: list[str], number: int) -> str:
    return cell[number].replace("\u00a0", " ") if number < len(cell) else ""


def _guarded(cells: list[str]) -> list[str]:
    r"""Prevent a bracket at the start of a LaTeX row from being read as an option of ``\\``."""
    return [f"{{}}{cell}" if cell.startswith("[") else cell for cell in cells]

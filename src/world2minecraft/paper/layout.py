"""A table and ours as one grid of text, with marks in cells and a line for each mark below it.

``[1]`` marks what in the paper contradicts itself, ``[A]`` what ours was measured on and how,
``[a]`` what we lack, with the command that fills the cell.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from string import ascii_lowercase, ascii_uppercase

from world2minecraft.paper.values import Ours, PaperRow, PaperTable


@dataclass
class Marks:
    """Texts by the mark that stands for each; equal texts share one."""

    signs: str
    texts: list[str] = field(default_factory=list)

    def of(self, text: str) -> str:
        """Return the mark of a text, a new one for a new text."""
        if text not in self.texts:
            self.texts.append(text)
        return f"[{self._sign(self.texts.index(text))}]"

    def lines(self) -> Iterator[str]:
        """Return each mark with its text."""
        return (f"[{self._sign(n)}] {text}" for n, text in enumerate(self.texts))

    def _sign(self, number: int) -> str:
        return self.signs[number] if number < len(self.signs) else str(number + 1)


@dataclass(frozen=True)
class Grid:
    """Rows of cells, the first the titles; ``ours`` are the numbers of rows that are ours.

    The first ``left`` columns are texts, all others numbers. ``notes`` are the lines below.
    """

    rows: list[list[str]]
    ours: frozenset[int]
    left: int
    notes: list[str]


def grid_of(table: PaperTable, ours: Mapping[str, Ours]) -> Grid:
    """Return a table with ours in it; ``ours`` by the keys of rows."""
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
    """Return how many cells have nothing of ours and are told to need what we lack."""
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
    """Return a row of ours: below a printed one it is called so, else by its own label."""
    stub = ["  ours", *[""] * (table.stub - 1)] if row.is_printed else list(row.cells[: table.stub])
    if told.source:
        stub[0] += f" {sources.of(told.source)}"
    return [
        *stub,
        *(told.cells.get(key) or _lack(table, row, key, lacks) for key in table.fillable),
    ]


def _lack(table: PaperTable, row: PaperRow, key: str, lacks: Marks) -> str:
    """Return the mark of the first lack that covers a cell; nothing where none does."""
    for lack in table.lacks:
        if lack.covers(row.key, key):
            return lacks.of(f"{lack.what}: {lack.command}")
    return ""


def _marks(table: PaperTable, row: PaperRow, lacks: Marks) -> str:
    """Return the marks of a row of which nothing is ours."""
    found = {_lack(table, row, key, lacks) for key in table.fillable}
    return "".join(f" {mark}" for mark in sorted(found - {""}))

"""Read tables of the paper, our figures and a user's results from YAML.

A ``PaperTable`` holds a table as printed, and what stands beside it. A user's file is checked like
any input.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from world2minecraft.core.errors import DamagedFileError, UnknownNameError
from world2minecraft.core.files import read_bytes

MAX_BYTES = 1 << 20
MAX_CELL, MAX_TEXT = 80, 400  # Letters.
_FIELDS = ("cells", "data", "command", "page", "line", "label")


@dataclass(frozen=True)
class PaperRow:
    """A row: ``cells`` as printed, in the order of the columns; ``notes`` by column.

    A row of ours that the paper has no counterpart of is not ``is_printed``; its cells are its
    label, and empty.
    """

    key: str
    cells: tuple[str, ...]
    notes: Mapping[str, str]
    is_printed: bool = True


@dataclass(frozen=True)
class Lack:
    """Cells that we cannot fill: ``what`` is missing, and the ``command`` that fills them then.

    ``rows`` and ``columns`` are keys; empty for all.
    """

    what: str
    command: str
    rows: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()

    def covers(self, row: str, column: str | None = None) -> bool:
        """Whether a row, or a cell of it, is meant.

        Example:
            >>> lack = Lack("a judge", "w2m compare judge ROOM", columns=("visual",))
            >>> lack.covers("layoutgpt"), lack.covers("layoutgpt", "oob")
            (True, False)
        """
        return (not self.rows or row in self.rows) and (
            column is None or not self.columns or column in self.columns
        )


@dataclass(frozen=True)
class Ours:
    """A row of ours: cells by column, what they were measured on (``data``), and how.

    ``page`` is the file of the repository that tells them, in ``line``; both are empty where the
    program itself knows them, or a user says them. ``label`` names a row that the table has not.
    """

    cells: Mapping[str, str]
    data: str = ""
    command: str = ""
    page: str = ""
    line: str = ""
    label: str = ""

    @property
    def source(self) -> str:
        """What the cells were measured on, and by which command, in one line."""
        told = (
            f"{self.data}: {self.command}"
            if self.data and self.command
            else self.data or self.command
        )
        return f"{told} ({self.page})" if self.page else told


@dataclass(frozen=True)
class PaperTable:
    """A table of the paper.

    ``columns`` and ``our_columns`` are titles by key; the first ``stub`` columns say what a row is.
    Where ``is_beside``, ours stands in columns of its own, else in a row below each printed one.
    """

    name: str
    number: int
    title: str
    about: str
    stub: int
    columns: Mapping[str, str]
    our_columns: Mapping[str, str]
    rows: tuple[PaperRow, ...]
    lacks: tuple[Lack, ...]
    is_beside: bool = False

    @property
    def titles(self) -> dict[str, str]:
        """Titles of all columns, ours last, by key."""
        return {**self.columns, **self.our_columns}

    @property
    def fillable(self) -> tuple[str, ...]:
        """The keys of the columns that results may stand in."""
        if self.is_beside:
            return tuple(self.our_columns)
        return (*tuple(self.columns)[self.stub :], *self.our_columns)


TABLES = Path(__file__).with_name("tables")
MEASURED = Path(__file__).with_name("measured.yaml")

Results = dict[str, dict[str, Ours]]  # By table, then by row.


@cache
def table_names() -> dict[str, int]:
    """Return the names of the tables with their numbers, in the paper's order."""
    numbers = {path.stem: _yaml(path)["number"] for path in TABLES.glob("*.yaml")}
    return dict(sorted(numbers.items(), key=lambda one: one[1]))


def read_table(which: str | int) -> PaperTable:
    """Return a table by its name or its number in the paper.

    Raises:
        UnknownNameError: there is none.

    Example:
        >>> read_table(6).title, read_table("layouts").number
        ('Layout methods', 6)
    """
    names = table_names()
    by_number = {str(number): name for name, number in names.items()}
    name = by_number.get(str(which), str(which))
    if name not in names:
        raise UnknownNameError("table of the paper", str(which), names)
    raw = _yaml(TABLES / f"{name}.yaml")
    columns, stub = raw["columns"], raw["stub"]
    rows = [_printed(row) for row in raw["rows"]]
    printed = tuple(row.key for row in rows)
    lacks = [_lack(lack, printed) for lack in raw.get("lacks", ())]
    rows += [_own(row["key"], row["label"], len(columns)) for row in raw.get("more", ())]
    return PaperTable(
        name=name,
        number=raw["number"],
        title=raw["title"],
        about=raw["about"],
        stub=stub,
        columns=columns,
        our_columns=raw.get("our_columns", {}),
        rows=tuple(rows),
        lacks=tuple(lacks),
        is_beside=raw.get("layout") == "columns",
    )


@cache
def measured() -> Results:
    """Return what we measured, by table and row."""
    return read_results(MEASURED)


def read_results(path: str | Path) -> Results:
    """Read results: YAML or JSON, ``TABLE: {ROW: {cells: {COLUMN: value}, data: ...}}``.

    A row that the table has not is a new one where it has a ``label``.

    Raises:
        InputError: the file is missing. DamagedFileError: it is no such table.
        UnknownNameError: a key is none of the tables, rows, columns or fields.
    """
    try:
        raw = _yaml(Path(path))
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise DamagedFileError(path, "is no YAML") from error
    results: Results = {}
    for name, rows in _mapping(path, "it", raw).items():
        table = read_table(name)
        results[table.name] = {
            row: _checked(path, table, row, _mapping(path, f"{name}.{row}", told))
            for row, told in _mapping(path, name, rows).items()
        }
    return results


def _checked(path: str | Path, table: PaperTable, row: str, told: Mapping[str, Any]) -> Ours:
    """Return a row of results whose keys are all known and whose texts can be printed."""
    known = [one.key for one in table.rows]
    if row not in known and "label" not in told:
        raise UnknownNameError(f"row of table {table.name}", row, known)
    for field in told:
        if field not in _FIELDS:
            raise UnknownNameError(f"field of row {row}", field, _FIELDS)
    cells = _mapping(path, f"the cells of {row}", told.get("cells", {}))
    for column in cells:
        if column not in table.fillable:
            raise UnknownNameError(f"column of table {table.name}", column, table.fillable)
    texts = {field: _text(path, row, told.get(field, ""), MAX_TEXT) for field in _FIELDS[1:]}
    return Ours({key: _text(path, key, value, MAX_CELL) for key, value in cells.items()}, **texts)


def _text(path: str | Path, key: str, value: Any, limit: int) -> str:
    if isinstance(value, bool) or not isinstance(value, (str, int, float)):
        raise DamagedFileError(path, f"{key} must be a number or a text")
    if isinstance(value, float) and not math.isfinite(value):
        raise DamagedFileError(path, f"{key} must be a finite number")
    text = str(value)
    if len(text) > limit or not text.isprintable():
        raise DamagedFileError(path, f"{key} must be of at most {limit} letters, in one line")
    return text


def _mapping(path: str | Path, what: str, value: Any) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise DamagedFileError(path, f"{what} must be a mapping, as w2m paper --help shows")
    return {str(key): one for key, one in value.items()}


def _printed(raw: Mapping[str, Any]) -> PaperRow:
    cells = tuple(cell.strip() for cell in raw["cells"].split("|"))
    return PaperRow(raw["key"], cells, raw.get("notes", {}))


def _own(key: str, label: str, width: int) -> PaperRow:
    cells = [cell.strip() for cell in label.split("|")]
    return PaperRow(key, (*cells, *[""] * (width - len(cells))), {}, is_printed=False)


def _lack(raw: Mapping[str, Any], printed: tuple[str, ...]) -> Lack:
    rows = raw.get("rows", ())
    rows = printed if rows == "printed" else tuple(rows)
    return Lack(raw["what"], raw["command"], rows, tuple(raw.get("columns", ())))


def _yaml(path: Path) -> Any:
    return yaml.safe_load(read_bytes(path, MAX_BYTES))

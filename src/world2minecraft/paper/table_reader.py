"""Reading of the paper's tables, of our measurements and of user results from YAML.

``PaperTable`` contains a table as published. User files are validated like any other input.
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
    """A row of a table.

    Attributes:
        key: The key of the row.
        cells: The cells as published, in column order. For a row that the paper does not have, its
            label followed by empty cells.
        notes: Notes by column.
        is_printed: Whether the paper has the row.
    """

    key: str
    cells: tuple[str, ...]
    notes: Mapping[str, str]
    is_printed: bool = True


@dataclass(frozen=True)
class Lack:
    """Cells for which we have no measurement, and how to obtain it.

    Attributes:
        what: The missing resource.
        command: The command that produces the values once the resource is available.
        rows: The keys of the rows. Empty means all.
        columns: The keys of the columns. Empty means all.
    """

    what: str
    command: str
    rows: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()

    def covers(self, row: str, column: str | None = None) -> bool:
        """Return whether the measurement is missing for a row, or for one of its cells.

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
    """A row of our own values.

    Attributes:
        cells: The values by column.
        data: The data on which the values were measured.
        command: The command that measures them.
        page: The documentation file that states the values. Empty for values from the program or
            the user.
        line: The line of the page that states the values.
        label: The label of a row that the published table does not have.
    """

    cells: Mapping[str, str]
    data: str = ""
    command: str = ""
    page: str = ""
    line: str = ""
    label: str = ""

    @property
    def source(self) -> str:
        """The data and the command of the values in one line."""
        told = (
            f"{self.data}: {self.command}"
            if self.data and self.command
            else self.data or self.command
        )
        return f"{told} ({self.page})" if self.page else told


@dataclass(frozen=True)
class PaperTable:
    """A table of the paper.

    Attributes:
        name: The name of the table.
        number: Its number in the paper.
        title: Its title.
        about: Its caption.
        stub: The number of leading columns that identify a row.
        columns: The titles of the published columns by key.
        our_columns: The titles of our own columns by key.
        rows: The rows.
        lacks: The cells for which we have no measurement.
        is_beside: Whether our values are in separate columns instead of a row below each published
            one.
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
        """The titles of all columns by key, with our own last."""
        return {**self.columns, **self.our_columns}

    @property
    def fillable(self) -> tuple[str, ...]:
        """The keys of the columns that can contain results."""
        if self.is_beside:
            return tuple(self.our_columns)
        return (*tuple(self.columns)[self.stub :], *self.our_columns)


TABLES = Path(__file__).with_name("tables")
MEASURED = Path(__file__).with_name("measured.yaml")

Results = dict[str, dict[str, Ours]]  # By table, then by row.


@cache
def table_names() -> dict[str, int]:
    """Return the numbers of the tables by name, in the paper's order."""
    numbers = {path.stem: _yaml(path)["number"] for path in TABLES.glob("*.yaml")}
    return dict(sorted(numbers.items(), key=lambda one: one[1]))


def read_table(which: str | int) -> PaperTable:
    """Read a table by its name or its number in the paper.

    Raises:
        UnknownNameError: If the table is unknown.

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
    """Return our measurements by table and row."""
    return read_results(MEASURED)


def read_results(path: str | Path) -> Results:
    """Read results from YAML or JSON: ``TABLE: {ROW: {cells: {COLUMN: value}, data: ...}}``.

    A row that the table does not have must have a ``label`` and is added.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If the file is not a valid table of results.
        UnknownNameError: If a table, row, column or field is unknown.
    """
    try:
        raw = _yaml(Path(path))
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise DamagedFileError(path, "not valid YAML") from error
    results: Results = {}
    for name, rows in _mapping(path, "the file", raw).items():
        table = read_table(name)
        results[table.name] = {
            row: _checked(path, table, row, _mapping(path, f"{name}.{row}", told))
            for row, told in _mapping(path, name, rows).items()
        }
    return results


def _checked(path: str | Path, table: PaperTable, row: str, told: Mapping[str, Any]) -> Ours:
    """Validate a row of results."""
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
        raise DamagedFileError(path, f"{key} must be a number or a string")
    if isinstance(value, float) and not math.isfinite(value):
        raise DamagedFileError(path, f"{key} must be a finite number")
    text = str(value)
    if len(text) > limit or not text.isprintable():
        raise DamagedFileError(path, f"{key} must be a single line of at most {limit} characters")
    return text


def _mapping(path: str | Path, what: str, value: Any) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise DamagedFileError(path, f"{what} must be a mapping; w2m paper --help shows an example")
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

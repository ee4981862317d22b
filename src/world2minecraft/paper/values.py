"""A table of the paper as printed, and what stands beside it."""

from collections.abc import Mapping
from dataclasses import dataclass


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

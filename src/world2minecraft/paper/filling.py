"""What stands in our rows of a table: figures of our pages, of the program, of the user."""

from dataclasses import replace

from world2minecraft.paper.from_program import known_to_the_program
from world2minecraft.paper.reading import Results, measured
from world2minecraft.paper.values import Ours, PaperRow, PaperTable


def filled(table: PaperTable, results: Results | None = None) -> tuple[PaperTable, dict[str, Ours]]:
    """Return a table and our rows of it, by key; rows that a user adds are in the table, too.

    A row of the user's ``results`` stands in place of ours, whole: no row mixes two measurements.
    """
    own = (results or {}).get(table.name, {})
    ours = {**known_to_the_program(table), **measured().get(table.name, {}), **own}
    known = {row.key for row in table.rows}
    new = tuple(_new(key, ours[key].label, table) for key in own if key not in known)
    return replace(table, rows=(*table.rows, *new)), ours


def _new(key: str, label: str, table: PaperTable) -> PaperRow:
    cells = [part.strip() for part in label.split("|")][: table.stub]
    return PaperRow(key, (*cells, *[""] * (len(table.columns) - len(cells))), {}, is_printed=False)

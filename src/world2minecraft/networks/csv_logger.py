"""Log the metrics of a run to ``metrics.csv`` and to TensorBoard.

The CSV has a row a figure: step, name, value. It holds no times, so that a run that was stopped and
went on leaves the same bytes as one that was not.
"""

# Not by Lightning's CSVLogger: it removes the file of an earlier try, whose rows up to the
# checkpoint are kept here, and writes in place, so that a kill may leave half a file.

import csv
import io
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import write_text

METRICS = "metrics.csv"
HEADER = ("step", "name", "value")


class CsvLogger:
    """Logs the figures of a run, from a step on."""

    def __init__(self, folder: Path, first_step: int = 0):
        """Go on after ``first_step``: what an earlier try wrote of later steps is dropped."""
        self._path, self._folder = folder / METRICS, folder / "tensorboard"
        self._rows = [row for row in read_metrics(self._path) if row[0] <= first_step]
        self._first = first_step
        self._board: Any = None

    def log_metrics(self, step: int, figures: Mapping[str, float]) -> None:
        """Log figures of a step; TensorBoard has them at once, the CSV with ``save``."""
        if self._board is None:
            from torch.utils.tensorboard import SummaryWriter  # noqa: PLC0415

            self._board = SummaryWriter(str(self._folder), purge_step=self._first + 1)
        for name in sorted(figures):
            self._rows.append((step, name, float(figures[name])))
            self._board.add_scalar(name, figures[name], step)

    def save(self) -> None:
        """Write the CSV whole."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(HEADER)
        writer.writerows((step, name, repr(value)) for step, name, value in self._rows)
        write_text(self._path, text.getvalue())
        if self._board is not None:
            self._board.flush()

    def finalize(self) -> None:
        """Write the CSV and let TensorBoard's file go."""
        self.save()
        if self._board is not None:
            self._board.close()


def read_metrics(path: Path) -> list[tuple[int, str, float]]:
    """Return the rows of a ``metrics.csv``; none where there is no file.

    Raises:
        DamagedFileError: it holds something else.

    Example:
        >>> read_metrics(Path("nowhere.csv"))
        []
    """
    if not path.is_file():
        return []
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))[1:]
        return [(int(step), name, float(value)) for step, name, value in rows]
    except ValueError as error:
        raise DamagedFileError(
            path,
            f"holds no rows of step, name, value ({error}); remove it, and the run goes on",
        ) from error

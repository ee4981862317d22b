"""Logging of metrics to ``metrics.csv`` and to TensorBoard.

The CSV file has a row with step, name and value for each metric. It contains no times, so a run
that was interrupted and resumed produces the same file as an uninterrupted run.
"""

# Lightning's CSVLogger is not used: it deletes the file of an earlier attempt, whose rows up to the
# checkpoint are kept here, and writes in place, so that a killed run could leave a partial file.

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
    """A logger for the metrics of a run."""

    def __init__(self, folder: Path, first_step: int = 0):
        """Open the log and discard existing rows of steps after ``first_step``."""
        self._path, self._folder = folder / METRICS, folder / "tensorboard"
        self._rows = [row for row in read_metrics(self._path) if row[0] <= first_step]
        self._first = first_step
        self._board: Any = None

    def log_metrics(self, step: int, figures: Mapping[str, float]) -> None:
        """Log metrics to TensorBoard immediately and to the CSV file at the next ``save``.

        Args:
            step: Training step.
            figures: Metrics by name.
        """
        if self._board is None:
            from torch.utils.tensorboard import SummaryWriter  # noqa: PLC0415

            self._board = SummaryWriter(str(self._folder), purge_step=self._first + 1)
        for name in sorted(figures):
            self._rows.append((step, name, float(figures[name])))
            self._board.add_scalar(name, figures[name], step)

    def save(self) -> None:
        """Write the complete CSV file."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(HEADER)
        writer.writerows((step, name, repr(value)) for step, name, value in self._rows)
        write_text(self._path, text.getvalue())
        if self._board is not None:
            self._board.flush()

    def finalize(self) -> None:
        """Write the CSV file and close the TensorBoard file."""
        self.save()
        if self._board is not None:
            self._board.close()


def read_metrics(path: Path) -> list[tuple[int, str, float]]:
    """Read the rows of ``metrics.csv``, or return an empty list if the file does not exist.

    Raises:
        DamagedFileError: If the file is not valid.

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
            f"must contain rows of step, name, value ({error}); delete the file to resume the run",
        ) from error

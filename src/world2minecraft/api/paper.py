"""The tables and figures of the paper, with our own measurements."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import path_of

if TYPE_CHECKING:
    from PIL.Image import Image

    from world2minecraft.paper import Ours, PaperTable


@dataclass(frozen=True, eq=False)
class FilledTable:
    """A table of the paper with our results. ``str()`` formats it for a terminal.

    Attributes:
        table: The table as printed in the paper.
        ours: Our rows by key, each with the data it was measured on and the command.
    """

    table: "PaperTable"
    ours: Mapping[str, "Ours"]

    @property
    def cells(self) -> int:
        """Number of cells with our results."""
        return sum(len(one.cells) for one in self.ours.values())

    @property
    def lacking(self) -> int:
        """Number of cells that require data or hardware we do not have."""
        from world2minecraft.paper.table_writer import lacking

        return lacking(self.table, self.ours)

    def text(self) -> str:
        """Return the table as text."""
        from world2minecraft.paper.table_writer import as_text

        return as_text(self.table, self.ours)

    def markdown(self) -> str:
        """Return the table as Markdown."""
        from world2minecraft.paper.table_writer import as_markdown

        return as_markdown(self.table, self.ours)

    def latex(self) -> str:
        """Return the table as LaTeX that uses booktabs."""
        from world2minecraft.paper.table_writer import as_latex

        return as_latex(self.table, self.ours)

    def to_dict(self) -> dict[str, Any]:
        """Return all keys, values and sources as JSON-compatible values."""
        from world2minecraft.paper.table_writer import as_values

        return as_values(self.table, self.ours)

    def __repr__(self) -> str:
        return f"FilledTable({self.table.number}, {self.table.name!r}, {self.table.title!r})"

    def __str__(self) -> str:
        return self.text()


def paper_tables(
    which: int | str = "all", *, results: str | Path | None = None
) -> list[FilledTable]:
    """Return tables of the paper with our results next to the printed ones.

    A cell that requires data or hardware we do not have is marked, with a note on the requirement
    and the command that fills the cell.

    Args:
        which: Number or name of a table, or ``all``.
        results: YAML or JSON file with your own results, used instead of ours.

    Raises:
        UnknownNameError: If the table is unknown.
        InputError: If the results cannot be read.

    Example:
        >>> from world2minecraft.api.paper import paper_tables
        >>> [paper_tables(6)[0].table.title, len(paper_tables()) > 5]
        ['Layout methods', True]
    """
    from world2minecraft.paper import fill_table, read_results, read_table, table_names

    own = read_results(results) if results is not None else None
    names = list(table_names()) if which == "all" else [which]
    return [FilledTable(*fill_table(read_table(name), own)) for name in names]


def paper_figure(
    run: Run | str | Path,
    *,
    capture: str | Path | None = None,
    walk: str | Path | None = None,
    out: str | Path | None = None,
) -> "Image":
    """Draw the paper's figure for a room: photo, world, predicted cells and construction.

    The photo and the world are shown from the same pose. The cells and the construction are shown
    from outside, without the ceiling and the near walls.

    Args:
        run: A finished reconstruction or its folder.
        capture: Capture that was reconstructed. Defaults to ``capture`` in the run folder.
        walk: Folder written by ``run_agent``. Adds a strip with the agent's views.
        out: Optional PNG file to write.

    Raises:
        CaptureError: If the capture has no posed photo that the run used.
        InputError: If a file is missing or damaged.

    Example:
        >>> from world2minecraft.api.paper import paper_figure
        >>> paper_figure(run, capture=scan).width > 500
        True
    """
    from PIL import Image

    from world2minecraft.core.files import write_bytes
    from world2minecraft.evaluation.report.comparison_pictures import as_png
    from world2minecraft.paper.figure import reconstruction_figure

    folder = path_of(run)
    strip = None if walk is None else Path(walk)
    pixels = reconstruction_figure(
        folder, folder / "capture" if capture is None else Path(capture), strip
    )
    if out is not None:
        write_bytes(Path(out), as_png(pixels))
    return Image.fromarray(pixels)

"""The tables and figures of the paper, with what we measured."""

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
    """A table of the paper with our figures in it; as text, for a terminal.

    Attributes:
        table: the table as printed.
        ours: our rows by their keys, each with what it was measured on and the command.
    """

    table: "PaperTable"
    ours: Mapping[str, "Ours"]

    @property
    def cells(self) -> int:
        """How many cells are ours."""
        return sum(len(one.cells) for one in self.ours.values())

    @property
    def lacking(self) -> int:
        """How many cells need data or hardware that we lack."""
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
        """Return the table as LaTeX, for booktabs."""
        from world2minecraft.paper.table_writer import as_latex

        return as_latex(self.table, self.ours)

    def to_dict(self) -> dict[str, Any]:
        """Return every key, value and source, for JSON."""
        from world2minecraft.paper.table_writer import as_values

        return as_values(self.table, self.ours)

    def __repr__(self) -> str:
        return f"FilledTable({self.table.number}, {self.table.name!r}, {self.table.title!r})"

    def __str__(self) -> str:
        return self.text()


def paper_tables(
    which: int | str = "all", *, results: str | Path | None = None
) -> list[FilledTable]:
    """Return tables of the paper with our figures beside the printed ones.

    A cell of ours that needs what we lack says so and names the command that fills it.

    Args:
        which: a table by its number or its name, or ``all``.
        results: results of your own, YAML or JSON, in place of ours.

    Raises:
        UnknownNameError: there is no such table. InputError: the results cannot be read.

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
    """Draw the paper's figure of a room: photo, world, predicted cells, construction.

    The photo and the world are seen from one pose, the cells and the construction from outside,
    without ceiling and near walls.

    Args:
        run: a finished reconstruction, or its folder.
        capture: what it was reconstructed from; ``capture`` of the run by default.
        walk: the folder of ``run_agent``, for a strip of what its agent saw.
        out: the PNG file to write.

    Raises:
        CaptureError: the capture has no posed photo that the run used.
        InputError: a file is missing or damaged.

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

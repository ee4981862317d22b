"""Matplotlib plots for the statistics of a data set: classes, fine classes and scenes."""

import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from world2minecraft.core.classes import CLASS_COLOURS, display_name
from world2minecraft.core.errors import MissingExtraError
from world2minecraft.core.files import write_bytes
from world2minecraft.minecraftocc.statistics.published_figures import NYU_TRAIN_VOXELS
from world2minecraft.minecraftocc.statistics.tables import class_shares, format_count
from world2minecraft.minecraftocc.statistics.types import DatasetStatistics

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH_IN, HEIGHT_IN, DPI = 7.6, 4.2, 200
ROW_IN = 0.3  # Height of a row.
FAINT, RULE, OURS = "#6d747c", "#dfe3e7", "#3f7cac"
MAX_LABEL = 0.08  # Of the axis: maximum width of a step.


def write_plots(statistics: DatasetStatistics, folder: str | Path) -> list[Path]:
    """Write the plots for a data set to a folder.

    ``classes.png`` has a bar for each class and a mark for its share in NYUv2. ``fine_classes.png``
    shows how many pixels see each fine class, and ``scenes.png`` the voxels of each scene. Local
    matplotlib settings are ignored, so the same statistics produce identical files.

    Returns:
        The paths of the files, sorted by name.

    Raises:
        MissingExtraError: If matplotlib is not installed.
        OutputError: If the folder cannot be written.
    """
    need_matplotlib()
    import matplotlib.style  # noqa: PLC0415  # An extra, and slow to import.

    plain = ["default", {"text.parse_math": False}]  # A name may hold a dollar sign.
    with matplotlib.style.context(plain):
        drawn = {"classes.png": class_plot(statistics), "scenes.png": scene_plot(statistics)}
        if statistics.fine:
            drawn["fine_classes.png"] = fine_plot(statistics)
        for name, figure in drawn.items():
            stream = io.BytesIO()
            figure.savefig(stream, format="png", dpi=DPI, metadata={"Software": None})
            write_bytes(Path(folder) / name, stream.getvalue())
    return [Path(folder) / name for name in sorted(drawn)]


def need_matplotlib() -> None:
    """Check that matplotlib is installed, before a data set is counted.

    Raises:
        MissingExtraError: If matplotlib is not installed.
    """
    try:
        import matplotlib.style  # noqa: F401, PLC0415
    except ImportError as error:
        raise MissingExtraError("drawing plots", "data") from error


def class_plot(statistics: DatasetStatistics) -> "Figure":
    """Plot the share of each class in all occupied voxels, in descending order."""
    ours, theirs = class_shares(statistics.class_voxels), class_shares(NYU_TRAIN_VOXELS)
    order = sorted(range(len(ours)), key=lambda n: -ours[n])
    under = f"{statistics.voxels:,} voxels in {statistics.pictures:,} images; lines show NYUv2"
    figure, axes = _new_page(f"Classes of {statistics.name}", under, 1.1 + ROW_IN * len(order))
    colours = [tuple(part / 255 for part in CLASS_COLOURS[n + 1]) for n in order]
    rows = np.arange(len(order))
    axes.barh(rows, [ours[n] for n in order], color=colours)
    axes.vlines([theirs[n] for n in order], rows - 0.45, rows + 0.45, colors="black", linewidths=1)
    axes.set_yticks(rows, [display_name(n + 1) for n in order])
    axes.set_xlim(0, 1.02 * max(0.01, *ours, *theirs))
    axes.invert_yaxis()
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:.0%}")
    axes.grid(axis="x", color=RULE)
    row_transform = axes.get_yaxis_transform()  # x in fractions of the axis, y in rows.
    for row, n in enumerate(order):
        columns_at = {1.08: f"{ours[n]:.1%}", 1.18: format_count(statistics.class_voxels[n + 1])}
        for place, text in columns_at.items():
            axes.text(place, row, text, transform=row_transform, ha="right", va="center")
    return figure


def scene_plot(statistics: DatasetStatistics) -> "Figure":
    """Plot the number of voxels of each scene, in descending order."""
    values = sorted((scene.voxels for scene in statistics.scenes), reverse=True)
    under = f"{len(values):,} scenes; mean {format_count(statistics.voxels_per_scene)} voxels"
    return _draw_steps(f"Voxels per scene of {statistics.name}", under, values, "scenes")


def fine_plot(statistics: DatasetStatistics) -> "Figure":
    """Plot the pixels of each frequent fine class in descending order on a log scale."""
    values = [one.pixels for one in statistics.fine or () if one.is_seen_enough]
    under = f"pixels of {len(values):,} frequent fine classes, log scale"
    return _draw_steps(
        f"Fine classes of {statistics.name}", under, values, "fine classes", log=True
    )


def _draw_steps(
    title: str, under: str, values: Sequence[int], what: str, log: bool = False
) -> "Figure":
    """Draw descending values as an area with grid lines at round numbers."""
    figure, axes = _new_page(title, under, HEIGHT_IN)
    axes.stairs(values, np.arange(len(values) + 1), fill=True, color=OURS, baseline=int(log))
    axes.set_xlim(0, max(len(values), 1 / MAX_LABEL))
    if log:
        axes.set_yscale("log")
    axes.set_ylim(int(log), 1.05 * max([2, *values]))
    axes.yaxis.set_major_formatter(lambda value, _: format_count(value).replace(".0", ""))
    axes.set_xticks([])
    axes.set_xlabel(f"{len(values):,} {what}", loc="left", color=FAINT)
    axes.grid(axis="y", color=RULE)
    return figure


def _new_page(title: str, under: str, height_in: float) -> "tuple[Figure, Axes]":
    from matplotlib.figure import Figure  # noqa: PLC0415

    figure = Figure(figsize=(WIDTH_IN, height_in), layout="constrained")
    axes = figure.add_subplot()
    figure.suptitle(title, x=0.02, ha="left", fontsize=14)
    axes.set_title(under, loc="left", fontsize=9, color=FAINT)
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_axisbelow(True)
    return figure, axes

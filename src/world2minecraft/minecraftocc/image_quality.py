"""Image quality of a data set or folder: NIQE, PIQE and LV for a sample of its images.

The paper measures 100 random images of each data set and does not name the variants of the metrics.
Here, each result names its variant: the NIQE model, the kernel size of the Laplacian and the size
of the images.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.capture.images import SUFFIXES, read_colour, read_header
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.evaluation.metrics.image_quality import NiqeModel, laplacian_variance, piqe
from world2minecraft.evaluation.metrics.image_quality.niqe import (
    distance,
    has_patches,
    patch_features,
)
from world2minecraft.minecraftocc.statistics.published_figures import (
    PAPER,
    PUBLISHED_QUALITY,
    PublishedQuality,
)
from world2minecraft.minecraftocc.statistics.tables import align_columns
from world2minecraft.minecraftocc.store import OccStore, open_store
from world2minecraft.minecraftocc.store.folder import META

KERNELS = (1, 5)
PAPER_KERNEL, PAPER_VARIANT = 5, "skvideo"  # Inferred: see CAVEATS.
NATIVE = "native"
MAX_SIDE_PX = 16_384  # Of resized images.
CAVEATS = (
    "NIQE and PIQE are made for photographs, so their values for rendered blocks mean little.",
    "LV changes by hundreds with kernel k and image size, and counts block edges as detail.",
    "The paper names no variant; its values resemble scikit-video's NIQE and LV with k=5.",
)


@dataclass(frozen=True)
class PictureSource:
    """A set of images that are read one at a time.

    Attributes:
        name: Name of the data set or folder.
        keys: Keys of the images.
        read: Function that reads the image with a key, uint8 [H, W, 3].
        is_picture: Function that returns whether a key is a colour image. None if all of them are.
    """

    name: str
    keys: tuple[str, ...]
    read: Callable[[str], np.ndarray]
    is_picture: Callable[[str], bool] | None = None


def open_pictures(path: str | Path) -> PictureSource:
    """Open the images of a data set, or of a folder with its subfolders.

    Raises:
        InputError: If there are no images.
        DamagedFileError: If the data set is damaged.
    """
    place = Path(path)
    if (place / META).is_file():
        return _of_store(open_store(place))
    return _of_folder(place)


def _of_store(store: OccStore) -> PictureSource:
    def read(key: str) -> np.ndarray:
        colour = store[key].colour
        if colour is None:
            raise InputError(store.folder, f"sample {key} has labels but no image")
        return colour

    return PictureSource(store.folder.resolve().name, tuple(store.keys()), read)


def _of_folder(folder: Path) -> PictureSource:
    if not folder.is_dir():
        raise InputError(folder, "not a data set and not a folder of images")
    found = sorted(
        place.relative_to(folder).as_posix()
        for place in folder.rglob("*")
        if place.suffix.lower() in SUFFIXES and place.is_file()
    )
    if not found:
        raise InputError(folder, f"no image files found ({', '.join(SUFFIXES)})")

    def is_picture(key: str) -> bool:
        return not read_header(folder / key).mode.startswith(("I", "F"))  # Such as depth images.

    def read(key: str) -> np.ndarray:
        return read_colour(folder / key)

    return PictureSource(folder.resolve().name, tuple(found), read, is_picture)


@dataclass(frozen=True)
class PictureQuality:
    """The quality metrics of one image at one size.

    Attributes:
        niqe: NIQE by model name; NaN if it cannot be computed.
        piqe: PIQE.
        laplacian: Variance of the Laplacian by kernel size.
    """

    niqe: Mapping[str, float]
    piqe: float
    laplacian: Mapping[int, float]


@dataclass(frozen=True)
class QualityRow:
    """Mean quality metrics of images at one size. A mean without values is None.

    Attributes:
        size: ``native``, or the size such as ``640x480``.
        pictures: Number of images.
        niqe: Mean NIQE by model name.
        piqe: Mean PIQE.
        laplacian: Mean variance of the Laplacian by kernel size.
        without_niqe: Number of images that are too small or too uniform for NIQE.
    """

    size: str
    pictures: int
    niqe: Mapping[str, float | None]
    piqe: float | None
    laplacian: Mapping[int, float | None]
    without_niqe: int


@dataclass(frozen=True)
class QualityReport:
    """The image quality of a data set.

    Attributes:
        name: Name of the data set.
        rows: Mean metrics for each image size.
        variants: Names of the NIQE models.
        sizes_px: Original sizes of the images, such as ``640x480``.
        found: Number of images in the data set, of which a sample was measured.
    """

    name: str
    rows: tuple[QualityRow, ...]
    variants: tuple[str, ...]
    sizes_px: tuple[str, ...]
    found: int = 0


def sample_keys(
    keys: Sequence[str], count: int, seed: int, is_wanted: Callable[[str], bool] | None = None
) -> list[str]:
    """Choose a random sample of keys.

    Args:
        keys: Keys in any order.
        count: Size of the sample. All keys are returned if there are fewer.
        seed: Random seed. The same seed always gives the same sample.
        is_wanted: Function that returns whether a key may be chosen. It is called only until the
            sample is complete. Defaults to all keys.

    Example:
        >>> sample_keys(["a", "b", "c", "d"], 2, seed=0)
        ['a', 'c']
    """
    if count < 1:
        raise UsageError(f"--sample must be 1 or more, got {count}")
    ordered = sorted(keys)
    shuffled = (ordered[n] for n in np.random.default_rng(seed).permutation(len(ordered)))
    return sorted(islice((key for key in shuffled if not is_wanted or is_wanted(key)), count))


def check_size(size: tuple[int, int]) -> None:
    """Check that images can be resized to this width and height.

    Raises:
        UsageError: If a side is out of range.
    """
    if min(size) < 1 or max(size) > MAX_SIDE_PX:
        width, height = size
        raise UsageError(
            f"--resize must be from 1 to {MAX_SIDE_PX:,} pixels per side, got {width}x{height}"
        )


def picture_quality(picture: np.ndarray, models: Sequence[NiqeModel]) -> PictureQuality:
    """Compute the quality metrics of an image, uint8 [H, W, 3]."""
    return PictureQuality(
        _niqe(picture, models),
        piqe(picture),
        {kernel: laplacian_variance(picture, kernel) for kernel in KERNELS},
    )


def measure_quality(
    name: str,
    keys: Sequence[str],
    read: Callable[[str], np.ndarray],
    models: Sequence[NiqeModel],
    resize: tuple[int, int] | None = None,
    *,
    progress: Progress = no_progress,
) -> QualityReport:
    """Compute the mean quality metrics of images at their original size and, if requested, resized.

    Args:
        name: Name of the data set.
        keys: Keys of the images to measure.
        read: Function that reads the image with a key, uint8 [H, W, 3].
        models: NIQE models to use.
        resize: Width and height of a second size to measure. None measures only the original size.
        progress: Callback that reports progress after each image.
    """
    found: dict[str, list[PictureQuality]] = {NATIVE: []}
    sizes = set()
    for done, key in enumerate(keys):
        progress("quality", done, len(keys), key)
        picture = read(key)
        size = (picture.shape[1], picture.shape[0])
        sizes.add(size)
        found[NATIVE].append(picture_quality(picture, models))
        if resize is not None:
            same = size == resize
            small = (
                found[NATIVE][-1]
                if same
                else picture_quality(resize_and_crop(picture, resize), models)
            )
            found.setdefault("x".join(map(str, resize)), []).append(small)
    progress("quality", len(keys), len(keys))
    if resize is not None and sizes == {resize}:
        del found["x".join(map(str, resize))]  # It would repeat the first row.
    variants = tuple(model.name for model in models)
    rows = tuple(_row(size, figures, variants) for size, figures in found.items())
    return QualityReport(name, rows, variants, tuple(f"{w}x{h}" for w, h in sorted(sizes)))


def resize_and_crop(picture: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """Resize an image to a width and height with an area filter, or bicubic if it is enlarged.

    An image with a different aspect ratio is cropped around its centre.
    """
    image = Image.fromarray(picture)
    share = max(size[0] / image.width, size[1] / image.height)
    width, height = size[0] / share, size[1] / share
    left, top = (image.width - width) / 2, (image.height - height) / 2
    box = (left, top, left + width, top + height)
    method = Image.Resampling.BOX if share < 1 else Image.Resampling.BICUBIC
    return np.array(image.resize(size, method, box), np.uint8)


def quality_text(report: QualityReport) -> str:
    """Format a report as a table with the paper's values at the top and remarks below."""
    shown = _shown_variants(report)
    head = ["data set", "size", "images", *(f"NIQE {name}" for name in shown)]
    head += ["PIQE", *(f"LV k={kernel}" for kernel in KERNELS)]
    rows = [tuple(head)]
    rows += [_published_row(row, shown) for row in PUBLISHED_QUALITY]
    for row in report.rows:
        size = _sizes(report.sizes_px) if row.size == NATIVE else row.size
        figures = [_format_number(row.niqe.get(name), 2) for name in shown]
        figures += [
            _format_number(row.piqe, 2),
            *(_format_number(row.laplacian[k], 0) for k in KERNELS),
        ]
        rows.append((report.name, size, f"{row.pictures:,}", *figures))
    lines = [*align_columns(rows), ""]
    lines += [f"note: {caveat}" for caveat in CAVEATS]
    without = max((row.without_niqe for row in report.rows), default=0)
    if without:
        lines.append(f"note: {without:,} images are too small or too uniform for NIQE.")
    return "\n".join(lines)


def quality_json(report: QualityReport) -> dict[str, Any]:
    """Return a report with the paper's values and the remarks as a dict for JSON."""
    return {
        **asdict(report),
        "published": {"source": PAPER, "rows": [asdict(row) for row in PUBLISHED_QUALITY]},
        "caveats": list(CAVEATS),
    }


def _niqe(picture: np.ndarray, models: Sequence[NiqeModel]) -> dict[str, float]:
    """Return NIQE by model name, computing shared features only once."""
    if has_patches(picture):
        manners = {model.manner for model in models}
        features = {manner: patch_features(picture, manner)[0] for manner in manners}
        return {model.name: distance(features[model.manner], model) for model in models}
    return {model.name: float("nan") for model in models}  # Too small: reported below the table.


def _row(size: str, figures: Sequence[PictureQuality], variants: Sequence[str]) -> QualityRow:
    by_model = {name: [one.niqe[name] for one in figures] for name in variants}
    missing = max((int(np.isnan(values).sum()) for values in by_model.values()), default=0)
    return QualityRow(
        size,
        len(figures),
        {name: _mean(values) for name, values in by_model.items()},
        _mean([one.piqe for one in figures]),
        {kernel: _mean([one.laplacian[kernel] for one in figures]) for kernel in KERNELS},
        missing,
    )


def _mean(values: Sequence[float]) -> float | None:
    known = [value for value in values if not np.isnan(value)]
    return float(np.mean(known)) if known else None


def _shown_variants(report: QualityReport) -> tuple[str, ...]:
    """Return the NIQE variants to show: the measured ones and the probable one of the paper."""
    more = () if PAPER_VARIANT in report.variants else (PAPER_VARIANT,)
    return (*report.variants, *more)


def _published_row(row: PublishedQuality, shown: Sequence[str]) -> tuple[str, ...]:
    scores = [f"{row.niqe:.2f}" if variant == PAPER_VARIANT else "-" for variant in shown]
    values = [f"{row.laplacian:,.0f}" if k == PAPER_KERNEL else "-" for k in KERNELS]
    return (row.name, "?", "100", *scores, f"{row.piqe:.2f}", *values)


def _sizes(sizes_px: Sequence[str]) -> str:
    return sizes_px[0] if len(sizes_px) == 1 else f"{len(sizes_px)} sizes"


def _format_number(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:,.{digits}f}"

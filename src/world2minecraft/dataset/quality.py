"""Picture quality of a data set: NIQE, PIQE and LV over a sample, beside the paper's table.

The paper measures 100 pictures of each set, chosen by chance, and names no variant. Here each
figure says its own: the NIQE model, the kernel of the Laplacian, the size of the pictures.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.dataset.statistics.paper import PAPER, PUBLISHED_QUALITY
from world2minecraft.dataset.statistics.tables import columns
from world2minecraft.errors import UsageError
from world2minecraft.metrics.image_quality import NiqeModel, laplacian_variance, niqe, piqe
from world2minecraft.progress import Progress, silent

KERNELS = (1, 5)
PAPER_KERNEL = 5  # See metrics/image_quality/sharpness.py.
NATIVE = "native"
CAVEATS = (
    "NIQE and PIQE model photographs; drawn pictures, above all of blocks, are no photographs.",
    "LV grows with resolution and by hundreds with the kernel (k), and takes block edges for detail.",
    "The paper names no variant; its values are such as scikit-video's NIQE and LV at k=5 give.",
)


@dataclass(frozen=True)
class PictureQuality:
    """The figures of one picture at one size; ``niqe`` is by model, ``laplacian`` by kernel."""

    niqe: Mapping[str, float]
    piqe: float
    laplacian: Mapping[int, float]


@dataclass(frozen=True)
class QualityRow:
    """Means over pictures at one size: None where no picture has a figure."""

    size: str  # "native" or "640x480"
    pictures: int
    niqe: Mapping[str, float | None]
    piqe: float | None
    laplacian: Mapping[int, float | None]
    without_niqe: int  # Pictures that are too small or too flat for it.


@dataclass(frozen=True)
class QualityReport:
    """What a sample of a data set gave."""

    name: str
    rows: tuple[QualityRow, ...]
    variants: tuple[str, ...]
    sizes_px: tuple[str, ...]  # of the pictures as they are


def choose(keys: Sequence[str], count: int, seed: int) -> list[str]:
    """Return a sample of keys, all where there are no more; the same for the same seed.

    Example:
        >>> choose(["a", "b", "c", "d"], 2, seed=0)
        ['a', 'd']
    """
    if count < 1:
        raise UsageError(f"--sample must be 1 or more, not {count}")
    ordered = sorted(keys)
    chosen = np.random.default_rng(seed).permutation(len(ordered))[:count]
    return [ordered[n] for n in sorted(chosen)]


def picture_quality(picture: np.ndarray, models: Iterable[NiqeModel]) -> PictureQuality:
    """Return the figures of a picture, uint8 [H, W, 3]; NIQE is nan where it has none."""
    return PictureQuality(
        {model.name: _niqe(picture, model) for model in models},
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
    progress: Progress = silent,
) -> QualityReport:
    """Measure pictures as they are, and resized.

    Args:
        name: of the data set.
        keys: of the pictures.
        read: returns a picture of a key, uint8 [H, W, 3].
        models: of NIQE.
        resize: width and height to measure at too; None for none.
        progress: told after each picture.
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
            small = picture if size == resize else resized(picture, resize)
            named = "x".join(map(str, resize))
            found.setdefault(named, []).append(picture_quality(small, models))
    progress("quality", len(keys), len(keys))
    variants = tuple(model.name for model in models)
    rows = tuple(_row(size, figures, variants) for size, figures in found.items())
    return QualityReport(name, rows, variants, tuple(f"{w}x{h}" for w, h in sorted(sizes)))


def resized(picture: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """Return a picture at a width and height, each pixel the mean of what it covers.

    A picture of other proportions is cut to those of the size, about its middle.
    """
    image = Image.fromarray(picture)
    share = max(size[0] / image.width, size[1] / image.height)
    width, height = size[0] / share, size[1] / share
    left, top = (image.width - width) / 2, (image.height - height) / 2
    box = (left, top, left + width, top + height)
    method = Image.Resampling.BOX if share < 1 else Image.Resampling.BICUBIC
    return np.array(image.resize(size, method, box), np.uint8)


def quality_text(report: QualityReport) -> str:
    """Return the table, the paper's rows above, and what to heed in reading it."""
    head = ["data set", "size", "pictures", *(f"NIQE {name}" for name in report.variants)]
    head += ["PIQE", *(f"LV k={kernel}" for kernel in KERNELS)]
    rows = [tuple(head)]
    rows += [_published_row(row.name, report) for row in PUBLISHED_QUALITY]
    for row in report.rows:
        size = ", ".join(report.sizes_px) if row.size == NATIVE else row.size
        figures = [_figure(row.niqe[name], 2) for name in report.variants]
        figures += [_figure(row.piqe, 2), *(_figure(row.laplacian[k], 0) for k in KERNELS)]
        rows.append((report.name, size, f"{row.pictures:,}", *figures))
    lines = [*columns(rows), ""]
    lines += [f"note: {caveat}" for caveat in CAVEATS]
    without = max((row.without_niqe for row in report.rows), default=0)
    if without:
        lines.append(f"note: {without:,} pictures are too small or too flat for NIQE.")
    return "\n".join(lines)


def quality_json(report: QualityReport) -> dict[str, Any]:
    """Return everything, the paper's rows and the caveats too, as JSON values."""
    return {
        **asdict(report),
        "published": {"source": PAPER, "rows": [asdict(row) for row in PUBLISHED_QUALITY]},
        "caveats": list(CAVEATS),
    }


def _niqe(picture: np.ndarray, model: NiqeModel) -> float:
    try:
        return niqe(picture, model)
    except ValueError:  # Too small: told in the table.
        return float("nan")


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


def _published_row(name: str, report: QualityReport) -> tuple[str, ...]:
    """Return a row of the paper: NIQE under scikit-video's variant where that is measured."""
    row = next(row for row in PUBLISHED_QUALITY if row.name == name)
    at = "skvideo" if "skvideo" in report.variants else report.variants[-1]
    scores = [f"{row.niqe:.2f}" if variant == at else "-" for variant in report.variants]
    values = [f"{row.laplacian:,.0f}" if k == PAPER_KERNEL else "-" for k in KERNELS]
    return (name, "?", "100", *scores, f"{row.piqe:.2f}", *values)


def _figure(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:,.{digits}f}"

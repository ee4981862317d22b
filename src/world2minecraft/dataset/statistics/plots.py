"""Plots of a data set: its classes, its fine classes, its scenes. PNG files, drawn by Pillow."""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from math import log10
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

from world2minecraft.classes import CLASS_COLOURS, CLASS_NAMES
from world2minecraft.dataset.statistics.paper import NYU_TRAIN_VOXELS
from world2minecraft.dataset.statistics.tables import class_shares, short
from world2minecraft.dataset.statistics.values import DatasetStatistics
from world2minecraft.files import write_bytes

SCALE = 2  # Pixels a point, so that letters are smooth on any screen.
WIDTH, MARGIN, ROW, HEAD = 760, 24, 30, 66
LABEL, TAIL = 86, 120  # Room for a bar's name and for its number.
PLOT_HEIGHT = 300
WIDEST = 60  # A bar, of few.
INK, FAINT, RULE, PAPER = "#22262b", "#6d747c", "#dfe3e7", "#ffffff"
TRACK, OURS = "#f3f5f7", "#3f7cac"


@dataclass(frozen=True)
class Bar:
    """One bar: its name, its share and number, its colour, and a share to hold it to."""

    name: str
    share: float
    count: int
    colour: str | tuple[int, int, int]
    other: float | None = None


def write_plots(statistics: DatasetStatistics, folder: str | Path) -> list[Path]:
    """Write the plots of a data set below a folder and return where they lie.

    ``classes.png`` has a bar for each class, with a mark for NYUv2's share; ``fine_classes.png``
    how often each fine class is seen; ``scenes.png`` the voxels of each scene.

    Raises:
        OutputError: the folder cannot be written.
    """
    drawn = {"classes.png": class_plot(statistics), "scenes.png": scene_plot(statistics)}
    if statistics.fine:
        drawn["fine_classes.png"] = fine_plot(statistics)
    for name, image in drawn.items():
        stream = io.BytesIO()
        image.save(stream, "PNG", optimize=True)
        write_bytes(Path(folder) / name, stream.getvalue())
    return [Path(folder) / name for name in sorted(drawn)]


def class_plot(statistics: DatasetStatistics) -> Image.Image:
    """Draw the share of each class in all voxels, the commonest first."""
    ours, theirs = class_shares(statistics.class_voxels), class_shares(NYU_TRAIN_VOXELS)
    rows = zip(
        CLASS_NAMES[1:], ours, statistics.class_voxels[1:], CLASS_COLOURS[1:], theirs, strict=True
    )
    bars = [
        Bar(name, share, count, colour, other)
        for name, share, count, colour, other in sorted(rows, key=lambda row: -row[1])
    ]
    under = f"{statistics.voxels:,} voxels of {statistics.pictures:,} pictures; the line is NYUv2's"
    return _bars(f"Classes of {statistics.name}", under, bars)


def scene_plot(statistics: DatasetStatistics) -> Image.Image:
    """Draw the voxels of each scene, most first."""
    values = sorted((scene.voxels for scene in statistics.scenes), reverse=True)
    under = f"{len(values):,} scenes; mean {short(statistics.voxels_per_scene)} voxels"
    return _steps(f"Voxels of the scenes of {statistics.name}", under, values, "scenes")


def fine_plot(statistics: DatasetStatistics) -> Image.Image:
    """Draw the pixels of each fine class that is seen enough, most first, on a log scale."""
    values = [one.pixels for one in statistics.fine or () if one.is_seen_enough]
    under = f"{len(values):,} fine classes that are seen enough, by their pixels on a log scale"
    return _steps(f"Fine classes of {statistics.name}", under, values, "fine classes", log=True)


def _bars(title: str, under: str, bars: Sequence[Bar]) -> Image.Image:
    image, draw = _page(title, under, HEAD + ROW * len(bars) + MARGIN)
    most = max([0.01, *(max(bar.share, bar.other or 0.0) for bar in bars)])
    left, room = MARGIN + LABEL, WIDTH - 2 * MARGIN - LABEL - TAIL
    for n, bar in enumerate(bars):
        top = HEAD + n * ROW
        _text(draw, (MARGIN, top + 6), bar.name, 13)
        _box(draw, (left, top + 4, left + room, top + ROW - 6), TRACK)
        length = room * bar.share / most
        _box(draw, (left, top + 4, left + max(length, 1.5), top + ROW - 6), bar.colour)
        if bar.other is not None:
            at = left + room * bar.other / most
            _box(draw, (at - 1, top + 1, at + 1, top + ROW - 3), INK)
        _text(draw, (left + room + 62, top + 6), f"{bar.share:.1%}", 12, INK, "ra")
        _text(draw, (WIDTH - MARGIN, top + 6), short(bar.count), 12, FAINT, "ra")
    return image


def _steps(
    title: str, under: str, values: Sequence[int], what: str, log: bool = False
) -> Image.Image:
    """Draw values that fall from left to right as an area, with lines at round numbers."""
    image, draw = _page(title, under, HEAD + PLOT_HEIGHT + 2 * MARGIN)
    left, bottom = MARGIN + 56, HEAD + PLOT_HEIGHT
    room = min(WIDTH - MARGIN - left, WIDEST * len(values))
    most = max([1, *values])
    whole = max(log10(most), 1e-9) if log else most

    def height(value: float) -> float:
        return PLOT_HEIGHT * (log10(max(value, 1)) if log else value) / whole

    for mark in _marks(most, log):
        y = bottom - height(mark)
        draw.line([_px(left), _px(y), _px(WIDTH - MARGIN), _px(y)], RULE, SCALE)
        _text(draw, (left - 10, y), short(mark).replace(".0", ""), 11, FAINT, "rm")
    for n, value in enumerate(values):
        a, b = left + room * n / len(values), left + room * (n + 1) / len(values)
        gap = 2 if b - a > 8 else 0
        _box(draw, (a + gap, bottom - max(height(value), 1), b - gap, bottom), OURS)
    draw.line([_px(left), _px(bottom), _px(WIDTH - MARGIN), _px(bottom)], FAINT, SCALE)
    _text(draw, (left, bottom + 8), f"{len(values):,} {what}", 12, FAINT)
    return image


def _marks(most: int, log: bool) -> list[float]:
    """Return round numbers up to the greatest, three to seven of them, or the powers of ten."""
    if log:
        return [10.0**n for n in range(int(log10(most)) + 1)]
    step = 10.0 ** int(log10(max(most, 1)))
    for part in (0.2, 0.5, 1.0):
        if most / (step * part) <= 7:
            return [step * part * n for n in range(1, int(most / (step * part)) + 1)]
    return [step * 2 * n for n in range(1, int(most / (step * 2)) + 1)]


def _page(title: str, under: str, height: float) -> tuple[Image.Image, ImageDraw.ImageDraw]:
    image = Image.new("RGB", (_px(WIDTH), _px(height)), PAPER)
    draw = ImageDraw.Draw(image)
    _text(draw, (MARGIN, 16), title, 18)
    _text(draw, (MARGIN, 40), under, 12, FAINT)
    return image, draw


def _text(
    draw: ImageDraw.ImageDraw,
    at: tuple[float, float],
    text: str,
    size: int,
    colour: str = INK,
    anchor: str = "la",
) -> None:
    font = ImageFont.load_default(size * SCALE)
    draw.text((_px(at[0]), _px(at[1])), text, colour, font, anchor=anchor)


def _box(
    draw: ImageDraw.ImageDraw,
    box: tuple[float, float, float, float],
    colour: str | tuple[int, int, int],
) -> None:
    left, top, right, bottom = map(_px, box)
    draw.rectangle((left, top, max(right - 1, left), max(bottom - 1, top)), colour)


def _px(points: float) -> int:
    return round(points * SCALE)

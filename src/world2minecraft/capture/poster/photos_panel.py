"""The contact sheet: some pictures of the capture, spread evenly, doubtful ones marked."""

from collections.abc import Mapping, Sequence

import numpy as np

from world2minecraft.capture.judged import spread_over
from world2minecraft.capture.poster.canvas import (
    FAINT,
    FIRST,
    PANEL,
    PAPER,
    WARN,
    Point,
    Sheet,
)
from world2minecraft.capture.quality.pictures import Picture

GAP_PX = 10
CAPTION_PX = 22


def draw_photos(
    sheet: Sheet, pictures: Sequence[Picture], marks: Mapping[int, str], corner: Point,
    size: Point, columns: int, rows: int,
) -> None:  # fmt: skip
    """Draw at most ``columns`` x ``rows`` pictures into a box.

    Args:
        sheet: the page.
        pictures: upright; spread evenly where there are more.
        marks: index of a picture to the word that is written on it, such as ``blurred``.
        corner: of the box, in pixels.
        size: of the box.
        columns: of tiles.
        rows: of tiles.
    """
    width = (size[0] - GAP_PX * (columns - 1)) / columns
    height = (size[1] - GAP_PX * (rows - 1)) / rows
    for place, picture in enumerate(chosen_pictures(pictures, marks, columns * rows)):
        row, column = divmod(place, columns)
        at = (corner[0] + column * (width + GAP_PX), corner[1] + row * (height + GAP_PX))
        _tile(sheet, picture, marks.get(picture.index, ""), at, (width, height))


def chosen_pictures(
    pictures: Sequence[Picture], marks: Mapping[int, str], count: int
) -> list[Picture]:
    """Return evenly spread pictures; up to a quarter of the places go to doubtful ones."""
    doubtful = [picture for picture in pictures if picture.index in marks]
    kept = spread_over(doubtful, min(len(doubtful), count // 4)) if doubtful else []
    names = {picture.index for picture in kept}
    others = [picture for picture in pictures if picture.index not in names]
    others = spread_over(others, count - len(kept)) if others else []
    return sorted([*kept, *others], key=lambda picture: picture.index)


def _tile(sheet: Sheet, picture: Picture, mark: str, at: Point, size: Point) -> None:
    """Draw a picture cut to its tile, or whole within it where it stands upright."""
    sheet.box(at, size, PANEL)
    height, width = picture.thumb.shape[:2]
    if width >= height:
        share = max(size[0] / width, size[1] / height)
    else:
        share = min(size[0] / width, size[1] / height)
    across, down = min(width, size[0] / share), min(height, size[1] / share)
    left, top = int((width - across) / 2), int((height - down) / 2)
    cut = picture.thumb[top : top + max(1, int(down)), left : left + max(1, int(across))]
    drawn = (across * share, down * share)
    corner = (at[0] + (size[0] - drawn[0]) / 2, at[1] + (size[1] - drawn[1]) / 2)
    sheet.picture(np.ascontiguousarray(cut), corner, drawn)
    if mark:
        sheet.box(at, size, outline=WARN, line=3)
        words = sheet.width(mark, 15) + 14
        sheet.box((at[0] + 6, at[1] + 6), (words, 22), WARN, radius=11)
        sheet.text((at[0] + 6 + words / 2, at[1] + 17), mark, 15, PAPER, anchor="mm")


def draw_bars(
    sheet: Sheet, title: str, values: np.ndarray, limit: float, corner: Point, size: Point,
    words: tuple[str, str], most: float = 0.0,
) -> None:  # fmt: skip
    """Draw one bar a picture; those under ``limit`` in orange, with a line at the limit.

    Args:
        sheet: the page.
        title: above the chart.
        values: float64 [N], NaN where there is none.
        limit: below which a bar is doubtful.
        corner: of the box.
        size: of the box.
        words: what stands under the left and the right end.
        most: what fills the chart's height; 0 for the largest value.
    """
    sheet.text(corner, title, 18)
    top, low = corner[1] + 28, corner[1] + size[1] - CAPTION_PX
    known = values[np.isfinite(values)]
    most = most or max(float(known.max(initial=0)), 2 * limit, 1e-9)
    step = size[0] / max(1, len(values))
    for place, value in enumerate(values):
        if not np.isfinite(value):
            continue
        tall = max(2.0, (low - top) * float(value) / most)
        left = corner[0] + place * step
        fill = WARN if value < limit else FIRST
        sheet.box((left, low - tall), (max(1.0, step - min(2, step / 4)), tall), fill)
    line = low - (low - top) * limit / most
    sheet.line([(corner[0], line), (corner[0] + size[0], line)], FAINT, 0.5)
    sheet.line([(corner[0], low), (corner[0] + size[0], low)], FAINT, 0.5)
    sheet.text((corner[0], low + 5), words[0], 15, FAINT)
    sheet.text((corner[0] + size[0], low + 5), words[1], 15, FAINT, anchor="ra")

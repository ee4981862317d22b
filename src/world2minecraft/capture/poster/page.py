"""The poster of a capture, and its PNG file.

For captures with poses, there is a plan on the left, and photos, view directions and diagnostics on
the right. For other captures, there is a large contact sheet on the left, and sharpness, overlap
and diagnostics on the right.
"""

import io
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from world2minecraft.capture.poster.canvas import (
    FAINT,
    INK,
    LEVELS,
    PANEL,
    PAPER,
    RULE,
    Point,
    Sheet,
)
from world2minecraft.capture.poster.panels import (
    draw_bars,
    draw_photos,
    draw_plan,
    draw_view_directions,
)
from world2minecraft.capture.poster_detection import SOFTWARE_TAG
from world2minecraft.capture.quality.diagnostics import (
    BLURRED_SHARE,
    DARK_BRIGHTNESS,
    ISOLATED_SHARE,
    MIN_SHARPNESS,
    Diagnostic,
    blurred_pictures,
)

if TYPE_CHECKING:
    from world2minecraft.capture.summary import CaptureSummary

WIDTH_PX, HEIGHT_PX = 1600, 1040
EDGE_PX = 40
LEFT_PX, RIGHT_PX = 780, 700  # Widths of the two columns; 40 lie between them.
TOP_PX, FOOT_PX = 140, 76
BODY_PX = 19


def draw_poster(summary: "CaptureSummary") -> np.ndarray:
    """Draw the poster of a capture as uint8 [1040, 1600, 3]."""
    sheet = Sheet(WIDTH_PX, HEIGHT_PX)
    _head(sheet, summary)
    tall = HEIGHT_PX - TOP_PX - FOOT_PX - EDGE_PX / 2
    left, right = (EDGE_PX, TOP_PX), (EDGE_PX + LEFT_PX + 40, TOP_PX)
    marks = picture_marks(summary)
    survey = summary.survey
    if survey.plan is not None and survey.directions is not None:
        draw_plan(
            sheet, survey.plan, survey.directions, left, (LEFT_PX, tall), frozenset(marks),
            survey.validated.capture.scale != "unknown", summary.route.kind != "solid",
        )  # fmt: skip
        top = TOP_PX
        if survey.pictures:
            draw_photos(sheet, survey.pictures, marks, right, (RIGHT_PX, 380), 4, 3)
            top += 380 + 18
        draw_view_directions(sheet, survey.directions, (right[0], top), (RIGHT_PX, 170))
        _write_diagnostics(sheet, summary.diagnostics, (right[0], top + 190), TOP_PX + tall)
    else:
        columns, rows = _contact_sheet_grid(len(survey.pictures))
        draw_photos(sheet, survey.pictures, marks, left, (LEFT_PX, tall), columns, rows)
        _charts(sheet, summary, right)
        _write_diagnostics(sheet, summary.diagnostics, (right[0], TOP_PX + 400), TOP_PX + tall)
    _foot(sheet, summary.next_command)
    return sheet.finished()


def _contact_sheet_grid(count: int) -> tuple[int, int]:
    for columns, rows in ((2, 2), (3, 3), (3, 4), (4, 5), (5, 6)):
        if count <= columns * rows:
            return columns, rows
    return 5, 6


def picture_marks(summary: "CaptureSummary") -> dict[int, str]:
    """Return a word, ``dark`` or ``blurred``, for each doubtful image by frame index."""
    if summary.route.kind == "solid":
        return {}
    pictures = summary.survey.pictures
    dark = {picture.index: "dark" for picture in pictures if picture.brightness < DARK_BRIGHTNESS}
    lit = [picture for picture in pictures if picture.index not in dark]
    return dark | {picture.index: "blurred" for picture in blurred_pictures(lit)}


def _head(sheet: Sheet, summary: "CaptureSummary") -> None:
    name = Path(summary.folder.name).name or "capture"
    sheet.text((EDGE_PX, 26), sheet.clipped(name, 42, 900), 42, INK, bold=True)
    verdict = _verdict(summary.diagnostics)
    width = sheet.width(verdict, 20) + 54
    at = (WIDTH_PX - EDGE_PX - width, 32)
    level = summary.diagnostics[0].level if summary.diagnostics else "ok"
    sheet.box(at, (width, 40), PAPER, LEVELS[level], 20, 1.5)
    _icon(sheet, level, (at[0] + 22, at[1] + 20))
    sheet.text((at[0] + 40, at[1] + 20), verdict, 20, LEVELS[level], anchor="lm")
    route = summary.route
    words = f"{route.called[0].upper()}{route.called[1:]} ({summary.source})"
    usable = f"{summary.usable} of {summary.frames} frames usable"
    line = f"{words}  -  {usable}  -  {route.words}, {route.about}"
    sheet.text((EDGE_PX, 84), sheet.clipped(line, 20, WIDTH_PX - 2 * EDGE_PX), 20, FAINT)
    sheet.line([(EDGE_PX, 120), (WIDTH_PX - EDGE_PX, 120)], RULE, 1)


def _verdict(diagnostics: tuple[Diagnostic, ...]) -> str:
    stops = sum(diagnostic.level == "stop" for diagnostic in diagnostics)
    warns = sum(diagnostic.level == "warn" for diagnostic in diagnostics)
    if stops:
        return "cannot be reconstructed yet"
    if warns:
        return f"usable, {warns} {'warning' if warns == 1 else 'warnings'}"
    return "no problems found"


def _charts(sheet: Sheet, summary: "CaptureSummary", corner: Point) -> None:
    pictures = summary.survey.pictures
    sharp = np.array([picture.sharpness for picture in pictures])
    limit = (
        max(BLURRED_SHARE * float(np.median(sharp)), MIN_SHARPNESS) if len(sharp) else MIN_SHARPNESS
    )
    ends = (pictures[0].name, pictures[-1].name) if pictures else ("", "")
    ends = (sheet.clipped(ends[0], 15, 300), sheet.clipped(ends[1], 15, 300))
    capped = np.minimum(sharp, 3 * np.median(sharp)) if len(sharp) else sharp
    title = f"Sharpness of {len(sharp)} images; those below the line are blurred"
    draw_bars(sheet, title, capped, limit, corner, (RIGHT_PX, 180), ends)
    below = (corner[0], corner[1] + 198)
    title = "Overlap of each image with the next"
    shares = summary.survey.shares
    if np.isfinite(shares).any():
        draw_bars(sheet, title, shares, ISOLATED_SHARE, below, (RIGHT_PX, 180), ends, 1.0)
    else:
        sheet.text(below, title, 18)
        text = "not computed: too few neighbouring images were sampled"
        sheet.text((below[0], below[1] + 32), text, 17, FAINT)


def _write_diagnostics(
    sheet: Sheet, diagnostics: tuple[Diagnostic, ...], corner: Point, bottom: float
) -> None:
    """Draw the diagnostics in order of severity, as far as there is space."""
    top, step = corner[1], BODY_PX + 6
    for place, diagnostic in enumerate(diagnostics):
        width = RIGHT_PX - 34
        lines = [(words, INK) for words in sheet.wrapped(diagnostic.text, BODY_PX, width)[:3]]
        if diagnostic.advice and diagnostic.level != "ok":
            lines += [
                (words, FAINT) for words in sheet.wrapped(diagnostic.advice, BODY_PX, width)[:2]
            ]
        left_over = len(diagnostics) - place
        if top + len(lines) * step > bottom - (step if left_over > 1 else 0) + 4:
            words = f"and {left_over} more, printed by w2m scan"
            sheet.text((corner[0] + 34, top + 2), words, BODY_PX, FAINT)
            return
        _icon(sheet, diagnostic.level, (corner[0] + 12, top + step / 2 - 1))
        for words, colour in lines:
            sheet.text((corner[0] + 34, top), words, BODY_PX, colour)
            top += step
        top += 7


def _icon(sheet: Sheet, level: str, at: Point) -> None:
    """Draw a tick, an exclamation mark or a cross in a circle."""
    x, y = at
    sheet.dot(at, 10, LEVELS[level])
    if level == "ok":
        sheet.line([(x - 5, y), (x - 1.5, y + 4), (x + 5, y - 4)], PAPER, 2)
    elif level == "warn":
        sheet.line([(x, y - 6), (x, y + 1.5)], PAPER, 2)
        sheet.dot((x, y + 5), 1.4, PAPER)
    else:
        sheet.line([(x - 4, y - 4), (x + 4, y + 4)], PAPER, 2)
        sheet.line([(x - 4, y + 4), (x + 4, y - 4)], PAPER, 2)


def _foot(sheet: Sheet, command: str) -> None:
    top = HEIGHT_PX - FOOT_PX
    sheet.box((EDGE_PX, top), (WIDTH_PX - 2 * EDGE_PX, 50), PANEL, radius=10)
    sheet.text((EDGE_PX + 20, top + 25), "next", 20, FAINT, anchor="lm")
    words = sheet.clipped(command, 22, WIDTH_PX - 2 * EDGE_PX - 110)
    sheet.text((EDGE_PX + 78, top + 25), words, 22, INK, anchor="lm")


def poster_png(summary: "CaptureSummary") -> bytes:
    """Return the poster as a deterministic PNG with a marker that identifies it as a poster."""
    stream = io.BytesIO()
    info = PngInfo()
    info.add_text("Software", SOFTWARE_TAG)
    Image.fromarray(draw_poster(summary)).save(stream, "PNG", pnginfo=info)
    return stream.getvalue()

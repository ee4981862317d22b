"""The chart of looks: how many pictures cover each heading and each height of look."""

import numpy as np

from world2minecraft.capture.poster.canvas import (
    FAINT,
    FIRST,
    INK,
    PANEL,
    RULE,
    Point,
    Sheet,
    blend,
)
from world2minecraft.capture.quality.view_directions import Directions

DEEP = blend(FIRST, INK, 0.45)
HEADINGS = ("N", "E", "S", "W", "N")


def draw_looks(sheet: Sheet, directions: Directions, corner: Point, size: Point) -> None:
    """Draw the chart into a box: headings across, north at both ends; up at the top."""
    sheet.text(corner, "Looked at: heading and tilt", 18)
    most = int(directions.seen.max())
    sheet.text(
        (corner[0] + size[0], corner[1]), f"darkest: {most} pictures", 15, FAINT, anchor="ra"
    )
    left, top = corner[0] + 62, corner[1] + 28
    wide, tall = size[0] - 62, size[1] - 28 - 22
    sheet.picture(heat(directions), (left, top), (wide, tall), smooth=False)
    sheet.box((left, top), (wide, tall), outline=RULE)
    for words, share in (("up", 1 / 6), ("level", 0.5), ("down", 5 / 6)):
        sheet.text((left - 8, top + tall * share), words, 16, FAINT, anchor="rm")
    for share in (1 / 3, 2 / 3):
        sheet.line([(left, top + tall * share), (left + wide, top + tall * share)], RULE, 0.5)
    for place, words in enumerate(HEADINGS):
        at = left + wide * place / (len(HEADINGS) - 1)
        anchor = "ma" if 0 < place < len(HEADINGS) - 1 else ("la", "ra")[place > 0]
        sheet.text((at, top + tall + 4), words, 16, INK, anchor=anchor)


def heat(directions: Directions) -> np.ndarray:
    """Return the counts as colours, uint8 [18, 36, 3], up at the top; none is the panel's."""
    seen = directions.seen[::-1]
    share = np.sqrt(seen / max(1, int(seen.max())))[..., None]
    low, high = np.array(blend(PANEL, FIRST, 0.25)), np.array(DEEP)
    colours = low * (1 - share) + high * share
    return np.where(seen[..., None] > 0, colours, np.array(PANEL)).round().astype(np.uint8)

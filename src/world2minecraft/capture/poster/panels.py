"""Panels of the poster: plan, contact sheet, bar charts and the chart of view directions."""

from collections.abc import Mapping, Sequence

import numpy as np

from world2minecraft.capture.poster.canvas import (
    FAINT,
    FIRST,
    INK,
    LAST,
    PANEL,
    PAPER,
    RULE,
    WARN,
    Colour,
    Point,
    Sheet,
    blend_colours,
)
from world2minecraft.capture.quality.picture_quality import Picture
from world2minecraft.capture.quality.top_view import TopView
from world2minecraft.capture.quality.view_directions import ViewDirections
from world2minecraft.capture.validation import evenly_spaced

DEEP = blend_colours(FIRST, INK, 0.45)
HEADINGS = ("N", "E", "S", "W", "N")
GAP_PX = 10
CAPTION_PX = 22
CONES = 60  # More would hide the room.
CONE_M, HALF_DEG = 0.34, 24.0
RELIEF = 1.6  # Strength of the shading of height steps in the plan.
WALL_M = 0.06  # The noise of a wall's far side.
LENGTHS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0)


def draw_view_directions(
    sheet: Sheet, directions: ViewDirections, corner: Point, size: Point
) -> None:
    """Draw the chart of view directions: headings from north to north, with up at the top."""
    sheet.text(corner, "View directions: heading and pitch", 18)
    maximum = int(directions.seen.max())
    sheet.text(
        (corner[0] + size[0], corner[1]), f"darkest: {maximum} images", 15, FAINT, anchor="ra"
    )
    left, top = corner[0] + 62, corner[1] + 28
    wide, tall = size[0] - 62, size[1] - 28 - 22
    sheet.picture(direction_heatmap(directions), (left, top), (wide, tall), smooth=False)
    sheet.box((left, top), (wide, tall), outline=RULE)
    for words, share in (("up", 1 / 6), ("level", 0.5), ("down", 5 / 6)):
        sheet.text((left - 8, top + tall * share), words, 16, FAINT, anchor="rm")
    for share in (1 / 3, 2 / 3):
        sheet.line([(left, top + tall * share), (left + wide, top + tall * share)], RULE, 0.5)
    for place, words in enumerate(HEADINGS):
        at = left + wide * place / (len(HEADINGS) - 1)
        anchor = "ma" if 0 < place < len(HEADINGS) - 1 else ("la", "ra")[place > 0]
        sheet.text((at, top + tall + 4), words, 16, INK, anchor=anchor)


def direction_heatmap(directions: ViewDirections) -> np.ndarray:
    """Return the counts as colours, uint8 [18, 36, 3], with up at the top."""
    seen = directions.seen[::-1]
    share = np.sqrt(seen / max(1, int(seen.max())))[..., None]
    low, high = np.array(blend_colours(PANEL, FIRST, 0.25)), np.array(DEEP)
    colours = low * (1 - share) + high * share
    return np.where(seen[..., None] > 0, colours, np.array(PANEL)).round().astype(np.uint8)


def draw_photos(
    sheet: Sheet, pictures: Sequence[Picture], marks: Mapping[int, str], corner: Point,
    size: Point, columns: int, rows: int,
) -> None:  # fmt: skip
    """Draw a grid of at most ``columns`` x ``rows`` images into a box.

    Args:
        sheet: The page.
        pictures: Upright images; a selection is drawn if there are more than tiles.
        marks: Word to write on an image, such as ``blurred``, by frame index.
        corner: Upper left corner of the box in pixels.
        size: Size of the box in pixels.
        columns: Number of columns.
        rows: Number of rows.
    """
    width = (size[0] - GAP_PX * (columns - 1)) / columns
    height = (size[1] - GAP_PX * (rows - 1)) / rows
    for place, picture in enumerate(select_pictures(pictures, marks, columns * rows)):
        row, column = divmod(place, columns)
        at = (corner[0] + column * (width + GAP_PX), corner[1] + row * (height + GAP_PX))
        _draw_tile(sheet, picture, marks.get(picture.index, ""), at, (width, height))


def select_pictures(
    pictures: Sequence[Picture], marks: Mapping[int, str], count: int
) -> list[Picture]:
    """Select evenly spaced images; up to a quarter of them are doubtful ones."""
    doubtful = [picture for picture in pictures if picture.index in marks]
    marked = evenly_spaced(doubtful, min(len(doubtful), count // 4)) if doubtful else []
    names = {picture.index for picture in marked}
    others = [picture for picture in pictures if picture.index not in names]
    others = evenly_spaced(others, count - len(marked)) if others else []
    return sorted([*marked, *others], key=lambda picture: picture.index)


def _draw_tile(sheet: Sheet, picture: Picture, mark: str, at: Point, size: Point) -> None:
    """Draw an image cropped to its tile, or complete if it is in portrait orientation."""
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
    words: tuple[str, str], maximum: float = 0.0,
) -> None:  # fmt: skip
    """Draw a bar chart with one bar per image; bars below the limit are orange.

    Args:
        sheet: The page.
        title: Title above the chart.
        values: Values, float64 [N]; NaN for no bar.
        limit: Value below which a bar is doubtful; drawn as a line.
        corner: Upper left corner of the box in pixels.
        size: Size of the box in pixels.
        words: Labels below the left and the right end.
        maximum: Value at full height; 0 for the largest value.
    """
    sheet.text(corner, title, 18)
    top, low = corner[1] + 28, corner[1] + size[1] - CAPTION_PX
    known = values[np.isfinite(values)]
    maximum = maximum or max(float(known.max(initial=0)), 2 * limit, 1e-9)
    step = size[0] / max(1, len(values))
    for place, value in enumerate(values):
        if not np.isfinite(value):
            continue
        tall = max(2.0, (low - top) * float(value) / maximum)
        left = corner[0] + place * step
        fill = WARN if value < limit else FIRST
        sheet.box((left, low - tall), (max(1.0, step - min(2, step / 4)), tall), fill)
    line = low - (low - top) * limit / maximum
    sheet.line([(corner[0], line), (corner[0] + size[0], line)], FAINT, 0.5)
    sheet.line([(corner[0], low), (corner[0] + size[0], low)], FAINT, 0.5)
    sheet.text((corner[0], low + 5), words[0], 15, FAINT)
    sheet.text((corner[0] + size[0], low + 5), words[1], 15, FAINT, anchor="ra")


def draw_plan(
    sheet: Sheet, plan: TopView, directions: ViewDirections | None, corner: Point, size: Point,
    doubtful: frozenset[int], has_unit: bool, walked: bool = True,
) -> None:  # fmt: skip
    """Draw the plan panel into a box of the page.

    Args:
        sheet: The page.
        plan: Top view, with or without depth.
        directions: Covered view directions for the rose, or None.
        corner: Upper left corner of the box in pixels.
        size: Size of the box in pixels.
        doubtful: Indices of the frames with blurred or dark images.
        has_unit: Whether the poses are in metres.
        walked: Whether to connect the cameras by a path.
    """
    sheet.box(corner, size, PANEL, radius=10)
    place = PanelTransform(plan, corner, size)
    if plan.colour.size:
        sheet.picture(shade_top_view(plan), place.corner, place.size)
    if plan.room_size_m is not None:
        _draw_room_size(sheet, plan, place)
    _draw_cameras(sheet, plan, place, doubtful, walked)
    _draw_scale_bar(sheet, place, corner, size, has_unit)
    if directions is not None:
        _draw_direction_rose(
            sheet, directions, (corner[0] + size[0] - 66, corner[1] + size[1] - 66)
        )


class PanelTransform:
    """The transform from a top view to its panel, which leaves 54 px below for the scale bar."""

    def __init__(self, plan: TopView, corner: Point, size: Point):
        free = (size[0] - 32, size[1] - 32 - 54)
        self.px_per_m = float(min(free[0] / plan.size_m[0], free[1] / plan.size_m[1]))
        width, height = plan.size_m * self.px_per_m
        self.size = (float(width), float(height))
        self.corner = (
            corner[0] + 16 + (free[0] - self.size[0]) / 2,
            corner[1] + 16 + (free[1] - self.size[1]) / 2,
        )
        self._low = plan.corner_m

    def at(self, x_m: float, y_m: float) -> Point:
        """Return the pixel of a position in the top view."""
        return (
            self.corner[0] + (x_m - float(self._low[0])) * self.px_per_m,
            self.corner[1] + self.size[1] - (y_m - float(self._low[1])) * self.px_per_m,
        )


def shade_top_view(plan: TopView) -> np.ndarray:
    """Return the raster of a top view for the page as uint8: shaded by height, with dark walls."""
    height = np.where(plan.seen, plan.height_m, 0.0)
    for axis in (0, 1):
        height = (np.roll(height, 1, axis) + height + np.roll(height, -1, axis)) / 3
    light = np.clip(RELIEF * (np.roll(height, -1, 1) - height + np.roll(height, -1, 0) - height),
                    -0.3, 0.22)  # fmt: skip
    colour = plan.colour * (1 + np.where(plan.seen, light, 0.0))[..., None]
    colour = colour * 0.88 + np.array(PAPER) * 0.12
    outside = _outside(plan)[..., None]
    colour = colour * (1 - 0.6 * outside) + np.array(PANEL) * 0.6 * outside
    wall = (0.92 * np.clip((plan.tall - 0.35) / 0.65, 0, 1))[..., None]
    colour = np.where(plan.seen[..., None], colour, np.array(PANEL))
    return np.clip(colour * (1 - wall) + np.array(INK) * wall, 0, 255).astype(np.uint8)


def _outside(plan: TopView) -> np.ndarray:
    """Return a mask, float [H, W], that is 1 outside the room's walls."""
    if plan.room_size_m is None:
        return np.zeros(plan.seen.shape)
    rows, columns = plan.seen.shape
    x = plan.corner_m[0] + (np.arange(columns) + 0.5) * plan.cell_m
    y = plan.corner_m[1] + (rows - np.arange(rows) - 0.5) * plan.cell_m
    beyond = [
        np.maximum(-at, at - side) > WALL_M
        for at, side in zip((x, y), plan.room_size_m[:2], strict=True)
    ]
    return (beyond[1][:, None] | beyond[0][None]).astype(np.float64)


def _draw_room_size(sheet: Sheet, plan: TopView, place: PanelTransform) -> None:
    """Draw the room's dimensions at its sides."""
    if plan.room_size_m is None:
        return
    x, y, z = (float(side) for side in plan.room_size_m)
    left, top = place.at(0, y)
    right, bottom = place.at(x, 0)
    for start, end in (
        ((left, bottom), (right, bottom)), ((left, top), (right, top)),
        ((left, top), (left, bottom)), ((right, top), (right, bottom)),
    ):  # fmt: skip
        _draw_dashed_line(sheet, start, end)
    _draw_tag(sheet, ((left + right) / 2, top), f"{x:.1f} m")
    _draw_tag(sheet, (left, (top + bottom) / 2), f"{y:.1f} m")
    _draw_tag(sheet, ((left + right) / 2, bottom), f"{z:.1f} m high")


def _draw_tag(sheet: Sheet, at: Point, words: str) -> None:
    width = sheet.width(words, 16) + 16
    sheet.box((at[0] - width / 2, at[1] - 12), (width, 24), PAPER, RULE, 12)
    sheet.text(at, words, 16, INK, anchor="mm")


def _draw_dashed_line(sheet: Sheet, start: Point, end: Point) -> None:
    length = float(np.hypot(end[0] - start[0], end[1] - start[1]))
    for along in np.arange(0, length, 10):
        a, b = along / length, min(along + 5, length) / length
        ends = [
            (start[0] + (end[0] - start[0]) * s, start[1] + (end[1] - start[1]) * s) for s in (a, b)
        ]
        sheet.line(ends, FAINT, 1)


def _draw_cameras(
    sheet: Sheet, plan: TopView, place: PanelTransform, doubtful: frozenset[int], walked: bool
) -> None:
    """Draw the camera path and the view directions, from teal to pink in time."""
    poses, count = plan.cameras, len(plan.cameras)
    points = [place.at(float(pose[0, 3]), float(pose[1, 3])) for pose in poses]
    for index in range(count - 1) if walked else ():
        colour = blend_colours(FIRST, LAST, index / max(1, count - 1))
        sheet.line([points[index], points[index + 1]], PAPER, 4)
        sheet.line([points[index], points[index + 1]], colour, 2)
    length = min(CONE_M * place.px_per_m, 46.0)
    length = max(length, 20.0)
    for index in np.unique(np.linspace(0, count - 1, min(CONES, count)).round().astype(int)):
        look = poses[index, :2, 2]
        flat = float(np.hypot(*look))
        colour = (
            WARN
            if int(index) in doubtful
            else blend_colours(FIRST, LAST, index / max(1, count - 1))
        )
        if flat > 0.15:
            _draw_view_cone(
                sheet, points[index], float(np.arctan2(look[1], look[0])), length * flat, colour
            )
        sheet.dot(points[index], 4, colour, PAPER)
    if not walked:
        return
    if count:
        _draw_flag(sheet, points[0], "start", FIRST)
    if count > 1:
        _draw_flag(sheet, points[-1], "end", LAST)


def _draw_view_cone(sheet: Sheet, at: Point, angle: float, length: float, colour: Colour) -> None:
    ends = [
        (at[0] + length * np.cos(angle + side), at[1] - length * np.sin(angle + side))
        for side in (np.radians(HALF_DEG), -np.radians(HALF_DEG))
    ]
    sheet.shape([at, *ends], colour, 0.62)
    sheet.line([ends[0], at, ends[1]], PAPER, 1)


def _draw_flag(sheet: Sheet, at: Point, words: str, colour: Colour) -> None:
    width = sheet.width(words, 15) + 14
    sheet.box((at[0] - width / 2, at[1] - 33), (width, 22), colour, radius=11)
    sheet.text((at[0], at[1] - 22), words, 15, PAPER, anchor="mm")
    sheet.dot(at, 6, colour, PAPER)


def _draw_scale_bar(
    sheet: Sheet, place: PanelTransform, corner: Point, size: Point, has_unit: bool
) -> None:
    left, low = corner[0] + 22, corner[1] + size[1] - 24
    if not has_unit:
        sheet.text((left, low), "no scale: the poses have no unit", 17, FAINT, anchor="lm")
        return
    length = max([1e-9, *(m for m in LENGTHS if m * place.px_per_m < 0.3 * size[0])])
    end = left + length * place.px_per_m
    for part in range(2):
        start = left + (end - left) * part / 2
        sheet.box((start, low - 3), ((end - left) / 2, 7), (INK, PAPER)[part], INK)
    sheet.text((end + 10, low), f"{length:g} m", 17, INK, anchor="lm")


def _draw_direction_rose(sheet: Sheet, directions: ViewDirections, middle: Point) -> None:
    """Draw the coverage of each heading: petals for eight sectors, gaps in orange."""
    sheet.dot(middle, 50, PAPER, RULE)
    for index, share in enumerate(directions.sectors()):
        angle = np.radians(90 - 45 * index)
        gap = share < 0.1
        length = 12 + 32 * (1.0 if gap else float(share))
        edge = [
            (middle[0] + length * np.cos(angle + turn), middle[1] - length * np.sin(angle + turn))
            for turn in np.radians(np.linspace(-20, 20, 9))
        ]
        sheet.shape([middle, *edge], WARN if gap else FIRST, 0.35 if gap else 0.75)
    sheet.dot(middle, 3, PAPER)
    sheet.box((middle[0] - 10, middle[1] - 62), (20, 20), PAPER, RULE, 10)
    sheet.text((middle[0], middle[1] - 52), "N", 15, INK, anchor="mm", bold=True)

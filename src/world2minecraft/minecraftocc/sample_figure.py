"""Figures of samples: the image, its depth, its labels, and a top view of its region.

The labels are projected into the image. If the colours match the objects, the axes, the camera and
the labels are consistent. The figure also contains a number that checks the depth in the same way.
"""

import numpy as np

from world2minecraft.capture.poster.canvas import FAINT, INK, PANEL, RULE, Sheet
from world2minecraft.core.classes import CLASS_COLOURS, CLASS_NAMES, UNKNOWN, display_name
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.minecraftocc.formats.label_grids import cells_behind_depth
from world2minecraft.minecraftocc.types import OccSample
from world2minecraft.rendering.voxel_camera import cast_voxels

PANEL_PX = (480, 360)
MARGIN_PX, LINE_PX, HEAD_PX = 24, 26, 54
LABEL_SHARE = 0.6  # Opacity of the labels over the image.
VIEW_M = 7.0  # Diagonal of the default region.
NOTHING = (206, 203, 195)  # Empty cells from above; unknown ones are lighter.
UNKNOWN_COLOUR = (232, 229, 222)
# Colours from near to far that are perceptually uniform, also for colour-blind people.
RAMP = np.array(
    [(68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37)], np.float64
)


def draw_sample(sample: OccSample) -> np.ndarray:
    """Draw the figure of a sample, uint8 [H, W, 3]."""
    width, height = PANEL_PX
    sheet = Sheet(MARGIN_PX * 4 + width * 2 + 150, HEAD_PX + (height + LINE_PX + MARGIN_PX) * 2)
    sheet.text((MARGIN_PX, 14), sample.key, 20, INK, bold=True)
    for number, (title, pixels, smooth) in enumerate(_panels(sample)):
        left = MARGIN_PX + (number % 2) * (width + MARGIN_PX)
        top = HEAD_PX + (number // 2) * (height + LINE_PX + MARGIN_PX)
        sheet.text((left, top), title, 14, FAINT)
        at, scale = _place_panel(sheet, pixels, (left, top + LINE_PX), smooth)
        if not smooth:
            _draw_view(sheet, sample, at, scale)
    _legend(sheet, sample, (MARGIN_PX * 3 + width * 2, HEAD_PX + LINE_PX))
    return sheet.finished()


def share_of_depth_in_cells(sample: OccSample) -> float | None:
    """Return the fraction of depth points in the region that are in or next to an occupied cell.

    Points in a cell that shares a face with an occupied cell are counted, because surfaces are at
    cell borders. The fraction is far below 1 if axes are swapped. Returns None if there is no
    depth, or if no point is in the region.
    """
    if sample.depth_m is None:
        return None
    _, cells = _cells_behind(sample, sample.depth_m)
    if not len(cells):
        return None
    return float(_dilate(sample.occ.occupied)[tuple(cells.T)].mean())


def project_labels(sample: OccSample) -> np.ndarray:
    """Return the label that each pixel sees, uint8 [H, W], or 0 for surfaces outside the region.

    The label is that of the cell behind the depth or, without depth, of the first occupied cell
    along the ray. The cell that contains the camera is ignored.
    """
    region, labels = sample.occ.region, np.array(sample.occ.labels)
    camera_to_region = _camera_to_region(sample)
    own = np.floor(camera_to_region[:3, 3] / region.voxel_m).astype(np.int64)
    if ((own >= 0) & (own < region.shape)).all():
        labels[tuple(own)] = 0
    hits = cast_voxels(labels, sample.camera, camera_to_region, voxel_m=region.voxel_m)
    met = labels.reshape(-1)[np.maximum(hits.voxel_index, 0)]
    met = np.where(hits.voxel_index >= 0, met, 0).astype(np.uint8)
    if sample.depth_m is not None:
        pixels, cells = _cells_behind(sample, sample.depth_m)
        behind = sample.occ.labels[tuple(cells.T)]
        met.reshape(-1)[pixels[behind > 0]] = behind[behind > 0]
    return met


def _camera_to_region(sample: OccSample) -> np.ndarray:
    return invert_rigid(sample.occ.region.region_to_room) @ sample.camera_to_room


def _cells_behind(sample: OccSample, depth_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    to_region = _camera_to_region(sample)
    return cells_behind_depth(depth_m, sample.camera, sample.occ.region, to_region)


def overlay_labels(sample: OccSample) -> np.ndarray:
    """Overlay the labels of a sample on its image, or on a grey background without an image."""
    size = (sample.camera.height_px, sample.camera.width_px)
    colour = np.full((*size, 3), PANEL, np.uint8) if sample.colour is None else sample.colour
    labels = project_labels(sample)
    mixed = LABEL_SHARE * _colour_labels(labels) + (1 - LABEL_SHARE) * colour
    return np.where((labels > 0)[..., None], mixed, colour).astype(np.uint8)


def _panels(sample: OccSample) -> list[tuple[str, np.ndarray, bool]]:
    size = (sample.camera.height_px, sample.camera.width_px)
    colour = sample.colour
    if colour is None:
        colour = np.full((*size, 3), PANEL, np.uint8)
    seen, far_m = _depth_colours(sample, size)
    title = "image" if sample.colour is not None else "image: none"
    return [
        (f"{title}, {size[1]} x {size[0]}", colour, True),
        (f"depth, 0 to {far_m:.1f} m" if far_m else "depth: none", seen, True),
        ("labels, projected into the image", overlay_labels(sample), True),
        ("top view of the region without ceiling", _from_above(sample), False),
    ]


def _depth_colours(sample: OccSample, size: tuple[int, int]) -> tuple[np.ndarray, float]:
    """Return the depth as colours, with plain holes, and the depth of the last colour."""
    depth_m = sample.depth_m
    known = None if depth_m is None else np.isfinite(depth_m) & (depth_m > 0)
    if depth_m is None or known is None or not known.any():
        return np.full((*size, 3), PANEL, np.uint8), 0.0
    far_m = float(np.percentile(depth_m[known], 99))
    steps = np.clip(np.where(known, depth_m, 0) / far_m, 0, 1) * (len(RAMP) - 1)
    low = np.minimum(steps.astype(int), len(RAMP) - 2)
    share = (steps - low)[..., None]
    colours = RAMP[low] * (1 - share) + RAMP[low + 1] * share
    return np.where(known[..., None], colours, PANEL).astype(np.uint8), far_m


def _from_above(sample: OccSample) -> np.ndarray:
    """Return the top view of the region, uint8 [Y, X, 3], with paler unseen columns."""
    labels = sample.occ.labels
    shown = (labels > 1) & (labels != UNKNOWN)  # 1 is the ceiling.
    top = labels.shape[2] - 1 - np.argmax(shown[:, :, ::-1], axis=2)
    ids = np.where(shown.any(axis=2), np.take_along_axis(labels, top[..., None], 2)[..., 0], 0)
    colours = _colour_labels(ids).astype(np.float64)
    colours *= (0.75 + 0.25 * top / max(labels.shape[2] - 1, 1))[..., None]
    colours[ids == 0] = NOTHING
    colours[(labels == UNKNOWN).all(axis=2)] = UNKNOWN_COLOUR
    outside = ~sample.occ.in_frustum.any(axis=2)
    colours[outside] = colours[outside] * 0.45 + np.array(PANEL) * 0.55
    return np.rot90(colours.astype(np.uint8)).copy()


def _place_panel(
    sheet: Sheet, pixels: np.ndarray, corner: tuple[float, float], smooth: bool
) -> tuple[tuple[float, float], float]:
    """Scale an image to fit its panel, draw it, and return its corner and its scale."""
    width, height = PANEL_PX
    scale = min(width / pixels.shape[1], height / pixels.shape[0])
    size = (pixels.shape[1] * scale, pixels.shape[0] * scale)
    at = (corner[0] + (width - size[0]) / 2, corner[1] + (height - size[1]) / 2)
    sheet.box(corner, PANEL_PX, PANEL)
    sheet.picture(np.ascontiguousarray(pixels), at, size, smooth)
    return at, scale


def _draw_view(sheet: Sheet, sample: OccSample, corner: tuple[float, float], scale: float) -> None:
    """Draw the field of view of the image's middle row over the top view of the region."""
    region, camera = sample.occ.region, sample.camera
    camera_to_region = _camera_to_region(sample)
    edges = np.array([[-camera.cx_px, 0], [camera.width_px - camera.cx_px, 0]]) / camera.fx_px
    steps = np.linspace(0, VIEW_M, 200)
    for x, y in edges:
        ray = apply(camera_to_region, steps[:, None] * np.array([x, y, 1.0])) / region.voxel_m
        within = np.all((ray[:, :2] >= 0) & (ray[:, :2] <= region.shape[:2]), axis=1)
        if within.any():
            ends = ray[within][[0, -1], :2]
            points = [(corner[0] + a * scale, corner[1] + (region.shape[1] - b) * scale)
                      for a, b in ends.tolist()]  # fmt: skip
            sheet.line([points[0], points[1]], INK, 1.5)


def _legend(sheet: Sheet, sample: OccSample, corner: tuple[float, float]) -> None:
    left, top = corner
    counts = np.bincount(sample.occ.labels.reshape(-1), minlength=256)
    for number in range(1, len(CLASS_NAMES)):
        fill = CLASS_COLOURS[number] if counts[number] else PANEL
        sheet.box((left, top), (14, 14), fill, RULE, 3)
        sheet.text((left + 22, top), display_name(number), 13, INK if counts[number] else FAINT)
        sheet.text((left + 150, top), f"{counts[number]:,}", 13, FAINT, anchor="ra")
        top += LINE_PX
    for line in _lines(sample, counts):
        top += LINE_PX * 0.85
        sheet.text((left, top), line, 13, FAINT)


def _lines(sample: OccSample, counts: np.ndarray) -> list[str]:
    occ = sample.occ
    met = share_of_depth_in_cells(sample)
    return [
        f"split: {sample.split or 'none'}",
        f"region: {occ.region.kind}",
        f"empty: {counts[0] / occ.labels.size:.0%} of cells",
        f"unknown: {counts[UNKNOWN] / occ.labels.size:.0%}",
        f"in view: {occ.in_frustum.mean():.0%}",
        f"seen first: {int(occ.visible.sum()):,}",
        "depth: none" if met is None else f"depth in cells: {met:.1%}",
    ]


def _colour_labels(labels: np.ndarray) -> np.ndarray:
    table = np.full((256, 3), UNKNOWN_COLOUR, np.uint8)
    table[: len(CLASS_COLOURS)] = CLASS_COLOURS
    return table[labels]


def _dilate(mask: np.ndarray) -> np.ndarray:
    """Return a mask dilated by the cells that share a face with it."""
    wide = mask.copy()
    for axis in range(3):
        ahead = [slice(None)] * 3
        behind = [slice(None)] * 3
        ahead[axis], behind[axis] = slice(1, None), slice(None, -1)
        wide[tuple(ahead)] |= mask[tuple(behind)]
        wide[tuple(behind)] |= mask[tuple(ahead)]
    return wide

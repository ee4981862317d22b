"""Contact sheets: the photo, the cells coloured by class, and the preview of the world."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from benchmarks.real_captures.scenes import read_nyu_classes
from world2minecraft.core.classes import CLASS_COLOURS, CLASS_DISPLAY_NAMES, SemanticClass
from world2minecraft.core.coordinates import cell_centers_m, look_at
from world2minecraft.core.files import write_bytes
from world2minecraft.core.types import Camera, OccupancyGrid, Scan, View
from world2minecraft.evaluation.report.comparison_pictures import as_png
from world2minecraft.evaluation.report.finished_run import read_built
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.rendering.preview import preview
from world2minecraft.rendering.voxel_camera import cast_voxels

PANEL = (480, 360)
CAPTION_PX = 18
SHADES = np.array([0.75, 0.85, 0.8, 0.9, 0.65, 1.0])  # Faces -x +x -y +y -z +z.
FOV_DEG = 40.0
NEAR_SHARE = 0.6  # Walls beyond this share of the room on the viewer's side are cut away.
PALETTE = np.array([*CLASS_COLOURS, (60, 60, 60)], np.uint8)  # Last: no class.
BACKGROUND = np.array((245, 245, 245), np.uint8)


def write_sheet(path: Path, run: Path, scan: Scan | None, label_image: Path | None) -> None:
    """Write the contact sheet of a finished run.

    Args:
        path: Path of the PNG file.
        run: Folder of the finished run.
        scan: Registered scan, or None for a floor plan.
        label_image: Label image of NYUv2 to show beside the photo, or None.
    """
    grid, _ = read_room(run / "room.npz")
    panels = []
    view = None if scan is None else middle_view(scan)
    if scan is not None and view is not None and view.colour is not None:
        panels += [("photo", view.colour), ("cells", cells_from_view(grid, scan, view))]
    if label_image is not None:
        truth = read_nyu_classes(label_image)
        panels.insert(1, ("labels", PALETTE[np.minimum(truth, len(PALETTE) - 1)]))
    panels.append(("cells from above", cells_from_above(grid)))
    panels.append(("world", preview(read_built(run / "build"), *PANEL)))
    write_bytes(path, as_png(join_panels(panels)))


def middle_view(scan: Scan) -> View | None:
    """Return the middle one of the views that a run used."""
    used = scan.frames_used
    views = (view for view in scan.views if view.name == used[len(used) // 2])
    return next(views, None) if used else None


def join_panels(panels: Sequence[tuple[str, np.ndarray]]) -> np.ndarray:
    """Return images side by side, each with its caption above and a legend below, uint8."""
    width, height = PANEL
    sheet = Image.new("RGB", (width * len(panels), height + 2 * CAPTION_PX), "white")
    draw = ImageDraw.Draw(sheet)
    for number, (caption, pixels) in enumerate(panels):
        picture = Image.fromarray(pixels)
        picture.thumbnail(PANEL)
        sheet.paste(picture, (number * width, CAPTION_PX))
        draw.text((number * width + 4, 3), caption, fill="black")
    for number in range(1, len(CLASS_COLOURS)):
        left = 4 + (number - 1) * 85
        top = height + CAPTION_PX
        draw.rectangle((left, top + 3, left + 12, top + 15), fill=CLASS_COLOURS[number])
        draw.text((left + 16, top + 3), CLASS_DISPLAY_NAMES[number], fill="black")
    return np.asarray(sheet)


def cells_from_view(grid: OccupancyGrid, scan: Scan, view: View) -> np.ndarray:
    """Return the cells of a grid in the colours of their classes, seen by a view's camera."""
    camera = view.colour_camera or view.depth_camera
    if camera is None:
        raise ValueError(f"view {view.name} has no camera")
    small = camera.scaled_to(PANEL[0], round(PANEL[0] * camera.height_px / camera.width_px))
    return _cast(grid.labels, grid, small, scan.scan_to_room @ view.camera_to_scan)


def cells_from_above(grid: OccupancyGrid) -> np.ndarray:
    """Return the cells of a grid from an upper corner, without ceiling and near walls."""
    occupied = np.argwhere(grid.occupied)
    centers_m = cell_centers_m(occupied, grid.origin_m, grid.voxel_m)
    low, high = centers_m.min(axis=0), centers_m.max(axis=0)
    middle, reach = (low + high) / 2, float(np.linalg.norm(high - low)) / 2
    toward = np.array([-0.45, -0.6, 0.75])
    classes = grid.labels[tuple(occupied.T)]
    structure = np.isin(classes, (SemanticClass.WALL, SemanticClass.WINDOW))
    offset = (centers_m - middle) / np.maximum(high - low, grid.voxel_m) * 2
    near = structure & (offset[:, :2] < -NEAR_SHARE).any(axis=1)
    cut = near | (classes == SemanticClass.CEILING)
    labels = grid.labels.copy()
    labels[tuple(occupied[cut].T)] = 0
    focal = PANEL[1] / 2 / np.tan(np.radians(FOV_DEG / 2))
    camera = Camera(*PANEL, focal, focal, PANEL[0] / 2, PANEL[1] / 2)
    distance = reach / np.sin(np.radians(FOV_DEG / 2))
    eye = middle + toward / np.linalg.norm(toward) * distance
    return _cast(labels, grid, camera, look_at(eye, middle))


def _cast(
    labels: np.ndarray, grid: OccupancyGrid, camera: Camera, camera_to_room: np.ndarray
) -> np.ndarray:
    hits = cast_voxels(labels, camera, camera_to_room, voxel_m=grid.voxel_m, origin_m=grid.origin_m)
    hit = hits.voxel_index >= 0
    classes = labels.reshape(-1)[np.where(hit, hits.voxel_index, 0)]
    colours = PALETTE[np.minimum(classes, len(PALETTE) - 1)].astype(np.float64)
    shaded = colours * SHADES[np.where(hit, hits.face, 0)][..., None]
    return np.where(hit[..., None], shaded.astype(np.uint8), BACKGROUND)

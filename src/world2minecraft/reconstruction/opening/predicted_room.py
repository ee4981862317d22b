"""Posed photos without depth as a capture, whose room follows from saved predictions.

The grids of the predictions have a vertical axis, floors and walls, which state the room's frame.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.capture.options import parse_options
from world2minecraft.capture.photo_stream import CapturePhotos, photos_of_capture
from world2minecraft.capture.readers.capture_json import write_plain
from world2minecraft.capture.validation import ValidatedCapture
from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.coordinates import (
    apply,
    cell_centers_m,
    invert_rigid,
    rotation_about_z,
)
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import View
from world2minecraft.formats.predicted_grids import GridRules, PredictedGrid
from world2minecraft.reconstruction.occupancy.monocular_occupancy import before_walls
from world2minecraft.reconstruction.occupancy.saved_grids import (
    GridFiles,
    find_grids,
    grid_region,
    place_frame,
    place_scene,
    read_grid,
)
from world2minecraft.reconstruction.opening.one_photo import SIGMA_NONE, is_one_photo, place_photo
from world2minecraft.reconstruction.opening.photo_views import DEPTH_UNIT, undistorted
from world2minecraft.reconstruction.parameters import Parameters

MIN_CELLS = 50  # Occupied, of all grids together: fewer are no room.
YAW_STEP_DEG = 0.5
BIN_M = 0.04  # Bin width for finding walls, in metres: half a cell.
KEEP_YAW = 0.9  # The grid's own axes are kept if their walls are nearly as sharp as the best.
SQUARE_DEG = 0.5  # Grids at such an angle, or at whole quarters, share their axes.
INNER = 1.0  # Percent of the floor's cells beyond each side of the room.
WALL_REACH_M = 0.5  # Maximum distance of a wall from the end of the floor, in metres.
WALL_LAYER = 0.3  # Minimum cells, as a share of the wall's fullest layer.
MIN_SIZE_M, MAX_SIZE_M = 1.0, 60.0


@dataclass(frozen=True, eq=False)
class PlacedCells:
    """The occupied cells of all grids in the scan, with the axes of the first grid.

    Attributes:
        points_m: Centres of the cells in the scan, float64 [N, 3].
        classes: Class of each cell, uint8 [N].
        grid_to_scan: Transform from the first grid to the scan.
        voxel_m: Edge length of the cells.
        share_axes: Whether all grids have the axes of the first, up to quarter turns.
    """

    points_m: np.ndarray
    classes: np.ndarray
    grid_to_scan: np.ndarray
    voxel_m: float
    share_axes: bool


def prepare_predicted(judged: ValidatedCapture, folder: Path, chosen: Parameters) -> None:
    """Write posed photos, or a single photo, as a capture whose room the predictions state.

    Raises:
        CaptureError: If the scale of the poses is unknown, or if the predictions show no room.
        InputError: If the predictions cannot be read.
    """
    single = is_one_photo(judged.capture.source)
    photos = photos_of_capture(judged)
    files = find_grids(Path(chosen.predictions.path), [frame.name for frame in photos.frames])
    rules = chosen.predictions.rules
    if not single and judged.capture.scale == "unknown":
        raise CaptureError(
            judged.capture.folder,
            "its poses have no metric scale, which predictions need; add depth, or poses in metres",
        )
    poses = _pose(photos, files, chosen) if single else None
    level = _level_frame(judged, chosen)
    cells = _cells(photos, poses, files, rules, level, judged.capture.source_to_scan)
    scan_to_room, size_m = find_room(cells)
    stated: dict[str, Any] = {
        "made_from": judged.capture.source,
        "depth_kind": "network",
        "scale": "estimated" if single else judged.capture.scale,
        "scale_sigma": SIGMA_NONE if single else judged.capture.scale_sigma,
        "skipped": [[*row] for row in judged.skipped],
        "notes": [*judged.notes, "the room's frame and size follow from the predictions"],
        "room": {"scan_to_room": scan_to_room.tolist(), "size_m": size_m.tolist()},
        "source_to_scan": judged.capture.source_to_scan.tolist(),
    }
    write_plain(folder, _views(photos, poses), depth_unit=DEPTH_UNIT, stated=stated, jpeg=True)


def _pose(photos: CapturePhotos, files: GridFiles, chosen: Parameters) -> dict[str, np.ndarray]:
    """Return the pose of a single photo: that of its grid, or the assumed one."""
    options = parse_options(chosen.capture)
    name = photos.frames[0].name if photos.frames else ""
    if name in files.of_view:
        grid = read_grid(files.of_view[name], chosen.predictions.rules, is_frame=True)
        if grid.camera_to_world is not None:
            return {name: grid.camera_to_world}
    return {name: place_photo(options.eye_height_m, options.pitch_deg)[0]}


def _level_frame(judged: ValidatedCapture, chosen: Parameters) -> np.ndarray:
    """Return a transform from the scan to a frame with z up and the floor at about 0.

    It follows from the stated up direction or the cameras' own, and from their assumed height, and
    serves to place grids that state no place.
    """
    poses = [frame.camera_to_world for frame in judged.frames if frame.camera_to_world is not None]
    up = judged.capture.world_up
    if up is None:
        up = -np.mean([pose[:3, 1] for pose in poses], axis=0) if poses else np.array([0, 0, 1.0])
    up = np.asarray(up) / max(float(np.linalg.norm(up)), 1e-9)
    side = np.eye(3)[int(np.abs(up).argmin())]
    x = np.cross(side, up)
    x /= np.linalg.norm(x)
    level = np.eye(4)
    level[:3, :3] = [x, np.cross(up, x), up]
    if poses:
        eye_m = float(np.median([(level[:3, :3] @ pose[:3, 3])[2] for pose in poses]))
        level[2, 3] = parse_options(chosen.capture).eye_height_m - eye_m
    return level


def _views(photos: CapturePhotos, poses: dict[str, np.ndarray] | None) -> Iterator[View]:
    for photo in photos:
        pose = photo.camera_to_scan if poses is None else poses.get(photo.name)
        if pose is not None and photo.camera is not None:
            yield View(photo.name, pose, *undistorted(photo.colour, photo.camera))


def _cells(
    photos: CapturePhotos,
    poses: dict[str, np.ndarray] | None,
    files: GridFiles,
    rules: GridRules,
    level: np.ndarray,
    source_to_scan: np.ndarray,
) -> PlacedCells:
    """Return the occupied cells that the images show, or all of the scene's grid."""
    found: list[tuple[PredictedGrid, np.ndarray, np.ndarray]] = []
    if files.scene is not None:
        grid = read_grid(files.scene, rules, is_frame=False)
        found.append((grid, place_scene(grid, source_to_scan), _occupied(grid)))
    else:
        for view in _views(photos, poses):
            if view.name not in files.of_view or view.colour_camera is None:
                continue
            grid = read_grid(files.of_view[view.name], rules, is_frame=True)
            place = place_frame(grid, view.camera_to_scan, level, source_to_scan)
            to_grid = invert_rigid(place) @ view.camera_to_scan
            seen = before_walls(grid.labels, grid_region(grid), to_grid, view.colour_camera)
            found.append((grid, place, seen & _occupied(grid)))
    return _joined(files.path, found)


def _occupied(grid: PredictedGrid) -> np.ndarray:
    return (grid.labels > 0) & (grid.labels != UNKNOWN)


def _joined(
    path: Path, found: Sequence[tuple[PredictedGrid, np.ndarray, np.ndarray]]
) -> PlacedCells:
    if sum(int(mask.sum()) for _, _, mask in found) < MIN_CELLS:
        raise CaptureError(
            path,
            f"the predictions show fewer than {MIN_CELLS} occupied cells in the images; check "
            "cam_pose (camera to world), the classes (--classes) and the convention (--convention)",
        )
    points, classes = [], []
    first = found[0][1]
    share_axes = True
    for grid, place, mask in found:
        centers_m = cell_centers_m(np.argwhere(mask), np.zeros(3), grid.voxel_m)
        points.append(apply(place, centers_m))
        classes.append(grid.labels[mask])
        share_axes &= _is_square(invert_rigid(first) @ place)
    return PlacedCells(
        np.concatenate(points), np.concatenate(classes), first, found[0][0].voxel_m, share_axes
    )


def _is_square(turn: np.ndarray) -> bool:
    """Return whether a rotation is one by whole quarters about z, within SQUARE_DEG."""
    close = np.cos(np.radians(SQUARE_DEG))
    return bool(turn[2, 2] > close and np.abs(turn[:2, :2]).max() > close)


def find_room(cells: PlacedCells) -> tuple[np.ndarray, np.ndarray]:
    """Return ``scan_to_room`` and the size of the room in metres.

    If all grids share their axes, the room's cells are those of the first grid.
    """
    scan_to_grid = invert_rigid(cells.grid_to_scan)
    points = apply(scan_to_grid, cells.points_m)
    walls = points[np.isin(cells.classes, (SemanticClass.WALL, SemanticClass.WINDOW)), :2]
    turn = rotation_about_z(0.0 if len(walls) < MIN_CELLS else find_yaw_deg(walls, cells))
    points = apply(turn, points)
    low, high = room_box_m(points, cells.classes, cells.voxel_m)
    if cells.share_axes and turn[0, 0] == 1:
        low[:2] = np.round(low[:2] / cells.voxel_m) * cells.voxel_m
        low[2] = np.round(low[2] / cells.voxel_m) * cells.voxel_m
    shift = np.eye(4)
    shift[:3, 3] = -low
    size_m = np.clip(high - low, MIN_SIZE_M, MAX_SIZE_M)
    return shift @ turn @ scan_to_grid, size_m


def find_yaw_deg(walls_m: np.ndarray, cells: PlacedCells) -> float:
    """Return the turn about z that lays walls along x and y, from -45 to 45 degrees.

    It is 0 if the axes of grids that share them are as good.

    Args:
        walls_m: Centres of wall cells, float64 [N, 2].
        cells: All cells.
    """
    turns = np.arange(-45, 45, YAW_STEP_DEG)
    sharp = np.array([_sharpness(walls_m, angle) for angle in turns])
    own = _sharpness(walls_m, 0.0)
    if cells.share_axes and own >= KEEP_YAW * sharp.max():
        return 0.0
    return float(turns[int(sharp.argmax())])


def _sharpness(walls_m: np.ndarray, turn_deg: float) -> float:
    """Return how concentrated walls are in planes across x and y after a turn."""
    turned = walls_m @ rotation_about_z(turn_deg)[:2, :2].T
    total = 0.0
    for axis in (0, 1):
        bins = np.floor(turned[:, axis] / BIN_M).astype(np.int64)
        counts = np.bincount(bins - bins.min()).astype(np.float64)
        total += float((counts**2).sum())
    return total


def room_box_m(
    points_m: np.ndarray, classes: np.ndarray, voxel_m: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the minimum and maximum corner of the room's inner box, float64 [3] each.

    The floor's top face is the bottom. Without floor or ceiling, the lowest and highest cells stand
    in for them.

    Args:
        points_m: Centres of occupied cells with z up, float64 [N, 3].
        classes: Their classes, uint8 [N].
        voxel_m: Edge length of the cells.
    """
    half = voxel_m / 2
    floor = points_m[np.equal(classes, SemanticClass.FLOOR)]
    ceiling = points_m[np.equal(classes, SemanticClass.CEILING)]
    ground = floor if len(floor) >= MIN_CELLS else points_m
    low, high = np.percentile(ground[:, :2], [INNER, 100 - INNER], axis=0)
    low, high = low - half, high + half
    walls = points_m[np.equal(classes, SemanticClass.WALL), :2]
    for axis in (0, 1):
        low[axis] = -inner_face_m(-walls[:, axis], -float(low[axis]), voxel_m)
        high[axis] = inner_face_m(walls[:, axis], float(high[axis]), voxel_m)
    bottom = float(np.median(floor[:, 2])) + half if len(floor) >= MIN_CELLS else None
    if bottom is None:
        bottom = float(np.percentile(points_m[:, 2], INNER)) - half
    if len(ceiling) >= MIN_CELLS:
        top = float(np.median(ceiling[:, 2])) - half
    else:
        top = float(np.percentile(points_m[:, 2], 100 - INNER)) + half
    return np.array([*low, bottom]), np.array([*high, top])


def inner_face_m(walls_m: np.ndarray, side_m: float, voxel_m: float) -> float:
    """Return where the wall at the upper side of the room begins, or the side without a wall.

    Floors often continue below the walls, which are several cells thick.

    Args:
        walls_m: Centres of wall cells along an axis, float64 [N].
        side_m: End of the floor along the axis.
        voxel_m: Edge length of the cells.
    """
    layers = np.round((walls_m[np.abs(walls_m - side_m) < WALL_REACH_M] - side_m) / voxel_m)
    if not len(layers):
        return side_m
    first = layers.min()
    counts = np.bincount((layers - first).astype(np.int64))
    inner = int(np.flatnonzero(counts >= WALL_LAYER * counts.max())[0])
    return min(side_m, side_m + float(first + inner - 0.5) * voxel_m)

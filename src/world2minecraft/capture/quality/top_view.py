"""Top view of a capture: coloured points of some frames, rasterised in a levelled frame.

Points above ``CUT_HEIGHT_SHARE`` of the room's height are excluded, so that the view shows the
inside. Columns with points at many heights are walls or tall furniture.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.alignment.gravity import rotation_to_z
from world2minecraft.capture.alignment.room_frame import Alignment, ImplausibleRoomError, align
from world2minecraft.capture.open_scan import ALIGNMENT_FRAMES
from world2minecraft.capture.quality.view_directions import estimate_up
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.capture.validation import ValidatedCapture, evenly_spaced
from world2minecraft.capture.view_stream import CaptureViews
from world2minecraft.core.coordinates import apply
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import View
from world2minecraft.geometry.unprojection import project, unproject_depth

POINTS_EACH = 60_000
CELLS = 560  # Along the longer side of the plan.
CUT_HEIGHT_SHARE, MAX_CUT_M = 0.85, 2.1
TOP_M = 0.08  # A cell's colour is that of its points within this depth of the highest.
RISE_M = 0.10
TALL_BINS = 9  # Points at so many heights, RISE_M apart, make a wall's full ink.
MARGIN_M = 0.35
UNCOLOURED = np.array([176, 178, 180], np.uint8)


@dataclass(frozen=True, eq=False)
class TopView:
    """A top view of a capture, with +y (north) at the top.

    Attributes:
        colour: Colours, uint8 [H, W, 3]; row 0 is in the north. H = W = 0 without depth.
        seen: Cells with points, bool [H, W].
        tall: Extent in height of the points in each cell, float32 [H, W] from 0 to 1.
        height_m: Height of the highest points in each cell in metres.
        corner_m: South-west corner of the raster in metres.
        size_m: Extent of the raster in metres.
        cell_m: Edge length of a raster cell in metres.
        cameras: Poses of all usable frames in the frame of the view, float64 [F, 4, 4].
        room_size_m: Size of the room in metres, or None if no room was found.
        notes: Notes of the alignment.
        problem: Why no room was found.
        near_m: Near end of the depth range in metres.
        far_m: Far end of the depth range in metres.
        holes: Share of depth pixels without depth.
        trust: Mean depth confidence, or None if it is unknown.
    """

    colour: np.ndarray
    seen: np.ndarray
    tall: np.ndarray
    height_m: np.ndarray
    corner_m: np.ndarray
    size_m: np.ndarray
    cell_m: float
    cameras: np.ndarray
    room_size_m: np.ndarray | None = None
    notes: tuple[str, ...] = ()
    problem: str = ""
    near_m: float = 0.0
    far_m: float = 0.0
    holes: float = 0.0
    trust: float | None = None


def make_top_view(validated: ValidatedCapture) -> TopView:
    """Render frames of a posed capture to a top view; without depth, only the cameras."""
    poses = np.array([np.asarray(frame.camera_to_world) for frame in validated.frames])
    with_depth = [frame for frame in validated.frames if frame.depth_path]
    if not with_depth:
        return _camera_top_view(validated, poses)
    gathered = _PointCollector(validated, evenly_spaced(with_depth, ALIGNMENT_FRAMES))
    problem, found = "", None
    try:
        found = align(gathered.views(), validated.capture.world_up)
    except ImplausibleRoomError as error:
        problem = str(error)
    if not sum(map(len, gathered.points)):
        raise CaptureError(
            validated.capture.folder,
            f"contains no reliable depth in the {len(gathered.holes)} sampled depth images; "
            "scan again from closer and more slowly",
        )
    scan_to_level = _level_frame(validated, poses) if found is None else found.scan_to_room
    return _rasterise(gathered, scan_to_level @ poses, scan_to_level, found, problem)


class _PointCollector:
    """A reader of views for ``align`` that also collects coloured points."""

    def __init__(self, validated: ValidatedCapture, frames: Sequence[FrameFiles]):
        self._stream = CaptureViews(
            validated.frames, validated.encoding, validated.capture.full_trust
        )
        self._frames = frames
        self.points: list[np.ndarray] = [np.zeros((0, 3), np.float32)]
        self.colours: list[np.ndarray] = [np.zeros((0, 3), np.uint8)]
        self.depths: list[np.ndarray] = []
        self.holes: list[float] = []
        self.trusts: list[float] = []

    def views(self) -> Iterator[View]:
        """Yield the views in order."""
        for view in self._stream.read(self._frames):
            self._keep(view)
            yield view

    def _keep(self, view: View) -> None:
        if view.depth_m is None or view.depth_camera is None:
            return
        points, _ = unproject_depth(view.depth_m, view.depth_camera, np.eye(4))
        self.holes.append(1 - len(points) / view.depth_m.size)
        if view.trust is not None:
            self.trusts.append(float(view.trust.mean()) / 255)
        points = points[:: max(1, len(points) // POINTS_EACH)].astype(np.float64)
        self.depths.append(points[::8, 2].astype(np.float32))
        colours = _sample_colours(view, apply(view.depth_to_colour, points))
        self.points.append(apply(view.depth_camera_to_scan, points).astype(np.float32))
        self.colours.append(colours)


def _sample_colours(view: View, points: np.ndarray) -> np.ndarray:
    """Return the colours of a view's colour image at 3D points, uint8 [N, 3]."""
    colours = np.tile(UNCOLOURED, (len(points), 1))
    if view.colour is None or view.colour_camera is None:
        return colours
    ahead = np.flatnonzero(points[:, 2] > 0.05)
    pixels = np.floor(project(points[ahead], view.colour_camera))
    height, width = view.colour.shape[:2]
    with np.errstate(invalid="ignore"):
        inside = ((pixels >= 0) & (pixels < (width, height))).all(axis=1)
    u, v = pixels[inside].astype(int).T
    colours[ahead[inside]] = view.colour[v, u]
    return colours


def _level_frame(validated: ValidatedCapture, poses: np.ndarray) -> np.ndarray:
    """Return a rotation that levels the scan, with the first view direction to the north."""
    up = validated.capture.world_up
    turned = np.eye(4)
    turned[:3, :3] = rotation_to_z(estimate_up(poses) if up is None else np.asarray(up))
    view_direction = turned[:3, :3] @ poses[0, :3, 2]
    if np.hypot(view_direction[0], view_direction[1]) > 0.1:
        angle = np.pi / 2 - np.arctan2(view_direction[1], view_direction[0])
        turn = np.eye(4)
        turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        turned = turn @ turned
    return turned


def _camera_top_view(validated: ValidatedCapture, poses: np.ndarray) -> TopView:
    cameras = _level_frame(validated, poses) @ poses
    places = cameras[:, :2, 3]
    low, high = places.min(axis=0), places.max(axis=0)
    margin = max(MARGIN_M, 0.15 * float((high - low).max()))
    low, high = low - margin, high + margin
    empty = np.zeros((0, 0))
    return TopView(
        empty[..., None].astype(np.uint8).reshape(0, 0, 1),
        empty.astype(bool),
        empty.astype(np.float32),
        empty.astype(np.float32),
        low,
        high - low,
        float((high - low).max()) / CELLS,
        cameras,
    )


def _rasterise(
    gathered: _PointCollector,
    cameras: np.ndarray,
    scan_to_level: np.ndarray,
    found: Alignment | None,
    problem: str,
) -> TopView:
    points = apply(scan_to_level, np.concatenate(gathered.points).astype(np.float64))
    colours = np.concatenate(gathered.colours)
    low, high = _extent(points, cameras[:, :2, 3], found)
    cell = float((high - low).max()) / CELLS
    floor = 0.0 if found is not None else float(np.quantile(points[:, 2], 0.01))
    height = (
        float(found.room_size_m[2])
        if found is not None
        else float(np.quantile(points[:, 2], 0.99) - floor)
    )
    points[:, 2] -= floor
    shape = tuple(np.maximum(np.ceil((high - low) / cell), 1).astype(int)[::-1])
    inside = ((points[:, :2] > low) & (points[:, :2] < high)).all(axis=1)
    inside &= (points[:, 2] > -0.3) & (points[:, 2] < height - 0.1)
    points, colours = points[inside], colours[inside]
    column, row = np.floor((points[:, :2] - low) / cell).astype(np.int64).T
    pixel = (shape[0] - 1 - np.minimum(row, shape[0] - 1)) * shape[1] + np.minimum(
        column, shape[1] - 1
    )
    tall = _tallness(pixel, points[:, 2], shape)
    below = points[:, 2] < min(CUT_HEIGHT_SHARE * height, MAX_CUT_M)
    colour, seen, top = _top_colours(pixel[below], points[below, 2], colours[below], shape)
    depths = np.concatenate(gathered.depths)
    near, far = np.quantile(depths, [0.05, 0.95]) if len(depths) else (0.0, 0.0)
    return TopView(
        colour,
        seen,
        tall,
        top,
        low,
        np.array([shape[1], shape[0]]) * cell,
        cell,
        cameras,
        None if found is None else found.room_size_m,
        () if found is None else found.notes,
        problem,
        round(float(near), 2),
        round(float(far), 2),
        round(float(np.mean(gathered.holes)), 3),
        round(float(np.mean(gathered.trusts)), 3) if gathered.trusts else None,
    )


def _extent(
    points: np.ndarray, places: np.ndarray, found: Alignment | None
) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of the view: almost all points, all cameras and the room."""
    low = np.minimum(np.quantile(points[:, :2], 0.003, axis=0), places.min(axis=0))
    high = np.maximum(np.quantile(points[:, :2], 0.997, axis=0), places.max(axis=0))
    if found is not None:
        low, high = np.minimum(low, 0.0), np.maximum(high, found.room_size_m[:2])
        # What was seen through a window must not make the room small.
        low, high = np.maximum(low, -2.0), np.minimum(high, found.room_size_m[:2] + 2.0)
    return low - MARGIN_M, high + MARGIN_M


def _tallness(pixel: np.ndarray, z: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Return the number of different heights of the points in each cell, relative to a wall."""
    raised = (z > 0.15) & (z < 3.0)
    bins = (z[raised] / RISE_M).astype(np.int64)
    distinct = np.unique(pixel[raised] * 64 + bins) // 64
    count = np.bincount(distinct, minlength=shape[0] * shape[1]).reshape(shape)
    return np.minimum(count / TALL_BINS, 1.0).astype(np.float32)


def _top_colours(
    pixel: np.ndarray, z: np.ndarray, colours: np.ndarray, shape: tuple[int, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the mean colour and height of each cell's highest points, and occupied cells."""
    count = shape[0] * shape[1]
    top = np.full(count, -np.inf)
    np.maximum.at(top, pixel, z)
    highest = z > top[pixel] - TOP_M
    pixel, colours, z = pixel[highest], colours[highest], z[highest]
    weight = np.bincount(pixel, minlength=count).astype(np.float64)
    channels = [colours[:, axis].astype(np.float64) for axis in range(3)]
    sums = np.stack(
        [np.bincount(pixel, values, minlength=count) for values in (*channels, z)], axis=1
    )
    sums, weight = _fill_holes(sums.reshape(*shape, 4), weight.reshape(shape))
    seen = weight > 0
    mean = sums / np.maximum(weight, 1e-9)[..., None]
    return np.round(mean[..., :3]).astype(np.uint8), seen, mean[..., 3].astype(np.float32)


def _fill_holes(sums: np.ndarray, weight: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fill small holes: empty cells with three occupied neighbours get their mean."""
    for _ in range(3):
        near, near_sums = np.zeros_like(weight), np.zeros_like(sums)
        filled = (weight > 0).astype(np.float64)
        mean = sums / np.maximum(weight, 1e-9)[..., None]
        padded = np.pad(filled, 1)
        padded_mean = np.pad(mean * filled[..., None], ((1, 1), (1, 1), (0, 0)))
        for down in range(3):
            for right in range(3):
                rows = slice(down, down + weight.shape[0])
                columns = slice(right, right + weight.shape[1])
                near += padded[rows, columns]
                near_sums += padded_mean[rows, columns]
        empty = (weight == 0) & (near >= 3)
        sums = np.where(empty[..., None], near_sums, sums)
        weight = np.where(empty, near, weight)
    return sums, weight

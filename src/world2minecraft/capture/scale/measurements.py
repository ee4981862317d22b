"""Measurements of a room in the unit of the scan: floor, cameras, ceiling and level faces.

The measuring functions use thresholds in metres. Depth is therefore first scaled to roughly metres
by the typical viewing distance in a room, and then by the typical height of a hand-held camera. The
results are converted back to the unit of the scan.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.capture.alignment.axis_profiles import axis_profile
from world2minecraft.capture.alignment.room_frame import find_level_frame
from world2minecraft.capture.alignment.walls import find_room_box
from world2minecraft.core.types import View
from world2minecraft.geometry.oriented_points import OrientedPoints, collect_oriented_points

USUAL_DEPTH_M = 1.9  # Median over the virtual walks of seeds 500 to 549, 1.4 to 2.6 each.
EVERY_PIXEL = 7  # Stride in depth images for their median.
USUAL_CAMERA_M = 1.45  # A person who stands and holds a phone before the chest or the eyes.
USUAL_RANGE_M = 2.0  # Typical distance of patches, in metres; for the first guess only.
MIN_FACING_COSINE = 0.94  # Cosine of 20 degrees.
LEVEL_RANGE_M = (0.25, 1.30)  # Heights of furniture tops that are measured, in metres.
MIN_LEVEL_M2 = 0.10  # A seat has 0.16.
MIN_CEILING_OVER_CAMERA = 1.15  # Wall cupboards and shelves have undersides too, at the eye.
MIN_CEILING_M2, MIN_CEILING_SHARE = 0.5, 0.4
OTHER_STOREY_RATIO = 1.7  # Cameras above this multiple of the lowest cameras' height are on stairs.
SINGLE_STOREY_SHARE = 0.9  # Minimum share of cameras over the lowest floor of one storey.
TOP_QUANTILE = 0.995
MERGE_DISTANCE_M = 0.035  # Two closer peaks are one noisy face.


def collect_unscaled(views: Iterable[View], max_per_view: int = 4096) -> OrientedPoints:
    """Collect oriented surface points of views in any unit; the result has the same unit.

    Args:
        views: Views, read twice and one at a time; views without depth are ignored.
        max_per_view: Maximum number of evenly spaced points per view.
    """
    median = _median_depth(views)
    if median <= 0:
        return collect_oriented_points((), max_per_view)
    factor = USUAL_DEPTH_M / median
    return scale_points(
        collect_oriented_points(_scale_views(views, factor), max_per_view), 1 / factor
    )


def scale_points(surface: OrientedPoints, factor: float) -> OrientedPoints:
    """Multiply all lengths of a surface by a positive factor."""
    cameras = surface.cameras.copy()
    cameras[:, :3, 3] *= factor
    return replace(
        surface,
        points_m=surface.points_m * factor,
        cameras=cameras,
        sigma_m=surface.sigma_m * factor,
    )


def _median_depth(views: Iterable[View]) -> float:
    """Return the median of the median depths of the views, or 0 without depth."""
    medians = []
    for view in views:
        if view.depth_m is not None:
            depth = view.depth_m[::EVERY_PIXEL, ::EVERY_PIXEL]
            if (depth > 0).any():
                medians.append(float(np.median(depth[depth > 0])))
    return float(np.median(medians)) if medians else 0.0


def _scale_views(views: Iterable[View], factor: float) -> Iterator[View]:
    for view in views:
        if view.depth_m is None:
            continue
        pose, between = view.camera_to_scan.copy(), view.depth_to_colour.copy()
        pose[:3, 3] *= factor
        between[:3, 3] *= factor
        depth = (view.depth_m * np.float32(factor)).astype(np.float32)
        yield View(
            view.name,
            pose,
            depth_m=depth,
            depth_camera=view.depth_camera,
            depth_to_colour=between,
        )


@dataclass(frozen=True)
class LevelFace:
    """A level face that faces up, in the unit of the scan.

    Attributes:
        height: Height above the floor.
        area: Area of the face.
    """

    height: float
    area: float


@dataclass(frozen=True)
class RoomMeasurements:
    """Lengths of a room in the unit of the scan; None for anything not seen.

    Attributes:
        rough: Scale at which the cameras would be at a typical height.
        camera: Median height of the cameras above the floor.
        floor_seen: Whether a floor was found.
        top: Height of the highest points, or None if there is another storey.
        ceiling: Height of the ceiling.
        levels: Level faces that face up.
        length: Longer side of the room's inner box.
        width: Shorter side of the room's inner box.
    """

    rough: float
    camera: float
    floor_seen: bool
    top: float | None
    ceiling: float | None
    levels: tuple[LevelFace, ...]
    length: float | None
    width: float | None


def measure_room(surface: OrientedPoints) -> RoomMeasurements:
    """Measure a room in a surface of any unit and orientation.

    Args:
        surface: At least a few hundred points, and the cameras that saw them.
    """
    rough = _rough_scale(surface)
    level, _ = _level_points(scale_points(surface, rough))
    camera = _lowest_camera(level.cameras[:, 2, 3])
    again = float(np.clip(USUAL_CAMERA_M / max(camera, 0.2), 0.2, 5.0))
    rough *= again
    level, seen = _level_points(scale_points(surface, rough))
    camera = _lowest_camera(level.cameras[:, 2, 3])
    heights = level.cameras[:, 2, 3]
    near = heights[heights < OTHER_STOREY_RATIO * camera]
    length, width = _side_lengths(level)
    ceiling = _ceiling_height(level, camera)
    return RoomMeasurements(
        rough=rough,
        camera=camera / rough,
        floor_seen=seen,
        top=_top_height(level) / rough if len(near) > SINGLE_STOREY_SHARE * len(heights) else None,
        ceiling=None if ceiling is None else ceiling / rough,
        levels=tuple(
            LevelFace(at.height / rough, at.area / rough**2) for at in _level_faces(level)
        ),
        length=None if length is None else length / rough,
        width=None if width is None else width / rough,
    )


def _rough_scale(surface: OrientedPoints) -> float:
    """Return the scale at which the median viewing distance is that of a typical room."""
    away = surface.points_m - surface.cameras[surface.owner, :3, 3]
    return USUAL_RANGE_M / max(float(np.median(np.linalg.norm(away, axis=1))), 1e-12)


def _level_points(surface: OrientedPoints) -> tuple[OrientedPoints, bool]:
    """Return the surface with z up and the floor at z = 0, and whether a floor was found."""
    frame = find_level_frame(surface)
    return surface.transformed(frame.scan_to_level), frame.floor_seen


def _lowest_camera(heights: np.ndarray) -> float:
    """Return the median height of the cameras on the lowest storey, above 0."""
    low = float(np.quantile(heights, 0.1))
    near = heights[heights <= OTHER_STOREY_RATIO * max(low, 0.05)]
    return max(float(np.median(near if len(near) else heights)), 0.05)


def _level_faces(level: OrientedPoints) -> list[LevelFace]:
    """Return the upward faces between stool height and chest height, from low to high."""
    up = level.points_m[level.normals[:, 2] > MIN_FACING_COSINE]
    found = axis_profile(up, 2, 0.02)
    peaks = [at for at in found.peaks(MIN_LEVEL_M2) if LEVEL_RANGE_M[0] <= at <= LEVEL_RANGE_M[1]]
    levels: list[LevelFace] = []
    for place in peaks:
        area = found.area_at(float(place))
        if levels and place - levels[-1].height < MERGE_DISTANCE_M:
            if area <= levels[-1].area:
                continue
            levels.pop()
        near = up[np.abs(up[:, 2] - place) < 0.03, 2]
        levels.append(LevelFace(float(np.median(near)), area))
    return levels


def _top_height(level: OrientedPoints) -> float:
    return float(np.quantile(level.points_m[:, 2], TOP_QUANTILE))


def _ceiling_height(level: OrientedPoints, camera: float) -> float | None:
    """Return the height of the lowest large downward face above the cameras."""
    down = level.points_m[level.normals[:, 2] < -MIN_FACING_COSINE]
    found = axis_profile(down, 2, 0.03)
    min_height = MIN_CEILING_OVER_CAMERA * camera
    places = [float(at) for at in found.peaks(MIN_CEILING_M2) if at > min_height]
    if not places:
        return None
    largest = max(found.area_at(at) for at in places)
    lowest = next(at for at in places if found.area_at(at) >= MIN_CEILING_SHARE * largest)
    return float(np.median(down[np.abs(down[:, 2] - lowest) < 0.045, 2]))


def _side_lengths(level: OrientedPoints) -> tuple[float | None, float | None]:
    """Return the longer and the shorter side of the room, or None if a wall is missing."""
    box = find_room_box(level)
    sides = []
    for axis, name in enumerate("xy"):
        both = {f"{name}-", f"{name}+"} <= set(box.seen)
        sides.append((float(box.high_m[axis] - box.low_m[axis]), both))
    sides.sort(key=lambda side: -side[0])
    (length, has_length), (width, has_width) = sides
    return (length if has_length else None), (width if has_width else None)

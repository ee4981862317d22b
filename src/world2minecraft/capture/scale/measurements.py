"""Measurements of a room in the scan's own unit: floor, cameras, ceiling, level faces.

The stages behind need thresholds in metres. So depth is first brought to about metres by what a
person who walks through a room usually looks at, and the surface by the height at which a person
holds a camera; what was found is carried back to the scan's unit.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.capture.alignment.axis_profiles import axis_profile
from world2minecraft.capture.alignment.gravity import find_ground, rotation_to_z
from world2minecraft.capture.alignment.walls import find_room_box, find_yaw
from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.types import View
from world2minecraft.geometry.oriented_points import OrientedPoints, collect_oriented_points

USUAL_DEPTH_M = 1.9  # Median over the virtual walks of seeds 500 to 549, 1.4 to 2.6 each.
EVERY_PIXEL = 7  # Of the depth images, for their median.
USUAL_CAMERA_M = 1.45  # A person who stands and holds a phone before the chest or the eyes.
USUAL_RANGE_M = 2.0  # How far off the patches are; only the first guess rests on it.
MIN_FACING_COSINE = 0.94  # Cosine of 20 degrees.
LEVEL_RANGE_M = (0.25, 1.30)  # What stands on a floor and has a top to measure by.
MIN_LEVEL_M2 = 0.10  # A seat has 0.16.
MIN_CEILING_OVER_CAMERA = 1.15  # Wall cupboards and shelves have undersides too, at the eye.
MIN_CEILING_M2, MIN_CEILING_SHARE = 0.5, 0.4
OTHER_STOREY_RATIO = 1.7  # Times the lowest cameras' height: cameras over that stand on stairs.
SINGLE_STOREY_SHARE = 0.9  # Of the cameras that stand on the lowest floor where it is the only one.
TOP_QUANTILE = 0.995
MERGE_DISTANCE_M = 0.035  # Two peaks nearer than that are one noisy face.


def collect_unscaled(views: Iterable[View], max_per_view: int = 4096) -> OrientedPoints:
    """Collect the flat patches of views in any unit; all lengths of the result are in that unit.

    Args:
        views: read twice, one view at a time; those without depth give nothing.
        max_per_view: of a view with more patches, that many are taken, evenly spread.
    """
    median = _median_depth(views)
    if median <= 0:
        return collect_oriented_points((), max_per_view)
    factor = USUAL_DEPTH_M / median
    return scale_points(
        collect_oriented_points(_scale_views(views, factor), max_per_view), 1 / factor
    )


def scale_points(surface: OrientedPoints, factor: float) -> OrientedPoints:
    """Return the surface with all its lengths multiplied by a factor above 0."""
    cameras = surface.cameras.copy()
    cameras[:, :3, 3] *= factor
    return replace(
        surface,
        points_m=surface.points_m * factor,
        cameras=cameras,
        sigma_m=surface.sigma_m * factor,
    )


def _median_depth(views: Iterable[View]) -> float:
    """Return the median over the views of their median depths, 0 where none has depth."""
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
    """A level face that looks up: its height over the floor, and its area, in the scan's unit."""

    height: float
    area: float


@dataclass(frozen=True)
class RoomMeasurements:
    """The lengths of a room in the scan's unit; None where a thing was not seen.

    ``camera`` is the cameras' middle height over the floor, ``camera_spread`` how much it varies,
    relative to it; ``top`` the height where points end, None where there is another storey;
    ``length`` and ``width`` the sides of the room's inner box, the longer first. ``rough`` is
    the scale at which the camera would be at its usual height.
    """

    rough: float
    camera: float
    camera_spread: float
    floor_seen: bool
    top: float | None
    ceiling: float | None
    levels: tuple[LevelFace, ...]
    length: float | None
    width: float | None


def measure_room(surface: OrientedPoints) -> RoomMeasurements:
    """Measure a room in a surface of any unit and tilt.

    Args:
        surface: at least a few hundred points, and the cameras that saw them.
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
        camera_spread=float(np.std(near) / camera) if len(near) else 0.0,
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
    """Return the scale at which what the cameras see is about as far as in a usual room."""
    away = surface.points_m - surface.cameras[surface.owner, :3, 3]
    return USUAL_RANGE_M / max(float(np.median(np.linalg.norm(away, axis=1))), 1e-12)


def _level_points(surface: OrientedPoints) -> tuple[OrientedPoints, bool]:
    """Return the surface with the floor at z = 0 and z up, and whether a floor was seen."""
    ground = find_ground(surface)
    to_level = np.eye(4)
    to_level[:3, :3] = rotation_to_z(ground.up)
    to_level[2, 3] = -ground.height_m
    return surface.transformed(to_level), ground.floor_area_m2 > 0


def _lowest_camera(heights: np.ndarray) -> float:
    """Return the middle height of the cameras of the lowest storey, above 0."""
    low = float(np.quantile(heights, 0.1))
    near = heights[heights <= OTHER_STOREY_RATIO * max(low, 0.05)]
    return max(float(np.median(near if len(near) else heights)), 0.05)


def _level_faces(level: OrientedPoints) -> list[LevelFace]:
    """Return the faces that look up between a stool's height and the chest's, from low to high."""
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
    """Return the height of the lowest large face that looks down over the cameras."""
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
    """Return the longer and the shorter side of the room, each None where a wall is missing."""
    box = find_room_box(level.transformed(rotation_about_z(-find_yaw(level))))
    sides = []
    for axis, name in enumerate("xy"):
        both = {f"{name}-", f"{name}+"} <= set(box.seen)
        sides.append((float(box.high_m[axis] - box.low_m[axis]), both))
    sides.sort(key=lambda side: -side[0])
    (length, has_length), (width, has_width) = sides
    return (length if has_length else None), (width if has_width else None)

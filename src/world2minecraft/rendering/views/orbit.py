"""Orbits: circles of cameras that show a whole build, for still images and animations."""

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.coordinates import apply, invert_rigid, look_at
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.rendering.views.cameras import Shot

ELEVATION_DEG = 28.0  # One sees the roof and the walls of a house.
TURN_DEG = 34.0  # Where the circle begins: off the diagonal, so that two sides differ.
MARGIN = 1.08
EAVES_M = 0.8  # From the labelled walls to the edge of the roof.
CENTRINGS = 3  # What is near looks larger, so that the middle of a build is not that of its view.
MAX_DISTANCE_M = 20_000.0


def orbit_shots(
    volume: BlockVolume,
    camera: Camera,
    frames: int,
    *,
    elevation_deg: float = ELEVATION_DEG,
    start_deg: float = TURN_DEG,
    rate_hz: float = 24.0,
) -> list[Shot]:
    """Return shots on a circle around a volume, each of which shows all of its building.

    The building is the labelled blocks with the roof above them; a garden around them may be cut
    off. Without labels, all blocks are shown.

    Args:
        volume: The blocks.
        camera: Camera intrinsics.
        frames: Number of shots, evenly spaced on the circle. The first shot faces north-west.
        elevation_deg: Elevation of the camera above the horizontal, in degrees.
        start_deg: Start angle of the circle, counter-clockwise from its default diagonal.
        rate_hz: Frames per second, for the time stamps.
    """
    points_m = corner_points_m(volume)
    middle_m = (points_m.min(axis=0) + points_m.max(axis=0)) / 2
    ways = [_way(start_deg + 360.0 * n / frames, elevation_deg) for n in range(frames)]
    for _ in range(CENTRINGS):
        distance_m = max(_fitting_distance_m(points_m - middle_m, way, camera) for way in ways)
        low_m = np.mean([_lowness_m(points_m - middle_m, way, distance_m) for way in ways])
        middle_m[2] -= low_m / max(np.cos(np.radians(elevation_deg)), 0.2)
    distance_m = max(_fitting_distance_m(points_m - middle_m, way, camera) for way in ways)
    return [
        Shot(camera, look_at(middle_m + way * distance_m, middle_m), n / rate_hz)
        for n, way in enumerate(ways)
    ]


def corner_points_m(volume: BlockVolume) -> np.ndarray:
    """Return the corners of the bounding box of the building, float64 [8, 3] in room metres."""
    filled = volume.states != 0
    labelled = (volume.semantic > 0) & (volume.semantic != UNKNOWN)
    if labelled.any():  # The roof and the eaves have no class either.
        columns = labelled.any(axis=1)
        near = ndimage.binary_dilation(
            columns, np.ones((3, 3)), max(1, round(EAVES_M * volume.blocks_per_metre))
        )
        filled &= near[:, None]
    if not filled.any():
        filled = np.ones_like(filled)
    spans = []
    for axis in range(3):
        used = np.flatnonzero(filled.any(axis=tuple({0, 1, 2} - {axis})))
        spans.append((used[0] + volume.corner[axis], used[-1] + 1 + volume.corner[axis]))
    corners = np.stack(np.meshgrid(*spans, indexing="ij"), axis=-1).reshape(-1, 3)
    return apply(volume.block_to_room, corners.astype(np.float64))


def _way(turn_deg: float, elevation_deg: float) -> np.ndarray:
    """Return the unit vector from the middle to the camera; a growing turn goes with the clock."""
    turn, up = np.radians(-turn_deg), np.radians(elevation_deg)
    return np.array([np.cos(turn) * np.cos(up), np.sin(turn) * np.cos(up), np.sin(up)])


def _lowness_m(points_m: np.ndarray, way: np.ndarray, distance_m: float) -> float:
    """Return how far under the picture's middle, at the build's distance, its view's middle is."""
    seen = apply(invert_rigid(look_at(way * distance_m, np.zeros(3))), points_m)
    down = seen[:, 1] / np.maximum(seen[:, 2], 1e-6)
    return float((down.min() + down.max()) / 2 * distance_m)


def _fitting_distance_m(points_m: np.ndarray, way: np.ndarray, camera: Camera) -> float:
    """Return the least distance from which all points lie within the picture."""
    axes = look_at(way, np.zeros(3))
    seen = apply(invert_rigid(axes), points_m)  # From a metre away, looking to the middle.
    seen[:, 2] -= 1.0  # How far each point lies behind the middle.
    half = np.array(
        [
            min(camera.cx_px, camera.width_px - camera.cx_px) / camera.fx_px,
            min(camera.cy_px, camera.height_px - camera.cy_px) / camera.fy_px,
        ]
    )
    needed = np.abs(seen[:, :2]) * MARGIN / np.maximum(half, 1e-6) - seen[:, 2:]
    nearest = -seen[:, 2].min() * 1.001 + 1e-3  # All points lie before the camera.
    return float(min(max(needed.max(), nearest), MAX_DISTANCE_M))

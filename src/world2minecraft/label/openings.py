"""Windows and doors: flat parts of a wall that lie back from its plane.

Glass gives depth seldom, and then lies some centimetres behind the wall. What stands back so and
begins above the floor is a window; what reaches down to the floor is a door leaf, class objs.
"""

from typing import cast

import numpy as np
from scipy import ndimage

from world2minecraft.classes import SemanticClass
from world2minecraft.label.parameters import GeometricParameters
from world2minecraft.label.surface import Surface
from world2minecraft.label.walls import WallRun, turned

EIGHT = np.ones((3, 3), bool)


def label_openings(
    surface: Surface,
    wall: np.ndarray,
    runs: list[WallRun],
    labels: np.ndarray,
    parameters: GeometricParameters,
) -> None:
    """Write windows and door leaves over the wall cells of ``labels``, all [X, Y, Z]."""
    low, high = parameters.opening_depth_m
    for run in runs:
        outward = run.sign * turned(surface.points_m[..., run.axis], run.axis, run.sign)
        cells = turned(wall, run.axis, run.sign).copy()
        cells[:, : run.span[0]] = False
        cells[:, run.span[1] + 1 :] = False
        depth = outward - run.outward_m
        back = cells & (depth >= low) & (depth <= high)
        near = cells & (np.abs(depth) < low)
        # Seen face on: columns along the wall and up, recessed where nothing lies on the plane.
        face = cast(np.ndarray, ndimage.binary_opening(back.any(axis=0) & ~near.any(axis=0), EIGHT))
        parts = cast(tuple[np.ndarray, int], ndimage.label(face, EIGHT))[0]
        for part, box in enumerate(ndimage.find_objects(parts), 1):
            kind = _kind(parts[box] == part, box, surface, parameters)
            if (
                kind is not None
                and _framed(parts == part, near.any(axis=0)) >= parameters.frame_share
            ):
                chosen = ndimage.binary_dilation(parts == part, EIGHT) & back.any(axis=0)
                turned(labels, run.axis, run.sign)[back & chosen[None]] = kind


def _kind(
    part: np.ndarray,
    box: tuple[slice, ...],
    surface: Surface,
    parameters: GeometricParameters,
) -> SemanticClass | None:
    """Return what a recessed part, seen face on, is; None where it is too small or ragged."""
    width, height = np.array(part.shape) * surface.voxel_m
    bottom = surface.origin_m[2] + box[1].start * surface.voxel_m
    if part.sum() * surface.voxel_m**2 < parameters.opening_area_m2 or part.mean() < 0.5:
        return None
    low, high = parameters.window_size_m
    if bottom >= parameters.window_sill_m and low <= width <= high and low <= height:
        return SemanticClass.WINDOW
    low, high = parameters.door_width_m
    if low <= width <= high and height >= parameters.door_height_m:
        return SemanticClass.OBJS
    return None


def _framed(part: np.ndarray, plane: np.ndarray) -> float:
    """Return the share of the ring around a part that lies on the wall's plane."""
    inner = ndimage.binary_dilation(part, EIGHT)
    ring = ndimage.binary_dilation(part, EIGHT, iterations=3) & ~inner
    return float(plane[ring].mean()) if ring.any() else 0.0

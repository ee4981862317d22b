"""The region of a view: on the scene's cells, from the floor under the camera upwards.

The rule itself is that of ``geometry/view_region.py``.
"""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.view_region import LabelRegion, RegionRule, label_region, view_yaw_deg
from world2minecraft.minecraftocc.types import SceneVoxels

__all__ = ["RegionRule", "floor_under", "label_region", "region_in", "view_yaw_deg"]


RUG_M = 0.25  # What lies so much higher than a floor that spreads wider is no floor of its own.


def region_in(
    voxels: SceneVoxels, camera_to_room: np.ndarray, rule: RegionRule | None = None
) -> LabelRegion:
    """Return the region of a view of a scene: on its cells, from the floor under the camera on."""
    return label_region(
        camera_to_room,
        rule,
        floor_m=floor_under(voxels, camera_to_room),
        grid_origin_m=voxels.origin_m,
    )


def floor_under(voxels: SceneVoxels, camera_to_room: np.ndarray, around_m: float = 1.0) -> float:
    """Return the height of the floor that a camera is over, in metres.

    It is the top of the highest cell of class floor below the camera, of the columns nearest to it
    that have one; of the whole scene where none is near, and 0 where there is none at all. Where
    that lies on a floor that spreads wider, as a rug does, it is the wider floor's.

    Args:
        voxels: the scene.
        camera_to_room: 4x4.
        around_m: how far beside the camera a floor still counts as near.
    """
    eye = (camera_to_room[:3, 3] - voxels.origin_m) / voxels.voxel_m
    layers = int(np.clip(np.floor(eye[2]), 0, voxels.labels.shape[2]))
    at, reach = np.floor(eye[:2]).astype(int), int(np.ceil(around_m / voxels.voxel_m))
    near = _floor_counts(voxels, at, reach, layers)
    for away in (0, 1, 3, reach):
        floor = np.flatnonzero(_floor_counts(voxels, at, away, layers))
        if len(floor):
            below = range(max(floor[-1] - int(RUG_M / voxels.voxel_m), 0), floor[-1] + 1)
            wide = [layer for layer in below if 2 * near[layer] >= max(near[below])]
            return float(voxels.origin_m[2] + (wide[-1] + 1) * voxels.voxel_m)
    floor = np.flatnonzero((voxels.labels == SemanticClass.FLOOR).any(axis=(0, 1)))
    below = floor[floor < layers] if (floor < layers).any() else floor[:1]
    return float(voxels.origin_m[2] + (below[-1] + 1) * voxels.voxel_m) if len(below) else 0.0


def _floor_counts(voxels: SceneVoxels, at: np.ndarray, away: int, layers: int) -> np.ndarray:
    """Return how many cells of the lowest ``layers`` are floor, of the columns around a place."""
    low, high = np.maximum(at - away, 0), np.maximum(at + away + 1, 0)
    part = voxels.labels[low[0] : high[0], low[1] : high[1], :layers]
    return np.count_nonzero(part == SemanticClass.FLOOR, axis=(0, 1))

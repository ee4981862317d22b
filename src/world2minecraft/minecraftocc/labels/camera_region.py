"""The region of a view, aligned with the cells of a scene and the floor below the camera.

The rule for the region is in ``geometry/view_region.py``.
"""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.view_region import LabelRegion, RegionRule, label_region, view_yaw_deg
from world2minecraft.minecraftocc.types import SceneVoxels

__all__ = ["RegionRule", "floor_under", "label_region", "region_in", "view_yaw_deg"]


RUG_M = 0.25  # Maximum height of a small area, such as a rug, above the floor that it lies on.
AROUND_M = 1.0  # Maximum horizontal distance of a nearby floor from the camera.


def region_in(
    voxels: SceneVoxels, camera_to_room: np.ndarray, rule: RegionRule | None = None
) -> LabelRegion:
    """Return the region of a view, aligned with the cells of a scene.

    The region starts at the floor below the camera.

    Args:
        voxels: Cells of the scene.
        camera_to_room: Camera pose in the room [4, 4].
        rule: Size and kind of the region. Defaults to the region of the paper.
    """
    return label_region(
        camera_to_room,
        rule,
        floor_m=floor_under(voxels, camera_to_room),
        grid_origin_m=voxels.origin_m,
    )


def floor_under(voxels: SceneVoxels, camera_to_room: np.ndarray) -> float:
    """Return the height in metres of the floor below a camera.

    This is the top of the highest floor cell below the camera, in the nearest columns with a floor
    cell. If there is none nearby, the floor cells of the whole scene are used; without any, the
    result is 0. If the cell belongs to a small area on top of a larger floor, such as a rug, the
    height of the larger floor is returned.

    Args:
        voxels: Cells of the scene.
        camera_to_room: Camera pose in the room [4, 4].
    """
    eye = (camera_to_room[:3, 3] - voxels.origin_m) / voxels.voxel_m
    layers = int(np.clip(np.floor(eye[2]), 0, voxels.labels.shape[2]))
    at, reach = np.floor(eye[:2]).astype(int), int(np.ceil(AROUND_M / voxels.voxel_m))
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
    """Return the number of floor cells per layer below ``layers`` in nearby columns."""
    low, high = np.maximum(at - away, 0), np.maximum(at + away + 1, 0)
    part = voxels.labels[low[0] : high[0], low[1] : high[1], :layers]
    return np.count_nonzero(part == SemanticClass.FLOOR, axis=(0, 1))

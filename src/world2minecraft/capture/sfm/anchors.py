"""Stated poses hold photos that see too little to place themselves.

Each photo sees eight points that are not there: they lie where its stated pose would have them,
and do not move. The robust loss lets many real points that agree overrule them. On a generated
room with bare walls, refining without them moved good poses by 70 mm. They hold the lens too, so
they are for captures that see too little to tell it.
"""

from typing import Any

import numpy as np

from world2minecraft.capture.sfm.camera_groups import normalised
from world2minecraft.core.types import Camera

CORNERS = ((0.2, 0.2), (0.8, 0.2), (0.2, 0.8), (0.8, 0.8))  # Of the picture,
DEPTHS = (0.6, 1.6)  # and how far, by the middle depth: near for the place, far for the turn.
ANCHORS = 2 * len(CORNERS) * len(DEPTHS)  # Each is seen twice: COLMAP takes no point seen once.


def anchor_pixels(camera: Camera) -> np.ndarray:
    """Return where a photo sees its anchors, float64 [16, 2]."""
    corners = np.array(CORNERS) * [camera.width_px, camera.height_px]
    return np.concatenate([corners] * (ANCHORS // len(corners)))


def anchor_points(camera: Camera, pose: np.ndarray, depth: float) -> np.ndarray:
    """Return the anchors of a photo with a stated pose, float64 [8, 3], for a middle depth."""
    rays = normalised(camera, anchor_pixels(camera)[: ANCHORS // 2])
    local = np.concatenate([rays, np.ones((len(rays), 1))], axis=1)
    local *= depth * np.repeat(DEPTHS, len(CORNERS))[:, None]
    return local @ pose[:3, :3].T + pose[:3, 3]


def anchored(
    pycolmap: Any, model: Any, stated: dict[int, np.ndarray], cameras: dict[int, Camera]
) -> list[int]:
    """Add the anchors of stated poses to a model whose images end with them; return their ids."""
    inside = [i for i in sorted(stated) if model.exists_image(i + 1)]
    if not inside or not model.num_points3D():
        return []
    depth = _middle_depth(model, inside)
    added = []
    for i in inside:
        first = model.image(i + 1).num_points2D() - ANCHORS
        for n, point in enumerate(anchor_points(cameras[i], stated[i], depth)):
            track = pycolmap.Track()
            track.add_element(i + 1, first + n)
            track.add_element(i + 1, first + n + ANCHORS // 2)
            added.append(model.add_point3D(point, track, np.zeros(3, np.uint8)))
    return added


def _middle_depth(model: Any, inside: list[int]) -> float:
    points = np.array([model.point3D(n).xyz for n in sorted(model.point3D_ids())])
    depths = []
    for i in inside:
        matrix = model.image(i + 1).cam_from_world().matrix()
        seen = points @ matrix[2, :3] + matrix[2, 3]
        depths.append(seen[seen > 0])
    return float(np.median(np.concatenate(depths)))

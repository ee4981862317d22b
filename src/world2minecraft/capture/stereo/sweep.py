"""The depth of one photo by a plane sweep over its neighbours, before anything is checked."""

import numpy as np

from world2minecraft.capture.stereo.cost import sweep_costs
from world2minecraft.capture.stereo.downscaled_photos import SmallPhoto
from world2minecraft.capture.stereo.parameters import StereoParameters
from world2minecraft.capture.stereo.paths import best_planes, sum_paths
from world2minecraft.core.coordinates import invert_rigid

NEAR_SHARE, FAR_SHARE = 0.8, 1.25  # Room around the nearest and farthest sparse points.


def depth_range(photo: SmallPhoto, all_m: np.ndarray) -> tuple[float, float]:
    """Return the nearest and farthest z-depth that is tried."""
    known = photo.guide_m if len(photo.guide_m) >= 20 else all_m
    near, far = np.percentile(known, [1, 99])
    return float(near * NEAR_SHARE), float(far * FAR_SHARE)


def sweep(
    photo: SmallPhoto,
    others: list[SmallPhoto],
    depths_m: tuple[float, float],
    values: StereoParameters,
) -> np.ndarray:
    """Return float32 [h, w]: the z-depth of each pixel, between the two of ``depths_m``."""
    near_m, far_m = depths_m
    inverse = np.linspace(1 / far_m, 1 / near_m, values.planes)
    turns, shifts = _homographies(photo, others)
    costs = sweep_costs(
        photo.grey, *_stacked([other.grey for other in others]), turns, shifts,
        inverse.astype(np.float32), min(values.best_of, len(others)), values.window_px // 2,
        values.noise**2,
    )  # fmt: skip
    if values.guide_cost:
        _lean_on_points(costs, photo, inverse, values.guide_cost)
    plane = best_planes(sum_paths(costs, values.small_step, values.large_step))
    step = (inverse[-1] - inverse[0]) / (values.planes - 1)
    return (1 / (inverse[0] + plane * step)).astype(np.float32)


def _stacked(greys: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return pictures of any sizes as one array with room for all, and their sizes."""
    sizes = np.array([grey.shape for grey in greys], np.int64)
    stack = np.zeros((len(greys), *sizes.max(axis=0)), np.float32)
    for number, grey in enumerate(greys):
        stack[number, : grey.shape[0], : grey.shape[1]] = grey
    return stack, sizes


def _lean_on_points(costs, photo, inverse, guide_cost):
    """Raise the costs of planes far from a sparse point, in the pixels around it."""
    high, wide, planes = costs.shape
    at = (1 / photo.guide_m - inverse[0]) / (inverse[1] - inverse[0])
    away = np.minimum(np.abs(np.arange(planes)[None] - at[:, None]) / 2, 1) * guide_cost
    u, v = np.floor(photo.guide_px).astype(int).T
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            y, x = np.clip(v + dy, 0, high - 1), np.clip(u + dx, 0, wide - 1)
            costs[y, x] = np.minimum(costs[y, x] + away, 254).astype(np.uint8)


def _homographies(photo: SmallPhoto, others: list[SmallPhoto]):
    """Return turns float32 [N, 3, 3] and shifts float32 [N, 3]; see cost.py."""
    back = np.linalg.inv(photo.camera.matrix)
    turns, shifts = [], []
    for other in others:
        here_to_there = invert_rigid(other.camera_to_scan) @ photo.camera_to_scan
        turns.append(other.camera.matrix @ here_to_there[:3, :3] @ back)
        shifts.append(other.camera.matrix @ here_to_there[:3, 3])
    return np.array(turns, np.float32), np.array(shifts, np.float32)

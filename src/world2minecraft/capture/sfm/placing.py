"""Single photos: how far a stated pose is from what its matches say, and a new one from points."""

import numpy as np

from world2minecraft.capture.sfm.bundle import Solved
from world2minecraft.capture.sfm.camera_groups import normalised, to_colmap
from world2minecraft.capture.sfm.colmap import colmap
from world2minecraft.capture.sfm.features import Features, unit_px
from world2minecraft.capture.sfm.links import Links
from world2minecraft.capture.sfm.parameters import PosingParameters
from world2minecraft.core.types import Camera

LEAST_SEEN = 30  # Points that a pose found anew must agree with; COLMAP's own least.


def epipolar_px(
    photos: list[Features],
    links: Links,
    poses: dict[int, np.ndarray],
    cameras: dict[int, Camera],
) -> dict[int, float]:
    """Return the median distance of each photo's matches from what the poses allow, in pixels.

    It is Sampson's, so it needs no points and no gate; photos without links are not in it.
    """
    rays = {i: normalised(cameras[i], photos[i].pixels) for i in poses}
    off: dict[int, list[np.ndarray]] = {}
    for (i, j), both in links.matches.items():
        if i in poses and j in poses:
            first_to_second = np.linalg.inv(poses[j]) @ poses[i]
            focal = (cameras[i].fx_px * cameras[j].fx_px) ** 0.5
            each = focal * sampson(rays[i][both[:, 0]], rays[j][both[:, 1]], first_to_second)
            off.setdefault(i, []).append(each)
            off.setdefault(j, []).append(each)
    return {i: float(np.median(np.concatenate(each))) for i, each in sorted(off.items())}


def sampson(first: np.ndarray, second: np.ndarray, first_to_second: np.ndarray) -> np.ndarray:
    """Return how far matched rays [K, 2] (on z = 1) are from meeting, to first order, [K]."""
    x, y, z = first_to_second[:3, 3]
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    essential = cross @ first_to_second[:3, :3]
    a = np.concatenate([first, np.ones((len(first), 1))], axis=1)
    b = np.concatenate([second, np.ones((len(second), 1))], axis=1)
    lines, back = a @ essential.T, b @ essential
    steep = (lines[:, :2] ** 2).sum(axis=1) + (back[:, :2] ** 2).sum(axis=1)
    return np.abs((b * lines).sum(axis=1)) / np.sqrt(np.maximum(steep, 1e-24))


def outliers(off_px: dict[int, float], unit: float, parameters: PosingParameters) -> set[int]:
    """Return the photos whose stated poses are wrong, not merely inexact."""
    if len(off_px) < 4:
        return set()  # Of three, nobody can say which one is wrong.
    usual = float(np.median(list(off_px.values())))
    limit = max(unit * parameters.outlier_px, parameters.outlier_times * usual)
    return {i for i, off in off_px.items() if off > limit}


def placed_anew(
    photo: int,
    photos: list[Features],
    links: Links,
    found: Solved,
    camera: Camera,
    parameters: PosingParameters,
) -> np.ndarray | None:
    """Return the pose of a photo by the points that its partners see, or None if it has too few."""
    point_of = {
        (int(i), int(f)): int(p)
        for p, i, f in zip(found.track_point, found.track_photo, found.track_feature, strict=True)
    }
    pairs: set[tuple[int, int]] = set()
    for (i, j), both in links.matches.items():
        if photo in (i, j):
            mine, other = (0, 1) if photo == i else (1, 0)
            for row in both.tolist():
                point = point_of.get((j if photo == i else i, row[other]))
                if point is not None:
                    pairs.add((row[mine], point))
    if len(pairs) < LEAST_SEEN:
        return None
    rows = np.array(sorted(pairs))
    with colmap() as pycolmap:
        options = pycolmap.AbsolutePoseEstimationOptions()
        options.ransac.random_seed = parameters.seed
        options.ransac.max_error = 4.0 * unit_px(photos)
        answer = pycolmap.estimate_and_refine_absolute_pose(
            photos[photo].pixels[rows[:, 0]],
            found.points[rows[:, 1]],
            to_colmap(pycolmap, camera, 1, simple=False),
            options,
        )
    if answer is None or answer["num_inliers"] < LEAST_SEEN:
        return None
    there = np.eye(4)
    there[:3] = answer["cam_from_world"].matrix()
    return np.linalg.inv(there)

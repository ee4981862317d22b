"""Similarity of two paths: dynamic time warping and coverage, as reported in VLN papers.

Paths are float64 [N, 3] points in metres of the room, and distances between points are Euclidean.
nDTW was defined by Ilharco et al. (2019) and CLS by Jain et al. (2019).
"""

import numpy as np

from world2minecraft.core.jit import njit

THRESHOLD_M = 3.0  # The published distance threshold of both scores.


def path_length_m(points_m: np.ndarray) -> float:
    """Return the length of a path in metres.

    Example:
        >>> path_length_m(np.array([[0, 0, 0], [3, 4, 0], [3, 4, 1]], float))
        6.0
    """
    return float(np.linalg.norm(np.diff(_checked(points_m), axis=0), axis=1).sum())


def without_repeats(points_m: np.ndarray) -> np.ndarray:
    """Return a path without consecutive duplicate points, which turns on the spot produce."""
    points = _checked(points_m)
    moved = np.any(points[1:] != points[:-1], axis=1)
    return points[np.concatenate([[True], moved])]


def dtw_m(path_m: np.ndarray, reference_m: np.ndarray) -> float:
    """Return the dynamic time warping distance of two paths in metres.

    The result is exact. Points are matched in order, with the ends of the paths matched to each
    other.
    """
    return float(_dtw(_checked(path_m), _checked(reference_m)))


def ndtw(path_m: np.ndarray, reference_m: np.ndarray, threshold_m: float = THRESHOLD_M) -> float:
    """Return the normalised dynamic time warping score, 0 to 1, which is 1 for identical paths.

    The score is ``exp(-DTW / (|reference| threshold))``.

    Args:
        path_m: The walked path in metres as float64 [N, 3].
        reference_m: The dense reference path as float64 [M, 3], not just its corners.
        threshold_m: The success threshold in metres.
    """
    total = dtw_m(without_repeats(path_m), reference_m)
    return float(np.exp(-total / (len(reference_m) * threshold_m)))


def cls(path_m: np.ndarray, reference_m: np.ndarray, threshold_m: float = THRESHOLD_M) -> float:
    """Return the coverage weighted by length score (CLS), 0 to 1.

    The coverage of a reference point decays with its distance to the path. The score is reduced if
    the path is longer or shorter than the covered reference.

    Args:
        path_m: The walked path in metres as float64 [N, 3].
        reference_m: The reference path in metres as float64 [M, 3].
        threshold_m: The distance in metres over which coverage decays.
    """
    path, reference = _checked(path_m), _checked(reference_m)
    nearest = np.linalg.norm(reference[:, None] - path[None], axis=2).min(axis=1)
    coverage = float(np.exp(-nearest / threshold_m).mean())
    expected_m = coverage * path_length_m(reference)
    off_m = abs(expected_m - path_length_m(path))
    if expected_m + off_m == 0:
        return coverage
    return coverage * expected_m / (expected_m + off_m)


@njit
def _dtw(path, reference):
    count = len(reference)
    row = np.full(count + 1, np.inf)
    row[0] = 0.0
    for i in range(len(path)):
        before, row[0] = row[0], np.inf
        for j in range(count):
            x = path[i, 0] - reference[j, 0]
            y = path[i, 1] - reference[j, 1]
            z = path[i, 2] - reference[j, 2]
            least = min(before, row[j], row[j + 1])
            before = row[j + 1]
            row[j + 1] = np.sqrt(x * x + y * y + z * z) + least
    return row[count]


def _checked(points_m: np.ndarray) -> np.ndarray:
    points = np.ascontiguousarray(points_m, np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or not len(points):
        raise ValueError(
            f"a path must have shape [N, 3] with at least one point, got {points.shape}"
        )
    if not np.isfinite(points).all():
        raise ValueError("path coordinates must be finite")
    return points

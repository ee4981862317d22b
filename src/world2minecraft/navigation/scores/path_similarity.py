"""Two paths compared: dynamic time warping and coverage, as VLN papers print them.

Paths are points float64 [N, 3] in metres of the room. Distances between their points are straight
lines. nDTW is of Ilharco et al. (2019), CLS of Jain et al. (2019).
"""

import numpy as np

from world2minecraft.core.jit import njit

THRESHOLD_M = 3.0  # Of both scores, as they were published; a distance that counts as near.


def path_length_m(points_m: np.ndarray) -> float:
    """Return the length of a path, the sum of straight lines between its points.

    Example:
        >>> path_length_m(np.array([[0, 0, 0], [3, 4, 0], [3, 4, 1]], float))
        6.0
    """
    return float(np.linalg.norm(np.diff(_checked(points_m), axis=0), axis=1).sum())


def without_repeats(points_m: np.ndarray) -> np.ndarray:
    """Return a path without points that equal the one before: turns on the spot are no way."""
    points = _checked(points_m)
    moved = np.any(points[1:] != points[:-1], axis=1)
    return points[np.concatenate([[True], moved])]


def dtw_m(path_m: np.ndarray, reference_m: np.ndarray) -> float:
    """Return the least sum of distances, in metres, by which two paths are laid on each other.

    Exact: each point is matched, in order, first with first and last with last.
    """
    return float(_dtw(_checked(path_m), _checked(reference_m)))


def ndtw(path_m: np.ndarray, reference_m: np.ndarray, threshold_m: float = THRESHOLD_M) -> float:
    """Return normalised dynamic time warping, 0 to 1: 1 where the path is the reference.

    ``exp(-DTW / (|reference| threshold))``; ``reference_m`` is the dense path that was walked, not
    its corners.
    """
    total = dtw_m(without_repeats(path_m), reference_m)
    return float(np.exp(-total / (len(reference_m) * threshold_m)))


def cls(path_m: np.ndarray, reference_m: np.ndarray, threshold_m: float = THRESHOLD_M) -> float:
    """Return coverage weighted by length score, 0 to 1: how much of the reference was walked.

    Coverage of each reference point decays with its distance from the path; a path that is longer
    or shorter than the reference that it covers loses.
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
        raise ValueError(f"a path must be one point or more, [N, 3], not {points.shape}")
    if not np.isfinite(points).all():
        raise ValueError("a path must be finite")
    return points

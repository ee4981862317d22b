"""A path with the corners that matter alone: Ramer, Douglas and Peucker."""

import numpy as np

EPSILON_M = 0.25  # A move: what lies nearer to a line cannot be walked otherwise.


def corners_of(path: np.ndarray, epsilon: float = EPSILON_M) -> np.ndarray:
    """Return the indices, rising, of the points that keep a path within ``epsilon`` of itself.

    Args:
        path: float64 [N, 2], N at least 1.
        epsilon: how far a left out point may lie from the line that stays.

    Example:
        >>> corners_of(np.array([[0, 0], [1, 0.01], [2, 0], [2, 3]]), 0.25).tolist()
        [0, 2, 3]
    """
    kept = np.zeros(len(path), bool)
    kept[[0, -1]] = True
    open_spans = [(0, len(path) - 1)]
    while open_spans:
        first, last = open_spans.pop()
        if last - first < 2:
            continue
        away = _from_line(path[first + 1 : last], path[first], path[last])
        farthest = int(away.argmax())
        if away[farthest] > epsilon:
            middle = first + 1 + farthest
            kept[middle] = True
            open_spans += [(first, middle), (middle, last)]
    return np.flatnonzero(kept)


def _from_line(points: np.ndarray, begin: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Return how far points lie from the line between two others, its ends included."""
    along = end - begin
    length2 = float(along @ along)
    if length2 == 0:
        return np.linalg.norm(points - begin, axis=1)
    share = np.clip((points - begin) @ along / length2, 0, 1)
    return np.linalg.norm(points - begin - share[:, None] * along, axis=1)

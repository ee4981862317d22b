"""Where a row of slices changes, such as the front of a row of cupboards."""

import numpy as np

SEAM_PENALTY = 5.0  # What a seam costs, in squared steps summed over the slices of a row.


def change_points(values: np.ndarray, least: int) -> list[int]:
    """Return where a row changes: the cuts that leave the least squared change, less a penalty.

    The optimum is found by dynamic programming over all cuts.

    Args:
        values: What was measured of each slice, in steps that count as a change, float [N, D];
            slices with NaN say nothing.
        least: Minimum length of a part in slices.

    Returns:
        Indices of the first slices of all parts but the first, ascending.

    Example:
        >>> change_points(np.repeat([[0.0], [4.0], [0.0]], 5, axis=0), 2)
        [5, 10]
    """
    known = np.asarray(np.isfinite(values).all(axis=1))
    values = np.where(known[:, None], values, 0.0)
    total = np.vstack([np.zeros(values.shape[1]), np.cumsum(values, axis=0)])
    square = np.concatenate([[0.0], np.cumsum((values**2).sum(axis=1))])
    count = np.concatenate([[0], np.cumsum(known)])
    best = np.full(len(values) + 1, np.inf)
    best[0] = -SEAM_PENALTY
    before = np.zeros(len(values) + 1, np.int64)
    for end in range(least, len(values) + 1):
        for begin in [0, *range(least, end - least + 1)]:
            seen = max(int(count[end] - count[begin]), 1)
            spread = square[end] - square[begin]
            spread -= float(((total[end] - total[begin]) ** 2).sum()) / seen
            cost = best[begin] + SEAM_PENALTY + spread
            if cost < best[end] - 1e-9:
                best[end], before[end] = cost, begin
    cuts: list[int] = []
    at = int(before[len(values)])
    while at > 0:
        cuts.append(at)
        at = int(before[at])
    return cuts[::-1]

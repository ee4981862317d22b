"""Peaks of one-dimensional histograms: where planes lie along their normal."""

import numpy as np

BIN_M = 0.01


def highest_peak(positions_m: np.ndarray, gate_m: float) -> tuple[float, int]:
    """Return where most of the positions lie within ``gate_m`` of each other, and how many do.

    Args:
        positions_m: float [N], not empty.
        gate_m: half the width of the window.

    Returns:
        The mean of the positions in the fullest window (the lowest of a tie), and their count.
    """
    low = np.floor(positions_m.min() / BIN_M)
    bins = (positions_m / BIN_M - low).astype(np.int64)
    histogram = np.bincount(bins)
    reach = max(round(gate_m / BIN_M), 1)
    total = np.concatenate([[0], np.cumsum(histogram)])
    middle = np.arange(len(histogram))
    ends = np.minimum(middle + reach + 1, len(histogram))
    window = total[ends] - total[np.maximum(middle - reach, 0)]
    best = int(window.argmax())
    inside = np.abs(bins - best) <= reach
    return float(positions_m[inside].mean()), int(inside.sum())

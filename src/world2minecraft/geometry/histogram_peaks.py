"""Peaks of one-dimensional histograms, used to find the position of planes along their normal."""

import numpy as np

BIN_M = 0.01


def highest_peak(positions_m: np.ndarray, gate_m: float) -> tuple[float, int]:
    """Find the window of width ``2 * gate_m`` that contains the most positions.

    Args:
        positions_m: Positions in metres, float [N]; must not be empty.
        gate_m: Half the width of the window in metres.

    Returns:
        The mean position in the fullest window in metres, and the number of positions in it. The
        lowest window wins a tie.
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

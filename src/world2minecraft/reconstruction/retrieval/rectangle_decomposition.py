"""Decomposition of an object that is not a box, such as an L of counters, into runs."""

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.reconstruction.retrieval.object_evidence import AGAINST, OWN, Evidence

THIN_LAYER = 0.35  # A layer with a smaller share of the plan separates the parts below and above.
SAME_TOP = 1  # Columns whose tops differ by at most this many cells belong to one run.
COMMON_TOPS = 3  # How many of the commonest tops are tried for the next run.


def cut_into_runs(evidence: Evidence, max_runs: int, min_run_cells: int) -> list[np.ndarray]:
    """Return the cells of each run, int64 [N, 3] in the window; each own cell is in one run.

    The object is first cut by height where its plan nearly vanishes (cupboards above a counter).
    Then the largest rectangle of columns of similar height is repeatedly removed from the plan.
    Columns without free cells below that height may be included, since only the front of a tall
    cupboard is seen and a kettle hides the counter below it. The remaining cells join a touching
    run or form their own.
    """
    runs: list[np.ndarray] = []
    rest: list[np.ndarray] = []
    for bottom, top in _storeys(evidence.code == OWN):
        storey = evidence.code[:, :, bottom:top]
        found, left = _rectangles(storey, max_runs - len(runs), min_run_cells)
        lift = np.array([0, 0, bottom])
        runs += [run + lift for run in found]
        rest.append(left + lift)
    return _with_rest(runs, np.concatenate(rest))


def _with_rest(runs: list[np.ndarray], rest: np.ndarray) -> list[np.ndarray]:
    """Give what remains to the first run whose box it touches; other pieces are their own runs."""
    boxes = [(run.min(axis=0) - 1, run.max(axis=0) + 1) for run in runs]
    joined = [[run] for run in runs]
    loose = np.ones(len(rest), np.bool_)
    for box, cells in zip(boxes, joined, strict=True):
        near = loose & ((rest >= box[0]) & (rest <= box[1])).all(axis=1)
        cells.append(rest[near])
        loose &= ~near
    return [*(np.concatenate(cells) for cells in joined), *_pieces(rest[loose])]


def _pieces(cells: np.ndarray) -> list[np.ndarray]:
    if not len(cells):
        return []
    low = cells.min(axis=0)
    mask = np.zeros(np.ptp(cells, axis=0) + 1, np.bool_)
    mask[tuple((cells - low).T)] = True
    numbers, count = label_components(mask)
    return [np.argwhere(numbers == number) + low for number in range(1, count + 1)]


def _storeys(own: np.ndarray) -> list[tuple[int, int]]:
    area = own.sum(axis=(0, 1))
    layers = np.flatnonzero(area)
    bottom, end = int(layers[0]), int(layers[-1]) + 1
    cuts = [bottom]
    for k in range(bottom + 1, end - 1):
        limit = THIN_LAYER * min(area[bottom:k].max(), area[k + 1 : end].max())
        ends_thin = area[k] < limit <= area[k + 1]
        if ends_thin and k - cuts[-1] >= 2:
            cuts.append(k + 1)
    return list(zip(cuts, [*cuts[1:], end], strict=True))


def _rectangles(
    storey: np.ndarray, max_runs: int, min_run_cells: int
) -> tuple[list[np.ndarray], np.ndarray]:
    own = storey == OWN
    top = (own * np.arange(1, storey.shape[2] + 1)).max(axis=2)
    free_from = _first_free_above(storey == AGAINST, top)
    left = top > 0
    runs = []
    while len(runs) < max_runs and left.any():
        area, x0, y0, x1, y1 = max(
            _largest(
                left & (np.abs(top - height) <= SAME_TOP), (top < height) & (free_from >= height)
            )
            for height in _common(top[left])
        )
        if area < min_run_cells:
            break
        window = np.zeros_like(left)
        window[x0:x1, y0:y1] = left[x0:x1, y0:y1]
        runs.append(np.argwhere(own & window[:, :, None]))
        left &= ~window
    return runs, np.argwhere(own & left[:, :, None])


def _first_free_above(free: np.ndarray, top: np.ndarray) -> np.ndarray:
    """Return, for each column, the first layer from its top on that was seen free."""
    layers = np.arange(free.shape[2])
    above = free & (layers >= top[:, :, None])
    return np.where(above.any(axis=2), above.argmax(axis=2), free.shape[2])


def _common(tops: np.ndarray) -> list[int]:
    values, counts = np.unique(tops, return_counts=True)
    return [int(values[index]) for index in np.argsort(-counts, kind="stable")[:COMMON_TOPS]]


def _largest(mask: np.ndarray, hidden: np.ndarray) -> tuple[int, int, int, int, int]:
    """Return the seen area and the bounds of the best rectangle of a plan, bool [X, Y]."""
    area, x0, y0, x1, y1 = largest_rectangle(mask.astype(np.uint8), hidden.astype(np.uint8))
    return int(area), int(x0), int(y0), int(x1), int(y1)


@njit
def largest_rectangle(mask, hidden):  # pragma: no cover - compiled
    """Return (seen, x0, y0, x1, y1) of the rectangle within mask or hidden with most mask cells.

    For each first row, the rows below are added one by one; a column is usable while all its cells
    are in mask or hidden. The first rectangle wins a tie.
    """
    nx, ny = mask.shape
    best = (0, 0, 0, 0, 0)
    for x0 in range(nx):
        usable = np.ones(ny, np.bool_)
        seen = np.zeros(ny, np.int64)
        for x1 in range(x0, nx):
            begin, total = 0, 0
            for y in range(ny):
                usable[y] = usable[y] and (mask[x1, y] == 1 or hidden[x1, y] == 1)
                seen[y] += mask[x1, y]
                if not usable[y]:
                    begin, total = y + 1, 0
                    continue
                if total == 0:
                    begin = y if seen[y] > 0 else y + 1
                total += seen[y]
                if total > best[0]:
                    best = (total, x0, begin, x1 + 1, y + 1)
    return best

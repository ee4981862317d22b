"""What a cut leaves over: crumbs that a template's surface hides, and crumbs that belong together.

In: the cells of each crumb and of the runs that match, all of one object.
"""

import numpy as np

FEWEST = 4  # Cells; a smaller crumb is noise of the run beside it.
Box = tuple[np.ndarray, np.ndarray]


def tidied(
    crumbs: list[np.ndarray], matched: list[np.ndarray], boxes: list[Box]
) -> list[np.ndarray]:
    """Return the crumbs, int [N, 3] each, that are worth a placement of their own.

    A crumb within one cell of a placed template's box is left out where it is small: build/ sets
    what no block shows. Crumbs that touch become one, unless their common box would take in cells
    of a run that is placed.

    Args:
        crumbs: the cells of each, in the grid.
        matched: the cells of each run that has a template.
        boxes: the first cell and the one past the last of each of these templates.
    """
    kept = [one for one in crumbs if len(one) >= FEWEST and not _is_hidden(one, boxes)]
    placed = np.concatenate(matched) if matched else np.zeros((0, 3), np.int32)
    joined = True
    while joined:
        joined = False
        for m in range(len(kept)):
            for n in range(m + 1, len(kept)):
                if _belong(kept[m], kept[n], placed):
                    kept[m] = np.concatenate([kept[m], kept.pop(n)])
                    joined = True
                    break
            if joined:
                break
    return kept


def _is_hidden(cells: np.ndarray, boxes: list[Box]) -> bool:
    return any(((cells >= low - 1) & (cells <= high)).all() for low, high in boxes)


def _belong(one: np.ndarray, other: np.ndarray, placed: np.ndarray) -> bool:
    first, second = _box(one), _box(other)
    if (np.maximum(first[0], second[0]) > np.minimum(first[1], second[1])).any():
        return False
    both = np.minimum(first[0], second[0]), np.maximum(first[1], second[1])
    taken = _within(placed, first) | _within(placed, second)
    return bool((_within(placed, both) == taken).all())


def _within(cells: np.ndarray, box: Box) -> np.ndarray:
    return np.asarray(((cells >= box[0]) & (cells < box[1])).all(axis=1))


def _box(cells: np.ndarray) -> Box:
    return cells.min(axis=0), cells.max(axis=0) + 1

"""Parts of one object that stand on one another: a table's top on its post, a bed on a bed."""

import numpy as np

OVERLAP = 0.5  # The share of the smaller part's plan that must lie over or under the other.
HALF_OF_26 = [
    (dx, dy, dz)
    for dx in (-1, 0, 1)
    for dy in (-1, 0, 1)
    for dz in (-1, 0, 1)
    if (dx, dy, dz) > (0, 0, 0)
]


def join_stacked(owners: np.ndarray, labels: np.ndarray) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], with stacked parts of one class under one number.

    A thin post is too sparse to hold candidates, so density parts a top from its foot. Two parts
    of the same class that touch are one object where at least half of the smaller one's plan
    lies over or under the other.
    """
    pairs = _touching(owners, labels)
    parent = list(range(int(owners.max(initial=0)) + 1))
    plans = _plans(owners, {number for pair in pairs for number in pair})
    for first, second in pairs:
        smaller = min(len(plans[first]), len(plans[second]))
        if len(plans[first] & plans[second]) >= OVERLAP * smaller:
            a, b = sorted((_root(parent, first), _root(parent, second)))
            parent[b] = a
    roots = np.array([_root(parent, number) for number in range(len(parent))], np.int32)
    return roots[owners]


def _touching(owners: np.ndarray, labels: np.ndarray) -> list[tuple[int, int]]:
    pairs: set[tuple[int, int]] = set()
    for shift in HALF_OF_26:
        near = tuple(
            slice(max(0, -s), n - max(0, s)) for s, n in zip(shift, owners.shape, strict=True)
        )
        far = tuple(
            slice(max(0, s), n - max(0, -s)) for s, n in zip(shift, owners.shape, strict=True)
        )
        meets = (owners[near] != owners[far]) & (owners[near] > 0) & (owners[far] > 0)
        meets &= labels[near] == labels[far]
        both = np.stack([owners[near][meets], owners[far][meets]], axis=1)
        pairs |= {(int(a), int(b)) for a, b in np.unique(np.sort(both, axis=1), axis=0)}
    return sorted(pairs)


def _plans(owners: np.ndarray, numbers: set[int]) -> dict[int, set[tuple[int, int]]]:
    """Return the columns that each numbered part covers."""
    plans: dict[int, set[tuple[int, int]]] = {number: set() for number in numbers}
    cells = np.argwhere(np.isin(owners, sorted(numbers)))
    for (x, y, _), number in zip(cells.tolist(), owners[tuple(cells.T)].tolist(), strict=True):
        plans[number].add((x, y))
    return plans


def _root(parent: list[int], number: int) -> int:
    while parent[number] != number:
        number = parent[number]
    return number

"""The cells of each owner, in one pass over those of a class."""

from collections.abc import Iterator

import numpy as np


def cells_by_owner(
    owners: np.ndarray, labels: np.ndarray, class_id: int
) -> Iterator[tuple[int, np.ndarray]]:
    """Give each owner of a class and its cells, int64 [N, 3], in the order of the owners.

    Args:
        owners: int32 [X, Y, Z], 0 for none.
        labels: uint8 [X, Y, Z].
        class_id: the class.
    """
    cells = np.argwhere((labels == class_id) & (owners > 0))
    numbers = owners[tuple(cells.T)]
    order = np.argsort(numbers, kind="stable")
    found, starts = np.unique(numbers[order], return_index=True)
    yield from zip(found.tolist(), np.split(cells[order], starts[1:]), strict=False)

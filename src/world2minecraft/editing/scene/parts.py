"""Connected parts of cells, and boxes around them."""

import numpy as np

from world2minecraft.geometry.connected_components import label_components

Box = tuple[slice, slice, slice]


def box_of(cells: np.ndarray, shape: tuple[int, ...], margin: int = 0) -> tuple[np.ndarray, Box]:
    """Return the lowest corner int [3] and the slices of a box around cells int [N, 3].

    The box is grown by ``margin`` cells and cut at the grid's sides.
    """
    low = np.maximum(cells.min(axis=0) - margin, 0)
    high = np.minimum(cells.max(axis=0) + margin + 1, shape)
    x, y, z = (slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
    return low, (x, y, z)


def parts_of_cells(cells: np.ndarray, *, corners: bool = False) -> list[np.ndarray]:
    """Return the connected parts of cells int [N, 3], each as rows int [M] of it, by first cell.

    Cells are joined by faces; by edges and corners too where ``corners``.
    """
    if not len(cells):
        return []
    low, high = cells.min(axis=0), cells.max(axis=0)
    mask = np.zeros(tuple(high - low + 1), bool)
    at = tuple((cells - low).T)
    mask[at] = True
    numbers = label_components(mask, corners=corners)[0][at]
    order = np.argsort(numbers, kind="stable")
    breaks = np.flatnonzero(np.diff(numbers[order])) + 1
    return np.split(order, breaks)


def component_of(labels: np.ndarray, seed: tuple[int, int, int]) -> np.ndarray:
    """Return the cells int32 [N, 3], in C order, that hold to a cell by faces and have its label.

    ``labels`` is uint8 [X, Y, Z]; the page finds the same in the browser.
    """
    numbers = label_components(labels == labels[seed], corners=False)[0]
    return np.argwhere(numbers == numbers[seed]).astype(np.int32)


def shifted(cells: np.ndarray, axis: int, step: int) -> np.ndarray:
    """Return cells int [N, 3] moved along one axis; they may lie outside the grid then."""
    moved = cells.copy()
    moved[:, axis] += step
    return moved

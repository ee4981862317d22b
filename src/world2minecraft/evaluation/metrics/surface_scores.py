"""Comparison of two sets of cells with a tolerance.

The inputs are bool grids of the same shape and frame. The results are precision and recall within
one cell, and the share of free space that was detected as free. Counts can be summed over scenes.
"""

from dataclasses import dataclass
from typing import Literal, cast

import numpy as np
from scipy import ndimage

from world2minecraft.evaluation.metrics.occupancy import ratio

Distance = Literal["chebyshev", "euclidean"]


@dataclass(frozen=True)
class SurfaceCounts:
    """Counts of found and true cells, and of those close to a cell of the other set.

    Attributes:
        found: The number of found cells.
        found_near: The number of found cells close to a true cell.
        true: The number of true cells.
        true_near: The number of true cells close to a found cell.
    """

    found: int = 0
    found_near: int = 0
    true: int = 0
    true_near: int = 0

    def __add__(self, other: "SurfaceCounts") -> "SurfaceCounts":
        return SurfaceCounts(
            self.found + other.found,
            self.found_near + other.found_near,
            self.true + other.true,
            self.true_near + other.true_near,
        )

    @property
    def precision(self) -> float:
        """The share of found cells close to a true cell, or 1 if there are none."""
        return ratio(self.found_near, self.found) if self.found else 1.0

    @property
    def recall(self) -> float:
        """The share of true cells close to a found cell, or 1 if there are none."""
        return ratio(self.true_near, self.true) if self.true else 1.0

    @property
    def f_score(self) -> float:
        """The harmonic mean of precision and recall."""
        return ratio(2 * self.precision * self.recall, self.precision + self.recall)


def count_surface(
    found: np.ndarray,
    true: np.ndarray,
    *,
    within_cells: float = 1,
    distance: Distance = "chebyshev",
    found_mask: np.ndarray | None = None,
    true_mask: np.ndarray | None = None,
) -> SurfaceCounts:
    """Count the cells of each set that are within a distance of the other set.

    Args:
        found: The cells of the reconstruction as bool [X, Y, Z].
        true: The cells of the reference as bool [X, Y, Z].
        within_cells: The tolerance in cells. 1 means a cell and its neighbours.
        distance: "chebyshev" counts all 26 neighbours as one cell away, "euclidean" only the 6 that
            share a face.
        found_mask: The found cells to score. None scores all. The others still count as neighbours.
        true_mask: The true cells to score. None scores all. The others still count as neighbours.

    Raises:
        ValueError: If the shapes differ, or the tolerance is invalid.
    """
    found, true = np.asarray(found, bool), np.asarray(true, bool)
    if found.shape != true.shape:
        raise ValueError(
            f"found and true must have the same shape, got {found.shape} and {true.shape}"
        )
    scored_found = found if found_mask is None else found & found_mask
    scored_true = true if true_mask is None else true & true_mask
    return SurfaceCounts(
        int(scored_found.sum()),
        int((scored_found & _grown(true, within_cells, distance)).sum()),
        int(scored_true.sum()),
        int((scored_true & _grown(found, within_cells, distance)).sum()),
    )


def free_space_recall(
    free: np.ndarray, true_free: np.ndarray, mask: np.ndarray | None = None
) -> float:
    """Return the share of truly free cells that were found free, or 1 if there are none.

    Args:
        free: The cells crossed by rays (label 0, not 255) as bool [X, Y, Z].
        true_free: The truly free cells as bool [X, Y, Z].
        mask: The cells to score. None scores all.
    """
    asked = true_free if mask is None else true_free & mask
    return ratio(int((asked & free).sum()), int(asked.sum())) if asked.any() else 1.0


def _grown(cells: np.ndarray, within_cells: float, distance: Distance) -> np.ndarray:
    """Return the cells within a distance of a set, including the set itself."""
    if within_cells < 0:
        raise ValueError(f"within_cells must not be negative, got {within_cells}")
    if distance == "chebyshev":
        if within_cells != int(within_cells):
            raise ValueError(
                f"within_cells must be an integer for the chebyshev distance, got {within_cells}"
            )
        return ndimage.maximum_filter(cells, size=2 * int(within_cells) + 1, mode="constant")
    if distance != "euclidean":
        raise ValueError(f"distance must be 'chebyshev' or 'euclidean', got {distance!r}")
    if not cells.any():
        return cells
    apart = cast(np.ndarray, ndimage.distance_transform_edt(~cells))
    return apart <= within_cells + 1e-9

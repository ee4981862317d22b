"""Scores of two sets of cells with a tolerance: is each cell of one near a cell of the other?

In: bool grids of the same shape and frame. Out: precision and recall within one cell, and the
share of free space that was found free. Counts add up over scenes.
"""

from dataclasses import dataclass
from typing import Literal, cast

import numpy as np
from scipy import ndimage

from world2minecraft.evaluation.metrics.occupancy import ratio

Distance = Literal["chebyshev", "euclidean"]


@dataclass(frozen=True)
class SurfaceCounts:
    """Cells found, those of them near a true cell; true cells, those of them near a found one."""

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
        """The share of found cells that lie near a true one; 1 where nothing was found."""
        return ratio(self.found_near, self.found) if self.found else 1.0

    @property
    def recall(self) -> float:
        """The share of true cells that lie near a found one; 1 where there are none."""
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
    """Count how many cells of each set lie within some cells of the other.

    Args:
        found: bool [X, Y, Z], the cells of the reconstruction.
        true: bool [X, Y, Z], the cells of the reference.
        within_cells: the tolerance; 1 = a cell and its neighbours.
        distance: ``chebyshev`` counts the 26 neighbours as one away (the issue's "within one
            voxel"), ``euclidean`` only the 6 that share a face.
        found_mask: the found cells that count, all by default. The others still serve as
            neighbours of true cells.
        true_mask: the same for the true ones.

    Raises:
        ValueError: the shapes differ.
    """
    found, true = np.asarray(found, bool), np.asarray(true, bool)
    if found.shape != true.shape:
        raise ValueError(f"found {found.shape} and true {true.shape} must have the same shape")
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
    """Return the share of truly free cells that were found free; 1 where there are none.

    Args:
        free: bool [X, Y, Z], cells that rays crossed (label 0, not 255).
        true_free: bool [X, Y, Z].
        mask: the cells to look at, all by default.
    """
    asked = true_free if mask is None else true_free & mask
    return ratio(int((asked & free).sum()), int(asked.sum())) if asked.any() else 1.0


def _grown(cells: np.ndarray, within_cells: float, distance: Distance) -> np.ndarray:
    """Return the cells within a distance of a set, the set itself included."""
    if within_cells < 0:
        raise ValueError(f"within_cells must not be negative, not {within_cells}")
    if distance == "chebyshev":
        if within_cells != int(within_cells):
            raise ValueError(f"a chebyshev distance is a whole number, not {within_cells}")
        return ndimage.maximum_filter(cells, size=2 * int(within_cells) + 1, mode="constant")
    if distance != "euclidean":
        raise ValueError(f"distance must be chebyshev or euclidean, not {distance!r}")
    if not cells.any():
        return cells
    apart = cast(np.ndarray, ndimage.distance_transform_edt(~cells))
    return apart <= within_cells + 1e-9

"""Labels from 2D label images: each cell takes the class that most of its pixels voted for.

Where nothing voted, the geometric label stands. Votes are robust (in a trial 30 % of wrong pixels
cost 0.1 points of mIoU), so that they only need single cells put right.
"""

from dataclasses import replace

import numpy as np

from world2minecraft.classes import CLASS_COUNT
from world2minecraft.label.geometric import GeometricLabeller
from world2minecraft.label.parameters import GeometricParameters
from world2minecraft.label.smoothing import smooth_labels
from world2minecraft.types import FusedEvidence, OccupancyGrid


class VotesLabeller:
    """Argmax of the votes over classes 1 to 11, and the geometric label where there are none."""

    def __init__(self, parameters: GeometricParameters | None = None, *, small_cells: int = 3):
        self.geometric = GeometricLabeller(parameters)
        self.small_cells = small_cells  # A part with fewer cells is noise: a guess.

    def label(self, grid: OccupancyGrid, evidence: FusedEvidence) -> OccupancyGrid:
        """Return the grid with a class for each occupied cell.

        Confidence is the winner's share of the votes times the cell's probability.

        Raises:
            ValueError: grid and evidence do not lie on the same cells.
        """
        base, origin = self.geometric.traced(grid, evidence)
        occupied = np.argwhere(base.occupied)
        seen_at = origin[tuple(occupied.T)]
        votes = evidence.votes.reshape(-1, CLASS_COUNT)[seen_at].astype(np.float32)[:, 1:]
        total = votes.sum(axis=1)
        voted = total > 0
        at = tuple(occupied[voted].T)
        labels, confidence = np.array(base.labels), np.array(base.confidence, np.float32)
        labels[at] = votes[voted].argmax(axis=1) + 1
        share = votes[voted].max(axis=1) / total[voted]
        confidence[at] = share * grid.confidence.reshape(-1)[seen_at[voted]].astype(np.float32)
        labels = smooth_labels(labels, self.small_cells)
        return replace(base, labels=labels, confidence=confidence.astype(np.float16))

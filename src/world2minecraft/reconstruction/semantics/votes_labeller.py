"""A labeller for votes of pixels: each cell takes the class with the most votes.

Cells without votes take the geometric label, which also decides between divided votes. Votes come
from label images, which have errors in patches, at edges and at a distance, or from a segmentation
network, which can tell a wardrobe or a curtain from a wall.
"""

from dataclasses import replace

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, SemanticClass
from world2minecraft.core.types import FusedEvidence, OccupancyGrid
from world2minecraft.reconstruction.layout.parameters import GeometricParameters
from world2minecraft.reconstruction.semantics.geometric_labeller import GeometricLabeller
from world2minecraft.reconstruction.semantics.smoothing import smooth_labels

# Weight of the geometric label beside the shares of the votes, for structure and for objects.
# With label images, the mIoU of eight tuning scans is 0.879 without it, and 0.885, 0.889, 0.891
# and 0.887 at 0.2, 0.4, 0.6 and 1.0.
STRUCTURE_PRIOR, OBJECT_PRIOR = 0.5, 0.15
# With the votes of the segmentation network: see docs/results/recognition.md for the fit on
# real frames.
NETWORK_STRUCTURE_PRIOR, NETWORK_OBJECT_PRIOR = 0.2, 0.05
# Subtracted from the share of objects in cells of walls, so that papers and switches on a wall do
# not become blocks in front of it. With a structure prior and a penalty of 0.1 and 0.4, and of 0.2
# and 0.6, 0.77 and 0.83 of the wall surface of a real kitchen is labelled wall, and 0.76 and 0.78
# of that of a lounge; the class accuracy of NYUv2 frames, in which pictures and doors are objects,
# falls by 0.002.
ON_WALL_PENALTY = 0.6


class VotesLabeller:
    """A labeller that takes the class with the most votes, or the geometric label without votes."""

    def __init__(self, parameters: GeometricParameters | None = None, *, small_cells: int = 3):
        self.geometric = GeometricLabeller(parameters)
        self.small_cells = small_cells  # Smaller parts are taken for noise.

    def label(self, grid: OccupancyGrid, evidence: FusedEvidence) -> OccupancyGrid:
        """Return the grid with a class for each occupied cell.

        The confidence is the winner's share of the votes times the occupancy probability of the
        cell.

        Raises:
            ValueError: If grid and evidence do not have the same cells.
        """
        base, origin = self.geometric.traced(grid, evidence)
        occupied = np.argwhere(base.occupied)
        seen_at = origin[tuple(occupied.T)]
        votes = evidence.votes.reshape(-1, CLASS_COUNT)[seen_at].astype(np.float32)[:, 1:]
        total = votes.sum(axis=1)
        voted = total > 0
        at = tuple(occupied[voted].T)
        labels, confidence = np.array(base.labels), np.array(base.confidence, np.float32)
        shares = votes[voted] / total[voted][:, None]
        prior = geometric_prior(base.labels[at], votes[voted])
        kinds = (shares + prior).argmax(axis=1)
        labels[at] = kinds + 1
        share = shares[np.arange(len(kinds)), kinds]
        confidence[at] = share * grid.confidence.reshape(-1)[seen_at[voted]].astype(np.float32)
        labels = smooth_labels(labels, self.small_cells)
        return replace(base, labels=labels, confidence=confidence.astype(np.float16))


def geometric_prior(labels: np.ndarray, votes: np.ndarray) -> np.ndarray:
    """Return the amounts added to classes 1 to 11 by geometric labels, float32 [N, 11].

    Args:
        labels: Geometric label of each cell, [N].
        votes: Votes of each cell, float [N, 11].
    """
    is_structure = labels <= SemanticClass.WINDOW
    from_network = is_from_network(votes)
    weight = np.where(
        from_network,
        np.where(is_structure, NETWORK_STRUCTURE_PRIOR, NETWORK_OBJECT_PRIOR),
        np.where(is_structure, STRUCTURE_PRIOR, OBJECT_PRIOR),
    )
    prior = np.zeros((len(labels), CLASS_COUNT - 1), np.float32)
    prior[np.arange(len(labels)), labels.astype(int) - 1] = weight
    prior[from_network & (labels == SemanticClass.WALL), SemanticClass.OBJS - 1] = -ON_WALL_PENALTY
    return prior


def is_from_network(votes: np.ndarray) -> np.ndarray:
    """Return whether the votes of each cell, float [..., K], come from a network, bool [...].

    Pixels of label images vote with 1 and networks with probabilities, so votes that are not whole
    numbers come from a network.
    """
    return (votes % 1 != 0).any(axis=-1)

"""What a labeller is, and the built-in ones by name."""

from typing import Protocol

from world2minecraft.registry import Registry
from world2minecraft.types import FusedEvidence, OccupancyGrid

LABELLERS = Registry(
    "labellers",
    {
        "geometric": "world2minecraft.label.geometric:GeometricLabeller",
        "votes": "world2minecraft.label.votes:VotesLabeller",
    },
)


class Labeller(Protocol):
    """Stage 4. An implementation is made without arguments, or with its parameters."""

    def label(self, grid: OccupancyGrid, evidence: FusedEvidence) -> OccupancyGrid:
        """Return the grid with a class and a confidence for each occupied cell.

        Args:
            grid: the cleaned read-out; its occupied cells are labelled anew.
            evidence: what the grid was read from, of the same shape, origin and cell.

        Raises:
            ValueError: grid and evidence do not lie on the same cells.
        """
        ...

"""Stage 4: assign a class to each occupied cell.

A labeller gets the grid and its evidence and returns the grid with a class and a confidence for
each occupied cell. Observed cells stay occupied, except cells of floors, ceilings and walls, which
are moved to the layer that contains the matter of their plane. ``find_structure`` returns the rooms
formed by these planes. ``LABELLERS`` contains the built-in labellers; others are registered through
the entry point group ``world2minecraft.labeller``.
"""

from typing import Protocol

from world2minecraft.core.registry import Registry
from world2minecraft.core.types import FusedEvidence, OccupancyGrid
from world2minecraft.reconstruction.layout.photo_walls import complete_walls, remove_wall_guesses
from world2minecraft.reconstruction.layout.room_layouts import find_structure

__all__ = [
    "LABELLERS",
    "Labeller",
    "complete_walls",
    "find_structure",
    "labeller",
    "remove_wall_guesses",
]

_FOLDER = "world2minecraft.reconstruction.semantics"
LABELLERS = Registry(
    "labeller",
    {
        "geometric": f"{_FOLDER}.geometric_labeller:GeometricLabeller",
        "votes": f"{_FOLDER}.votes_labeller:VotesLabeller",
        "completion": f"{_FOLDER}.completion_labeller:CompletionLabeller",
    },
)


class Labeller(Protocol):
    """A labeller of stage 4, constructed without arguments or with its parameters."""

    def label(self, grid: OccupancyGrid, evidence: FusedEvidence) -> OccupancyGrid:
        """Return the grid with a class and a confidence for each occupied cell.

        Args:
            grid: Cleaned grid; existing labels of its occupied cells are replaced.
            evidence: Evidence of the grid with the same shape, origin and cell size.

        Raises:
            ValueError: If grid and evidence do not have the same cells.
        """
        ...


def labeller(name: str) -> Labeller:
    """Create a labeller by name.

    Raises:
        UnknownNameError: If no labeller has this name; the message suggests the closest match.
    """
    return LABELLERS.load(name)()

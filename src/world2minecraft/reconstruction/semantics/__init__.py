"""Stage 4: what each occupied cell is.

A labeller takes the grid and the evidence behind it and gives the grid back with a class and a
confidence for each occupied cell. Evidence wins: observed cells stay occupied, but for those of
floors, ceilings and walls, which are pulled into the one layer that holds their plane's matter.
``find_structure`` gives the rooms that these planes form. ``LABELLERS`` holds the built-in ones;
others join through the entry point group ``world2minecraft.labeller``.
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


def labeller(name: str) -> Labeller:
    """Return a new labeller by name.

    Raises:
        UnknownNameError: none has this name; the message suggests the nearest.
    """
    return LABELLERS.load(name)()

"""Importer of reconstructions by this program, with the true rooms if known.

Without a ground truth, the rooms are those found by the run, which favours it. With a ground truth,
its rooms are transformed into the frame of the run, and only the openings are those of the run.
Because furniture templates are not solid boxes, collisions are also counted between their solid
parts, so that a chair under a table does not collide.
"""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.core.errors import InputError
from world2minecraft.core.types import Layout
from world2minecraft.evaluation.scoring.object_scores import in_room
from world2minecraft.evaluation.scoring.used_frames import truth_of_run
from world2minecraft.formats.layout import read_rooms
from world2minecraft.formats.objects_and_placements import read_placements
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.furniture.layout_checks import collisions
from world2minecraft.paper.layouts.compared_scene import ComparedScene
from world2minecraft.paper.layouts.importers.value_checks import MAX_OBJECTS

if TYPE_CHECKING:
    from world2minecraft.paper.layouts.importers import How

METHOD = "World2Minecraft"


class Format:
    """The format of finished runs."""

    @staticmethod
    def is_mine(path: Path, data: Any) -> bool:
        """Return whether a folder is a finished run."""
        return path.is_dir() and (path / "placements.json").is_file()

    @staticmethod
    def read(path: Path, data: Any, how: "How") -> list[ComparedScene]:
        """Read the only scene of a run.

        Raises:
            InputError: If the folder is not a run, or has no rooms.
            ValueError: If the run has too many placements.
        """
        if not path.is_dir():
            raise InputError(path, "not the folder of a run")
        grid, scan_to_room = read_room(path / "room.npz")
        placed = read_placements(path / "placements.json")
        if len(placed) > MAX_OBJECTS:
            raise ValueError(f"{len(placed):,} placements exceed the limit of {MAX_OBJECTS:,}")
        rooms = read_rooms(path, grid)
        if how.truth is not None:
            found = tuple(opening for room in rooms for opening in room.openings)
            rooms = true_rooms(path, how.truth, scan_to_room)
            rooms = (replace(rooms[0], openings=found), *rooms[1:]) if rooms else rooms
        if not rooms:
            raise InputError(path, "the run has no rooms; run w2m reconstruct again")
        met = len(collisions(placed, grid=grid))
        return [ComparedScene(path.name, METHOD, rooms, placed, collided=met)]


FORMAT = Format()


def true_rooms(run: Path, truth: Path, scan_to_room: Any) -> tuple[Layout, ...]:
    """Return the rooms of a ground truth in the frame of a run.

    Raises:
        InputError: If the ground truth cannot be read.
    """
    known = truth_of_run(run, truth)
    return in_room(known.layouts, scan_to_room @ known.truth_to_scan)

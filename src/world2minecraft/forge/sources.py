"""What SceneForge opens: a run's folder, or any occupancy file, as a scene with objects.

==============================  ================================================================
a run's folder, its room.npz    its grid, objects and placements as they stand
any other occupancy file        objects are found and matched first, as ``w2m build`` does
==============================  ================================================================
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.edit.scene import objects_of
from world2minecraft.errors import InputError
from world2minecraft.exchange.objects import read_objects, read_placements
from world2minecraft.exchange.occupancy import read_occupancy
from world2minecraft.exchange.room import read_room
from world2minecraft.exchange.rooms import read_rooms
from world2minecraft.find import find_objects
from world2minecraft.furnish import furnish
from world2minecraft.types import Layout, OccupancyGrid, SceneObject

RUN_FILES = ("room.npz", "objects.json", "placements.json")


@dataclass(frozen=True, eq=False)
class Opened:
    """A scene as it was found. ``folder`` is where it is saved, ``inputs`` what was read."""

    name: str
    folder: Path
    inputs: tuple[Path, ...]
    grid: OccupancyGrid
    scan_to_room: np.ndarray  # float64 [4, 4]
    objects: tuple[SceneObject, ...]
    rooms: tuple[Layout, ...] = ()
    is_demo: bool = False


def read_source(source: Path) -> Opened:
    """Read a scene from where it lies; nothing is written.

    Raises:
        InputError: there is nothing, or nothing that can be read. DamagedFileError: a file is not
        what its format says. LimitError: it is too large.
    """
    if source.is_dir():
        return _read_run(source)
    if source.name == "room.npz" and (source.parent / "objects.json").is_file():
        return _read_run(source.parent)
    return _read_file(source)


def _read_run(folder: Path) -> Opened:
    if not (folder / "room.npz").is_file():
        raise InputError(folder, "is no run of w2m: room.npz is missing")
    grid, scan_to_room = read_room(folder / "room.npz")
    rooms = read_rooms(folder, grid)
    held = tuple(folder / name for name in RUN_FILES if (folder / name).is_file())
    if not (folder / "objects.json").is_file():
        grid, objects = with_objects(grid, rooms)
        return Opened(folder.name, folder, held, grid, scan_to_room, objects, rooms)
    instances = read_objects(folder / "objects.json", grid)
    has_furniture = (folder / "placements.json").is_file()
    placed = read_placements(folder / "placements.json") if has_furniture else ()
    objects = objects_of(instances, placed)
    return Opened(folder.resolve().name, folder, held, grid, scan_to_room, objects, rooms)


def _read_file(source: Path) -> Opened:
    grid = read_occupancy(source)
    scan_to_room = read_room(source)[1] if source.name == "room.npz" else np.eye(4)
    grid, objects = with_objects(grid)
    is_ours = source.name in ("room.npz", "occ.json")
    folder = source.parent if is_ours else source.parent / source.stem
    return Opened(source.name, folder, (source,), grid, scan_to_room, objects)


def with_objects(
    grid: OccupancyGrid, rooms: Sequence[Layout] = ()
) -> tuple[OccupancyGrid, tuple[SceneObject, ...]]:
    """Return a grid with the instances that are found in it, and the objects with furniture."""
    found = find_objects(grid)
    placed = furnish(found.grid, found.instances, None, rooms)
    return found.grid, objects_of(found.instances, placed)

"""Reading of the sources that SceneForge can open, as scenes with objects. Nothing is written.

==============================  ================================================================
a run folder or its room.npz    its grid, objects and placements are used unchanged
``occ.json``                    any form that ``formats/occupancy_files.py`` reads, with objects
                                from ``centers.json`` beside it, if that file exists
any other occupancy file        objects are detected and matched first, as in ``w2m build``
None                            the demo room that is part of the package
==============================  ================================================================
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from world2minecraft.core.classes import OBJECT_CLASSES
from world2minecraft.core.coordinates import apply, cell_centers_m
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.core.types import Layout, ObjectInstance, OccupancyGrid, SceneObject
from world2minecraft.core.whole_reads import read_whole
from world2minecraft.editing.scene import objects_of
from world2minecraft.formats.layout import read_rooms
from world2minecraft.formats.objects_and_placements import read_objects, read_placements
from world2minecraft.formats.occupancy_files import (
    Center,
    read_any_centers,
    read_any_occ,
    read_occupancy,
    to_room_frame,
)
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.furniture.front_estimation import (
    Surroundings,
    estimate_facing,
    read_surroundings,
)
from world2minecraft.reconstruction.instances import find_objects
from world2minecraft.reconstruction.retrieval import place_templates

MAX_CENTERS = 65535
RUN_FILES = ("room.npz", "objects.json", "placements.json")
DEMO_FOLDER = Path(__file__).parent / "demo_room"
DEMO_PICTURE = "preview.webp"
DEMO_OUT = Path("demo-room")


def instances_from_centers(
    grid: OccupancyGrid, centers: Sequence[Center]
) -> tuple[OccupancyGrid, tuple[ObjectInstance, ...]]:
    """Return the grid with instance ids, and one object for each centre of an object class.

    Each cell belongs to the nearest centre of its class. Cells of a class without a centre belong
    to no object. A centre without cells becomes an object with the size of one cell.

    Raises:
        LimitError: If there are more centres than instance ids.
    """
    wanted = [one for one in centers if one.class_id in OBJECT_CLASSES]
    if len(wanted) > MAX_CENTERS:
        raise LimitError(
            "centers", f"contains {len(wanted):,} object centres, the limit is {MAX_CENTERS:,}"
        )
    instance = np.zeros(grid.shape, np.uint16)
    around = read_surroundings(grid.labels)
    objects: list[ObjectInstance] = []
    for class_id in OBJECT_CLASSES:
        places = np.array([one.position_m for one in wanted if one.class_id == class_id])
        if not len(places):
            continue
        cells = np.argwhere(grid.labels == class_id).astype(np.int32)
        owners = _nearest(cell_centers_m(cells, grid.origin_m, grid.voxel_m), places)
        for number, place in enumerate(places):
            own = cells[owners == number]
            objects.append(_object(len(objects) + 1, class_id, place, own, grid, around))
            instance[tuple(own.T)] = len(objects)
    return replace(grid, instance=instance), tuple(objects)


def _nearest(points_m: np.ndarray, places_m: np.ndarray) -> np.ndarray:
    """Return the index of the nearest centre for each point, float64 [N, 3]."""
    found = KDTree(places_m).query(points_m)[1] if len(points_m) else []
    return np.asarray(found, np.int64)


def _object(
    number: int,
    class_id: int,
    place_m: np.ndarray,
    cells: np.ndarray,
    grid: OccupancyGrid,
    around: Surroundings,
) -> ObjectInstance:
    if not len(cells):
        side = np.full(3, grid.voxel_m)
        return ObjectInstance(number, class_id, place_m, side, 0.0, cells, 0.0)
    front = estimate_facing(cells, class_id, around)
    first, last = cells.min(axis=0), cells.max(axis=0) + 1
    size = (last - first) * grid.voxel_m
    center = grid.origin_m + (first + last) * grid.voxel_m / 2
    own_axes = size[[1, 0, 2]] if front.quarter_turns % 2 else size
    yaw = 90.0 * front.quarter_turns
    return ObjectInstance(number, class_id, center, own_axes, yaw, cells, 1.0)


@dataclass(frozen=True, eq=False)
class OpenedScene:
    """A scene as it was read from its source.

    ``folder`` is the folder to save it to. ``is_run`` says whether the existing files there may be
    overwritten. ``inputs`` are the files that were read, and ``source`` is their folder or file.
    Furniture must stay within ``rooms``.
    """

    name: str
    folder: Path
    inputs: tuple[Path, ...]
    grid: OccupancyGrid
    scan_to_room: np.ndarray  # float64 [4, 4]
    objects: tuple[SceneObject, ...]
    rooms: tuple[Layout, ...] = ()
    source: Path = Path()
    is_run: bool = False
    is_demo: bool = False


def resolve_source(source: Path | None) -> Path:
    """Return the source for a path: a run folder for its ``room.npz``, or the demo for None."""
    if source is None:
        return DEMO_OUT.absolute()
    if source.name == "room.npz" and (source.parent / "objects.json").is_file():
        return source.absolute().parent
    return source.absolute()


def read_source(source: Path | None, out: Path | None = None) -> OpenedScene:
    """Read a scene from its source.

    Args:
        source: A run folder or an occupancy file. None reads the demo room.
        out: Folder to save the scene to. None saves beside the source.

    Raises:
        InputError: If the source does not exist or cannot be read.
        DamagedFileError: If a file is not valid in its format.
        LimitError: If the scene is too large.
    """
    place = resolve_source(source)
    if source is None:
        opened = replace(
            _read_run(DEMO_FOLDER),
            name="Demo room", folder=place, inputs=(), is_run=False, is_demo=True,
        )  # fmt: skip
    elif place.is_dir():
        opened = _read_run(place)
    elif place.suffix == ".json":
        opened = _read_paper(place)
    else:
        opened = _read_file(place)
    return opened if out is None else replace(opened, folder=out.absolute(), is_run=False)


def demo_room(folder: Path | None = None) -> OpenedScene:
    """Return the demo room, which ``save`` would write to ``folder``.

    It is a living room as reconstructed by ``w2m demo``, with the floaters, holes and doubtful
    objects of a real run. ``python tools/make_demo_room.py`` regenerates its files.
    """
    return read_source(None, folder)


def read_source_rooms(source: Path, grid: OccupancyGrid) -> tuple[Layout, ...]:
    """Return the rooms that furniture must stay within, or none if the source has no rooms."""
    try:
        return read_rooms(source, grid) if source.is_dir() else ()
    except InputError:
        return ()


def _read_run(folder: Path) -> OpenedScene:
    return read_whole(folder, lambda: _read_run_files(folder))


def _read_run_files(folder: Path) -> OpenedScene:
    if not (folder / "room.npz").is_file():
        raise InputError(folder, "room.npz not found; create a run with w2m reconstruct")
    grid, scan_to_room = read_room(folder / "room.npz")
    if to_room_frame(grid)[0] is not grid:
        return _read_file(folder / "room.npz")  # The other files do not lie at its coordinates.
    rooms = read_source_rooms(folder, grid)
    inputs = tuple(folder / name for name in RUN_FILES if (folder / name).is_file())
    if (folder / "objects.json").is_file():
        instances = read_objects(folder / "objects.json", grid)
        is_furnished = (folder / "placements.json").is_file()
        placed = read_placements(folder / "placements.json") if is_furnished else ()
        try:
            objects = objects_of(instances, placed)
        except ValueError as error:
            raise DamagedFileError(
                folder / "placements.json", f"does not match objects.json: {error}"
            ) from error
    else:
        grid, objects = detect_objects(grid, rooms)
    fields = (folder.name, folder, inputs, grid, scan_to_room, objects, rooms)
    return OpenedScene(*fields, source=folder, is_run=True)


def _read_file(source: Path) -> OpenedScene:
    grid, grid_to_room = to_room_frame(read_occupancy(source))
    stored = read_room(source)[1] if source.name == "room.npz" else np.eye(4)
    scan_to_room = grid_to_room @ stored
    grid, objects = detect_objects(grid)
    is_run = source.name == "room.npz"
    folder = source.parent if is_run else source.parent / source.stem
    fields = (source.name, folder, (source,), grid, scan_to_room, objects)
    return OpenedScene(*fields, source=source, is_run=is_run)


def _read_paper(source: Path) -> OpenedScene:
    grid, unit = read_any_occ(source)
    beside = source.with_name(source.name.replace("occ", "centers"))
    inputs, centers = (source,), None
    if beside != source and beside.is_file():
        centers, inputs = read_any_centers(beside, grid, unit), (source, beside)
    grid, grid_to_room = to_room_frame(grid)
    if centers is not None:
        centers = [one._replace(position_m=apply(grid_to_room, one.position_m)) for one in centers]
    grid, objects = detect_objects(grid, (), centers)
    is_run = source.name == "occ.json" and not (source.parent / "room.npz").exists()
    folder = source.parent if is_run else source.parent / source.stem
    fields = (source.name, folder, inputs, grid, grid_to_room, objects)
    return OpenedScene(*fields, source=source, is_run=is_run)


def detect_objects(
    grid: OccupancyGrid,
    rooms: Sequence[Layout] = (),
    centers: Sequence[Center] | None = None,
) -> tuple[OccupancyGrid, tuple[SceneObject, ...]]:
    """Return a grid with instance ids, and its objects with their matched furniture.

    Args:
        grid: The occupancy.
        rooms: Rooms that the furniture must stay within.
        centers: Object centres. None detects the objects.
    """
    instances: tuple[ObjectInstance, ...]
    if centers is None:
        found = find_objects(grid)
        grid, instances = found.grid, found.instances
    else:
        grid, instances = instances_from_centers(grid, centers)
    return grid, objects_of(instances, place_templates(grid, instances, None, rooms))

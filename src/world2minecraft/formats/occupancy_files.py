"""Occupancy files of this program, the paper and other programs, and plain label arrays.

===================  ==========================================================================
``room.npz``         all arrays of OccupancyGrid
``*.npz``            ``labels`` uint8 [X, Y, Z]; optional ``voxel_m`` (0.08) and ``origin_m`` (0)
``*.npy``            the labels alone
``*.json``           ``occ.json``
===================  ==========================================================================

The paper prints no schema for ``occ.json`` and ``centers.json``, so ``read_any_occ`` and
``read_any_centers`` accept several. The voxels are the top-level value, or the first list under a
name in ``_HOLDERS``, in one of these forms:

- ``[[x, y, z, class], ...]``; ``[{"x", "y", "z", "class"}, ...]``; ``[{"position": [x, y, z],
  "class"}, ...]``; two lists of equal length with positions and classes;
- a list of positions per class: ``{"chair": [[x, y, z], ...], ...}`` or ``{"5": ...}``;
- a class for each cell: ``[[[...]]]``, indexed by x, y and z.

Classes are ids 0 to 11 or 255, or names. Positions are cell indices if all are integers, and
otherwise cell centres in metres. Further keys are ``voxel_m``, ``origin_m`` and ``shape`` or their
synonyms. The default cell size is 0.08 m (for metres, the smallest step between positions), and
the default shape is the smallest that contains all voxels.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, UNKNOWN, SemanticClass
from world2minecraft.core.errors import (
    MALFORMED,
    DamagedFileError,
    InputError,
    LimitError,
    UsageError,
)
from world2minecraft.core.files import npz_array_names, read_json, read_npy, read_npz
from world2minecraft.core.types import OBSERVED, UNSEEN, OccupancyGrid
from world2minecraft.formats.class_ids import EMBODIED_EMPTY, read_class_set
from world2minecraft.formats.paper_json import MAX_CELLS, read_occ_json
from world2minecraft.formats.run_arrays import GRID_ARRAYS, read_room

DEFAULT_VOXEL_M = 0.08  # The paper's.
MAX_ROOM_M = 1000.0  # Coordinates beyond are of a map, not of a room.
MAX_FLOOR_M = 3.0  # A floor farther from z = 0 has another height datum, or is another storey.
CELLS, METRES = "cells", "metres"
_HOLDERS = (
    "voxels", "occupancy", "occ", "centers", "centres", "center_points", "cells", "points",
    "grid", "data", "objects", "instances",
)  # fmt: skip
_PLACES = (
    "position_m", "center_m", "position", "center", "centre", "coords", "coord", "coordinates",
    "positions", "location", "point", "xyz", "indices", "index", "points",
)  # fmt: skip
_CLASSES = (
    "class_id", "class", "label", "category", "category_id", "semantic", "type", "cls",
    "labels", "classes", "categories", "value", "name",
)  # fmt: skip
_SIDES = ("voxel_m", "voxel_size", "voxelSize", "resolution", "voxel", "cell_size")
_ORIGINS = ("origin_m", "origin", "min_bound", "offset", "min")
_SHAPES = ("shape", "dims", "dimensions", "grid_size", "gridSize", "size")
_OTHER_NAMES = {"furniture": 10, "objects": 11, "object": 11, "tv": 9, "none": 0, "free": 0}


def read_occupancy(path: str | Path, classes: str = "") -> OccupancyGrid:
    """Read an occupancy grid from a file in any supported format.

    The format is detected from the suffix and the contents of the file.

    Args:
        path: Path of the file.
        classes: Class set of the labels of a ``.npy`` or ``.npz`` file, such as ``embodied``. The
            default is ``nyu12``, whose ids are those of this program. ``auto`` selects
            ``embodied`` if the largest id is 12, which only that set has.

    Raises:
        UnknownNameError: If the class set is unknown.
        InputError: If the file does not exist or is not an occupancy file.
        DamagedFileError: If the file is not valid in its format.
        LimitError: If the grid is too large.
    """
    source = Path(path)
    if not source.is_file():
        raise InputError(
            source, "not found; give a room.npz, an occ.json, or labels as .npz or .npy"
        )
    if source.suffix == ".json":
        if classes not in ("", "auto", "nyu12", "occscannet"):
            raise UsageError(f"classes is for .npy and .npz files; {source} names its classes")
        return read_occ_json(source)
    if source.suffix == ".npy":
        return labels_grid(_classes_of(read_npy(source), classes, source), source)
    if source.suffix != ".npz":
        raise InputError(
            source, "is not an occupancy file; expected the suffix .npz, .npy or .json"
        )
    held = npz_array_names(source)
    if set(GRID_ARRAYS) <= set(held) and classes in ("", "auto"):
        return read_room(source)[0]
    wanted = ("labels", *(name for name in ("voxel_m", "origin_m") if name in held))
    arrays = read_npz(source, wanted)
    labels = _classes_of(arrays["labels"], classes, source)
    try:
        voxel_m = float(arrays.get("voxel_m", DEFAULT_VOXEL_M))
        origin_m = np.asarray(arrays.get("origin_m", np.zeros(3)), np.float64)
    except MALFORMED as error:
        raise DamagedFileError(
            source, f"contains an invalid voxel_m or origin_m ({error})"
        ) from error
    return labels_grid(labels, source, voxel_m, origin_m)


def _classes_of(ids: np.ndarray, classes: str, source: Path) -> np.ndarray:
    """Return the classes of ids in a class set, or in the set that has them for ``auto``.

    Without a class set, ids up to 12 are refused with the option that reads them, and others are
    returned unchanged.
    """
    if classes in ("", "auto"):
        known = ids[ids != UNKNOWN] if ids.dtype.kind in "iuf" else ids[:0]
        if not known.size or known.max() != EMBODIED_EMPTY:
            return ids
        classes = "embodied" if classes == "auto" else "nyu12"
    return read_class_set(classes).convert(ids, source)


def labels_grid(
    labels: np.ndarray,
    source: str | Path = "labels",
    voxel_m: float = DEFAULT_VOXEL_M,
    origin_m: np.ndarray | None = None,
) -> OccupancyGrid:
    """Return a grid with the given labels, full confidence and no colour.

    Raises:
        DamagedFileError: If the labels are not an [X, Y, Z] array of class ids.
    """
    try:
        whole = labels.astype(np.uint8)
        if not np.array_equal(whole, labels):
            raise ValueError("labels must be integers, 0 to 11 or 255")
        known = whole != 255
        return OccupancyGrid(
            labels=whole,
            confidence=known.astype(np.float16),
            colour=np.zeros((*whole.shape, 3), np.uint8),
            source=np.where(known, OBSERVED, UNSEEN).astype(np.uint8),
            instance=np.zeros(whole.shape, np.uint16),
            voxel_m=voxel_m,
            origin_m=np.zeros(3) if origin_m is None else origin_m,
        )
    except MALFORMED as error:
        raise DamagedFileError(
            source, f"does not contain a valid grid of class ids ({error})"
        ) from error


def to_room_frame(grid: OccupancyGrid) -> tuple[OccupancyGrid, np.ndarray]:
    """Move a georeferenced grid into the room frame, and return it with ``grid_to_room``.

    In the room frame, the top of the floor is z = 0. A grid that lies more than ``MAX_ROOM_M`` away
    or whose lowest floor is more than ``MAX_FLOOR_M`` above or below z = 0 is moved by whole cells:
    its corner to x = y = 0 and the top of its floor to z = 0. Other grids are returned unchanged,
    with the identity as float64 [4, 4].
    """
    floor_m = _floor_cells(grid) * grid.voxel_m
    is_near = np.abs(grid.origin_m[:2]).max() <= MAX_ROOM_M
    if is_near and abs(grid.origin_m[2] + floor_m) <= MAX_FLOOR_M:
        return grid, np.eye(4)
    origin_m = np.array([0.0, 0.0, -floor_m])
    grid_to_room = np.eye(4)
    grid_to_room[:3, 3] = origin_m - grid.origin_m
    return replace(grid, origin_m=origin_m), grid_to_room


def _floor_cells(grid: OccupancyGrid) -> int:
    """Return the number of layers up to the top of the lowest floor, or below all that is held."""
    counts = np.equal(grid.labels, SemanticClass.FLOOR).sum(axis=(0, 1))
    if counts.any():
        return int((counts >= 0.5 * counts.max()).argmax()) + 1
    return int(grid.occupied.any(axis=(0, 1)).argmax())


def inner_corner_m(grid: OccupancyGrid) -> np.ndarray:
    """Return the corner (x_min, y_max) of the room's inner box in whole cells, float64 [2].

    The corner is on the inner faces of the outermost wall layers, or at the outermost occupied
    cells if there are no walls.
    """
    walls = np.equal(grid.labels, SemanticClass.WALL)
    occupied = grid.occupied
    x_cell = _inner_cell(walls.sum(axis=(1, 2)), np.asarray(occupied.any(axis=(1, 2))))
    y_cell = _inner_cell(walls.sum(axis=(0, 2))[::-1], np.asarray(occupied.any(axis=(0, 2)))[::-1])
    cells = np.array([x_cell, grid.shape[1] - y_cell])
    return np.round(grid.origin_m[:2] / grid.voxel_m + cells) * grid.voxel_m


def _inner_cell(wall_counts: np.ndarray, occupied: np.ndarray) -> int:
    """Return the first cell after the outermost large wall layer, or the first occupied cell."""
    half = len(wall_counts) // 2
    layers = np.flatnonzero(wall_counts[: half + 1] >= 0.5 * max(wall_counts.max(), 1))
    if len(layers):
        return int(layers[0]) + 1
    return int(occupied.argmax())


class Center(NamedTuple):
    """The centre of an object in the room frame in metres, float64 [3], and its class."""

    position_m: np.ndarray
    class_id: int


def read_any_occ(path: str | Path) -> tuple[OccupancyGrid, str]:
    """Read an occupancy grid, and return it with its position unit, ``cells`` or ``metres``.

    Raises:
        DamagedFileError: If the file contains voxels in none of the supported forms.
        LimitError: If the grid has too many cells.
    """
    value = read_json(path)
    if isinstance(value, dict) and value.get("format") == "world2minecraft/occ":
        return read_occ_json(path), CELLS
    keys = value if isinstance(value, dict) else {}
    try:
        held = _voxel_list(value)
        if (labels := _dense_labels(held)) is not None:
            unit, origin = CELLS, _first_of(keys, _ORIGINS, [0.0] * 3)
            voxel_m = float(_first_of(keys, _SIDES, DEFAULT_VOXEL_M))
        else:
            points, classes = _points(held)
            unit = CELLS if np.array_equal(points, np.round(points)) else METRES
            voxel_m = float(
                _first_of(
                    keys, _SIDES, _smallest_step(points) if unit == METRES else DEFAULT_VOXEL_M
                )
            )
            cells, origin = _cells(points, unit, voxel_m, _first_of(keys, _ORIGINS, None))
            labels = _fill_grid(path, cells, classes, _first_of(keys, _SHAPES, None))
        low = np.array(origin, np.float64)
        return labels_grid(labels, path, voxel_m, np.round(low / voxel_m) * voxel_m), unit
    except (*MALFORMED, RecursionError) as error:
        raise DamagedFileError(
            path, f"does not contain voxels in a supported form ({error})"
        ) from error


def read_any_centers(path: str | Path, grid: OccupancyGrid, unit: str) -> tuple[Center, ...]:
    """Read the centres of objects.

    Args:
        path: Path of ``centers.json``.
        grid: Occupancy grid of the objects.
        unit: Unit of ``occ.json``, ``cells`` or ``metres``. Centres are in the same unit, except
            under keys that end with ``_m``.

    Raises:
        DamagedFileError: If the file contains centres in none of the supported forms.
    """
    value = read_json(path)
    try:
        held = _voxel_list(value)
        rows = held if isinstance(held, list) else []
        in_metres = unit == METRES or _has_any_key(rows, ("position_m", "center_m"))
        points, classes = _points(held)
        if not in_metres:
            points = grid.origin_m + (points + 0.5) * grid.voxel_m
        return tuple(map(Center, points, map(int, classes)))
    except (*MALFORMED, RecursionError) as error:
        raise DamagedFileError(
            path, f"does not contain centres in a supported form ({error})"
        ) from error


def _voxel_list(value: Any) -> Any:
    """Return the value that contains the voxels: the value itself, or a part under a known name."""
    for name in _HOLDERS:
        if isinstance(value, dict) and isinstance(value.get(name), list | dict):
            names = (*_CLASSES, *_PLACES)
            has_twin = any(isinstance(value.get(other), list) for other in names if other != name)
            if name in _PLACES and has_twin and _has_class_list(value, name):
                return value
            return _voxel_list(value[name]) if isinstance(value[name], dict) else value[name]
    return value


def _has_class_list(value: Mapping[str, Any], name: str) -> bool:
    """Return whether a list of positions has its classes in a second list."""
    return any(
        isinstance(value.get(other), list) and len(value[other]) == len(value[name])
        for other in _CLASSES
    )


def _dense_labels(held: Any) -> np.ndarray | None:
    """Return labels [X, Y, Z] if there is a class for each cell, else None."""
    try:
        is_deep = isinstance(held, list) and isinstance(held[0][0], list)
    except (IndexError, KeyError, TypeError):
        return None
    if not is_deep:
        return None
    labels = np.array(held)
    if labels.ndim != 3:
        raise ValueError("the rows have different lengths")
    return labels


def _points(held: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return positions float64 [N, 3] and classes int [N]."""
    pairs = list(_pairs(held))
    points = np.array([place for place, _ in pairs], np.float64).reshape(-1, 3)
    if not np.isfinite(points).all():
        raise ValueError("a position is not a number")
    return points, np.array([_class(name) for _, name in pairs], np.int64)


def _pairs(held: Any) -> Iterator[tuple[Iterable[float], Any]]:
    if isinstance(held, dict):
        places, classes = _first_of(held, _PLACES, None), _first_of(held, _CLASSES, None)
        if isinstance(places, list) and isinstance(classes, list):
            if len(places) != len(classes):
                raise ValueError(f"got {len(places)} positions but {len(classes)} classes")
            yield from zip(places, classes, strict=True)
            return
        for name, places in held.items():
            if not isinstance(places, list):
                continue
            for row in places:
                yield _place(row), name
        return
    if not isinstance(held, list):
        raise ValueError("expected a list of positions")
    for row in held:
        if isinstance(row, list) and len(row) < 4:
            raise ValueError(f"expected x, y, z and a class, got {row}")
        yield _place(row), row[3] if isinstance(row, list) else _first_of(row, _CLASSES, None)


def _place(row: Any) -> list[float]:
    if isinstance(row, list):
        return [float(value) for value in row[:3]]
    if "x" in row:
        return [float(row[axis]) for axis in "xyz"]
    place = _first_of(row, _PLACES, None)
    return [float(place[axis]) for axis in "xyz"] if isinstance(place, dict) else place[:3]


def _class(name: Any) -> int:
    """Return the class id of a number, a number in a text, or a name."""
    word = str(name).strip().lower()
    if word in CLASS_NAMES:
        return CLASS_NAMES.index(word)
    try:
        number = float(_OTHER_NAMES.get(word, word))
    except ValueError:
        number = -1.0
    if not (number in range(12) or number == 255):
        raise ValueError(f"{name!r} is not a class; expected 0 to 11, 255 or a class name")
    return int(number)


def _first_of(row: Mapping[str, Any], names: Iterable[str], default: Any) -> Any:
    """Return the value of the first of several keys in a row."""
    return next((row[name] for name in names if name in row), default)


def _has_any_key(rows: Iterable[Any], names: Iterable[str]) -> bool:
    return any(name in row for row in rows if isinstance(row, dict) for name in names)


def _smallest_step(points: np.ndarray) -> float:
    """Return the smallest step between positions, which is the cell size."""
    steps = [np.diff(np.unique(np.round(axis, 4))) for axis in points.T]
    found = [float(step.min()) for step in steps if len(step)]
    return round(min(found), 4) if found else DEFAULT_VOXEL_M


def _cells(
    points: np.ndarray, unit: str, voxel_m: float, origin: Any
) -> tuple[np.ndarray, np.ndarray]:
    """Return the cells int64 [N, 3] of positions, starting at 0, and the origin in metres."""
    if not (math.isfinite(voxel_m) and voxel_m > 0):
        raise ValueError(f"the cell size must be above 0, got {voxel_m}")
    first = points.min(axis=0) if len(points) else np.zeros(3)
    if unit == CELLS:
        shift = np.minimum(first, 0)
        low = np.zeros(3) if origin is None else np.array(origin, np.float64)
        return (points - shift).astype(np.int64), low + shift * voxel_m
    low = first - voxel_m / 2 if origin is None else np.array(origin, np.float64)
    return np.floor((points - low) / voxel_m + 1e-6).astype(np.int64), low


def _fill_grid(path: str | Path, cells: np.ndarray, classes: np.ndarray, shape: Any) -> np.ndarray:
    if not len(cells) and shape is None:
        raise ValueError("neither voxels nor a shape found")
    least = cells.max(axis=0) + 1 if len(cells) else np.ones(3, np.int64)
    sides = least if shape is None else np.maximum(np.array(shape, np.int64).reshape(3), least)
    if (cells < 0).any():
        raise ValueError("a voxel has coordinates below the origin")
    if np.prod(sides.astype(np.float64)) > MAX_CELLS:
        raise LimitError(
            path, f"requires a grid of {sides.tolist()}; the limit is {MAX_CELLS:,} cells"
        )
    labels = np.zeros(tuple(sides), np.uint8)
    labels[tuple(cells.T)] = classes
    return labels

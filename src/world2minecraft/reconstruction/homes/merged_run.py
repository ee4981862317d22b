"""Merge runs in a common frame: one grid, one list of objects, and open doors between rooms.

Space belongs to the run whose room contains it; observations by other runs through doors are
discarded. In walls, the observations of all runs are kept.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OBSERVED, Layout, ObjectInstance, OccupancyGrid, Placement
from world2minecraft.furniture.layout_checks import inside_polygon
from world2minecraft.reconstruction.homes.doors import Doorway, head_of, shift_door
from world2minecraft.reconstruction.homes.moved_run import Move, Run, move_run
from world2minecraft.reconstruction.homes.room_placement import Placed

MAX_CELLS = 600_000_000
MAX_OBJECTS = 65535
KEPT_SHARE = 0.5  # Minimum share of an object's cells in its room; others were seen through a door.
FREE_SHARE = 0.5
BACK_CELLS = 2  # Maximum distance of a door leaf behind the face of its wall.
WALL = int(SemanticClass.WALL)
ROOM_CLASSES = (WALL, int(SemanticClass.WINDOW), int(SemanticClass.OBJS))


@dataclass(frozen=True, eq=False)
class Home:
    """A joined run, the size of its bounding box in metres, and notes for the report."""

    run: Run
    size_m: np.ndarray
    lines: tuple[str, ...]


def merge_runs(placed: Placed, name: str = "") -> Home:
    """Merge runs in a common frame into one run, with its corner at the origin.

    Args:
        placed: Runs from ``place_runs``.
        name: Name of the merged run.

    Raises:
        UsageError: If the merged run is too large.
    """
    runs: Sequence[Run] = placed.runs
    low = np.min([layout.floor_polygon_m.min(axis=0) for r in runs for layout in r.layouts], axis=0)
    voxel_m = runs[0].grid.voxel_m
    base = min(layout.floor_z_m for run in runs for layout in run.layouts)
    corner = [-int(np.floor(value / voxel_m + 1e-6)) for value in low]
    shift = Move(0, (corner[0], corner[1], -round(base / voxel_m)))
    runs = [move_run(run, shift) for run in runs]
    cells, offsets = _one_grid(runs)
    away = np.array(shift.cells) * voxel_m
    for pair in placed.doors:
        _open(cells, *(shift_door(door, away, 0) for door in pair))
    instances, placements, dropped = _objects(runs, cells.arrays["instance"], offsets)
    layouts = tuple(
        replace(layout, name=_room_name(run, layout.name)) for run in runs for layout in run.layouts
    )
    high = np.max([layout.floor_polygon_m.max(axis=0) for layout in layouts], axis=0)
    top = max(layout.floor_z_m + layout.wall_height_m for layout in layouts)
    count = len(placed.doors)
    lines = [f"{count} door{'s' * (count != 1)} between the rooms left open"]
    if dropped:
        lines.append(
            f"{dropped} objects seen through doors dropped, since the next room contains them"
        )
    run = Run(name, cells.grid(instances), instances, placements, layouts)
    return Home(run, np.round(np.array([*high, top]), 6), tuple(lines))


def _room_name(run: Run, name: str) -> str:
    return f"{run.name}: {name}" if name else run.name


@dataclass(frozen=True, eq=False)
class _Cells:
    """The arrays of a grid under construction by name, and the index of their first cell."""

    arrays: dict[str, np.ndarray]
    first: np.ndarray
    voxel_m: float

    def slice_of(self, axis: int, low_m: float, high_m: float, more: int = 0) -> slice:
        """Return the cells between two positions along an axis, with a margin on both sides."""
        low, high = (
            round(value / self.voxel_m) - int(self.first[axis]) for value in (low_m, high_m)
        )
        return slice(max(low - more, 0), max(high + more, low + 1, 1))

    def grid(self, instances: Sequence[ObjectInstance]) -> OccupancyGrid:
        """Return the grid; cells of dropped objects belong to no object."""
        known = np.zeros(MAX_OBJECTS + 1, bool)
        known[[one.id for one in instances]] = True
        instance = self.arrays["instance"]
        instance[~known[instance]] = 0
        origin = np.round(self.first * self.voxel_m, 9)
        return OccupancyGrid(**self.arrays, voxel_m=self.voxel_m, origin_m=origin)


def _one_grid(runs: Sequence[Run]) -> tuple[_Cells, list[int]]:
    """Return the merged cells of all runs, and the offset of each run's ids."""
    voxel_m = runs[0].grid.voxel_m
    firsts = [np.rint(run.grid.origin_m / voxel_m).astype(int) for run in runs]
    ends = [first + run.grid.shape for first, run in zip(firsts, runs, strict=True)]
    first = np.min(firsts, axis=0)
    shape = tuple((np.max(ends, axis=0) - first).tolist())
    if np.prod(shape, dtype=np.float64) > MAX_CELLS:
        extent = " x ".join(f"{side * voxel_m:.0f}" for side in shape)
        raise UsageError(
            f"the joined rooms span {extent} m, too large for one grid; join fewer rooms or set "
            "their positions (--at)"
        )
    offsets = np.cumsum([0, *(_most_id(run) for run in runs)]).tolist()
    if offsets[-1] > MAX_OBJECTS:
        raise UsageError(f"the joined rooms contain over {MAX_OBJECTS:,} objects; join fewer rooms")
    owner = _owners(runs, first, shape, voxel_m)
    arrays = {
        "labels": np.full(shape, UNKNOWN, np.uint8),
        "confidence": np.zeros(shape, np.float16),
        "colour": np.zeros((*shape, 3), np.uint8),
        "source": np.zeros(shape, np.uint8),
        "instance": np.zeros(shape, np.uint16),
    }
    for number, run in enumerate(runs):
        low = firsts[number] - first
        view = tuple(slice(a, a + n) for a, n in zip(low, run.grid.shape, strict=True))
        held, grid = arrays["labels"][view], run.grid
        own = owner[view[:3]] == number
        nobodys = owner[view[:3]] < 0
        known = grid.labels != UNKNOWN
        solid = known & (grid.labels > 0)
        # In walls the first scan counts, but surface counts more than air.
        better = (held == UNKNOWN) | (solid & (held == 0))
        take = known & (own | (nobodys & better))
        for name, array in arrays.items():
            values = getattr(grid, name)
            if name == "instance":
                values = np.where(values > 0, values + np.uint16(offsets[number]), values)
            array[view][take] = values[take]
    return _Cells(arrays, first, voxel_m), offsets


def _most_id(run: Run) -> int:
    return max([int(run.grid.instance.max(initial=0)), *(one.id for one in run.instances)])


def _owners(runs: Sequence[Run], first: np.ndarray, shape: tuple, voxel_m: float) -> np.ndarray:
    """Return the run whose room contains each cell, int16 [X, Y, Z]; -1 in walls and outside.

    If rooms of two runs overlap, because one scan looked far through a door, the run that knows
    more of the cells there owns them.
    """
    owner = np.full(shape, -1, np.int16)
    for number, run in enumerate(runs):
        for layout in run.layouts:
            columns = _columns(layout, first, shape, voxel_m)
            low = round(layout.floor_z_m / voxel_m) - int(first[2]) - 1
            high = int(np.ceil((layout.floor_z_m + layout.wall_height_m) / voxel_m)) - int(first[2])
            layers = slice(max(low, 0), max(high + 1, 0))
            part = owner[:, :, layers]
            mine = np.broadcast_to(columns[:, :, None], part.shape)
            for other in range(number):
                both = mine & (part == other)
                counts = [_known_in(runs[n], both, layers, first) for n in (number, other)]
                if counts[0] <= counts[1]:
                    mine = mine & ~both
            part[mine] = number
    return owner


def _columns(layout: Layout, first: np.ndarray, shape: tuple, voxel_m: float) -> np.ndarray:
    """Return the columns whose centre is inside a room's outline, bool [X, Y]."""
    columns = np.zeros(shape[:2], bool)
    polygon = layout.floor_polygon_m
    spans = []
    for axis in (0, 1):
        at = (first[axis] + np.arange(shape[axis]) + 0.5) * voxel_m
        spans.append(np.flatnonzero((at > polygon[:, axis].min()) & (at < polygon[:, axis].max())))
    if all(len(span) for span in spans):
        i, j = np.meshgrid(*spans, indexing="ij")
        points = (np.stack([i, j], axis=-1).reshape(-1, 2) + first[:2] + 0.5) * voxel_m
        columns[i, j] = inside_polygon(points, polygon, 0.0).reshape(i.shape)
    return columns


def _known_in(run: Run, mask: np.ndarray, layers: slice, first: np.ndarray) -> int:
    """Return the number of cells of a mask, [X, Y, layers] of the whole, that a run knows."""
    cells = np.argwhere(mask) + np.array([0, 0, layers.start]) + first
    cells -= np.rint(run.grid.origin_m / run.grid.voxel_m).astype(int)
    cells = cells[((cells >= 0) & (cells < run.grid.shape)).all(axis=1)]
    return int((run.grid.labels[tuple(cells.T)] != UNKNOWN).sum())


def _open(cells: _Cells, mine: Doorway, theirs: Doorway) -> None:
    """Open the wall between two doors that meet, and add a floor in the opening, in place."""
    across = mine.outward % 2  # The axis of the way through.
    along = 1 - across
    width = min(mine.width_m, theirs.width_m)
    middle = (mine.middle_m[along] + theirs.middle_m[along]) / 2
    floor_m = max(mine.floor_z_m, theirs.floor_z_m)
    head_m = floor_m + head_of(mine, theirs)
    ends = sorted((mine.middle_m[across], theirs.middle_m[across]))
    spans: list[slice] = [slice(0)] * 2
    spans[along] = cells.slice_of(along, middle - width / 2, middle + width / 2)
    spans[across] = cells.slice_of(across, ends[0], ends[1], BACK_CELLS)
    up = cells.slice_of(2, floor_m, head_m)
    labels = cells.arrays["labels"]
    if not (mine.sure and theirs.sure) and (labels[(*spans, up)] == 0).mean() < FREE_SHARE:
        return  # Both were inferred from free cells; without any, there is no door.
    way = np.zeros(labels.shape, bool)
    way[(*spans, up)] = True
    way &= np.isin(labels, (*ROOM_CLASSES, UNKNOWN))
    sill = np.zeros(labels.shape, bool)
    sill[(*spans, slice(max(up.start - 1, 0), max(up.start, 1)))] = True
    sill &= np.isin(labels, (WALL, UNKNOWN))
    for part, kind in ((way, SemanticClass.EMPTY), (sill, SemanticClass.FLOOR)):
        labels[part], cells.arrays["instance"][part] = int(kind), 0
        cells.arrays["confidence"][part], cells.arrays["source"][part] = 1.0, OBSERVED


def _objects(
    runs: Sequence[Run], instance: np.ndarray, offsets: Sequence[int]
) -> tuple[tuple[ObjectInstance, ...], tuple[Placement, ...], int]:
    """Return the objects that are mostly kept, renumbered, and the number of dropped objects."""
    left = np.bincount(instance.reshape(-1), minlength=offsets[-1] + 1)
    cells = np.argwhere(instance > 0).astype(np.int32)
    owners = instance[tuple(cells.T)]
    order = np.argsort(owners, kind="stable")
    cells, owners = cells[order], owners[order]
    instances: list[ObjectInstance] = []
    placements: list[Placement] = []
    dropped = 0
    for run, offset in zip(runs, offsets, strict=False):
        retained: set[int] = set()
        for one in run.instances:
            number = one.id + offset
            if left[number] < KEPT_SHARE * max(len(one.cells), 1):
                dropped += 1
                continue
            retained.add(one.id)
            start, end = np.searchsorted(owners, [number, number + 1])
            support = one.supported_by
            by = support + offset if isinstance(support, int) else support
            moved = replace(one, id=number, cells=cells[start:end], supported_by=by)
            instances.append(moved)
        placements += [
            replace(one, object_id=one.object_id + offset)
            for one in run.placements
            if one.object_id in retained
        ]
    return tuple(instances), tuple(placements), dropped

"""Placements settled: each within its room, no two of them solid in the same place.

In: the placements as they were matched. Where the solid parts of two meet, the least change parts
them: one is moved by up to a quarter of a metre, or trimmed, or built from its own cells, which
never meet those of another.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import Layout, OccupancyGrid, Placement
from world2minecraft.furniture.solids import OWN_CELLS, box_m, depth_m, own_cells, solids_m
from world2minecraft.reconstruction.retrieval.bounds import least_sides_m, with_box, within_rooms
from world2minecraft.reconstruction.retrieval.clearing import clear_overlaps

FORGIVEN_M = 0.03  # Under the 4 cm that the metric forgives.
FARTHEST_M = 0.24  # Farther off its cells no longer lie in what stands for them.
CELLS_COST_M = 0.3  # A template is worth as much as being moved this far.
CHAIR_COST_M = 0.6  # A heap of cells is no chair.
MOVED_ONES = (SemanticClass.CHAIR,)  # What people move; the rest stands where it stands.


class Change(NamedTuple):
    """Another way to put a placement, or None to leave it out, and what it costs, in metres."""

    cost_m: float
    which: int
    placement: Placement | None


def settle(
    placements: Sequence[Placement], grid: OccupancyGrid, rooms: Sequence[Layout] = ()
) -> tuple[Placement, ...]:
    """Return the placements, in their order, within their rooms and without collisions.

    Args:
        placements: as matched.
        grid: holds the objects' cells.
        rooms: outlines of the rooms; without any, nothing is known to be outside.
    """
    held = [within_rooms(one, rooms, grid.voxel_m) for one in placements]
    cleared = clear_overlaps([one for one in held if one is not None], grid.voxel_m)
    table = _Table(list(cleared), grid, rooms)
    for _ in range(4 * len(cleared)):  # Each round parts a pair; cells end it at the latest.
        pair = table.worst_pair()
        if pair is None:
            break
        table.apply(_best_change(table, *pair))
    return tuple(one for one in table.placements if one is not None)


class _Table:
    """The placements while they are being parted, with what of them is solid."""

    def __init__(
        self, placements: list[Placement | None], grid: OccupancyGrid, rooms: Sequence[Layout]
    ):
        self.placements, self.grid, self.rooms = placements, grid, rooms
        self.original = list(placements)
        self.solids = [self.solid(one) for one in placements]
        self.boxes = np.array([_hull(one) for one in self.solids]).reshape(-1, 2, 3)
        self.depths = np.zeros((len(placements), len(placements)))
        for index in range(len(placements)):
            self.depths[index] = self.meets(index, placements[index], self.solids[index])

    def solid(self, placement: Placement | None) -> np.ndarray:
        return np.zeros((0, 2, 3)) if placement is None else solids_m(placement, self.grid)

    def meets(self, index: int, placement: Placement | None, solid: np.ndarray) -> np.ndarray:
        """Return how deep a placement in the place of ``index`` meets each other one."""
        result = np.zeros(len(self.placements))
        if placement is None or not len(solid):
            return result
        low, high = _hull(solid)
        near = ((self.boxes[:, 1] > low) & (self.boxes[:, 0] < high)).all(axis=1)
        for other in np.flatnonzero(near).tolist():
            one = self.placements[other]
            if other != index and one is not None and one.object_id != placement.object_id:
                result[other] = depth_m(solid, self.solids[other])
        return result

    def worst_pair(self) -> tuple[int, int] | None:
        """Return the two that meet deepest, the first of equals, or None."""
        if not self.depths.size or self.depths.max() <= FORGIVEN_M:
            return None
        m, n = np.unravel_index(int(np.argmax(np.round(self.depths, 6))), self.depths.shape)
        return int(m), int(n)

    def apply(self, change: Change) -> None:
        index = change.which
        self.placements[index] = change.placement
        self.solids[index] = self.solid(change.placement)
        self.boxes[index] = _hull(self.solids[index])
        self.depths[index] = self.meets(index, change.placement, self.solids[index])
        self.depths[:, index] = self.depths[index]


def _best_change(table: _Table, m: int, n: int) -> Change:
    """Return the cheapest change of either that parts the two and brings no new meeting.

    Where there is none, one of them becomes its own cells, or goes where it is that already and
    lies within the other.
    """
    changes = sorted(
        [*_changes(table, m, n), *_changes(table, n, m)],
        key=lambda one: (round(one.cost_m, 6), one.which),
    )
    for change in changes:
        solid = table.solid(change.placement)
        deep = table.meets(change.which, change.placement, solid) > FORGIVEN_M
        before = table.depths[change.which] > FORGIVEN_M
        if not (deep & ~before).any() and not deep[m] and not deep[n]:
            return change
    return _last_resort(table, m, n)


def _changes(table: _Table, index: int, other: int) -> Iterator[Change]:
    one, rival = table.placements[index], table.placements[other]
    if one is None or rival is None:
        return
    box, solid = box_m(one), table.solids[other]
    weight = 1.0 if one.class_id in MOVED_ONES else 2.0 + _volume(box) / _volume(box_m(rival))
    if one.template != OWN_CELLS:
        for step in _steps(table.grid.voxel_m):
            moved = with_box(one, box + step)
            if _stays(moved, table):
                yield Change(weight * float(np.abs(step).sum()), index, moved)
        dear = CHAIR_COST_M if one.class_id == SemanticClass.CHAIR else CELLS_COST_M
        yield Change(weight * dear, index, _as_cells(one, table))
    for trimmed in _trims(box, solid, least_sides_m(one, table.grid.voxel_m)):
        cut = with_box(one, trimmed)
        if one.template == OWN_CELLS:
            before = max(len(own_cells(one, table.grid)), 1)
            lost = 1 - len(own_cells(cut, table.grid)) / before
            if lost < 1:
                yield Change(CELLS_COST_M * lost, index, cut)
            continue
        first = table.original[index] or one
        if np.abs(trimmed - box_m(first)).max() <= FARTHEST_M + 1e-6:
            yield Change(weight * float(np.abs(trimmed - box).max()), index, cut)


def _steps(voxel_m: float) -> list[np.ndarray]:
    """Return the ways, metres, to move something on the floor: half cells along x or y."""
    count = int(FARTHEST_M / voxel_m * 2 + 1e-6)
    sides = (np.eye(3)[0], -np.eye(3)[0], np.eye(3)[1], -np.eye(3)[1])
    return [side * voxel_m / 2 * n for n in range(1, count + 1) for side in sides]


def _stays(placement: Placement, table: _Table) -> bool:
    kept = within_rooms(placement, table.rooms, table.grid.voxel_m)
    return kept is not None and np.allclose(box_m(kept), box_m(placement), atol=1e-3)


def _trims(box: np.ndarray, solid: np.ndarray, least: np.ndarray) -> Iterator[np.ndarray]:
    """Give a box cut so that it ends before, or begins behind, the solid boxes it meets."""
    ways = np.minimum(box[1] - solid[:, 0], solid[:, 1] - box[0]).min(axis=1)
    met = solid[ways > FORGIVEN_M]
    if not len(met):  # Its cells stand out of its box, and they alone meet the other.
        return
    for axis in range(3):
        for end, edge in ((1, met[:, 0, axis].min()), (0, met[:, 1, axis].max())):
            trimmed = box.copy()
            trimmed[end, axis] = edge
            if (trimmed[1] - trimmed[0] >= least - 1e-6).all():
                yield trimmed


def _last_resort(table: _Table, m: int, n: int) -> Change:
    """Return one of the two as its own cells; of two of cells the smaller is left out."""
    for index in sorted((m, n), key=lambda i: len(table.solids[i])):
        one = table.placements[index]
        if one is not None and one.template != OWN_CELLS:
            return Change(0.0, index, _as_cells(one, table))
    return Change(0.0, min((m, n), key=lambda i: len(table.solids[i])), None)


def _as_cells(placement: Placement, table: _Table) -> Placement:
    """Return a placement of the same object built from its own cells within its box and a cell."""
    grid = table.grid
    near = box_m(placement) + np.array([[-grid.voxel_m], [grid.voxel_m]])
    plain = replace(placement, template=OWN_CELLS, parameters={})
    cells = own_cells(with_box(plain, near), grid)
    if not len(cells):
        return plain
    low, high = cells.min(axis=0), cells.max(axis=0) + 1
    box = grid.origin_m + np.stack([low, high]) * grid.voxel_m
    kept = within_rooms(with_box(plain, box), table.rooms, grid.voxel_m)
    return plain if kept is None else kept


def _hull(solid: np.ndarray) -> np.ndarray:
    if not len(solid):
        return np.zeros((2, 3))
    return np.stack([solid[:, 0].min(axis=0), solid[:, 1].max(axis=0)])


def _volume(box: np.ndarray) -> float:
    return float(max(np.prod(box[1] - box[0]), 1e-9))

"""Settle placements so that each is within its room and no two overlap.

The surface of a scan is thick and its walls are precise to one or two centimetres, so boxes can
reach into walls by a cell; they are trimmed or moved. Overlaps of one or two cells are resolved by
trimming, and an object on another begins at its top. If the solid parts of two objects still
overlap, the smallest change separates them: one is moved by up to 0.25 m, trimmed, or built from
its own cells, which never overlap those of another object.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OWN_CELLS, Layout, OccupancyGrid, Placement
from world2minecraft.furniture import template
from world2minecraft.furniture.layout_checks import inside_polygon
from world2minecraft.furniture.solid_parts import box_m, depth_m, own_cells, solids_m
from world2minecraft.reconstruction.retrieval.rectangle_decomposition import largest_rectangle

# Within rooms.
STEP_M = 0.04  # Step with which placements are fitted to slanted walls.
LOST_M = 0.6  # Objects farther outside were seen through an opening or in a mirror.
MIN_REMAINING_SHARE = 0.7  # Minimum remaining share of a cut side, else the object is moved.
HAIR_M = 1e-6

# Overlaps.
DEEPEST_CELLS = 2  # Overlap due to noise and shared cells; larger overlaps are real.
TUCKED = {SemanticClass.CHAIR, SemanticClass.TABLE}  # A chair may be under its table.

FORGIVEN_M = 0.03  # Tolerated overlap, below the 4 cm of the metric.
FARTHEST_M = 0.24  # Maximum shift: beyond it, the object no longer covers its cells.
CELLS_COST_M = 0.3  # Cost of building an object from cells instead of its template.
CHAIR_COST_M = 0.6  # The same for chairs, which are not recognizable from their cells.
MOVED_ONES = (SemanticClass.CHAIR,)  # Classes that are moved first, since people move them too.


def within_rooms(placement: Placement, rooms: Sequence[Layout], voxel_m: float) -> Placement | None:
    """Return a placement completely within one room, or None if it is outside all rooms.

    The room is that which contains most of the placement. Parts outside are cut off as far as the
    template's minimum size allows; after that, the whole placement is moved.

    Args:
        placement: Matched placement.
        rooms: Rooms of the scan; without rooms the placement is not changed.
        voxel_m: Cell size in metres, the minimum size of a side.
    """
    if not rooms:
        return placement
    box = box_m(placement)
    room = max(rooms, key=lambda one: round(_shared(box, one), 6))
    if _shared(box, room) <= -LOST_M:
        return None
    low_z, high_z = room.floor_z_m, room.floor_z_m + room.wall_height_m
    least = least_sides_m(placement, voxel_m)
    box = _within_span(box, 2, low_z, high_z, least[2])
    polygon = room.floor_polygon_m
    for axis in (0, 1):
        ends = polygon[:, axis]
        box = _within_span(box, axis, float(ends.min()), float(ends.max()), least[axis])
    if not inside_polygon(_rim(box, polygon), polygon, HAIR_M).all():
        inner = _within_outline(box, polygon, least)
        return None if inner is None else with_box(placement, inner)
    return with_box(placement, box)


def floor_under_m(middle_m: np.ndarray, rooms: Sequence[Layout], voxel_m: float) -> float:
    """Return the height of the floor under a centre float64 [3], in metres.

    It is the highest floor below the centre among the rooms around it, or among all rooms if none
    contains the centre; 0, the ground floor, without rooms.
    """
    under = [one for one in rooms if one.floor_z_m <= middle_m[2] + voxel_m]
    plan = np.asarray(middle_m, np.float64)[None, :2]
    around = [one for one in under if inside_polygon(plan, one.floor_polygon_m, 0.0)[0]]
    return max((one.floor_z_m for one in around or under), default=0.0)


def least_sides_m(placement: Placement, voxel_m: float) -> np.ndarray:
    """Return the minimum size of a placement's rotated box in metres, float64 [3]."""
    if placement.template == OWN_CELLS:
        own = np.full(3, voxel_m)
    else:
        spans = template(placement.template).size_m
        own = np.array([max(span.minimum, voxel_m) for span in spans])
    own = np.minimum(own, placement.size_m)
    return own[[1, 0, 2]] if placement.quarter_turns % 2 else own


def with_box(placement: Placement, box: np.ndarray) -> Placement:
    """Return a placement with the rotated box ``box`` float64 [2, 3]."""
    size = box[1] - box[0]
    own = size[[1, 0, 2]] if placement.quarter_turns % 2 else size
    return replace(placement, center_m=np.round(box.mean(axis=0), 4), size_m=np.round(own, 4))


def _shared(box: np.ndarray, room: Layout) -> float:
    """Return the volume that a box shares with a room's bounding box; negative if it is outside."""
    corners = room.floor_polygon_m
    low = np.array([*corners.min(axis=0), room.floor_z_m])
    high = np.array([*corners.max(axis=0), room.floor_z_m + room.wall_height_m])
    sides = np.minimum(box[1], high) - np.maximum(box[0], low)
    if (sides <= 0).any():
        return float(sides.min())
    inner = np.concatenate([_rim(box, corners), [box.mean(axis=0)[:2]]])
    share = float(inside_polygon(inner, corners, HAIR_M).mean())
    return float(np.prod(sides)) * max(share, 1e-3)


def _within_span(box: np.ndarray, axis: int, low: float, high: float, least: float) -> np.ndarray:
    """Return a box cut to a span along an axis, or moved into it if too little would remain."""
    result = box.copy()
    result[:, axis] = np.clip(box[:, axis], low, high)
    if result[1, axis] - result[0, axis] >= least - HAIR_M:
        return result
    side = min(least, high - low)
    start = min(max(float(box[0, axis]), low), high - side)
    if box[1, axis] > high:
        start = high - side
    result[:, axis] = start, start + side
    return result


def _within_outline(box: np.ndarray, polygon: np.ndarray, least: np.ndarray) -> np.ndarray | None:
    """Return a box inside a polygon: cut if most of it remains, else moved, else minimal."""
    first = _largest_within(box[:, :2], polygon)
    wanted = np.maximum(least[:2], MIN_REMAINING_SHARE * np.ptp(box, axis=0)[:2])
    if first is not None and (np.ptp(first, axis=0) >= wanted - HAIR_M).all():
        return np.column_stack([first, box[:, 2]])
    moved = _moved_within(box, polygon)
    if moved is not None:
        return moved
    grown = np.stack([box[0, :2] - least[:2], box[1, :2] + least[:2]])
    wider = _largest_within(grown, polygon)
    if wider is None:
        return None
    middle, half = box[:, :2].mean(axis=0), np.minimum(least[:2], np.ptp(wider, axis=0)) / 2
    middle = np.clip(middle, wider[0] + half, wider[1] - half)
    return np.column_stack([np.stack([middle - half, middle + half]), box[:, 2]])


def _moved_within(box: np.ndarray, polygon: np.ndarray) -> np.ndarray | None:
    """Return a box moved into a polygon by the shortest way of up to ``LOST_M`` along x and y."""
    steps = np.arange(-LOST_M, LOST_M + HAIR_M, 2 * STEP_M)
    ways = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
    ways = ways[np.argsort(np.round((ways**2).sum(axis=1), 6), kind="stable")]
    rim = _rim(box, polygon)
    for way in ways:
        if inside_polygon(rim + way, polygon, HAIR_M).all():
            return box + np.array([*way, 0.0])
    return None


def _largest_within(plan: np.ndarray, polygon: np.ndarray) -> np.ndarray | None:
    """Return the largest axis-aligned part of a plan inside a polygon, float64 [2, 2]."""
    edges = [_cut_positions(plan[:, axis], polygon[:, axis]) for axis in (0, 1)]
    corners = np.stack(np.meshgrid(*edges, indexing="ij"), axis=-1)
    shape = corners.shape[:2]
    inside = inside_polygon(corners.reshape(-1, 2), polygon, HAIR_M).reshape(shape)
    middles = (corners[:-1, :-1] + corners[1:, 1:]) / 2
    whole = inside[:-1, :-1] & inside[1:, :-1] & inside[:-1, 1:] & inside[1:, 1:]
    whole &= inside_polygon(middles.reshape(-1, 2), polygon, HAIR_M).reshape(whole.shape)
    if not whole.any():
        return None
    cells = whole.astype(np.uint8)
    _, x0, y0, x1, y1 = largest_rectangle(cells, np.zeros_like(cells))
    return np.array([[edges[0][x0], edges[1][y0]], [edges[0][x1], edges[1][y1]]])


def _cut_positions(span: np.ndarray, marks: np.ndarray) -> np.ndarray:
    """Return the increasing positions at which a span may be cut: ends, marks and regular steps."""
    count = max(int(np.ceil((span[1] - span[0]) / STEP_M)), 1)
    inner = marks[(marks > span[0]) & (marks < span[1])]
    ends = np.linspace(span[0], span[1], count + 1)
    return np.unique(np.round(np.concatenate([ends, inner]), 6))


def _rim(box: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """Return points on the outline of a box, float64 [N, 2], with those level with corners."""
    xs, ys = (_cut_positions(box[:, axis], polygon[:, axis]) for axis in (0, 1))
    low, high = box[0, :2], box[1, :2]
    sides = [
        np.column_stack([xs, np.full(len(xs), low[1])]),
        np.column_stack([xs, np.full(len(xs), high[1])]),
        np.column_stack([np.full(len(ys), low[0]), ys]),
        np.column_stack([np.full(len(ys), high[0]), ys]),
    ]
    return np.concatenate(sides)


def clear_overlaps(placements: list[Placement], voxel_m: float) -> tuple[Placement, ...]:
    """Return the placements, in their order, with overlaps of up to two cells removed.

    In height, the upper object is trimmed. In plan, loose cells and small objects are trimmed
    before furniture, and otherwise the longer object if its template allows, else the other. No
    object loses more than two cells of a side in total. ``iou`` remains that of the match.
    """
    boxes = [box_m(one) for one in placements]
    for m, n in combinations(range(len(placements)), 2):
        first, second = placements[m], placements[n]
        if first.object_id == second.object_id or {first.class_id, second.class_id} == TUCKED:
            continue
        depth = np.minimum(boxes[m][1], boxes[n][1]) - np.maximum(boxes[m][0], boxes[n][0])
        axis = int(np.argmin(np.round(depth, 6)))
        if not 1e-6 < depth[axis] <= DEEPEST_CELLS * voxel_m + 1e-6:
            continue
        for yields, stays in _turns(m, n, boxes, axis, placements):
            trimmed = _trimmed(boxes[yields], boxes[stays], axis)
            if _allowed(placements[yields], trimmed, axis, voxel_m):
                boxes[yields] = trimmed
                break
    return tuple(with_box(one, box) for one, box in zip(placements, boxes, strict=True))


def _turns(
    m: int, n: int, boxes: list[np.ndarray], axis: int, placements: list[Placement]
) -> list[tuple[int, int]]:
    """Return the possible pairs of an object and the one it yields to, the better choice first."""
    if axis == 2:
        upper_first = boxes[m][0][2] > boxes[n][0][2]
        return [(m, n), (n, m)] if upper_first else [(n, m), (m, n)]
    lesser = [_is_lesser(placements[index]) for index in (m, n)]
    if lesser[0] != lesser[1]:
        return [(m, n), (n, m)] if lesser[0] else [(n, m), (m, n)]
    longer = np.ptp(boxes[m], axis=0)[axis] >= np.ptp(boxes[n], axis=0)[axis]
    return [(m, n), (n, m)] if longer else [(n, m), (m, n)]


def _is_lesser(placement: Placement) -> bool:
    return placement.template == OWN_CELLS or placement.class_id == SemanticClass.OBJS


def _trimmed(box: np.ndarray, other: np.ndarray, axis: int) -> np.ndarray:
    result = box.copy()
    if box[:, axis].sum() >= other[:, axis].sum():
        result[0, axis] = other[1, axis]
    else:
        result[1, axis] = other[0, axis]
    return result


def _allowed(placement: Placement, box: np.ndarray, axis: int, voxel_m: float) -> bool:
    """Return whether a placement may have this box: it keeps its floor and its template's size."""
    side = float(np.ptp(box[:, axis]))
    if side < voxel_m - 1e-6:
        return False
    if placement.template == OWN_CELLS:
        return True
    before = box_m(placement)
    if np.abs(box - before)[:, axis].max() > DEEPEST_CELLS * voxel_m + 1e-6:
        return False
    one = template(placement.template)
    if axis == 2 and one.mount == "floor" and box[0, 2] > before[0, 2] + 1e-6:
        return False
    own = 1 - axis if axis < 2 and placement.quarter_turns % 2 else axis
    return side >= int(one.size_m[own].minimum / voxel_m + 1e-6) * voxel_m - 1e-6


class Change(NamedTuple):
    """An alternative placement, or None to remove it, with its cost in metres."""

    cost_m: float
    which: int
    placement: Placement | None


def settle_placements(
    placements: Sequence[Placement], grid: OccupancyGrid, rooms: Sequence[Layout] = ()
) -> tuple[Placement, ...]:
    """Return the placements, in their order, within their rooms and without collisions.

    Args:
        placements: Matched placements.
        grid: Grid with the objects' cells.
        rooms: Rooms of the scan; without rooms no space counts as outside.
    """
    held = [within_rooms(one, rooms, grid.voxel_m) for one in placements]
    cleared = clear_overlaps([one for one in held if one is not None], grid.voxel_m)
    table = _Table(list(cleared), grid, rooms)
    for _ in range(4 * len(cleared)):  # Each round separates one pair.
        pair = table.worst_pair()
        if pair is None:
            break
        table.apply(_best_change(table, *pair))
    return tuple(one for one in table.placements if one is not None)


class _Table:
    """The placements during separation, with their solid parts."""

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
        """Return the depth by which a placement at the place of ``index`` overlaps each other."""
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
        """Return the pair of placements with the deepest overlap, or None."""
        if not self.depths.size or self.depths.max() <= FORGIVEN_M:
            return None
        m, n = np.unravel_index(int(np.argmax(np.round(self.depths, 6))), self.depths.shape)
        return int(m), int(n)

    def apply(self, change: Change) -> None:
        """Replace a placement and update its solid, bounding box and overlaps."""
        index = change.which
        self.placements[index] = change.placement
        self.solids[index] = self.solid(change.placement)
        self.boxes[index] = _hull(self.solids[index])
        self.depths[index] = self.meets(index, change.placement, self.solids[index])
        self.depths[:, index] = self.depths[index]


def _best_change(table: _Table, m: int, n: int) -> Change:
    """Return the cheapest change that separates two placements without a new collision.

    Without such a change, one of them is built from its own cells, or removed if it already is and
    is inside the other.
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
        for step in _moves(table.grid.voxel_m):
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


def _moves(voxel_m: float) -> list[np.ndarray]:
    """Return the possible moves of an object on the floor in metres: half cells along x or y."""
    count = int(FARTHEST_M / voxel_m * 2 + 1e-6)
    sides = (np.eye(3)[0], -np.eye(3)[0], np.eye(3)[1], -np.eye(3)[1])
    return [side * voxel_m / 2 * n for n in range(1, count + 1) for side in sides]


def _stays(placement: Placement, table: _Table) -> bool:
    kept = within_rooms(placement, table.rooms, table.grid.voxel_m)
    return kept is not None and np.allclose(box_m(kept), box_m(placement), atol=1e-3)


def _trims(box: np.ndarray, solid: np.ndarray, least: np.ndarray) -> Iterator[np.ndarray]:
    """Yield a box cut to end before, or begin behind, the solid boxes it overlaps."""
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
    """Return one of the two built from its cells; if both are, the smaller is removed."""
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

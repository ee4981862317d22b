"""The doors of a run: where a person can leave a room, and in which direction.

Doors are the doors and doorways of the room outlines, and gaps in the walls that a person fits
through. For such a gap, both directions may lead out of the room.
"""

from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.construction.doorways import find_gaps
from world2minecraft.core.types import Layout, Opening
from world2minecraft.furniture.layout_checks import inside_polygon
from world2minecraft.reconstruction.homes.moved_run import Run

MIN_WIDTH_M, MAX_WIDTH_M = 0.45, 2.5
ASIDE_M = 0.3  # Distance before and behind an opening at which free space is required.
SAME_PLACE_M = 0.5  # Maximum distance of two detections of the same door.
HEADS_M = (1.9, 2.3)  # Range of heights of a passage whose lintel was not seen.
BODY_M = (0.3, 1.7)
USUAL_HEAD_M = 2.0
OPEN_SHARE = 0.8  # Minimum share of free cells across the wall, at the height of a body.
ACROSS_CELLS = 2
STEPS = ((1, 0), (0, 1), (-1, 0), (0, -1))


@dataclass(frozen=True)
class Doorway:
    """A passable opening, with the quarter turns of the direction out of its room.

    ``sure`` is False if the opening was found in free cells only, with an imprecise width.
    """

    middle_m: tuple[float, float]
    width_m: float
    head_m: float
    outward: int
    floor_z_m: float
    sure: bool = True


def doorways_of(run: Run) -> tuple[Doorway, ...]:
    """Return the doors of a run; those of the room outlines come first."""
    found: list[Doorway] = []
    for layout in run.layouts:
        found += [door for one in layout.openings if (door := _of_opening(one, layout))]
    for layout in run.layouts:
        for door in (*_passages(run, layout), *_gaps(run, layout)):
            if not any(_is_same(door, other) for other in found):
                found.append(door)
    return tuple(found)


def _is_same(one: Doorway, other: Doorway) -> bool:
    distance = np.abs(np.array(one.middle_m) - other.middle_m).max()
    level = abs(one.floor_z_m - other.floor_z_m) < 1.0
    return bool(distance < SAME_PLACE_M) and one.outward == other.outward and level


def _of_opening(opening: Opening, layout: Layout) -> Doorway | None:
    width = float(np.linalg.norm(opening.end_m - opening.start_m))
    outward = _outward(opening, layout)
    if opening.kind == "window" or not MIN_WIDTH_M <= width <= MAX_WIDTH_M or outward is None:
        return None
    x, y = ((opening.start_m + opening.end_m) / 2).tolist()
    return Doorway((x, y), width, opening.head_m, outward, layout.floor_z_m)


def _outward(opening: Opening, layout: Layout) -> int | None:
    """Return the quarter turns of the direction out of a room, or None if there is none."""
    middle = (opening.start_m + opening.end_m) / 2
    along = np.abs(opening.end_m - opening.start_m)
    ways = (1, 3) if along[0] >= along[1] else (0, 2)
    points = np.array([middle + ASIDE_M * np.array(STEPS[way]) for way in ways])
    inside = inside_polygon(points, layout.floor_polygon_m, 0.0)
    if inside[0] == inside[1]:
        return None
    return ways[1] if inside[0] else ways[0]


def _passages(run: Run, layout: Layout) -> list[Doorway]:
    """Return the positions at which rays at body height crossed the outline of a room.

    An open door leaf may be in the frame, so that one side of the opening is not seen as wall.
    """
    grid, found = run.grid, []
    clear = _clear(run, layout.floor_z_m)
    corners = layout.floor_polygon_m
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        side = end - start
        length = float(np.linalg.norm(side))
        if length < MIN_WIDTH_M or np.abs(side).min() > 0.05 * length:
            continue
        # Counter-clockwise: out is to the right of the way along an edge.
        outward = int(np.rint(np.arctan2(-side[0], side[1]) / (np.pi / 2))) % 4
        count = int(length / grid.voxel_m)
        points = start + (np.arange(count)[:, None] + 0.5) / count * side
        across = np.arange(-ACROSS_CELLS, ACROSS_CELLS + 1) * grid.voxel_m
        places = points[:, None] + across[None, :, None] * np.array(STEPS[outward])
        cells = np.floor((places - grid.origin_m[:2]) / grid.voxel_m).astype(int)
        held = ((cells >= 0) & (cells < clear.shape)).all(axis=2)
        cells = np.where(held[..., None], cells, 0)
        share = np.where(held, clear[cells[..., 0], cells[..., 1]], 0.0)
        is_open = share.min(axis=1) >= OPEN_SHARE
        for first, last in _runs(is_open):
            width = (last - first) / count * length
            if MIN_WIDTH_M <= width <= MAX_WIDTH_M:
                x, y = (start + (first + last) / 2 / count * side).tolist()
                door = Doorway((x, y), width, USUAL_HEAD_M, outward, layout.floor_z_m, False)
                found.append(door)
    return found


def _clear(run: Run, floor_z_m: float) -> np.ndarray:
    """Return the free share of each column at body height, float [X, Y]."""
    grid = run.grid
    low, high = (
        int(np.clip(round((floor_z_m + m - grid.origin_m[2]) / grid.voxel_m), 0, grid.shape[2]))
        for m in BODY_M
    )
    if high <= low:
        return np.zeros(grid.shape[:2])
    return np.asarray((grid.labels[:, :, low:high] == 0).mean(axis=2))


def _runs(mask: np.ndarray) -> list[tuple[int, int]]:
    """Return the half-open range of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(np.int8), [0]])))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def _gaps(run: Run, layout: Layout) -> list[Doorway]:
    """Return the gaps in a run's walls, each with both directions through it."""
    grid, found = run.grid, []
    for gap in find_gaps(grid, grid.labels == 0, layout.floor_z_m):
        spans = [
            [float(grid.origin_m[axis]) + n * grid.voxel_m for n in cells]
            for axis, cells in ((gap.axis, gap.along), (1 - gap.axis, gap.across))
        ]
        width = spans[0][1] - spans[0][0]
        for side, place in enumerate(spans[1]):
            # The face of the wall on the near side is where a door's place is counted.
            outward = ((1 - gap.axis) + (0 if side == 0 else 2)) % 4
            middle = [0.0, 0.0]
            middle[gap.axis], middle[1 - gap.axis] = sum(spans[0]) / 2, place
            one = Doorway(
                (middle[0], middle[1]), width, USUAL_HEAD_M, outward, layout.floor_z_m, False
            )
            if width <= MAX_WIDTH_M:
                found.append(one)
    return found


def head_of(one: Doorway, other: Doorway) -> float:
    """Return the height above the floor, in metres, of the opening that two doors share."""
    known = [door.head_m for door in (one, other) if door.sure]
    return float(np.clip(min(known), *HEADS_M)) if known else USUAL_HEAD_M


def shift_door(door: Doorway, shift_m: np.ndarray, turns: int) -> Doorway:
    """Rotate a door by quarter turns and shift it by float64 [3] in metres."""
    x, y = door.middle_m
    for _ in range(turns):
        x, y = -y, x
    return replace(
        door,
        middle_m=(x + float(shift_m[0]), y + float(shift_m[1])),
        outward=(door.outward + turns) % 4,
        floor_z_m=door.floor_z_m + float(shift_m[2]),
    )

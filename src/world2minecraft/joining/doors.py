"""Where one room may stand beside others: its doors against theirs.

Two runs have a door in common where openings of about one width and height meet from both sides of
a wall. Turns are quarter turns and shifts whole cells. What one scan saw through the open door must
agree with what the other saw of the same place.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.joining.moving import Move, Run, moved, moved_layout
from world2minecraft.metrics.layout import inside_polygon
from world2minecraft.types import Layout, Opening

SAME_WIDTH_M, SAME_HEAD_M = 0.25, 0.25
LEAST_WIDTH_M = 0.45
WALL_CELLS = 2  # Between two rooms: the wall's face in each.
OVERLAP_M2 = 0.25  # Of floor that both would have: outlines are off by a cell.
LEAST_COMMON = 40  # Cells that both know, before their agreement counts.
AGREE_WEIGHT = 2.0
MORE_DOORS = 0.5  # What each further door that meets adds.
SIDE_M = 0.15  # An opening lies so near to the outline of its room.


@dataclass(frozen=True)
class Doorway:
    """An opening one can walk through, and the quarter turns of the direction out of its room."""

    middle_m: tuple[float, float]
    width_m: float
    head_m: float
    outward: int
    floor_z_m: float


@dataclass(frozen=True)
class Fit:
    """A place for a run: how it is moved there, how well it fits, and by which door of which run.

    ``door`` is where, in the common frame, and how wide.
    """

    move: Move
    score: float
    beside: str
    door: Doorway


def doorways_of(layouts: tuple[Layout, ...]) -> tuple[Doorway, ...]:
    """Return the doors and doorways of rooms, each with the way out."""
    found = []
    for layout in layouts:
        for opening in layout.openings:
            width = float(np.linalg.norm(opening.end_m - opening.start_m))
            outward = _outward(opening, layout)
            if opening.kind != "window" and width >= LEAST_WIDTH_M and outward is not None:
                middle = ((opening.start_m + opening.end_m) / 2).tolist()
                found.append(
                    Doorway(tuple(middle), width, opening.head_m, outward, layout.floor_z_m)
                )
    return tuple(found)


def _outward(opening: Opening, layout: Layout) -> int | None:
    """Return the quarter turns of the direction that leads out of a room; None where none does."""
    middle = (opening.start_m + opening.end_m) / 2
    along = np.abs(opening.end_m - opening.start_m)
    ways = (1, 3) if along[0] >= along[1] else (0, 2)
    steps = {0: (1, 0), 1: (0, 1), 2: (-1, 0), 3: (0, -1)}
    points = np.array([middle + 2 * SIDE_M * np.array(steps[way]) for way in ways])
    inside = inside_polygon(points, layout.floor_polygon_m, 0.0)
    if inside[0] == inside[1]:
        return None
    return ways[1] if inside[0] else ways[0]


def fits(run: Run, placed: list[Run]) -> list[Fit]:
    """Return the places where a run may stand beside those that stand already, best first.

    Places that are one and the same, found by several doors, are one.
    """
    voxel_m = run.grid.voxel_m
    found: dict[Move, Fit] = {}
    for other in placed:
        for theirs in doorways_of(other.layouts):
            for own in doorways_of(run.layouts):
                if not _alike(own, theirs):
                    continue
                move = _meeting(own, theirs, voxel_m)
                if move in found:
                    continue
                score = _score(run, move, placed, own, theirs)
                if score is not None:
                    found[move] = Fit(move, round(score, 6), other.name, theirs)
    return sorted(
        found.values(), key=lambda fit: (-fit.score, fit.move.quarter_turns, fit.move.cells)
    )


def _alike(own: Doorway, theirs: Doorway) -> bool:
    return (
        abs(own.width_m - theirs.width_m) <= SAME_WIDTH_M
        and abs(own.head_m - theirs.head_m) <= SAME_HEAD_M
    )


def _meeting(own: Doorway, theirs: Doorway, voxel_m: float) -> Move:
    """Return the move that sets a door against another one, a wall's thickness away."""
    turns = (theirs.outward + 2 - own.outward) % 4
    turn = Move(turns).transform(voxel_m)[:2, :2]
    ahead = Move(theirs.outward).transform(voxel_m)[:2, 0]
    target = np.array(theirs.middle_m) + ahead * WALL_CELLS * voxel_m
    shift = np.rint((target - turn @ np.array(own.middle_m)) / voxel_m).astype(int)
    up = round((theirs.floor_z_m - own.floor_z_m) / voxel_m)
    return Move(turns, (int(shift[0]), int(shift[1]), int(up)))


def _score(run: Run, move: Move, placed: list[Run], own: Doorway, theirs: Doorway) -> float | None:
    """Return how well a run fits at a place, None where it would stand in another room."""
    to_new = move.transform(run.grid.voxel_m)
    layouts = tuple(moved_layout(layout, to_new) for layout in run.layouts)
    if any(overlap_m2(layouts, other.layouts) > OVERLAP_M2 for other in placed):
        return None
    score = 1 - abs(own.width_m - theirs.width_m) - abs(own.head_m - theirs.head_m)
    here = moved(run, move)
    doors = doorways_of(here.layouts)
    score += MORE_DOORS * (sum(_met(door, placed) for door in doors) - 1)
    for other in placed:
        common, agreed = agreement(here, other)
        if common >= LEAST_COMMON:
            score += AGREE_WEIGHT * (agreed - 0.5)
    return score


def _met(door: Doorway, placed: list[Run]) -> bool:
    """Whether a door that stands in its place meets one of another run."""
    for other in placed:
        for theirs in doorways_of(other.layouts):
            apart = np.abs(np.array(door.middle_m) - theirs.middle_m)
            opposite = (door.outward - theirs.outward) % 4 == 2
            if opposite and apart.max() <= 0.4 and _alike(door, theirs):
                return True
    return False


def overlap_m2(
    layouts: tuple[Layout, ...], others: tuple[Layout, ...], step_m: float = 0.1
) -> float:
    """Return how much floor two sets of rooms would share, storey by storey."""
    shared = 0.0
    for one in layouts:
        for other in others:
            top = min(one.floor_z_m + one.wall_height_m, other.floor_z_m + other.wall_height_m)
            if top - max(one.floor_z_m, other.floor_z_m) < 0.5:
                continue
            low = np.maximum(one.floor_polygon_m.min(axis=0), other.floor_polygon_m.min(axis=0))
            high = np.minimum(one.floor_polygon_m.max(axis=0), other.floor_polygon_m.max(axis=0))
            if (high - low <= step_m).any():
                continue
            axes = [np.arange(a + step_m / 2, b, step_m) for a, b in zip(low, high, strict=True)]
            points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
            both = inside_polygon(points, one.floor_polygon_m, 0.0)
            both &= inside_polygon(points, other.floor_polygon_m, 0.0)
            shared += float(both.sum()) * step_m**2
    return shared


def agreement(one: Run, other: Run) -> tuple[int, float]:
    """Return how many cells two runs both know, and the share that is solid or free in both."""
    views = common_views(one, other)
    if views is None:
        return 0, 0.0
    mine, theirs = (run.grid.labels[view] for run, view in zip((one, other), views, strict=True))
    known = (mine != 255) & (theirs != 255)
    count = int(known.sum())
    same = int(((mine > 0) == (theirs > 0))[known].sum())
    return count, same / max(count, 1)


def common_views(one: Run, other: Run) -> tuple[tuple[slice, ...], tuple[slice, ...]] | None:
    """Return where two grids of one frame lie over each other, as slices of each."""
    voxel_m = one.grid.voxel_m
    firsts = [np.rint(run.grid.origin_m / voxel_m).astype(int) for run in (one, other)]
    low = np.maximum(*firsts)
    ends = [first + run.grid.shape for first, run in zip(firsts, (one, other), strict=True)]
    high = np.minimum(*ends)
    if (high <= low).any():
        return None
    mine, theirs = (
        tuple(slice(a, b) for a, b in zip(low - first, high - first, strict=True))
        for first in firsts
    )
    return mine, theirs

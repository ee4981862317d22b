"""Place the rooms of a home at given positions, or by their doors.

Two runs share a door if openings of about the same width and height meet from both sides of a wall.
Rotations are quarter turns, shifts are whole cells. Scans look through open doors, so the
observations of both runs must agree there, which determines the position to the cell.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Layout
from world2minecraft.furniture.layout_checks import inside_polygon
from world2minecraft.geometry.morphology import dilate
from world2minecraft.reconstruction.homes.doors import Doorway, doorways_of, shift_door
from world2minecraft.reconstruction.homes.moved_run import Move, Run, move_layout, move_run

SAME_WIDTH_M, SAME_HEAD_M = 0.3, 0.3
WALL_CELLS = 2  # Thickness of the wall between two rooms: one face in each room.
ALONG_CELLS, THINNER, THICKER = 4, 1, 3  # Maximum position errors of a door, in cells.
STEP_M = 0.1  # Distance of the points that measure a shared floor.
OVERLAP_M2 = 0.25  # Tolerated overlap of two floors: outlines have errors of a cell.
MIN_COMMON = 150  # Solid cells of one that the other knows, before their agreement counts.
# Right places of three generated houses, scanned room by room, agree by 0.99, wrong ones by 0.45 to
# 0.87: what is below counts against a place.
AGREE_WEIGHT, AGREE_NEUTRAL = 4.0, 0.75
AGREEING = 0.9  # Minimum agreement of two overlapping rooms.
BESIDE_CELLS = 4  # Around the wall between two rooms.
NEAR_CELLS = 7  # Closer positions count as one.
MORE_DOORS = 0.3  # Score of each further pair of doors that meet.
UNSURE_COST = 0.1

SURE_BY = 0.15  # Minimum lead of the best position over all others.
MAX_SHOWN = 4
MET_M = 0.5  # Doors within this distance meet.
ALIKE = 0.85  # Minimum agreement of two scans of the same room.
HAND_OVERLAP = 0.5  # Maximum overlap, as a share of the smaller room, at positions given by hand.


@dataclass(frozen=True)
class Fit:
    """A possible position of a run: its move, its score, and the doors by which it is connected.

    ``beside`` is the name of the connected run; ``doors`` are the door of that run and the run's
    own door, in the common frame.
    """

    move: Move
    score: float
    beside: str
    doors: tuple[Doorway, Doorway]


@dataclass(frozen=True, eq=False)
class Known:
    """The solid, dilated solid and known cells of a run, bool [X, Y, Z], and its first cell."""

    solid: np.ndarray
    thick: np.ndarray
    known: np.ndarray
    first: np.ndarray


def known_of(run: Run) -> Known:
    """Return the solid and known cells of a run, without floor and ceiling (they fit anywhere)."""
    level = np.isin(run.grid.labels, (SemanticClass.FLOOR, SemanticClass.CEILING))
    solid = run.grid.occupied & ~level
    first = np.rint(run.grid.origin_m / run.grid.voxel_m).astype(int)
    return Known(solid, dilate(solid), run.grid.labels != 255, first)


def fits(run: Run, placed: Sequence[Run]) -> list[Fit]:
    """Return the possible positions of a run next to the placed runs, best first.

    Equal positions found by several doors are returned once.
    """
    voxel_m = run.grid.voxel_m
    own_doors = doorways_of(run)
    others = [(other, known_of(other), doorways_of(other)) for other in placed]
    turned = {turns: known_of(move_run(run, Move(turns))) for turns in range(4)}
    found: list[Fit] = []
    for other, there, doors in others:
        for theirs, own in product(doors, own_doors):
            if not _alike(own, theirs):
                continue
            move = _meeting(own, theirs, voxel_m)
            wall = _wall_of(theirs, voxel_m)
            move = _refined(turned[move.quarter_turns], move, theirs.outward, there, wall)
            here = _shifted(turned[move.quarter_turns], move)
            score = _score(run, move, here, (own, theirs, other.name), others)
            if score is not None:
                shift = np.array(move.cells) * voxel_m
                pair = (theirs, shift_door(own, shift, move.quarter_turns))
                found.append(Fit(move, round(score, 6), other.name, pair))
    found.sort(key=lambda fit: (-fit.score, fit.move.quarter_turns, fit.move.cells))
    best: list[Fit] = []
    for fit in found:
        if not any(_is_near(fit.move, other.move) for other in best):
            best.append(fit)
    return best


def _is_near(one: Move, other: Move) -> bool:
    distance = np.abs(np.array(one.cells) - other.cells).max()
    return one.quarter_turns == other.quarter_turns and distance < NEAR_CELLS


def _alike(own: Doorway, theirs: Doorway) -> bool:
    sure = own.sure and theirs.sure
    return abs(own.width_m - theirs.width_m) <= SAME_WIDTH_M and (
        not sure or abs(own.head_m - theirs.head_m) <= SAME_HEAD_M
    )


def _meeting(own: Doorway, theirs: Doorway, voxel_m: float) -> Move:
    """Return the move that places a door at another one, at the distance of a wall's thickness."""
    turns = (theirs.outward + 2 - own.outward) % 4
    turn = Move(turns).transform(voxel_m)[:2, :2]
    ahead = Move(theirs.outward).transform(voxel_m)[:2, 0]
    target = np.array(theirs.middle_m) + ahead * WALL_CELLS * voxel_m
    shift = np.rint((target - turn @ np.array(own.middle_m)) / voxel_m).astype(int)
    up = round((theirs.floor_z_m - own.floor_z_m) / voxel_m)
    return Move(turns, (int(shift[0]), int(shift[1]), int(up)))


def _wall_of(door: Doorway, voxel_m: float) -> tuple[int, int]:
    """Return the axis perpendicular to a door's wall, and the cell directly behind its face."""
    axis = door.outward % 2
    return axis, int(np.floor(door.middle_m[axis] / voxel_m))


def _refined(turned: Known, move: Move, outward: int, there: Known, wall: tuple[int, int]) -> Move:
    """Return the move, within a few cells of the door position, that agrees best with a scan.

    The move is not changed if the scans share too few cells.
    """
    ahead = np.rint(Move(outward).transform(1.0)[:3, 0]).astype(int)
    aside = np.array([-ahead[1], ahead[0], 0])
    best, most = move, -1.0
    steps = product(range(-ALONG_CELLS, ALONG_CELLS + 1), range(-THINNER, THICKER + 1))
    for along, across in sorted(steps, key=lambda step: (abs(step[0]) + abs(step[1]), step)):
        cells = np.array(move.cells) + along * aside + across * ahead
        tried = Move(move.quarter_turns, tuple(cells.tolist()))
        common, agreed = agreement(_shifted(turned, tried), there, wall)
        if common >= MIN_COMMON and agreed > most + 1e-9:
            best, most = tried, agreed
    return best


def _shifted(turned: Known, move: Move) -> Known:
    return Known(turned.solid, turned.thick, turned.known, turned.first + np.array(move.cells))


def _score(
    run: Run, move: Move, here: Known, by: tuple[Doorway, Doorway, str], others: list
) -> float | None:
    """Return how well a run fits at a position, or None if it would overlap another room.

    ``by`` contains its own door, the door it meets, and the name of the run with that door.
    """
    own, theirs, beside = by
    voxel_m = run.grid.voxel_m
    to_new = move.transform(voxel_m)
    layouts = tuple(move_layout(layout, to_new) for layout in run.layouts)
    score = 1 - abs(own.width_m - theirs.width_m) - UNSURE_COST * (not own.sure or not theirs.sure)
    if own.sure and theirs.sure:
        score -= abs(own.head_m - theirs.head_m)
    for other, there, _ in others:
        is_next = other.name == beside
        common, agreed = agreement(here, there, _wall_of(theirs, voxel_m) if is_next else None)
        counts = common >= MIN_COMMON
        if overlap_m2(layouts, other.layouts) > OVERLAP_M2 and not (counts and agreed > AGREEING):
            return None
        if counts:
            score += AGREE_WEIGHT * min(agreed - AGREE_NEUTRAL, 1.0 if is_next else 0.0)
    shift = np.array(move.cells) * voxel_m
    doors = [shift_door(one, shift, move.quarter_turns) for one in doorways_of(run) if one.sure]
    met = sum(any(_meet(door, far) for _, _, doors_ in others for far in doors_) for door in doors)
    return score + MORE_DOORS * max(met - 1, 0)


def _meet(door: Doorway, other: Doorway) -> bool:
    distance = np.abs(np.array(door.middle_m) - other.middle_m).max()
    opposite = (door.outward - other.outward) % 4 == 2
    return bool(other.sure and opposite and distance <= 0.4 and _alike(door, other))


def agreement(one: Known, other: Known, wall: tuple[int, int] | None = None) -> tuple[int, float]:
    """Return the number of solid cells that both runs know, and the share of them that agrees.

    A solid cell agrees if the other run has a solid cell at or next to it.

    Args:
        one: Cells of one run.
        other: Cells of another run in the same frame.
        wall: Axis and cell of a wall between the rooms, whose cells are ignored.
    """
    low = np.maximum(one.first, other.first)
    high = np.minimum(one.first + one.solid.shape, other.first + other.solid.shape)
    if (high <= low).any():
        return 0, 0.0
    mine, theirs = (
        tuple(slice(a, b) for a, b in zip(low - run.first, high - run.first, strict=True))
        for run in (one, other)
    )
    common = agreed = 0
    for left, a, right, b in ((one, mine, other, theirs), (other, theirs, one, mine)):
        judged = left.solid[a] & right.known[b]
        if wall is not None:
            near = slice(
                *np.clip(np.array([-1, 2]) * BESIDE_CELLS + wall[1] - low[wall[0]], 0, None)
            )
            np.moveaxis(judged, wall[0], 0)[near] = False
        common += int(judged.sum())
        agreed += int((judged & right.thick[b]).sum())
    return common, agreed / max(common, 1)


def overlap_m2(layouts: tuple[Layout, ...], others: tuple[Layout, ...]) -> float:
    """Return the floor area in square metres that two sets of rooms share, storey by storey."""
    shared = 0.0
    for one, other in product(layouts, others):
        top = min(one.floor_z_m + one.wall_height_m, other.floor_z_m + other.wall_height_m)
        if top - max(one.floor_z_m, other.floor_z_m) < 0.5:
            continue
        low = np.maximum(one.floor_polygon_m.min(axis=0), other.floor_polygon_m.min(axis=0))
        high = np.minimum(one.floor_polygon_m.max(axis=0), other.floor_polygon_m.max(axis=0))
        if (high - low <= STEP_M).any():
            continue
        axes = [np.arange(a + STEP_M / 2, b, STEP_M) for a, b in zip(low, high, strict=True)]
        points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
        both = inside_polygon(points, one.floor_polygon_m, 0.0)
        both &= inside_polygon(points, other.floor_polygon_m, 0.0)
        shared += float(both.sum()) * STEP_M**2
    return shared


@dataclass(frozen=True, eq=False)
class Placed:
    """The runs in a common frame, with their moves, notes on the placement, and connected doors.

    ``doors`` contains pairs of doors that meet, one of each run.
    """

    runs: tuple[Run, ...]
    moves: tuple[Move, ...]
    lines: tuple[str, ...]
    doors: tuple[tuple[Doorway, Doorway], ...]


def place_runs(runs: Sequence[Run], by_hand: Mapping[str, Move] | None = None) -> Placed:
    """Return all runs in the frame of the first run.

    Args:
        runs: Two or more runs with different names.
        by_hand: Given moves of runs by name; the first run may have one too.

    Raises:
        UsageError: If a run fits nowhere or in several positions, or if two runs overlap.
    """
    hand = dict(by_hand or {})
    first = runs[0].name
    moves: dict[str, Move] = {first: hand.get(first, Move())}
    lines = {run.name: f"{run.name} was placed at the given position (--at)" for run in runs}
    lines[first] = f"{first} keeps its scanned position" if first not in hand else lines[first]
    moves |= {run.name: hand[run.name] for run in runs if run.name in hand}
    left = [run for run in runs if run.name not in moves]
    met: list[tuple[Doorway, Doorway]] = []
    while left:
        standing = [move_run(run, moves[run.name]) for run in runs if run.name in moves]
        options = {run.name: fits(run, standing) for run in left}
        sure = [name for name, found in options.items() if found and _is_sure(found)]
        if not sure:
            raise UsageError(_undecided(left, options, standing[0].grid.voxel_m))
        best = max(sure, key=lambda name: (options[name][0].score, -_index(runs, name)))
        fit = options[best][0]
        moves[best] = fit.move
        lines[best] = (
            f"{best} was placed next to {fit.beside} at a door {fit.doors[0].width_m:.2f} m wide"
        )
        met.append(fit.doors)
        left = [run for run in left if run.name != best]
    placed = tuple(move_run(run, moves[run.name]) for run in runs)
    _check_apart(placed, set(hand))
    met += [pair for pair in doors_between(placed) if not any(_is_one(pair, old) for old in met)]
    return Placed(
        placed,
        tuple(moves[run.name] for run in runs),
        tuple(lines[run.name] for run in runs),
        tuple(met),
    )


def _is_sure(found: list[Fit]) -> bool:
    return len(found) == 1 or found[0].score - found[1].score >= SURE_BY


def _index(runs: Sequence[Run], name: str) -> int:
    return [run.name for run in runs].index(name)


def _undecided(left: list[Run], options: Mapping[str, list[Fit]], voxel_m: float) -> str:
    """Return the reason why no run can be placed, and the option to pass."""
    open_ones = [run for run in left if options[run.name]]
    if not open_ones:
        run = left[0]
        without = "" if doorways_of(run) else " (it has no detected door)"
        return (
            f"{run.name} matches no door of the other rooms{without}; "
            f"set its position (--at {run.name}=X,Y,TURNS, in metres and quarter turns)"
        )
    name = open_ones[0].name
    found = options[name]
    ways = " or ".join(f"--at {stated(name, fit.move, voxel_m)}" for fit in found[:MAX_SHOWN])
    return f"{name} fits about equally well in {len(found)} positions; choose one with {ways}"


def stated(name: str, move: Move, voxel_m: float) -> str:
    """Format a move as a value of ``--at``."""
    x, y, z = (round(cells * voxel_m, 3) for cells in move.cells)
    place = f"{name}={x:g},{y:g},{move.quarter_turns}"
    return place + (f",{z:g}" if z else "")


def _check_apart(placed: Sequence[Run], hand: set[str]) -> None:
    """Refuse runs whose given positions overlap, unless their observations agree."""
    for number, one in enumerate(placed):
        for other in placed[:number]:
            shared = overlap_m2(one.layouts, other.layouts)
            if shared <= HAND_OVERLAP * min(_floor_m2(one), _floor_m2(other)):
                continue
            seen_alike = agreement(known_of(one), known_of(other))[1] >= ALIKE
            if {one.name, other.name} & hand and not seen_alike:
                raise UsageError(
                    f"{one.name} and {other.name} overlap by {shared:.1f} m2 of floor; move one "
                    f"of them (--at {one.name}=X,Y,TURNS)"
                )


def _floor_m2(run: Run) -> float:
    return max(overlap_m2(run.layouts, run.layouts), 0.1)


def parse_place(text: str, names: Sequence[str], voxel_m: float) -> tuple[str, Move]:
    """Parse ``NAME=X,Y,TURNS``, optionally followed by Z in metres, into a run name and a move.

    Raises:
        UsageError: If the text is malformed or names an unknown run.
    """
    name, _, rest = text.partition("=")
    parts = rest.split(",")
    try:
        numbers = [float(part) for part in parts]
        if (
            len(numbers) not in (3, 4)
            or not all(np.isfinite(numbers))
            or max(map(abs, numbers)) > 1e4
        ):
            raise ValueError
        turns = int(numbers[2])
        if turns != numbers[2]:
            raise ValueError
    except ValueError:
        raise UsageError(
            f"--at must be NAME=X,Y,TURNS in metres and quarter turns, such as kitchen=3.5,0,1, "
            f"got {text!r}"
        ) from None
    if name not in names:
        raise UsageError(f"no room is named {name!r} (--at); known rooms: {', '.join(names)}")
    place = [*numbers[:2], numbers[3] if len(numbers) == 4 else 0.0]
    cells = tuple(round(value / voxel_m) for value in place)
    return name, Move(turns % 4, cells)  # type: ignore[arg-type]


def doors_between(placed: Sequence[Run]) -> list[tuple[Doorway, Doorway]]:
    """Return the pairs of outline doors that meet, each of an earlier and a later run."""
    doors = [[door for door in doorways_of(run) if door.sure] for run in placed]
    pairs = []
    for number, own in enumerate(doors):
        for others in doors[number + 1 :]:
            for mine, theirs in product(own, others):
                distance = np.array(theirs.middle_m) - mine.middle_m
                opposite = (mine.outward - theirs.outward) % 4 == 2
                if opposite and np.abs(distance).max() < MET_M:
                    pairs.append((mine, theirs))
    return pairs


def _is_one(pair: tuple[Doorway, Doorway], other: tuple[Doorway, Doorway]) -> bool:
    middles = [np.mean([door.middle_m for door in doors], axis=0) for doors in (pair, other)]
    return float(np.abs(middles[0] - middles[1]).max()) < MET_M

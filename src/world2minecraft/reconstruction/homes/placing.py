"""All runs in their places: by hand where that was given, else by their doors."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.reconstruction.homes.doors import Doorway, doorways_of
from world2minecraft.reconstruction.homes.fits import Fit, agreement, fits, known_of, overlap_m2
from world2minecraft.reconstruction.homes.moved_run import Move, Run, moved

SURE_BY = 0.15  # A place is taken where it fits better than any other by so much.
MOST_SHOWN = 4
MET_M = 0.5  # Doors nearer than that meet.
ALIKE = 0.85  # Two scans of one room agree by so much.
HAND_OVERLAP = 0.5  # Of the smaller room: given by hand, yet one room in the other.


@dataclass(frozen=True, eq=False)
class Placed:
    """The runs in one frame, the move of each, sentences on how they were placed, and doors.

    ``doors`` are pairs that meet, one of each run.
    """

    runs: tuple[Run, ...]
    moves: tuple[Move, ...]
    told: tuple[str, ...]
    doors: tuple[tuple[Doorway, Doorway], ...]


def place_runs(runs: Sequence[Run], by_hand: Mapping[str, Move] | None = None) -> Placed:
    """Return all runs in one frame, that of the first.

    Args:
        runs: two or more, of different names.
        by_hand: moves for some of them, by name; the first may have one too.

    Raises:
        UsageError: a run fits nowhere, or in several places about as well; or two overlap.
    """
    hand = dict(by_hand or {})
    first = runs[0].name
    moves: dict[str, Move] = {first: hand.get(first, Move())}
    told = {run.name: f"{run.name} stands where it was put by hand" for run in runs}
    told[first] = f"{first} stands where it was scanned" if first not in hand else told[first]
    moves |= {run.name: hand[run.name] for run in runs if run.name in hand}
    left = [run for run in runs if run.name not in moves]
    met: list[tuple[Doorway, Doorway]] = []
    while left:
        standing = [moved(run, moves[run.name]) for run in runs if run.name in moves]
        options = {run.name: fits(run, standing) for run in left}
        sure = [name for name, found in options.items() if found and _is_sure(found)]
        if not sure:
            raise UsageError(_undecided(left, options, standing[0].grid.voxel_m))
        best = max(sure, key=lambda name: (options[name][0].score, -_index(runs, name)))
        fit = options[best][0]
        moves[best] = fit.move
        told[best] = (
            f"{best} was set beside {fit.beside} at a door {fit.doors[0].width_m:.2f} m wide"
        )
        met.append(fit.doors)
        left = [run for run in left if run.name != best]
    placed = tuple(moved(run, moves[run.name]) for run in runs)
    _check_apart(placed, set(hand))
    met += [pair for pair in doors_between(placed) if not any(_is_one(pair, old) for old in met)]
    return Placed(
        placed,
        tuple(moves[run.name] for run in runs),
        tuple(told[run.name] for run in runs),
        tuple(met),
    )


def _is_sure(found: list[Fit]) -> bool:
    return len(found) == 1 or found[0].score - found[1].score >= SURE_BY


def _index(runs: Sequence[Run], name: str) -> int:
    return [run.name for run in runs].index(name)


def _undecided(left: list[Run], options: Mapping[str, list[Fit]], voxel_m: float) -> str:
    """Return why no run can be placed, and what to type."""
    open_ones = [run for run in left if options[run.name]]
    if not open_ones:
        run = left[0]
        without = "" if doorways_of(run) else ": no door was found in it"
        return (
            f"{run.name} fits at no door of the other rooms{without}; "
            f"say where it stands: --at {run.name}=X,Y,TURNS (metres, quarter turns)"
        )
    name = open_ones[0].name
    found = options[name]
    ways = " or ".join(f"--at {stated(name, fit.move, voxel_m)}" for fit in found[:MOST_SHOWN])
    return f"{name} fits in {len(found)} places about as well; choose one: {ways}"


def stated(name: str, move: Move, voxel_m: float) -> str:
    """Return a move as ``--at`` takes it."""
    x, y, z = (round(cells * voxel_m, 3) for cells in move.cells)
    place = f"{name}={x:g},{y:g},{move.quarter_turns}"
    return place + (f",{z:g}" if z else "")


def _check_apart(placed: Sequence[Run], hand: set[str]) -> None:
    """Refuse runs put by hand into one place, where they did not see the same things."""
    for number, one in enumerate(placed):
        for other in placed[:number]:
            shared = overlap_m2(one.layouts, other.layouts)
            if shared <= HAND_OVERLAP * min(_floor_m2(one), _floor_m2(other)):
                continue
            seen_alike = agreement(known_of(one), known_of(other))[1] >= ALIKE
            if {one.name, other.name} & hand and not seen_alike:
                raise UsageError(
                    f"{one.name} and {other.name} would stand in one place, {shared:.1f} m2 of "
                    f"floor in both; move one: --at {one.name}=X,Y,TURNS"
                )


def _floor_m2(run: Run) -> float:
    return max(overlap_m2(run.layouts, run.layouts), 0.1)


def parse_place(text: str, names: Sequence[str], voxel_m: float) -> tuple[str, Move]:
    """Return the run and the move that ``NAME=X,Y,TURNS`` says; Z in metres may follow.

    Raises:
        UsageError: it is written in another way, or names no run.
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
            f"--at {text!r} must be NAME=X,Y,TURNS, such as kitchen=3.5,0,1 (metres, quarter turns)"
        ) from None
    if name not in names:
        raise UsageError(f"--at names {name!r}; the rooms are {', '.join(names)}")
    place = [*numbers[:2], numbers[3] if len(numbers) == 4 else 0.0]
    cells = tuple(round(value / voxel_m) for value in place)
    return name, Move(turns % 4, cells)  # type: ignore[arg-type]


def doors_between(placed: Sequence[Run]) -> list[tuple[Doorway, Doorway]]:
    """Return the doors of the rooms' outlines that meet: of an earlier run and of a later one."""
    doors = [[door for door in doorways_of(run) if door.sure] for run in placed]
    pairs = []
    for number, own in enumerate(doors):
        for others in doors[number + 1 :]:
            for mine, theirs in product(own, others):
                apart = np.array(theirs.middle_m) - mine.middle_m
                opposite = (mine.outward - theirs.outward) % 4 == 2
                if opposite and np.abs(apart).max() < MET_M:
                    pairs.append((mine, theirs))
    return pairs


def _is_one(pair: tuple[Doorway, Doorway], other: tuple[Doorway, Doorway]) -> bool:
    middles = [np.mean([door.middle_m for door in doors], axis=0) for doors in (pair, other)]
    return float(np.abs(middles[0] - middles[1]).max()) < MET_M

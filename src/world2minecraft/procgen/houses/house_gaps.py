"""The gaps in a house's walls: the front door, doors to the hall, doorways, windows."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from world2minecraft.procgen.houses.house_plan import WALL_M, Cell, HousePlan
from world2minecraft.procgen.rooms.furniture_model import whole
from world2minecraft.procgen.rooms.ground import Wall
from world2minecraft.procgen.rooms.openings import DOOR_M, HEAD_M, SILL_M, Hole

CORNER_M = 0.2  # What stays of a wall beside a door.
BATH_SILL_M = 1.3
OPEN_M = 1.4  # A doorway without a leaf, between a kitchen, a dining room and a living room.
SOCIAL = ("living", "dining", "kitchen")


@dataclass(frozen=True)
class Gap:
    """An opening as the first of ``cells`` sees it; a second cell lies behind its wall."""

    kind: Literal["window", "door", "doorway"]
    cells: tuple[int, ...]
    wall: Wall
    first_m: float
    last_m: float
    sill_m: float
    head_m: float

    def hole(self, cell: int, placed: Cell) -> Hole:
        """Return it as a hole in a wall of one of its cells, in that cell's own frame."""
        turn, at = self.wall.turn, self.wall.at_m
        if cell != self.cells[0]:
            turn, at = (turn + 2) % 4, at + (-WALL_M if turn < 2 else WALL_M)
        off = (placed.x_m, placed.y_m)
        at, run = at - off[turn % 2], off[1 - turn % 2]
        first, last = whole(self.first_m - run), whole(self.last_m - run)
        walls = placed.ground.walls
        number = next(
            n
            for n, wall in enumerate(walls)
            if wall.turn == turn
            and abs(wall.at_m - at) < 0.01
            and wall.first_m - 0.01 <= first
            and last <= wall.last_m + 0.01
        )
        return Hole(self.kind, number, first, last, self.sill_m, self.head_m)


def house_gaps(plan: HousePlan, rng: np.random.Generator) -> tuple[Gap, ...]:
    """Return the gaps of a plan; the front door is first."""
    gaps = [_front_door(plan)]
    for number, cell in enumerate(plan.cells):
        if cell.kind != "hall":
            gaps.append(_hall_door(plan, number, rng))
        gaps += _windows(plan, number, rng)
    for number in range(len(plan.cells) - 1):
        gaps += _doorway(plan, number)
    return tuple(gaps)


def walls_of(cell: Cell) -> tuple[Wall, ...]:
    """Return the walls of a cell in the frame of the house."""
    moved = []
    for wall in cell.ground.walls:
        off = (cell.x_m, cell.y_m)
        run = off[1 - wall.turn % 2]
        at = whole(wall.at_m + off[wall.turn % 2])
        moved.append(Wall(wall.turn, at, whole(wall.first_m + run), whole(wall.last_m + run)))
    return tuple(moved)


def _front_door(plan: HousePlan) -> Gap:
    """Return the front door, at the far end of the corridor of the ground storey."""
    wall = max((w for w in walls_of(plan.cells[0]) if w.turn == 2), key=lambda w: w.at_m)
    first = whole((wall.first_m + wall.last_m - DOOR_M[0]) / 2)
    return Gap("door", (0,), wall, first, whole(first + DOOR_M[0]), 0.0, DOOR_M[1])


def _hall_door(plan: HousePlan, number: int, rng: np.random.Generator) -> Gap:
    cell = plan.cells[number]
    hall = next(n for n, c in enumerate(plan.cells) if c.kind == "hall" and c.storey == cell.storey)
    turn = 3 if cell.y_m < plan.cells[hall].y_m else 1
    wall = next(w for w in walls_of(cell) if w.turn == turn)
    near = rng.random() < 0.5
    first = whole(wall.first_m + CORNER_M if near else wall.last_m - CORNER_M - DOOR_M[0])
    return Gap("door", (number, hall), wall, first, whole(first + DOOR_M[0]), 0.0, DOOR_M[1])


def _windows(plan: HousePlan, number: int, rng: np.random.Generator) -> list[Gap]:
    """Return a window in each outer wall that is long enough, one at least where one is outer."""
    cell = plan.cells[number]
    outer = [
        wall for wall in walls_of(cell) if wall.length_m > 1.6 and _is_outer(plan, number, wall)
    ]
    gaps = []
    for n, wall in enumerate(sorted(outer, key=lambda w: -w.length_m)):
        if n and rng.random() < 0.4:
            continue
        small = cell.kind == "bathroom"
        wide = whole(0.7 if small else min(rng.uniform(1.1, 1.6), wall.length_m - 0.8))
        first = whole((wall.first_m + wall.last_m - wide) / 2 + rng.uniform(-0.2, 0.2))
        sill = BATH_SILL_M if small else SILL_M
        gaps.append(Gap("window", (number,), wall, first, whole(first + wide), sill, HEAD_M))
    return gaps


def _is_outer(plan: HousePlan, number: int, wall: Wall) -> bool:
    """Tell whether nothing of the same storey lies behind a wall."""
    x0, y0, x1, y1 = wall.rect(wall.first_m, wall.last_m, -0.4, -0.04)
    storey = plan.cells[number].storey
    others = (c for n, c in enumerate(plan.cells) if n != number and c.storey == storey)
    return not any(
        x0 < c.rect[2] and c.rect[0] < x1 and y0 < c.rect[3] and c.rect[1] < y1 for c in others
    )


def _doorway(plan: HousePlan, number: int) -> list[Gap]:
    """Return a wide doorway between two neighbours of which one eats where the other cooks."""
    a, b = plan.cells[number], plan.cells[number + 1]
    beside = a.storey == b.storey and a.y_m == b.y_m and abs(a.rect[2] + WALL_M - b.x_m) < 0.01
    if not beside or a.kind not in SOCIAL or b.kind not in SOCIAL:
        return []
    wall = next(w for w in walls_of(a) if w.turn == 2)
    first = whole((wall.first_m + wall.last_m - OPEN_M) / 2)
    gap = Gap("doorway", (number, number + 1), wall, first, whole(first + OPEN_M), 0.0, DOOR_M[1])
    return [gap]

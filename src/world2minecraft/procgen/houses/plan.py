"""Floor plans of houses: a corridor with rooms on both sides, wall openings and stairs.

The corridor runs along x, with rooms below and above it, separated by straight walls of 12 cm. Both
storeys have the same corridor. In a house with two storeys, the upper side starts with a part of
the hall that contains the stairs. All lengths are multiples of 2 cm. The inner faces of the outer
walls are at x = 0 and y = 0.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.rooms.floor_shapes import Box, Ground, Rect, Wall
from world2minecraft.procgen.rooms.furniture_model import Colour, Model, Part, round_to_step, shade
from world2minecraft.procgen.rooms.openings import DOOR_M, HEAD_M, SILL_M, Hole
from world2minecraft.procgen.rooms.placement import Item

WALL_M = 0.12  # Partition walls of 11.5 cm brick or 12.5 cm board on studs.
SLAB_M = 0.24  # Ceiling below and floor above, 12 cm each.
CORRIDOR_M = (1.2, 1.5)  # Housing norms ask for 0.9 to 1.2 m.
SIDE_M = (3.3, 4.1)  # How deep the rooms along a corridor are.
STAIR_M, PASSAGE_M = 0.9, 1.1  # Stairs at home are 0.8 to 1.0 m wide.
ARRIVAL_M = 0.92  # The floor where the stairs end.
# (risers, rise, tread): 2 x rise + tread is 0.62 to 0.64 m, as a step of a person asks for.
FLIGHTS = ((14, 0.20, 0.24), (15, 0.18, 0.26))
ALONG_M: dict[str, tuple[float, float]] = {  # How much of a corridor's length a kind takes.
    "living": (4.6, 5.4), "kitchen": (3.6, 4.2), "dining": (4.2, 4.8), "bed": (3.8, 4.4),
    "children": (3.2, 3.8), "office": (3.4, 4.2), "study": (3.4, 4.0), "bathroom": (2.2, 2.8),
}  # fmt: skip
MAX_STRETCH = 1.3  # Beyond it a side of the house ends before the other one does.
ONE_STOREY = (
    "living", "bed", "kitchen", "bathroom", "children", "dining", "office", "study", "bed",
    "bathroom", "children", "bed", "office",
)  # fmt: skip
GROUND_STOREY = ("living", "kitchen", "bathroom", "dining", "office", "study", "bed", "living")
UPPER_STOREY = ("bed", "bathroom", "children", "bed", "study", "children", "office", "bathroom")
CORNER_M = 0.2  # What stays of a wall beside a door.
BATH_SILL_M = 1.3
OPEN_M = 1.4  # A doorway without a leaf, between a kitchen, a dining room and a living room.
SOCIAL = ("living", "dining", "kitchen")
OBJS = int(SemanticClass.OBJS)
STEP_THICK_M = 0.26  # From a step's top down to the underside of the flight.
HEADROOM_M = 2.0  # Building codes ask for 1.9 to 2.1 m over the line of walk.
RAIL_M, RAIL_THICK_M, POST_GAP_M = 0.9, 0.04, 0.12  # Codes: 0.9 m high, under 12 cm between.


@dataclass(frozen=True)
class Cell:
    """One room of a house, with its kind, storey and position."""

    kind: str
    storey: int
    x_m: float
    y_m: float
    ground: Ground

    @property
    def rect(self) -> Rect:
        """The bounding rectangle of the room."""
        width, depth, _ = self.ground.size_m
        return self.x_m, self.y_m, self.x_m + width, self.y_m + depth


@dataclass(frozen=True)
class Flight:
    """A flight of stairs in the hall that rises along +y from the start of ``rect``."""

    rect: Rect
    risers: int
    rise_m: float
    tread_m: float


@dataclass(frozen=True)
class HousePlan:
    """The rooms of a house by storey (the hall first), the ceiling height and the stairs."""

    cells: tuple[Cell, ...]
    storeys: int
    height_m: float
    flight: Flight | None

    @property
    def pitch_m(self) -> float:
        """The distance in metres from one floor to the next."""
        return round_to_step(self.height_m + SLAB_M)

    @property
    def size_m(self) -> tuple[float, float, float]:
        """The size of the inner bounding box of all rooms, in metres."""
        x, y = (max(cell.rect[n] for cell in self.cells) for n in (2, 3))
        return x, y, round_to_step(self.pitch_m * (self.storeys - 1) + self.height_m)


def plan_house(rooms: int, storeys: int, rng: np.random.Generator) -> HousePlan:
    """Generate a house plan with ``rooms`` rooms, including halls, on one or two storeys."""
    risers, rise, tread = FLIGHTS[int(rng.integers(len(FLIGHTS)))]
    run = round_to_step((risers - 1) * tread)
    two = storeys == 2
    height = round_to_step(risers * rise - SLAB_M) if two else round_to_step(rng.uniform(2.4, 2.7))
    wide = round_to_step(rng.uniform(*CORRIDOR_M))
    below, above = (round_to_step(rng.uniform(*SIDE_M)) for _ in range(2))
    above = round_to_step(run + ARRIVAL_M) if two else above
    storey_kinds = _kinds(rooms, storeys)
    bay = round_to_step(STAIR_M + PASSAGE_M) if two else 0.0
    shared = [_sides(kinds, bay, rng) for kinds in storey_kinds]
    length = max(
        _length_taken(side, bay if n else 0.0) for pair in shared for n, side in enumerate(pair)
    )
    has_below = any(pair[0] for pair in shared)
    corridor_y = round_to_step(below + WALL_M) if has_below else 0.0
    above_y = round_to_step(corridor_y + wide + WALL_M)
    cells = []
    for storey, (low, high) in enumerate(shared):
        start = round_to_step(bay + WALL_M) if two else 0.0
        cells.append(_hall(storey, length, corridor_y, wide, bay, above, height))
        cells += _row(low, storey, 0.0, length, 0.0, below, height)
        cells += _row(high, storey, start, length, above_y, above, height)
    top = above_y - WALL_M
    flight = (
        Flight((0.0, top, STAIR_M, round_to_step(top + run)), risers, rise, tread) if two else None
    )
    return HousePlan(tuple(cells), storeys, height, flight)


def _kinds(rooms: int, storeys: int) -> list[tuple[str, ...]]:
    if storeys == 1:
        return [ONE_STOREY[: rooms - 1]]
    lower = (rooms + 1) // 2
    return [GROUND_STOREY[: lower - 1], UPPER_STOREY[: rooms - lower - 1]]


def _sides(
    kinds: tuple[str, ...], bay: float, rng: np.random.Generator
) -> tuple[list[tuple[str, float]], list[tuple[str, float]]]:
    """Distribute the rooms to both sides of the corridor with similar lengths."""
    rooms = [(kind, round_to_step(rng.uniform(*ALONG_M[kind]))) for kind in kinds]
    sides: tuple[list, list] = ([], [])
    for room in sorted(rooms, key=lambda entry: -entry[1]):
        taken = [_length_taken(side, bay if n else 0.0) for n, side in enumerate(sides)]
        sides[0 if taken[0] < taken[1] else 1].append(room)
    for side in sides:
        order = rng.permutation(len(side))
        side[:] = [side[int(n)] for n in order]
    return sides


def _length_taken(side: list[tuple[str, float]], bay: float) -> float:
    parts = [along for _, along in side] + ([bay] if bay else [])
    return round_to_step(sum(parts) + WALL_M * max(0, len(parts) - 1))


def _hall(
    storey: int, length: float, y: float, wide: float, bay: float, above: float, height: float
) -> Cell:
    if not bay:
        return Cell("hall", storey, 0.0, y, Ground((length, wide, height)))
    # The bay has no wall towards the corridor.
    size = (length, round_to_step(wide + WALL_M + above), height)
    return Cell("hall", storey, 0.0, y, Ground(size, ((bay, wide, length, size[1]),)))


def _row(
    side: list[tuple[str, float]],
    storey: int,
    start: float,
    length: float,
    y: float,
    deep: float,
    height: float,
) -> list[Cell]:
    """Return the rooms of one side, stretched to the length of the house."""
    if not side:
        return []
    natural = sum(along for _, along in side)
    free = length - start - WALL_M * (len(side) - 1)
    stretch = min(free / natural, MAX_STRETCH)
    cells, x = [], start
    for n, (kind, along) in enumerate(side):
        end = min(length, round_to_step(x + along * stretch))
        if n == len(side) - 1 and stretch < MAX_STRETCH:
            end = length
        cells.append(Cell(kind, storey, x, y, Ground((round_to_step(end - x), deep, height))))
        x = round_to_step(end + WALL_M)
    return cells


@dataclass(frozen=True)
class Gap:
    """A wall opening as seen from the first room in ``cells``.

    A second room in ``cells`` is on the other side of the wall.
    """

    kind: Literal["window", "door", "doorway"]
    cells: tuple[int, ...]
    wall: Wall
    first_m: float
    last_m: float
    sill_m: float
    head_m: float

    def hole(self, cell: int, placed: Cell) -> Hole:
        """Return the opening as a hole in a wall of one of its rooms, in the frame of that room."""
        turn, at = self.wall.turn, self.wall.at_m
        if cell != self.cells[0]:
            turn, at = (turn + 2) % 4, at + (-WALL_M if turn < 2 else WALL_M)
        off = (placed.x_m, placed.y_m)
        at, run = at - off[turn % 2], off[1 - turn % 2]
        first, last = round_to_step(self.first_m - run), round_to_step(self.last_m - run)
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
    """Generate the wall openings of a plan, starting with the front door."""
    gaps = [_front_door(plan)]
    for number, cell in enumerate(plan.cells):
        if cell.kind != "hall":
            gaps.append(_hall_door(plan, number, rng))
        gaps += _windows(plan, number, rng)
    for number in range(len(plan.cells) - 1):
        gaps += _doorway(plan, number)
    return tuple(gaps)


def walls_of(cell: Cell) -> tuple[Wall, ...]:
    """Return the walls of a room in the frame of the house."""
    moved = []
    for wall in cell.ground.walls:
        off = (cell.x_m, cell.y_m)
        run = off[1 - wall.turn % 2]
        at = round_to_step(wall.at_m + off[wall.turn % 2])
        moved.append(
            Wall(wall.turn, at, round_to_step(wall.first_m + run), round_to_step(wall.last_m + run))
        )
    return tuple(moved)


def _front_door(plan: HousePlan) -> Gap:
    """Return the front door at the end of the corridor on the ground floor."""
    wall = max((w for w in walls_of(plan.cells[0]) if w.turn == 2), key=lambda w: w.at_m)
    first = round_to_step((wall.first_m + wall.last_m - DOOR_M[0]) / 2)
    return Gap("door", (0,), wall, first, round_to_step(first + DOOR_M[0]), 0.0, DOOR_M[1])


def _hall_door(plan: HousePlan, number: int, rng: np.random.Generator) -> Gap:
    cell = plan.cells[number]
    hall = next(n for n, c in enumerate(plan.cells) if c.kind == "hall" and c.storey == cell.storey)
    turn = 3 if cell.y_m < plan.cells[hall].y_m else 1
    wall = next(w for w in walls_of(cell) if w.turn == turn)
    near = rng.random() < 0.5
    first = round_to_step(wall.first_m + CORNER_M if near else wall.last_m - CORNER_M - DOOR_M[0])
    return Gap(
        "door", (number, hall), wall, first, round_to_step(first + DOOR_M[0]), 0.0, DOOR_M[1]
    )


def _windows(plan: HousePlan, number: int, rng: np.random.Generator) -> list[Gap]:
    """Return windows for the outer walls that are long enough, at least one if possible."""
    cell = plan.cells[number]
    outer = [
        wall for wall in walls_of(cell) if wall.length_m > 1.6 and _is_outer(plan, number, wall)
    ]
    gaps = []
    for n, wall in enumerate(sorted(outer, key=lambda w: -w.length_m)):
        if n and rng.random() < 0.4:
            continue
        small = cell.kind == "bathroom"
        wide = round_to_step(0.7 if small else min(rng.uniform(1.1, 1.6), wall.length_m - 0.8))
        first = round_to_step((wall.first_m + wall.last_m - wide) / 2 + rng.uniform(-0.2, 0.2))
        sill = BATH_SILL_M if small else SILL_M
        gaps.append(
            Gap("window", (number,), wall, first, round_to_step(first + wide), sill, HEAD_M)
        )
    return gaps


def _is_outer(plan: HousePlan, number: int, wall: Wall) -> bool:
    """Return whether no room of the same storey is behind a wall."""
    x0, y0, x1, y1 = wall.rect(wall.first_m, wall.last_m, -0.4, -0.04)
    storey = plan.cells[number].storey
    others = (c for n, c in enumerate(plan.cells) if n != number and c.storey == storey)
    return not any(
        x0 < c.rect[2] and c.rect[0] < x1 and y0 < c.rect[3] and c.rect[1] < y1 for c in others
    )


def _doorway(plan: HousePlan, number: int) -> list[Gap]:
    """Return a wide doorway between two adjacent kitchens, dining rooms or living rooms."""
    a, b = plan.cells[number], plan.cells[number + 1]
    adjacent = a.storey == b.storey and a.y_m == b.y_m and abs(a.rect[2] + WALL_M - b.x_m) < 0.01
    if not adjacent or a.kind not in SOCIAL or b.kind not in SOCIAL:
        return []
    wall = next(w for w in walls_of(a) if w.turn == 2)
    first = round_to_step((wall.first_m + wall.last_m - OPEN_M) / 2)
    gap = Gap(
        "doorway", (number, number + 1), wall, first, round_to_step(first + OPEN_M), 0.0, DOOR_M[1]
    )
    return [gap]


def stairs_model(flight: Flight, wood: Colour) -> Model:
    """Return a model of stairs whose front, +x, is the bottom step.

    The top riser is the edge of the floor slab.
    """
    treads = flight.risers - 1
    d, w, h = (round_to_step(v) for v in (treads * flight.tread_m, STAIR_M, treads * flight.rise_m))
    parts = []
    for n in range(treads):
        top, near = flight.rise_m * (n + 1), d / 2 - n * flight.tread_m
        far, low = near - flight.tread_m, max(0.0, top - STEP_THICK_M)
        parts.append(Part((far, -w / 2, low, near, w / 2, top - 0.04), shade(wood, 0.8), "wood"))
        parts.append(Part((far, -w / 2, top - 0.04, near, w / 2, top), wood, "wood"))
    return Model("stairs", OBJS, (d, w, h), tuple(parts))


def railing_model(length_m: float, wood: Colour) -> Model:
    """Return a model of a railing on posts that runs along its y axis."""
    d, w, h = RAIL_THICK_M, round_to_step(length_m), RAIL_M
    count = max(2, round(w / (POST_GAP_M + RAIL_THICK_M)) + 1)
    parts = [Part((-d / 2, -w / 2, h - 0.06, d / 2, w / 2, h), wood, "wood")]
    for n in range(count):
        y = -w / 2 + round_to_step((w - RAIL_THICK_M) * n / (count - 1))
        parts.append(Part((-d / 2, y, 0.0, d / 2, y + RAIL_THICK_M, h - 0.06), (236, 234, 228)))
    return Model("railing", OBJS, (d, w, h), tuple(parts))


def stairwell(plan: HousePlan, flight: Flight) -> Box:
    """Return the hole in the slab above the stairs as x0, y0, z0, x1, y1, z1."""
    x0, y0, x1, y1 = flight.rect
    # The first step over which the ceiling would be too low, and one before it.
    first = max(0, int((plan.height_m - HEADROOM_M) / flight.rise_m) - 1)
    start = round_to_step(y0 + first * flight.tread_m)
    return x0, start, plan.height_m, x1, y1, plan.pitch_m


def stair_items(plan: HousePlan, flight: Flight, wood: Colour) -> tuple[list[Item], list[Item]]:
    """Return the items of the stairs on the ground storey and of the railings above."""
    x0, y0, x1, y1 = flight.rect
    steps = Item(stairs_model(flight, wood), (x0 + x1) / 2, (y0 + y1) / 2, 0.0, 270.0)
    _, start, _, _, end, level = stairwell(plan, flight)
    half = RAIL_THICK_M / 2
    along = Item(railing_model(end - start, wood), x1 + half, (start + end) / 2, level, 0.0)
    across = railing_model(x1 + RAIL_THICK_M - x0, wood)
    ahead = Item(across, (x0 + x1) / 2 + half, start - half, level, 270.0)
    return [steps], [along, ahead]

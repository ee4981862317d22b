"""The plan of a house: a corridor with rooms along it, the same walls on every storey.

The corridor runs along x; rooms lie below and above it with straight walls of 12 cm between them.
Where there are two storeys, the upper side begins with a bay of the hall that holds the stairs.
All lengths are multiples of 2 cm; the inner faces of the outer walls are at x = 0 and y = 0.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.procgen.rooms.furniture_model import whole
from world2minecraft.procgen.rooms.ground import Ground, Rect

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


@dataclass(frozen=True)
class Cell:
    """One room of a house: its kind, its storey and its place."""

    kind: str
    storey: int
    x_m: float
    y_m: float
    ground: Ground

    @property
    def rect(self) -> Rect:
        """The rectangle around it."""
        width, depth, _ = self.ground.size_m
        return self.x_m, self.y_m, self.x_m + width, self.y_m + depth


@dataclass(frozen=True)
class Flight:
    """Stairs that rise along +y from ``rect``'s start; the hall's bay holds them."""

    rect: Rect
    risers: int
    rise_m: float
    tread_m: float


@dataclass(frozen=True)
class HousePlan:
    """The cells, storey by storey, the hall first on each; heights; the stairs."""

    cells: tuple[Cell, ...]
    storeys: int
    height_m: float
    flight: Flight | None

    @property
    def pitch_m(self) -> float:
        """From floor to floor."""
        return whole(self.height_m + SLAB_M)

    @property
    def size_m(self) -> tuple[float, float, float]:
        """The inner box around all rooms."""
        x, y = (max(cell.rect[n] for cell in self.cells) for n in (2, 3))
        return x, y, whole(self.pitch_m * (self.storeys - 1) + self.height_m)


def plan_house(rooms: int, storeys: int, rng: np.random.Generator) -> HousePlan:
    """Return a plan of ``rooms`` rooms, halls among them, on one or two storeys."""
    risers, rise, tread = FLIGHTS[int(rng.integers(len(FLIGHTS)))]
    run = whole((risers - 1) * tread)
    two = storeys == 2
    height = whole(risers * rise - SLAB_M) if two else whole(rng.uniform(2.4, 2.7))
    wide = whole(rng.uniform(*CORRIDOR_M))
    below, above = (whole(rng.uniform(*SIDE_M)) for _ in range(2))
    above = whole(run + ARRIVAL_M) if two else above
    storey_kinds = _kinds(rooms, storeys)
    bay = whole(STAIR_M + PASSAGE_M) if two else 0.0
    shared = [_sides(kinds, bay, rng) for kinds in storey_kinds]
    length = max(_taken(side, bay if n else 0.0) for pair in shared for n, side in enumerate(pair))
    has_below = any(pair[0] for pair in shared)
    corridor_y = whole(below + WALL_M) if has_below else 0.0
    above_y = whole(corridor_y + wide + WALL_M)
    cells = []
    for storey, (low, high) in enumerate(shared):
        start = whole(bay + WALL_M) if two else 0.0
        cells.append(_hall(storey, length, corridor_y, wide, bay, above, height))
        cells += _row(low, storey, 0.0, length, 0.0, below, height)
        cells += _row(high, storey, start, length, above_y, above, height)
    top = above_y - WALL_M
    flight = Flight((0.0, top, STAIR_M, whole(top + run)), risers, rise, tread) if two else None
    return HousePlan(tuple(cells), storeys, height, flight)


def _kinds(rooms: int, storeys: int) -> list[tuple[str, ...]]:
    if storeys == 1:
        return [ONE_STOREY[: rooms - 1]]
    lower = (rooms + 1) // 2
    return [GROUND_STOREY[: lower - 1], UPPER_STOREY[: rooms - lower - 1]]


def _sides(
    kinds: tuple[str, ...], bay: float, rng: np.random.Generator
) -> tuple[list[tuple[str, float]], list[tuple[str, float]]]:
    """Share the rooms out to both sides of the corridor, so that the sides come out as long."""
    rooms = [(kind, whole(rng.uniform(*ALONG_M[kind]))) for kind in kinds]
    sides: tuple[list, list] = ([], [])
    for room in sorted(rooms, key=lambda entry: -entry[1]):
        taken = [_taken(side, bay if n else 0.0) for n, side in enumerate(sides)]
        sides[0 if taken[0] < taken[1] else 1].append(room)
    for side in sides:
        order = rng.permutation(len(side))
        side[:] = [side[int(n)] for n in order]
    return sides


def _taken(side: list[tuple[str, float]], bay: float) -> float:
    parts = [along for _, along in side] + ([bay] if bay else [])
    return whole(sum(parts) + WALL_M * max(0, len(parts) - 1))


def _hall(
    storey: int, length: float, y: float, wide: float, bay: float, above: float, height: float
) -> Cell:
    if not bay:
        return Cell("hall", storey, 0.0, y, Ground((length, wide, height)))
    # The bay has no wall towards the corridor.
    size = (length, whole(wide + WALL_M + above), height)
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
        end = min(length, whole(x + along * stretch))
        if n == len(side) - 1 and stretch < MAX_STRETCH:
            end = length
        cells.append(Cell(kind, storey, x, y, Ground((whole(end - x), deep, height))))
        x = whole(end + WALL_M)
    return cells

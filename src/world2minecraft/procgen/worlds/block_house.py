"""Conversion of house plans to whole blocks: the interiors of rooms, doors, windows and stairs.

Plans are metric, with walls of 12 cm. Here every wall is one block thick, at the block that
contains the middle of the metric wall. Room sizes therefore change by less than two blocks, and
walls of two storeys remain aligned.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from world2minecraft.minecraft.physics.player_body import HEIGHT, WIDTH
from world2minecraft.minecraft.physics.walk_graph import columns_per_block
from world2minecraft.procgen.houses.plan import WALL_M, Cell, Gap, HousePlan, house_gaps, plan_house

RAIL = 1  # A rail takes a block.


@dataclass(frozen=True)
class BlockRoom:
    """The interior of a room: blocks [low, high) along x and y, and the layer above its floor."""

    number: int
    kind: str
    storey: int
    low: tuple[int, int]
    high: tuple[int, int]
    ground: int
    height: int
    blocked: tuple[tuple[int, int, int, int], ...] = ()  # x0, y0, x1, y1 of excluded floor.

    @property
    def size(self) -> tuple[int, int]:
        """The number of blocks along x and y."""
        return self.high[0] - self.low[0], self.high[1] - self.low[1]

    def floor(self, shape: tuple[int, int]) -> np.ndarray:
        """Return the floor columns of the room as a bool array of the given shape."""
        inside = np.zeros(shape, bool)
        inside[self.low[0] : self.high[0], self.low[1] : self.high[1]] = True
        for x0, y0, x1, y1 in self.blocked:
            inside[x0:x1, y0:y1] = False
        return inside


@dataclass(frozen=True)
class BlockGap:
    """A wall opening: blocks [low, high) along x and y, from ``bottom`` to ``top`` (exclusive)."""

    kind: Literal["window", "door", "doorway"]
    rooms: tuple[int, ...]
    turn: int  # Direction from the wall into the first room, in quarter turns.
    low: tuple[int, int]
    high: tuple[int, int]
    bottom: int
    top: int


@dataclass(frozen=True)
class BlockFlight:
    """Stairs that rise along +y: columns [x0, x1), the first row and the number of steps.

    ``hole`` is the first row of the opening in the upper floor.
    """

    x0: int
    x1: int
    y0: int
    steps: int
    hole: int

    @property
    def end(self) -> int:
        """The row after the last step, whose top is level with the upper floor."""
        return self.y0 + self.steps


@dataclass(frozen=True)
class BlockHouse:
    """A house plan in blocks. Indices start at the first inner block and the lowest floor."""

    plan: HousePlan
    gaps_m: tuple[Gap, ...]
    rooms: tuple[BlockRoom, ...]
    gaps: tuple[BlockGap, ...]
    flight: BlockFlight | None
    size: tuple[int, int]
    grounds: tuple[int, ...]
    height: int
    blocks_per_metre: float


def person_size_blocks(blocks_per_metre: float) -> tuple[int, int]:
    """Return the width and height in blocks that a walking person occupies.

    Example:
        >>> person_size_blocks(4.0)
        (3, 8)
    """
    half = WIDTH * blocks_per_metre / 2
    wide = 2 * int(np.ceil(half - 0.5 - 1e-6)) + 1  # In the middle of a block.
    if columns_per_block(blocks_per_metre, 2 * half) > 1:
        wide = min(wide, 2 * int(np.ceil(half - 1e-6)))  # Between two.
    return wide, int(np.ceil(HEIGHT * blocks_per_metre - 1e-6))


def plan_block_house(
    seed: Sequence[int], rooms: int, storeys: int, blocks_per_metre: float
) -> BlockHouse:
    """Generate a house plan with ``rooms`` rooms on ``storeys`` storeys, in blocks."""
    rng = np.random.default_rng([*seed, rooms, storeys])
    plan = plan_house(rooms, storeys, rng)
    gaps = house_gaps(plan, rng)
    scale = blocks_per_metre
    height = max(person_size_blocks(scale)[1] + 1, round(plan.height_m * scale))
    placed = tuple(_room(number, cell, height, scale) for number, cell in enumerate(plan.cells))
    size = max(room.high[0] for room in placed), max(room.high[1] for room in placed)
    cut = tuple(_gap(gap, placed, plan.cells, scale) for gap in gaps)
    grounds = tuple(storey * (height + 2) for storey in range(storeys))
    flight = _flight(plan, placed, height + 2, scale)
    return BlockHouse(plan, gaps, placed, cut, flight, size, grounds, height, scale)


def _walls(low_m: float, high_m: float, scale: float) -> tuple[int, int]:
    """Return the blocks between the walls on both sides of a range, [low, high)."""
    first = int(np.floor((low_m - WALL_M / 2) * scale + 1e-9)) + 1
    last = int(np.floor((high_m + WALL_M / 2) * scale + 1e-9))
    return first, max(last, first + 1)


def _room(number: int, cell: Cell, height: int, scale: float) -> BlockRoom:
    x0, y0, x1, y1 = cell.rect
    across, along = _walls(x0, x1, scale), _walls(y0, y1, scale)
    blocked = []
    for bx0, by0, _, _ in cell.ground.blocks:  # Only a hall has one: beside its bay.
        start = int(np.floor((x0 + bx0 + WALL_M / 2) * scale + 1e-9))
        floor_end = int(np.floor((y0 + by0 + WALL_M / 2) * scale + 1e-9))
        blocked.append((start, floor_end, across[1], along[1]))
    low, high = (across[0], along[0]), (across[1], along[1])
    ground = cell.storey * (height + 2)
    return BlockRoom(number, cell.kind, cell.storey, low, high, ground, height, tuple(blocked))


def _gap(gap: Gap, rooms: tuple[BlockRoom, ...], cells: tuple[Cell, ...], scale: float) -> BlockGap:
    room, cell = rooms[gap.cells[0]], cells[gap.cells[0]]
    across, along = gap.wall.turn % 2, 1 - gap.wall.turn % 2
    inward = 1 if gap.wall.turn < 2 else -1
    at = int(np.floor((gap.wall.at_m - inward * WALL_M / 2) * scale + 1e-9))
    start_m = (cell.x_m, cell.y_m)[along]
    first = room.low[along] + round((gap.first_m - start_m) * scale)
    person = person_size_blocks(scale) if gap.kind != "window" else (1, 1)
    width = max(person[0], round((gap.last_m - gap.first_m) * scale))
    least, most = (
        max(rooms[n].low[along] for n in gap.cells),
        min(rooms[n].high[along] for n in gap.cells),
    )
    if across == 0 and room.blocked and at > room.blocked[0][0]:
        most = min(most, room.blocked[0][1])  # At the end of a corridor, beside the bay.
    first = int(np.clip(first, least, max(least, most - width)))
    low, high = [0, 0], [0, 0]
    low[across], high[across] = at, at + 1
    low[along], high[along] = first, min(first + width, most)
    bottom = 0 if gap.kind != "window" else max(1, round(gap.sill_m * scale))
    top = min(max(person[1], round(gap.head_m * scale)), room.height)
    ground = room.ground
    return BlockGap(
        gap.kind,
        gap.cells,
        gap.wall.turn,
        (low[0], low[1]),
        (high[0], high[1]),
        ground + bottom,
        ground + max(top, bottom + 1),
    )


def _flight(
    plan: HousePlan, rooms: tuple[BlockRoom, ...], pitch: int, scale: float
) -> BlockFlight | None:
    """Return stairs with one block per step that end on the upper floor.

    They start at a row where their opening does not reach the corridor of the upper floor and a
    person can stand at the top.
    """
    if plan.flight is None:
        return None
    x0, _, x1, _ = plan.flight.rect
    hall, (wide, high) = rooms[0], person_size_blocks(scale)
    bay, corridor_end = hall.blocked[0][:2]
    across = max(wide, min(round((x1 - x0) * scale), bay - hall.low[0] - RAIL - wide))
    # Rows from the hole's first to the first step; the rail is a row before the hole.
    ahead = wide - (hall.height - high)
    start = min(corridor_end + RAIL + ahead, hall.high[1] - pitch - wide + 1)
    start = max(start, hall.low[1] + wide)
    return BlockFlight(hall.low[0], hall.low[0] + across, start, pitch, start - ahead)

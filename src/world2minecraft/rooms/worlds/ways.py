"""Ways that stay free: from every door of a room to every other, as wide as a person.

A room's ways are asked before a thing is put: what would shut a door, or close off a good part of
the floor, is not put.
"""

from collections.abc import Sequence

import numpy as np

from world2minecraft.geometry.parts import connected_parts
from world2minecraft.rooms.worlds.house import BlockGap, BlockHouse, BlockRoom

BODY_M, HEAD_M = 0.55, 1.7  # Shoulders are 0.45 m wide; what hangs higher hinders nobody.
KEPT_SHARE = 0.7  # Of the free floor that ways must still reach.


class Ways:
    """Which columns of each room are taken, and whether its ways are free."""

    def __init__(self, house: BlockHouse):
        self.house = house
        self.body = max(1, round(BODY_M * house.blocks_per_metre))
        self.head = max(2, round(HEAD_M * house.blocks_per_metre))
        self.taken = [~room.floor(house.size) for room in house.rooms]
        self.ends: list[list[np.ndarray]] = [[] for _ in house.rooms]
        for gap in house.gaps:
            if gap.kind != "window":
                for number in gap.rooms:
                    self.ends[number].append(_before(gap, house.rooms[number], house.size))

    def close(self, room: BlockRoom, box: tuple[int, int, int, int]) -> None:
        """Take columns [x0, y0, x1, y1) of a room for good, as stairs do."""
        x0, y0, x1, y1 = box
        self.taken[room.number][x0:x1, y0:y1] = True

    def end(self, room: BlockRoom, box: tuple[int, int, int, int]) -> None:
        """Add a place that ways must reach."""
        strip = np.zeros(self.house.size, bool)
        strip[box[0] : box[2], box[1] : box[3]] = True
        self.ends[room.number].append(strip)

    def stands(self, room: BlockRoom, cells: np.ndarray) -> np.ndarray:
        """Return those columns, int [N, 2], of cells [N, 3] of the house that hinder a person."""
        low = cells[:, 2] < room.ground + self.head
        return np.unique(cells[low, :2], axis=0)

    def stay(self, room: BlockRoom, columns: np.ndarray) -> bool:
        """Whether ways stay free when columns, int [N, 2], are taken too."""
        if not len(columns):
            return True
        after = self.taken[room.number].copy()
        after[tuple(columns.T)] = True
        for body in range(self.body, 0, -1):
            now = self._reached(room, after, body)
            if now is not None:
                return bool(now.sum() >= KEPT_SHARE * (~after).sum())
            # Where a plan is too narrow for a person, its ways are kept for somebody thinner.
            if self._reached(room, self.taken[room.number], body) is not None:
                return False
        return False

    def take(self, room: BlockRoom, columns: np.ndarray) -> None:
        """Take columns, int [N, 2]."""
        self.taken[room.number][tuple(columns.T)] = True

    def free(self, room: BlockRoom) -> np.ndarray:
        """Return the columns, bool [X, Y] of the house, that nothing stands on."""
        return ~self.taken[room.number]

    def _reached(self, room: BlockRoom, taken: np.ndarray, body: int) -> np.ndarray | None:
        """Return the floor, bool of the room's box, that a body reaches from all doors, or None."""
        box = (slice(room.low[0], room.high[0]), slice(room.low[1], room.high[1]))
        free = ~taken[box]
        # Places of the body's first corner, then all columns that it covers from there.
        places = _eroded(free, body)
        parts, count = connected_parts(places, corners=False)
        ends = [end[box] for end in self.ends[room.number]]
        for number in range(1, count + 1):
            reached = _grown(parts == number, body)
            if all((reached & end).any() for end in ends) and (ends or reached.any()):
                return reached
        return None


def _eroded(free: np.ndarray, body: int) -> np.ndarray:
    places = free
    for axis in (0, 1):
        padded = np.pad(places, [(0, body - 1) if a == axis else (0, 0) for a in (0, 1)])
        windows = [np.roll(padded, -n, axis) for n in range(body)]
        places = np.logical_and.reduce(windows)[: free.shape[0], : free.shape[1]]
    return places


def _grown(places: np.ndarray, body: int) -> np.ndarray:
    covered = places
    for axis in (0, 1):
        padded = np.pad(covered, [(body - 1, 0) if a == axis else (0, 0) for a in (0, 1)])
        windows = [np.roll(padded, -n, axis) for n in range(body)]
        whole = np.logical_or.reduce(windows)
        covered = whole[: places.shape[0], : places.shape[1]]
    return covered


def _before(gap: BlockGap, room: BlockRoom, size: Sequence[int]) -> np.ndarray:
    """Return the columns of a room right before a gap, bool of the house's size."""
    strip = np.zeros((size[0], size[1]), bool)
    axis = gap.turn % 2
    low, high = list(gap.low), list(gap.high)
    inside = gap.low[axis] < room.low[axis]
    low[axis] = room.low[axis] if inside else room.high[axis] - 1
    if room.blocked and not inside and axis == 1:  # A door above the corridor, beside the bay.
        low[axis] = gap.low[axis] - 1
    high[axis] = low[axis] + 1
    strip[low[0] : high[0], low[1] : high[1]] = True
    return strip

"""Checks that a person can walk between all doors of a room while furniture is placed.

Furniture is not placed if it would block a door or close off a large part of the floor.
"""

import numpy as np

from world2minecraft.geometry.connected_components import label_components
from world2minecraft.procgen.worlds.block_house import (
    BlockGap,
    BlockHouse,
    BlockRoom,
    person_size_blocks,
)

KEPT_SHARE = 0.6  # Of the free floor that ways must still cover,
KEPT_PLACES = 0.95  # and of the places where a person fits that one must still come to.


class ClearPaths:
    """The occupied columns of each room, and checks whether its paths remain clear."""

    def __init__(self, house: BlockHouse):
        self.house = house
        self.body, self.head = person_size_blocks(house.blocks_per_metre)
        self.taken = [~room.floor(house.size) for room in house.rooms]
        # The first corners of places where a person must be able to stand.
        self.ends: list[list[tuple[int, int]]] = [[] for _ in house.rooms]
        for gap in house.gaps:
            if gap.kind != "window":
                for number in gap.rooms:
                    self.end(house.rooms[number], _before(gap, ~self.taken[number], self.body))

    def close(self, room: BlockRoom, box: tuple[int, int, int, int]) -> None:
        """Mark columns [x0, y0, x1, y1) of a room as permanently occupied, such as by stairs."""
        x0, y0, x1, y1 = box
        self.taken[room.number][x0:x1, y0:y1] = True

    def end(self, room: BlockRoom, corner: tuple[int, int]) -> None:
        """Add a place that paths must reach, given by its lowest column, and keep it free."""
        self.ends[room.number].append(corner)

    def stands(self, room: BlockRoom, cells: np.ndarray) -> np.ndarray:
        """Return the columns, int [N, 2], of house cells, int [N, 3], that obstruct a person."""
        low = cells[:, 2] < room.ground + self.head
        return np.unique(cells[low, :2], axis=0)

    def stay(self, room: BlockRoom, columns: np.ndarray) -> bool:
        """Return whether paths remain clear if columns, int [N, 2], become occupied."""
        if not len(columns):
            return True
        box = (slice(room.low[0], room.high[0]), slice(room.low[1], room.high[1]))
        after = self.taken[room.number].copy()
        after[tuple(columns.T)] = True
        free = ~after[box]
        # Places of the body's first corner, then all columns that it covers from there.
        places = _erode(free, self.body)
        reached = self._reached(room, places)
        if reached is None or reached.sum() < KEPT_PLACES * places.sum():
            return False
        return bool(_dilate(reached, self.body).sum() >= KEPT_SHARE * free.sum())

    def take(self, room: BlockRoom, columns: np.ndarray) -> None:
        """Mark columns, int [N, 2], as occupied."""
        self.taken[room.number][tuple(columns.T)] = True

    def free(self, room: BlockRoom) -> np.ndarray:
        """Return which columns of the house are free in a room, as bool [X, Y]."""
        return ~self.taken[room.number]

    def _reached(self, room: BlockRoom, places: np.ndarray) -> np.ndarray | None:
        """Return the places of a room that are connected to all ends, or None."""
        parts, count = label_components(places, corners=False)
        ends = np.array(self.ends[room.number]).reshape(-1, 2) - room.low
        if not count:
            return None
        numbers = np.unique(parts[tuple(ends.T)]) if len(ends) else np.array([_largest(parts)])
        if len(numbers) != 1 or numbers[0] == 0:
            return None
        return parts == numbers[0]


def _largest(parts: np.ndarray) -> int:
    return int(np.bincount(parts[parts > 0]).argmax())


def _erode(free: np.ndarray, body: int) -> np.ndarray:
    places = free
    for axis in (0, 1):
        places = np.logical_and.reduce(_windows(places, body, axis, before=0))
    return places


def _dilate(places: np.ndarray, body: int) -> np.ndarray:
    covered = places
    for axis in (0, 1):
        covered = np.logical_or.reduce(_windows(covered, body, axis, before=body - 1))
    return covered


def _windows(mask: np.ndarray, body: int, axis: int, before: int) -> list[np.ndarray]:
    """Return a mask shifted by 0 to ``body`` - 1 along an axis, with False beyond its ends."""
    size = mask.shape[axis]
    shape = [side + (body - 1) * (a == axis) for a, side in enumerate(mask.shape)]
    padded, rest = np.zeros(shape, bool), (slice(None),) * axis
    padded[(*rest, slice(before, before + size))] = mask
    return [padded[(*rest, slice(n, n + size))] for n in range(body)]


def _before(gap: BlockGap, floor: np.ndarray, body: int) -> tuple[int, int]:
    """Return the lowest column of a person who stands in a room in front of a gap."""
    across, along = gap.turn % 2, 1 - gap.turn % 2
    corner, beyond = [0, 0], [0, 0]
    corner[along] = (gap.low[along] + gap.high[along] - body) // 2
    beyond[along], beyond[across] = corner[along], gap.high[across]
    is_beyond = beyond[across] < floor.shape[across] and floor[tuple(beyond)]
    corner[across] = gap.high[across] if is_beyond else gap.low[across] - body
    return corner[0], corner[1]

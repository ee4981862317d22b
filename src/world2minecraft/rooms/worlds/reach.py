"""Where the game's player comes to on foot: from cell to cell, a jump up, three blocks down.

Conservative: what has any collision box higher than a carpet fills its cell, and one stands on its
top; fences and walls are too high to jump on, and closed doors stay closed.
"""

import numpy as np

from world2minecraft.minecraft.shapes import boxes_of
from world2minecraft.rooms.worlds.house import BlockHouse
from world2minecraft.types import BlockVolume

THIN = 0.2  # Blocks: carpets and snow are walked over.
JUMP = 1.25
DEEPEST = 3  # Blocks that one drops without harm.
SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1))


def standing(volume: BlockVolume) -> tuple[np.ndarray, np.ndarray]:
    """Return where feet may be, and which cells a body passes, bool [X, Y, Z] in block axes."""
    tops = np.array(
        [max((float(box[4]) for box in boxes_of(state)), default=0.0) for state in volume.palette]
    )
    solid = (tops > THIN)[volume.states]
    carries = solid & (tops <= JUMP)[volume.states]
    free = ~solid
    feet = free.copy()
    feet[:, :-1] &= free[:, 1:]
    feet[:, 1:] &= carries[:, :-1]
    feet[:, 0] = False
    return feet, free


def reached(volume: BlockVolume, spawn: tuple[float, float, float]) -> np.ndarray:
    """Return the cells, bool [X, Y, Z] in block axes, that feet come to from a place."""
    feet, free = standing(volume)
    at = tuple(int(np.floor(v)) - c for v, c in zip(spawn, volume.corner, strict=True))
    found = np.zeros_like(feet)
    if not feet[at]:
        return found
    found[at] = True
    lifted = np.zeros_like(free)  # Over these feet there is room to jump.
    lifted[:, :-2] = free[:, 2:]
    frontier = found.copy()
    while frontier.any():
        near = np.zeros_like(found)
        for dx, dz in SIDES:
            near |= _stepped(frontier, 0, dx, dz)
            near |= _stepped(frontier & lifted, 1, dx, dz)
            beside = _stepped(frontier, 0, dx, dz) & free & _stepped(free, -1, 0, 0)
            for _ in range(DEEPEST):
                beside = _stepped(beside, -1, 0, 0) & free
                near |= beside
        frontier = near & feet & ~found
        found |= frontier
    return found


def _stepped(cells: np.ndarray, dy: int, dx: int, dz: int) -> np.ndarray:
    """Return cells moved by some blocks along x, y and z; what leaves the volume is lost."""
    result = np.zeros_like(cells)
    shape = cells.shape
    target, source = [], []
    for size, step in zip(shape, (dx, dy, dz), strict=True):
        target.append(slice(max(step, 0), size + min(step, 0)))
        source.append(slice(max(-step, 0), size + min(-step, 0)))
    result[tuple(target)] = cells[tuple(source)]
    return result


def reached_floors(
    volume: BlockVolume, house: BlockHouse, spawn: tuple[float, float, float]
) -> list[tuple[int, int]]:
    """Return for each room how many places on its floor are reached, and how many there are."""
    feet, _ = standing(volume)
    found = reached(volume, spawn)
    east, up, south = (-value for value in volume.corner)
    counts = []
    for room in house.rooms:
        floor = room.floor(house.size)
        x, y = np.nonzero(floor)
        at = (x + east, np.full(len(x), room.ground + 64 + up), house.size[1] - 1 - y + south)
        counts.append((int(found[at].sum()), int(feet[at].sum())))
    return counts

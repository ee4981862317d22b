"""Block light: what states emit, which let it through, and how it spreads.

Light falls by one for each block it goes, and blocks that fill their whole cube stop it, but for
glass and its like. Facts stand in ``data/light_levels.json``.

``flood_light`` spreads every kind of light from cell to cell. Its arrays are flat views of a grid
with one cell of margin on every side, so that a step never leaves them. ``kinds`` names for each
cell its row in ``words``, which says what light can pass:

- bits 0 to 23: which quarters of its faces are covered, four bits a face in the order -x +x -y +y
  -z +z. A quarter's bit is 2 * (upper half of the first other axis) + (upper half of the second).
  Light passes from cell to cell unless the two faces that touch cover all four quarters together.
- ``SHUT``, all of them: light never enters, but leaves freely, as it does from a glowing block.
- ``DIMS``: light that falls straight down is dimmed by it, as in water.
- ``SOLID``: it darkens corners, and has no light of its own to show. The margin is shut, not solid.
"""

import json
from functools import cache, lru_cache
from importlib.resources import files

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.collision_shapes import is_full_cube
from world2minecraft.minecraft.rules.block_traits import pattern_of

SHUT = 0xFFFFFF
DIMS = 1 << 24
SOLID = 1 << 25
DATA_FILE = "data/light_levels.json"
BRIGHTEST = 15


def neighbour_steps(shape: tuple[int, ...]) -> np.ndarray:
    """Return the six steps -x +x -y +y -z +z in a flat view of a grid, int64 [6]."""
    along = np.array([shape[1] * shape[2], shape[2], 1], np.int64)
    return np.stack([-along, along], axis=1).reshape(-1)


def pad_margin(values: np.ndarray, margin: int) -> np.ndarray:
    """Return values [X, Y, Z] with one cell of ``margin`` on every side, [X + 2, Y + 2, Z + 2]."""
    padded = np.full(tuple(size + 2 for size in values.shape), margin, values.dtype)
    padded[1:-1, 1:-1, 1:-1] = values
    return padded


@njit
def flood_light(light, kinds, words, steps, seeds):
    """Spread light from the cells ``seeds`` (int64 [N]), which have theirs already, in place.

    Cells are raised level by level from the brightest, so that each is raised once.
    """
    first = np.zeros(258, np.int64)
    for seed in seeds:
        first[255 - light[seed] + 1] += 1
    first = np.cumsum(first)
    order, filled = np.empty(len(seeds), np.int64), first.copy()
    for seed in seeds:
        order[filled[255 - light[seed]]] = seed
        filled[255 - light[seed]] += 1
    queue, raised = np.empty(1024, np.int64), np.empty(1024, np.int64)
    count = 0
    for level in range(255, 1, -1):
        seeded = first[255 - level + 1] - first[255 - level]
        room = 6 * (seeded + count)
        if room > len(raised):
            raised = np.empty(2 * room, np.int64)
        found = 0
        for n in range(seeded):
            found = _spread_cell(
                light, kinds, words, steps, order[first[255 - level] + n], level, raised, found
            )
        for n in range(count):
            found = _spread_cell(light, kinds, words, steps, queue[n], level, raised, found)
        queue, raised, count = raised, queue, found


@njit
def _spread_cell(light, kinds, words, steps, cell, level, raised, found):
    """Raise the neighbours of a cell; append them to ``raised``, return how many it holds."""
    if light[cell] != level:  # A seed that was raised by a brighter one.
        return found
    word = words[kinds[cell]]
    if word & SHUT == SHUT:
        word = word ^ SHUT
    for side in range(6):
        near = cell + steps[side]
        if light[near] >= level - 1:
            continue
        if ((word >> (4 * side)) | (words[kinds[near]] >> (4 * (side ^ 1)))) & 15 != 15:
            light[near] = level - 1
            raised[found] = near
            found += 1
    return found


@lru_cache(maxsize=1 << 16)
def emitted_light(state: str) -> int:
    """Return the light that a block state gives, 0 to 15.

    Raises:
        UsageError: the text is no block state.

    Example:
        >>> emitted_light("minecraft:lantern[hanging=true]")
        15
    """
    whole = complete(parse_state(state))
    name, values = whole.name.partition(":")[2], dict(whole.properties)
    if name == "light":
        level = values.get("level", "15")
        return min(int(level), BRIGHTEST) if level.isdecimal() else BRIGHTEST
    for pattern, when, level in _levels():
        if pattern.match(name) and all(values.get(key) == value for key, value in when.items()):
            return level
    return 0


@lru_cache(maxsize=1 << 16)
def lets_light_through(state: str) -> bool:
    """Whether light goes on through a block state: all that fill no whole cube, and glass.

    Raises:
        UsageError: the text is no block state.
    """
    name = parse_state(state).name.partition(":")[2]
    clear, unclear = _patterns()
    if unclear.match(name):
        return False
    return clear.match(name) is not None or not is_full_cube(state)


def spread_light(sources: np.ndarray, clear: np.ndarray) -> np.ndarray:
    """Return the block light everywhere, uint8 [X, Y, Z].

    Args:
        sources: uint8 [X, Y, Z], the light that a block gives itself, 0 to 15.
        clear: bool [X, Y, Z], where light goes through.
    """
    light = pad_margin(sources.astype(np.uint8, copy=False), 0)
    shut = pad_margin(~clear, True).reshape(-1).view(np.uint8)
    words = np.array([0, SHUT], np.uint32)
    seeds = np.flatnonzero(light)
    flood_light(light.reshape(-1), shut, words, neighbour_steps(light.shape), seeds)
    return np.ascontiguousarray(light[1:-1, 1:-1, 1:-1])


def block_light(volume: BlockVolume) -> np.ndarray:
    """Return the block light of a volume, uint8 [X, Y, Z] in block axes."""
    gives = np.array([emitted_light(state) for state in volume.palette], np.uint8)
    clear = np.array([lets_light_through(state) for state in volume.palette], bool)
    return spread_light(gives[volume.states], clear[volume.states])


@cache
def _raw() -> dict:
    return json.loads(files("world2minecraft.minecraft").joinpath(DATA_FILE).read_text("utf-8"))


@cache
def _levels() -> tuple:
    return tuple(
        (pattern_of(entry["blocks"]), entry.get("when", {}), entry["level"])
        for entry in _raw()["levels"]
    )


@cache
def _patterns() -> tuple:
    return pattern_of(_raw()["clear"]), pattern_of(_raw()["unclear"])

"""Block light: the light that blocks emit, the blocks that light passes, and its propagation.

Light decreases by one per block. Blocks that fill their whole cube stop it, except glass and
similar blocks. The light levels are in ``data/light_levels.json``.

``flood_light`` propagates any kind of light from cell to cell. Its arrays are flat views of a grid
with one cell of margin on every side, so that a step never leaves the array. ``kinds`` contains for
each cell a row index into ``words``, whose bits describe how light passes the cell:

- Bits 0 to 23 are the covered quarters of its faces, four bits per face in the order -x +x -y +y -z
  +z. The bit of a quarter is 2 * (upper half of the first other axis) + (upper half of the second
  other axis). Light passes between two cells unless the two touching faces together cover all four
  quarters.
- ``SHUT`` is all of these bits: light never enters but leaves freely, as from a glowing block.
- ``DIMS``: the block dims light that falls straight down, as water does.
- ``SOLID``: the block darkens corners and has no light of its own. The margin is shut but not
  solid.
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
    """Return the six index steps -x +x -y +y -z +z in a flat view of a grid, as int64 [6]."""
    along = np.array([shape[1] * shape[2], shape[2], 1], np.int64)
    return np.stack([-along, along], axis=1).reshape(-1)


def pad_margin(values: np.ndarray, margin: int) -> np.ndarray:
    """Pad values [X, Y, Z] with one cell of ``margin`` on every side to [X + 2, Y + 2, Z + 2]."""
    padded = np.full(tuple(size + 2 for size in values.shape), margin, values.dtype)
    padded[1:-1, 1:-1, 1:-1] = values
    return padded


@njit
def flood_light(light, kinds, words, steps, seeds):
    """Propagate light in place from the seed cells, int64 [N], whose light is already set.

    Cells are processed from the brightest level down, so that each cell is raised only once.
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
    """Raise the light of a cell's neighbours and append them to ``raised``; return its length."""
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
    """Return the light level that a block state emits, 0 to 15.

    Raises:
        UsageError: If the text is not a valid block state.

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
    """Return whether light passes through a block state.

    Light passes through glass and through all blocks that do not fill a whole cube.

    Raises:
        UsageError: If the text is not a valid block state.
    """
    name = parse_state(state).name.partition(":")[2]
    clear, unclear = _patterns()
    if unclear.match(name):
        return False
    return clear.match(name) is not None or not is_full_cube(state)


def spread_light(sources: np.ndarray, clear: np.ndarray) -> np.ndarray:
    """Return the block light of every cell as uint8 [X, Y, Z].

    Args:
        sources: Light level that each block emits, 0 to 15, as uint8 [X, Y, Z].
        clear: Whether light passes through each cell, as bool [X, Y, Z].
    """
    light = pad_margin(sources.astype(np.uint8, copy=False), 0)
    shut = pad_margin(~clear, True).reshape(-1).view(np.uint8)
    words = np.array([0, SHUT], np.uint32)
    seeds = np.flatnonzero(light)
    flood_light(light.reshape(-1), shut, words, neighbour_steps(light.shape), seeds)
    return np.ascontiguousarray(light[1:-1, 1:-1, 1:-1])


def block_light(volume: BlockVolume) -> np.ndarray:
    """Return the block light of a volume as uint8 [X, Y, Z] in block axes."""
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

"""Propagation of sky light and block light in a volume, as in the game.

Sky light is 15 below open sky. Glass lets it pass downward, water and leaves attenuate it, and
elsewhere it loses 1 per step. The volume is surrounded by open air, so light enters from above and
from the sides. Block light starts at the light level of a state. Slabs and stairs block light at
the faces that they cover. A *reach* of r blocks per level uses r finer units for each level, so
that light travels r times as far: in a room of 4 blocks per metre a lamp then lights more than its
own corner.
"""

from fnmatch import fnmatchcase
from functools import lru_cache

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.minecraft.block_states import parse_state
from world2minecraft.minecraft.collision_shapes import boxes_of, is_full_cube
from world2minecraft.minecraft.rules.light import (
    DIMS,
    SHUT,
    SOLID,
    emitted_light,
    flood_light,
    lets_light_through,
    neighbour_steps,
)

# States whose shape holds light back face by face; the game's own list, in its words.
SHAPED = (
    "*_slab", "*_stairs", "snow", "farmland", "dirt_path", "piston", "sticky_piston",
    "piston_head", "end_portal_frame", "enchanting_table", "stonecutter", "lectern",
    "daylight_detector", "sculk_sensor", "calibrated_sculk_sensor", "sculk_shrieker",
)  # fmt: skip
# Whole cubes that light falls through undimmed.
CLEAR_CUBES = ("glass", "*_glass", "barrier", "copper_grate", "*_copper_grate")
WET = ("water", "lava", "kelp", "kelp_plant", "seagrass", "tall_seagrass", "bubble_column")
HIDDEN_LAMP = "minecraft:light"
BRIGHTEST = 15
MAX_REACH = 16.0  # 15 * 16 units just fit a byte.


@lru_cache(maxsize=1 << 16)
def opacity_word(state: str) -> int:
    """Return the light properties of a block state as a word of ``minecraft.rules.light``.

    Raises:
        UsageError: If the text is not a valid block state.
    """
    if not lets_light_through(state):
        return SHUT | SOLID
    parsed = parse_state(state)
    name = parsed.name.partition(":")[2]
    word = 0
    if _matches(name, SHAPED):
        word |= _covers(boxes_of(state))
    wet = name in WET or ("waterlogged", "true") in parsed.properties
    if wet or (is_full_cube(state) and not _matches(name, CLEAR_CUBES)):
        word |= DIMS
    return word


def light_tables(
    palette: tuple[str, ...], hidden_lamps: bool = True
) -> tuple[np.ndarray, np.ndarray]:
    """Return the light tables of a palette, with a row for the margin before those of the states.

    Args:
        palette: Block states.
        hidden_lamps: Whether the game's invisible light blocks emit light.

    Returns:
        The words of ``minecraft.rules.light``, uint32 [P + 1], and the emitted light levels, uint8
        [P + 1], 0 to 15.
    """
    words = [SHUT, *map(opacity_word, palette)]
    gives = [
        0 if state.partition("[")[0] == HIDDEN_LAMP and not hidden_lamps else emitted_light(state)
        for state in palette
    ]
    return np.array(words, np.uint32), np.array([0, *gives], np.uint8)


def _matches(name: str, patterns: tuple[str, ...]) -> bool:
    return any(fnmatchcase(name, pattern) for pattern in patterns)


def _covers(boxes: np.ndarray) -> int:
    """Return which quarters of the six faces a shape's boxes cover."""
    word = 0
    for side in range(6):
        axis, others = side // 2, [n for n in range(3) if n != side // 2]
        for box in boxes:
            touches = box[axis] <= 0 if side % 2 == 0 else box[axis + 3] >= 1
            for quarter in range(4 if touches else 0):
                low = np.array([quarter // 2, quarter % 2]) / 2
                inside = np.all(box[others] <= low) and np.all(box[3:][others] >= low + 0.5)
                word |= int(inside) << (4 * side + quarter)
    return word


def flood_sky(kinds: np.ndarray, words: np.ndarray, reach: float = 1.0) -> np.ndarray:
    """Return sky light with a margin, uint8 [X + 2, Y + 2, Z + 2], in 1 / ``reach`` levels.

    Args:
        kinds: Rows of ``words``, uint16 [X + 2, Y + 2, Z + 2]. The margin has row 0.
        words: Light properties, uint32 [K]; see ``minecraft.rules.light``.
        reach: Blocks per level, from ``rounded_reach``; 1 as in the game.
    """
    top = light_units(BRIGHTEST, reach)
    sky = np.full(kinds.shape, top, np.uint8)
    sky[1:-1, 1:-1, 1:-1] = 0
    steps = neighbour_steps(kinds.shape)
    if sky[1:-1, 1:-1, 1:-1].size:
        _light_from_above(sky, kinds, words, top)
        flat = sky.reshape(-1)
        seeds = _light_from_sides(sky, flat, kinds.reshape(-1), words, steps, top)
        flood_light(flat, kinds.reshape(-1), words, steps, seeds)
    return sky


def flood_block(
    kinds: np.ndarray, words: np.ndarray, gives: np.ndarray, reach: float = 1.0
) -> np.ndarray:
    """Return block light with a dark margin, uint8 [X + 2, Y + 2, Z + 2].

    ``gives`` uint8 [K] is the light level that each state emits. The other arguments are those of
    ``flood_sky``.
    """
    unit = np.array([light_units(level, reach) for level in range(BRIGHTEST + 1)], np.uint8)
    light = unit[gives][kinds]
    flat = light.reshape(-1)
    flood_light(flat, kinds.reshape(-1), words, neighbour_steps(kinds.shape), np.flatnonzero(flat))
    return light


def rounded_reach(reach: float) -> float:
    """Return the nearest reach for which full light is an integer number of units.

    Raises:
        ValueError: If the reach is out of range.
    """
    if not 1 <= reach <= MAX_REACH:
        raise ValueError(f"reach must be 1 to {MAX_REACH:g} blocks per light level, got {reach}")
    return round(BRIGHTEST * reach) / BRIGHTEST


def light_units(level: int, reach: float) -> int:
    """Return a light level in the units of a reach."""
    return int(level * reach + 0.5)


@njit
def falls_into(words, above, cell):
    """Return whether full sky light passes straight down from one kind of cell into another."""
    upper, lower = words[above], words[cell]
    if upper & SHUT == SHUT:  # The margin: it holds nothing back.
        upper = upper ^ SHUT
    return lower & DIMS == 0 and ((upper >> 8) | (lower >> 12)) & 15 != 15


@njit
def _light_from_above(sky, kinds, words, top):
    """Set the cells that the sky lights straight from above to ``top``."""
    size_x, size_y, size_z = sky.shape
    for x in range(1, size_x - 1):
        for y in range(size_y - 2, 0, -1):
            for z in range(1, size_z - 1):
                if sky[x, y + 1, z] == top and falls_into(
                    words, kinds[x, y + 1, z], kinds[x, y, z]
                ):
                    sky[x, y, z] = top


@njit
def enters(words, kind, side):
    """Return whether light enters a kind of cell from open air at one of its sides."""
    return (words[kind] >> (4 * side)) & 15 != 15


@njit
def _light_from_sides(sky, flat, kinds, words, steps, top):
    """Light what the open air at the sides lights; return the cells to spread from, int64 [N]."""
    size_x, size_y, size_z = sky.shape
    seeds, count = np.empty(1024, np.int64), 0
    for x in range(1, size_x - 1):
        for y in range(1, size_y - 1):
            for z in range(1, size_z - 1):
                cell = (x * size_y + y) * size_z + z
                seed = False
                for side in range(6):
                    near = cell + steps[side]
                    if flat[cell] == top:
                        dark = flat[near] < top - 1
                        seed |= dark and words[kinds[near]] & SHUT != SHUT
                    elif kinds[near] == 0 and side != 2 and enters(words, kinds[cell], side):
                        flat[cell] = top - 1
                        seed = True
                if seed:
                    if count == len(seeds):
                        seeds = np.concatenate((seeds, np.empty(count, np.int64)))
                    seeds[count] = cell
                    count += 1
    return seeds[:count]

"""Sky light and block light: what blocks emit, what light passes, and how it spreads in the game.

Light decreases by one per block. Blocks that fill their whole cube stop it, except glass and
similar blocks. The light levels are in ``data/light_levels.json``. Sky light is 15 below open sky.
Glass lets it pass downward, water and leaves attenuate it, and elsewhere it loses 1 per step. A
volume is surrounded by open air, so sky light enters from above and from the sides. Slabs and
stairs block light at the faces that they cover. A *reach* of r blocks per level uses r finer units
for each level, so that light travels r times as far: in a room of 4 blocks per metre a lamp then
lights more than its own corner.

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

from fnmatch import fnmatchcase
from functools import cache, lru_cache

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.collision_shapes import boxes_of, is_full_cube
from world2minecraft.minecraft.data_files import read_data
from world2minecraft.minecraft.rules.block_traits import pattern_of

SHUT = 0xFFFFFF
DIMS = 1 << 24
SOLID = 1 << 25
BRIGHTEST = 15
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
MAX_REACH = 16.0  # 15 * 16 units just fit a byte.


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


@lru_cache(maxsize=1 << 16)
def opacity_word(state: str) -> int:
    """Return the light properties of a block state as a word.

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
        The words, uint32 [P + 1], and the emitted light levels, uint8 [P + 1], 0 to 15.
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
        words: Light properties, uint32 [K].
        reach: Blocks per level, from ``rounded_reach``; 1 as in the game.
    """
    top = light_units(BRIGHTEST, reach)
    sky = np.full(kinds.shape, top, np.uint8)
    sky[1:-1, 1:-1, 1:-1] = 0
    steps = neighbour_steps(kinds.shape)
    if sky[1:-1, 1:-1, 1:-1].size:
        lowest = np.ones((kinds.shape[0], kinds.shape[2]), np.int32)
        _light_from_above(sky, kinds, words, lowest, top)
        flat, flat_kinds = sky.reshape(-1), kinds.reshape(-1)
        seeds = _light_from_sides(sky, flat, flat_kinds, words, steps, lowest, top)
        flood_light(flat, flat_kinds, words, steps, seeds)
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
def _light_from_above(sky, kinds, words, lowest, top):
    """Set the cells that the sky lights straight from above to ``top``.

    ``lowest`` int32 [X + 2, Z + 2] becomes the lowest of them in each column within the margin, and
    ``size_y - 1``, the margin, where there is none.
    """
    size_x, size_y, size_z = sky.shape
    lowest[1:-1, 1:-1] = size_y - 1
    for x in range(1, size_x - 1):
        for y in range(size_y - 2, 0, -1):
            for z in range(1, size_z - 1):
                if lowest[x, z] == y + 1 and falls_into(words, kinds[x, y + 1, z], kinds[x, y, z]):
                    sky[x, y, z] = top
                    lowest[x, z] = y


@njit
def enters(words, kind, side):
    """Return whether light enters a kind of cell from open air at one of its sides."""
    return (words[kind] >> (4 * side)) & 15 != 15


@njit
def _light_from_sides(sky, flat, kinds, words, steps, lowest, top):
    """Light what the open air at the sides lights; return the cells to spread from, int64 [N].

    Of the cells that the sky lights, those spread that have a darker column beside them, and the
    lowest of each column.
    """
    size_x, size_y, size_z = sky.shape
    seeds, count = np.empty(1024, np.int64), 0
    for x in range(1, size_x - 1):
        for z in range(1, size_z - 1):
            low = lowest[x, z]
            beside = max(lowest[x - 1, z], lowest[x + 1, z], lowest[x, z - 1], lowest[x, z + 1])
            first = (x * size_y) * size_z + z
            if count + size_y >= len(seeds):
                seeds = np.concatenate((seeds, np.empty(len(seeds) + size_y, np.int64)))
            for y in range(low, min(max(beside, low + 1), size_y - 1)):
                cell = first + y * size_z
                for side in range(6):
                    near = cell + steps[side]
                    if flat[near] < top - 1 and words[kinds[near]] & SHUT != SHUT:
                        seeds[count] = cell
                        count += 1
                        break
            is_border = x in (1, size_x - 2) or z in (1, size_z - 2)
            for y in range(1 if is_border else max(low - 1, 1), low):
                cell = first + y * size_z
                for side in range(6):
                    near = cell + steps[side]
                    if kinds[near] == 0 and side != 2 and enters(words, kinds[cell], side):
                        flat[cell] = top - 1
                        seeds[count] = cell
                        count += 1
                        break
    return seeds[:count]


@cache
def _raw() -> dict:
    return read_data("light_levels.json")


@cache
def _levels() -> tuple:
    return tuple(
        (pattern_of(entry["blocks"]), entry.get("when", {}), entry["level"])
        for entry in _raw()["levels"]
    )


@cache
def _patterns() -> tuple:
    return pattern_of(_raw()["clear"]), pattern_of(_raw()["unclear"])

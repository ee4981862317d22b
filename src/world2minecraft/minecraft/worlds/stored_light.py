"""Light and heightmaps of the chunks of a volume, as the game stores them.

Map renderers and servers show what is stored. Light levels have 4 bits each: ``SkyLight`` and
``BlockLight`` of a section have 2048 bytes, and the lower half of a byte is the cell with the even
x. Sections without ``BlockLight`` are dark. A section without ``SkyLight`` takes that of the lowest
layer of the section above it, and has full sky light if there is none. Light therefore ends one
section below and one above the sections with blocks.

A heightmap has a height for each column of a chunk: the layers from the bottom of the world to the
top of the highest block that counts, 0 without any. Heights have 9 bits each, in the order z, x,
and since 1.16 none crosses a word boundary.
"""

from collections.abc import Collection, Sequence
from fnmatch import fnmatchcase
from functools import lru_cache

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.minecraft.block_states import parse_state
from world2minecraft.minecraft.collision_shapes import boxes_of
from world2minecraft.minecraft.rules.light import (
    BRIGHTEST,
    WET,
    flood_block,
    flood_sky,
    light_tables,
)
from world2minecraft.minecraft.versions import GameVersion

LIGHT_BYTES = 2048
HEIGHT_BITS, COLUMNS = 9, 256
FIRST_WITHOUT_GAPS = 2529  # 20w17a, of 1.16: no number over two words.
SURFACE, SOLID_FLOOR, MOTION, MOTION_WITHOUT_LEAVES = 1, 2, 4, 8
HEIGHTMAPS = {
    "WORLD_SURFACE": SURFACE,
    "OCEAN_FLOOR": SOLID_FLOOR,
    "MOTION_BLOCKING": MOTION,
    "MOTION_BLOCKING_NO_LEAVES": MOTION_WITHOUT_LEAVES,
}
AIRS = ("air", "cave_air", "void_air")
# A shape blocks motion if its mean side is as that of a trapdoor, or if it is a whole block high.
MIN_MEAN_SIDE = 0.7291666
# Blocks that the game lists apart from this rule, on either side.
ALWAYS_SOLID = (
    "*_sign", "*_pressure_plate", "*_banner", "bamboo", "pointed_dripstone", "chain", "*lantern",
    "cake", "*candle_cake", "*_amethyst_bud", "amethyst_cluster", "turtle_egg", "conduit",
    "dead_*_coral", "dead_*_coral_fan", "dead_*_coral_wall_fan", "sculk_vein",
)  # fmt: skip
NEVER_SOLID = ("snow", "ladder", "azalea", "flowering_azalea", "big_dripleaf", "scaffolding")


@lru_cache(maxsize=1 << 16)
def surface_traits(state: str) -> int:
    """Return in which heightmaps a block state counts, as a sum of the numbers in ``HEIGHTMAPS``.

    Raises:
        UsageError: If the text is not a valid block state.

    Example:
        >>> surface_traits("minecraft:oak_leaves") == SURFACE + SOLID_FLOOR + MOTION
        True
        >>> surface_traits("minecraft:red_carpet") == SURFACE
        True
    """
    parsed = parse_state(state)
    name = parsed.name.partition(":")[2]
    if name in AIRS:
        return 0
    is_solid = blocks_motion(state)
    is_wet = name in WET or ("waterlogged", "true") in parsed.properties
    found = SURFACE + (SOLID_FLOOR if is_solid else 0)
    if is_solid or is_wet:
        found += MOTION if name.endswith("_leaves") else MOTION + MOTION_WITHOUT_LEAVES
    return found


def blocks_motion(state: str) -> bool:
    """Return whether a block state blocks motion in the sense of the heightmaps.

    Raises:
        UsageError: If the text is not a valid block state.
    """
    name = parse_state(state).name.partition(":")[2]
    if any(fnmatchcase(name, pattern) for pattern in NEVER_SOLID):
        return False
    if any(fnmatchcase(name, pattern) for pattern in ALWAYS_SOLID):
        return True
    boxes = boxes_of(state)
    if not len(boxes):
        return False
    sides = boxes[:, 3:].max(axis=0) - boxes[:, :3].min(axis=0)
    return bool(sides.mean() >= MIN_MEAN_SIDE or sides[1] >= 1)


class StoredLight:
    """The light and the heightmaps of a volume in empty surroundings.

    Args:
        states: Blocks as indices of the palette, uint16 [X, Y, Z] in block axes.
        palette: Block states.
        corner: World position of the volume's first cell.
        version: Game version of the world.
    """

    def __init__(
        self,
        states: np.ndarray,
        palette: Sequence[str],
        corner: tuple[int, int, int],
        version: GameVersion,
    ):
        first = np.array(corner) >> 4
        last = (np.array(corner) + states.shape - 1) >> 4
        first[1], last[1] = first[1] - 1, last[1] + 1
        self._first = first
        start = np.array(corner) - 16 * first
        kinds = np.zeros(tuple(16 * (last - first + 1) + 2), np.uint16)
        kinds[1:-1, 1:-1, 1:-1] = 1  # Air.
        inside = tuple(
            slice(1 + at, 1 + at + size) for at, size in zip(start, states.shape, strict=True)
        )
        np.add(states, 1, out=kinds[inside])
        words, gives = light_tables(tuple(palette))
        self._sky = flood_sky(kinds, words)
        self._block = flood_block(kinds, words, gives) if gives.any() else None
        traits = np.array([surface_traits(state) for state in palette], np.uint8)
        found = np.zeros((len(HEIGHTMAPS), states.shape[0], states.shape[2]), np.uint16)
        surface_heights(states, traits, found)
        found[found > 0] += corner[1] - version.min_y
        places = (int(last[0] - first[0] + 1), int(last[2] - first[2] + 1))
        heights = np.zeros((len(HEIGHTMAPS), 16 * places[0], 16 * places[1]), np.uint16)
        x, z = start[0], start[2]
        heights[:, x : x + states.shape[0], z : z + states.shape[2]] = found
        chunks = heights.reshape(len(HEIGHTMAPS), places[0], 16, places[1], 16)
        is_gapless = version.level_data_version >= FIRST_WITHOUT_GAPS
        pack = pack_heights if is_gapless else pack_straddling_heights
        # Of each chunk (x, z), the columns in the order z, x.
        self._heightmaps = pack(chunks.transpose(1, 3, 0, 4, 2).reshape(*places, -1, COLUMNS))

    def heightmaps(self, place: tuple[int, int]) -> dict[str, np.ndarray]:
        """Return the packed heightmaps of the chunk at (x, z) by name, int64."""
        x, z = place[0] - int(self._first[0]), place[1] - int(self._first[2])
        words = self._heightmaps[x, z] if self._holds(place) else 0 * self._heightmaps[0, 0]
        return dict(zip(HEIGHTMAPS, words, strict=True))

    def sections(
        self, place: tuple[int, int], filled: Collection[int]
    ) -> dict[int, dict[str, bytes]]:
        """Return the light tags of a chunk by the y of the section.

        Args:
            place: The chunk's position (x, z) in the world, in chunks.
            filled: The y of the sections with blocks. Air above them has tags only if it is not as
                bright as the open sky.
        """
        found: dict[int, dict[str, bytes]] = {}
        if not self._holds(place):
            return found
        at = 16 * (np.array([place[0], 0, place[1]]) - self._first) + 1
        packed = np.empty(LIGHT_BYTES, np.uint8)
        is_open = True  # Whether all sections above are air with full sky light.
        for level in range((self._sky.shape[1] - 2) // 16 - 1, -1, -1):
            origin = np.array([at[0], 16 * level + 1, at[2]])
            y, tags = level + int(self._first[1]), {}
            if self._block is not None and pack_levels(self._block, origin, packed) != 0:
                tags["BlockLight"] = packed.tobytes()
            level_of_all = pack_levels(self._sky, origin, packed)
            is_open = is_open and level_of_all == BRIGHTEST and y not in filled
            if not is_open:
                tags["SkyLight"] = packed.tobytes()
            if tags:
                found[y] = tags
        return found

    def _holds(self, place: tuple[int, int]) -> bool:
        x, z = place[0] - self._first[0], place[1] - self._first[2]
        size_x, size_z = self._heightmaps.shape[:2]
        return bool(0 <= x < size_x and 0 <= z < size_z)


def pack_heights(heights: np.ndarray) -> np.ndarray:
    """Pack the heights [..., 256] of chunks as since 1.16, seven in a word, int64 [..., 37]."""
    per_word = 64 // HEIGHT_BITS
    count = -(-COLUMNS // per_word)
    padded = np.zeros((*heights.shape[:-1], count * per_word), np.uint64)
    padded[..., :COLUMNS] = heights
    shifts = np.arange(per_word, dtype=np.uint64) * np.uint64(HEIGHT_BITS)
    words = (padded.reshape(*heights.shape[:-1], count, per_word) << shifts).sum(axis=-1)
    return words.astype(np.uint64).view(np.int64)


def pack_straddling_heights(heights: np.ndarray) -> np.ndarray:
    """Pack the heights [..., 256] of chunks as before 1.16, without gaps, int64 [..., 36]."""
    bits = (heights[..., None] >> np.arange(HEIGHT_BITS, dtype=np.uint16)) & np.uint16(1)
    flat = bits.astype(np.uint8).reshape(*heights.shape[:-1], -1)
    return np.packbits(flat, axis=-1, bitorder="little").view("<i8").astype(np.int64)


@njit
def pack_levels(light, origin, out):  # pragma: no cover
    """Pack the light of one section in half bytes.

    Args:
        light: Light levels 0 to 15, uint8 [X, Y, Z].
        origin: Position of the section's first cell in ``light``, int64 [3].
        out: Output, uint8 [2048].

    Returns:
        The level of all cells, or -1 if they differ.
    """
    level = int(light[origin[0], origin[1], origin[2]])
    at = 0
    for y in range(origin[1], origin[1] + 16):
        for z in range(origin[2], origin[2] + 16):
            for x in range(origin[0], origin[0] + 16, 2):
                low, high = light[x, y, z], light[x + 1, y, z]
                out[at] = low | high << 4
                at += 1
                if low != level or high != level:
                    level = -1
    return level


@njit
def surface_heights(states, traits, heights):  # pragma: no cover
    """Set for each column the number of layers up to the highest block that counts.

    Args:
        states: Volume of states, uint16 [X, Y, Z].
        traits: Heightmaps in which each state counts, uint8 [palette], a bit for each.
        heights: Output, uint16 [maps, X, Z], zero on entry.
    """
    size_x, size_y, size_z = states.shape
    for x in range(size_x):
        for y in range(size_y - 1, -1, -1):
            for z in range(size_z):
                counts = traits[states[x, y, z]]
                if counts:
                    for number in range(len(heights)):
                        if counts >> number & 1 and heights[number, x, z] == 0:
                            heights[number, x, z] = y + 1

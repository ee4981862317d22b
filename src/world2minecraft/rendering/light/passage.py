"""What block states are to light: what each gives, and which way it lets light through."""

from fnmatch import fnmatchcase
from functools import lru_cache

import numpy as np

from world2minecraft.minecraft.block_states import parse_state
from world2minecraft.minecraft.collision_shapes import boxes_of, is_full_cube
from world2minecraft.minecraft.rules.flood import DIMS, SHUT, SOLID
from world2minecraft.minecraft.rules.light import lets_light_through, light_of

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


@lru_cache(maxsize=1 << 16)
def word_of(state: str) -> int:
    """Return what ``minecraft.rules.flood`` knows of a block state.

    Raises:
        UsageError: the text is no block state.
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


def light_rows(
    palette: tuple[str, ...], hidden_lamps: bool = True
) -> tuple[np.ndarray, np.ndarray]:
    """Return the tables of a palette, a row for each state after one for the margin.

    Args:
        palette: block states.
        hidden_lamps: whether the game's invisible light blocks shine.

    Returns:
        uint32 [P + 1], the words of ``minecraft.rules.flood``, and uint8 [P + 1], the light that
        each gives, 0 to 15.
    """
    words = [SHUT, *map(word_of, palette)]
    gives = [
        0 if state.partition("[")[0] == HIDDEN_LAMP and not hidden_lamps else light_of(state)
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

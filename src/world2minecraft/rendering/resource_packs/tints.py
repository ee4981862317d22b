"""Tint colours for grey textures: grass, leaves, water, redstone and stems.

The game blends the colours of grass, leaves and water by biome. This program uses the plains biome,
with the pack's own colour maps if it has them.
"""

import re
from collections.abc import Callable, Mapping

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.minecraft.block_states import BlockState

Colour = tuple[int, int, int]
Tint = Colour | None
# sRGB of plains.
PLAINS: Mapping[str, Colour] = {
    "grass": (145, 189, 89),
    "foliage": (119, 171, 47),
    "dry_foliage": (161, 116, 72),
    "birch": (128, 167, 85),
    "spruce": (97, 153, 97),
    "water": (63, 118, 228),
    "lily_pad": (32, 128, 48),
    "attached_stem": (224, 199, 28),
}
# Where plains lie in the colour maps, pixels of 256: by temperature 0.8 and downfall 0.4.
MAP_COLUMN, MAP_ROW = 51, 173
COLOUR_MAPS = ("grass", "foliage", "dry_foliage")
# The first that matches a whole block name counts; mods' blocks are judged by their names too.
_RULES: tuple[tuple[re.Pattern[str], str], ...] = tuple(
    (re.compile(pattern), name)
    for pattern, name in (
        ("birch_leaves", "birch"),
        ("spruce_leaves", "spruce"),
        ("leaf_litter", "dry_foliage"),
        ("lily_pad", "lily_pad"),
        ("attached_(melon|pumpkin)_stem", "attached_stem"),
        (".*_leaves|vine", "foliage"),
        (".*(water|bubble_column).*", "water"),
        (".*(grass|fern|sugar_cane|petals|wildflowers).*|bush", "grass"),
    )
)
_ON_STEMS = ("pink_petals", "wildflowers")  # Their index 0 is the flower, which has its colour.


def checked_tints(
    changes: Mapping[str, Colour] | None, map_colour: Callable[[str, int, int], Tint]
) -> dict[str, Colour]:
    """Return the plains tints, from a pack's colour maps if it has them, with some changes.

    Args:
        changes: sRGB colours 0 to 255 by tint name.
        map_colour: Function from (name of a map, column, row) to its colour, or None without such a
            map.

    Raises:
        UnknownNameError: If a tint name is unknown.
        UsageError: If a colour is invalid.
    """
    tints = dict(PLAINS)
    for name in COLOUR_MAPS:
        tints[name] = map_colour(name, MAP_COLUMN, MAP_ROW) or tints[name]
    for name, colour in (changes or {}).items():
        if name not in PLAINS:
            raise UnknownNameError("tint", name, PLAINS)
        if len(colour) != 3 or not all(0 <= value <= 255 for value in colour):
            raise UsageError(f"tint {name} must be red, green, blue from 0 to 255, got {colour}")
        tints[name] = (int(colour[0]), int(colour[1]), int(colour[2]))
    return tints


def tint_rule(state: BlockState, tints: Mapping[str, Colour]) -> Callable[[int], Tint]:
    """Return the function from a tint index of a state's model to a colour, or None."""
    _, _, block = state.name.partition(":")
    if block == "redstone_wire":
        colour = redstone(_integer(state.get("power")))
        return lambda _: colour
    if block in ("melon_stem", "pumpkin_stem"):
        age = _integer(state.get("age"))
        return lambda _: (age * 32, 255 - age * 8, age * 4)
    name = next((name for pattern, name in _RULES if pattern.fullmatch(block)), None)
    if name is None:
        return lambda _: None
    return lambda index: None if block in _ON_STEMS and index == 0 else tints[name]


def redstone(power: int) -> Colour:
    """Return the colour of redstone dust for a power of 0 to 15.

    Example:
        >>> redstone(15)
        (255, 51, 0)
    """
    share = power / 15
    red = share * 0.6 + (0.4 if power else 0.3)
    green, blue = share * share * 0.7 - 0.5, share * share * 0.6 - 0.7
    return (_byte(red), _byte(green), _byte(blue))


def _byte(value: float) -> int:
    return round(min(max(value, 0.0), 1.0) * 255)


def _integer(text: str) -> int:
    return min(int(text), 15) if text.isdigit() and len(text) < 3 else 0

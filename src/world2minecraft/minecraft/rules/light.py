"""Block light: what states give, which let it through, and how far it goes.

Light falls by one for each block it goes, and blocks that fill their whole cube stop it, but for
glass and its like. Facts stand in ``data/light_levels.json``.
"""

import json
from functools import cache, lru_cache
from importlib.resources import files

import numpy as np

from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.collision_shapes import is_full_cube
from world2minecraft.minecraft.rules.flood import SHUT, spread, steps_of, with_margin
from world2minecraft.minecraft.rules.name_patterns import pattern_of

DATA_FILE = "data/light_levels.json"
BRIGHTEST = 15


@lru_cache(maxsize=1 << 16)
def light_of(state: str) -> int:
    """Return the light that a block state gives, 0 to 15.

    Raises:
        UsageError: the text is no block state.

    Example:
        >>> light_of("minecraft:lantern[hanging=true]")
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
    light = with_margin(sources.astype(np.uint8, copy=False), 0)
    shut = with_margin(~clear, True).reshape(-1).view(np.uint8)
    words = np.array([0, SHUT], np.uint32)
    seeds = np.flatnonzero(light)
    spread(light.reshape(-1), shut, words, steps_of(light.shape), seeds)
    return np.ascontiguousarray(light[1:-1, 1:-1, 1:-1])


def block_light(volume: BlockVolume) -> np.ndarray:
    """Return the block light of a volume, uint8 [X, Y, Z] in block axes."""
    gives = np.array([light_of(state) for state in volume.palette], np.uint8)
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

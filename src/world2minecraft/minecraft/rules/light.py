"""Block light: what states give, which let it through, and how far it goes.

Light falls by one for each block it goes, and blocks that fill their whole cube stop it, but for
glass and its like. Facts stand in ``data/light_levels.json``.
"""

import json
from functools import cache, lru_cache
from importlib.resources import files

import numpy as np

from world2minecraft.jit import njit
from world2minecraft.minecraft.rules.tables import pattern_of
from world2minecraft.minecraft.shapes import is_full_cube
from world2minecraft.minecraft.states import complete, parse_state
from world2minecraft.types import BlockVolume

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
    light = np.ascontiguousarray(sources).astype(np.uint8, copy=True)
    if light.size:
        _spread(light, np.ascontiguousarray(clear))
    return light


def block_light(volume: BlockVolume) -> np.ndarray:
    """Return the block light of a volume, uint8 [X, Y, Z] in block axes."""
    gives = np.array([light_of(state) for state in volume.palette], np.uint8)
    clear = np.array([lets_light_through(state) for state in volume.palette], bool)
    return spread_light(gives[volume.states], clear[volume.states])


@njit
def _spread(light, clear):  # pragma: no cover
    """Spread light in place: a queue for each level, from the brightest down."""
    size_x, size_y, size_z = light.shape
    for level in range(BRIGHTEST, 1, -1):
        queue = np.empty(((light == level).sum(), 3), np.int32)
        count = 0
        for x in range(size_x):
            for y in range(size_y):
                for z in range(size_z):
                    if light[x, y, z] == level:
                        queue[count, 0], queue[count, 1], queue[count, 2] = x, y, z
                        count += 1
        for i in range(count):
            for axis in range(3):
                for step in (-1, 1):
                    x, y, z = queue[i, 0], queue[i, 1], queue[i, 2]
                    if axis == 0:
                        x += step
                    elif axis == 1:
                        y += step
                    else:
                        z += step
                    if x < 0 or y < 0 or z < 0 or x >= size_x or y >= size_y or z >= size_z:
                        continue
                    if clear[x, y, z] and light[x, y, z] < level - 1:
                        light[x, y, z] = level - 1


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

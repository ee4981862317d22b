"""Small random worlds for the tests of light, with what their states hold back written by hand."""

import numpy as np

PALETTE = (
    "minecraft:air",
    "minecraft:stone",
    "minecraft:glass",
    "minecraft:water",
    "minecraft:oak_leaves[persistent=true]",
    "minecraft:oak_slab[type=bottom]",
    "minecraft:oak_slab[type=top]",
    "minecraft:oak_stairs[facing=east,half=bottom]",
    "minecraft:lantern",
    "minecraft:glowstone",
)
_P = frozenset  # Quarters of a face as (first other axis, second), 1 for the upper half.
_FULL = _P({(0, 0), (0, 1), (1, 0), (1, 1)})
_LOW_FIRST, _HIGH_FIRST = _P({(0, 0), (0, 1)}), _P({(1, 0), (1, 1)})
_LOW_SECOND, _HIGH_SECOND = _P({(0, 0), (1, 0)}), _P({(0, 1), (1, 1)})
# By face -x +x -y +y -z +z. The other axes: of x faces y, z; of y faces x, z; of z faces x, y.
SLOW_SHAPES = {
    "minecraft:oak_slab[type=bottom]": {
        0: _LOW_FIRST, 1: _LOW_FIRST, 2: _FULL, 4: _LOW_SECOND, 5: _LOW_SECOND,
    },
    "minecraft:oak_slab[type=top]": {
        0: _HIGH_FIRST, 1: _HIGH_FIRST, 3: _FULL, 4: _HIGH_SECOND, 5: _HIGH_SECOND,
    },
    "minecraft:oak_stairs[facing=east,half=bottom]": {
        0: _LOW_FIRST, 1: _FULL, 2: _FULL, 3: _HIGH_FIRST,
        4: _LOW_SECOND | _HIGH_FIRST, 5: _LOW_SECOND | _HIGH_FIRST,
    },
}  # fmt: skip


def random_world(seed: int, most: int = 7) -> np.ndarray:
    """Return uint16 [X, Y, Z] of rows of ``PALETTE``: half air, some of everything."""
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(2, most, 3))
    states = rng.integers(0, len(PALETTE), shape)
    states[rng.random(shape) < 0.3] = 0
    states[rng.random(shape) < 0.25] = 1
    return states.astype(np.uint16)

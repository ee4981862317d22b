"""How the conditions of a rule are found, one function each, from a volume's zones and kinds."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from scipy import ndimage

from world2minecraft.minecraftocc.block_map.rooms import next_above

if TYPE_CHECKING:
    from world2minecraft.minecraftocc.block_map.context import Context

UNDER_M = 0.5  # How thick a floor is, and what goes on of a wall beside it.
ROOF_M, SKY_M, WIDE_M = 3.0, 1.8, 1.5
SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1))


def shifted(values: np.ndarray, x: int, y: int, z: int) -> np.ndarray:
    """Return the values of the blocks at an offset; beyond the volume there is nothing, 0."""
    result = np.zeros_like(values)
    cuts = [_overlap(*pair) for pair in zip((x, y, z), values.shape, strict=True)]
    result[tuple(ours for ours, _ in cuts)] = values[tuple(theirs for _, theirs in cuts)]
    return result


def _overlap(step: int, side: int) -> tuple[slice, slice]:
    low, high = min(max(0, -step), side), min(max(0, step), side)
    return slice(low, side - high), slice(high, side - low)


def _air_above(context: "Context") -> np.ndarray:
    return ~shifted(context.filled, 0, 1, 0)


def _air_below(context: "Context") -> np.ndarray:
    below = ~shifted(context.filled, 0, -1, 0)
    below[:, 0] = False
    return below


def _on_floor(context: "Context") -> np.ndarray:
    return shifted(context.condition("floor"), 0, -1, 0)


def _at_wall(context: "Context") -> np.ndarray:
    wall = context.condition("wall")
    return np.any([shifted(wall, x, 0, z) for x, z in SIDES], axis=0)


def _under_ceiling(context: "Context") -> np.ndarray:
    """Blocks that hang: a gapless column of blocks over them ends at a ceiling."""
    above = context.condition("ceiling") & context.building
    hangs, layers = np.zeros_like(above), above.shape[1]
    for layer in range(layers - 2, -1, -1):
        held = above[:, layer + 1] | hangs[:, layer + 1]
        hangs[:, layer] = held & context.filled[:, layer] & ~above[:, layer]
    return hangs


def _beside_own(context: "Context", rises: tuple[int, ...]) -> np.ndarray:
    """Return where a block of the same kind lies beside, so much higher or lower."""
    kinds = context.kinds
    steps = [(x, rise, z) for x, z in SIDES for rise in rises]
    near = [shifted(kinds, *step) == kinds for step in steps]
    return context.filled & np.any(near, axis=0)


def _under_floor(context: "Context") -> np.ndarray:
    reach = max(1, round(UNDER_M * context.scale))
    floor, result = context.condition("floor"), np.zeros(context.filled.shape, bool)
    below = context.condition("outside") & context.building
    here = floor
    for _ in range(reach):
        here = shifted(here, 0, 1, 0) & below
        result |= here
    return result


def _wall_line(context: "Context") -> np.ndarray:
    """Return where a wall goes on: at the height of a ceiling or of the floor over it."""
    reach = max(1, round(UNDER_M * context.scale))
    wall, outside = context.condition("wall"), context.condition("outside") & context.building
    result = np.zeros_like(wall)
    for up in (1, -1):
        here = wall
        for _ in range(reach):
            here = shifted(here, 0, up, 0) & outside
            result |= here
    return result


def _over_ceiling(context: "Context") -> np.ndarray:
    reach = max(2, round(ROOF_M * context.scale))
    ceiling = context.condition("ceiling")
    near = np.zeros_like(ceiling)
    for up in range(1, reach + 1):
        near |= shifted(ceiling, 0, -up, 0)
    wide = ndimage.binary_dilation(
        near, np.ones((3, 1, 3)), iterations=max(1, round(context.scale))
    )
    return np.asarray(wide) & context.condition("outside")


def _open_floor(context: "Context") -> np.ndarray:
    layers = np.arange(context.filled.shape[1])[None, :, None]
    head = max(2, round(SKY_M * context.scale))
    stands = context.building & (next_above(context.building) - layers > head)
    side = max(2, round(WIDE_M * context.scale))
    wide = ndimage.binary_opening(stands, np.ones((side, 1, side)))
    return np.asarray(wide) & context.condition("outside")


MAKERS: dict[str, Callable[["Context"], np.ndarray]] = {
    "under_floor": _under_floor,
    "wall_line": _wall_line,
    "over_ceiling": _over_ceiling,
    "open_floor": _open_floor,
    "air_above": _air_above,
    "air_below": _air_below,
    "on_floor": _on_floor,
    "at_wall": _at_wall,
    "under_ceiling": _under_ceiling,
    "in_row": lambda context: _beside_own(context, (0,)),
    "climbs": lambda context: _beside_own(context, (1, -1)),
}

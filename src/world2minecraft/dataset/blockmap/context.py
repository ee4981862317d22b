"""Where a block is: the conditions and measures of ``conditions``, found when they are asked for."""

from collections.abc import Callable

import numpy as np
from scipy import ndimage

from world2minecraft.dataset.blockmap.conditions import NEIGHBOURS
from world2minecraft.dataset.blockmap.rules import Rule, Span
from world2minecraft.dataset.blockmap.storeys import (
    CEILING,
    FLOOR,
    INSIDE,
    OUTSIDE,
    WALL,
    next_above,
    zones_of,
)
from world2minecraft.dataset.blockmap.things import shares_of, things_of

COARSE = 2.0  # Blocks per metre under which a chair is one block.
UNDER_M, ROOF_M, SKY_M = 0.5, 3.0, 2.0
ZONES = {"outside": OUTSIDE, "floor": FLOOR, "ceiling": CEILING, "wall": WALL, "inside": INSIDE}


class Context:
    """The surroundings of every block of a volume.

    Args:
        kinds: int [X, Y, Z], a number for each block's class or kind; 0 is air.
        names: the name of each number.
        structure: the kinds that floors, walls and ceilings can be of.
        apart: what is no part of the things that it touches.
        blocks: int [X, Y, Z], a number for each block's id.
        turned: bool [X, Y, Z], blocks that are upside down.
        scale: blocks per metre.
    """

    def __init__(
        self,
        kinds: np.ndarray,
        names: tuple[str, ...],
        structure: frozenset[str],
        apart: frozenset[str],
        blocks: np.ndarray,
        turned: np.ndarray,
        scale: float,
    ):
        self.kinds, self.names, self.scale = kinds, names, scale
        self.filled = ~np.isin(kinds, self._numbers(("empty",)))
        self.building = np.isin(kinds, self._numbers(structure))
        self.zones = zones_of(self.building, scale)
        held = self.filled & (self.zones.zone == INSIDE) & ~np.isin(kinds, self._numbers(apart))
        self.things = things_of(held, blocks, self.zones.ground, scale)
        self._found: dict[str, np.ndarray] = {
            "turned": turned,
            "coarse": np.full(kinds.shape, scale < COARSE),
        }

    def holds(self, rule: Rule, at: np.ndarray) -> np.ndarray:
        """Return whether a rule holds at blocks given by flat indices, bool [N]."""
        result = np.ones(len(at), bool)
        for name in rule.where:
            truth = self.condition(name.removeprefix("not ")).ravel()[at]
            result &= ~truth if name.startswith("not ") else truth
        if rule.spans or rule.shares:
            parts = self.things.parts.ravel()[at]
            result &= parts > 0
            for name, span in rule.spans.items():
                result &= _within(self.things.measures[name], span)[parts]
            for name, span in rule.shares.items():
                own = np.isin(self.kinds, self._numbers((name,)))
                result &= _within(shares_of(self.things.parts, own), span)[parts]
        return result

    def condition(self, name: str) -> np.ndarray:
        """Return where a condition holds, bool [X, Y, Z]."""
        if name in ZONES:
            return self.zones.zone == ZONES[name]
        if name not in self._found:
            side, _, other = name.partition(" ")
            if other:
                own = np.isin(self.kinds, self._numbers((other,)))
                self._found[name] = _shifted(own, *NEIGHBOURS[side])
            else:
                self._found[name] = _MAKERS[name](self)
        return self._found[name]

    def _numbers(self, names: frozenset[str] | tuple[str, ...]) -> np.ndarray:
        return np.array([n for n, name in enumerate(self.names) if name in names], np.int64)


def _within(values: np.ndarray, span: Span) -> np.ndarray:
    return (values >= span[0] - 1e-9) & (values <= span[1] + 1e-9)


def _shifted(mask: np.ndarray, x: int, y: int, z: int) -> np.ndarray:
    """Return where the block at an offset holds; beyond the volume nothing does."""
    result = np.zeros_like(mask)
    ours, theirs = [], []
    for step, side in zip((x, y, z), mask.shape, strict=True):
        ours.append(slice(max(0, -step), side - max(0, step)))
        theirs.append(slice(max(0, step), side + min(0, step)))
    result[tuple(ours)] = mask[tuple(theirs)]
    return result


SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1))


def _air_above(context: Context) -> np.ndarray:
    return ~_shifted(context.filled, 0, 1, 0)


def _air_below(context: Context) -> np.ndarray:
    below = ~_shifted(context.filled, 0, -1, 0)
    below[:, 0] = False
    return below


def _on_floor(context: Context) -> np.ndarray:
    return _shifted(context.condition("floor"), 0, -1, 0)


def _at_wall(context: Context) -> np.ndarray:
    wall = context.condition("wall")
    return np.any([_shifted(wall, x, 0, z) for x, z in SIDES], axis=0)


def _under_ceiling(context: Context) -> np.ndarray:
    """Blocks that hang: a gapless column of blocks over them ends at a ceiling."""
    hangs = np.zeros(context.filled.shape, bool)
    above = context.condition("ceiling") & context.building
    for layer in range(hangs.shape[1] - 2, -1, -1):
        held = above[:, layer + 1] | hangs[:, layer + 1]
        hangs[:, layer] = held & context.filled[:, layer] & ~above[:, layer]
    return hangs


def _beside_own(context: Context, rises: tuple[int, ...]) -> np.ndarray:
    result = np.zeros(context.kinds.shape, bool)
    for number in np.unique(context.kinds).tolist():
        own = context.kinds == number
        for x, z in SIDES if number else ():
            for rise in rises:
                result |= own & _shifted(own, x, rise, z)
    return result


def _under_floor(context: Context) -> np.ndarray:
    reach = max(1, round(UNDER_M * context.scale))
    floor, result = context.condition("floor"), np.zeros(context.filled.shape, bool)
    below = context.condition("outside") & context.building
    here = floor
    for _ in range(reach):
        here = _shifted(here, 0, 1, 0) & below
        result |= here
    return result


def _wall_line(context: Context) -> np.ndarray:
    """Return where a wall goes on: at the height of a ceiling or of the floor over it."""
    reach = max(1, round(UNDER_M * context.scale))
    wall, outside = context.condition("wall"), context.condition("outside") & context.building
    result = np.zeros_like(wall)
    for up in (1, -1):
        here = wall
        for _ in range(reach):
            here = _shifted(here, 0, up, 0) & outside
            result |= here
    return result


def _over_ceiling(context: Context) -> np.ndarray:
    reach = max(2, round(ROOF_M * context.scale))
    ceiling = context.condition("ceiling")
    near = np.zeros_like(ceiling)
    for up in range(1, reach + 1):
        near |= _shifted(ceiling, 0, -up, 0)
    wide = ndimage.binary_dilation(
        near, np.ones((3, 1, 3)), iterations=max(1, round(context.scale))
    )
    return np.asarray(wide) & context.condition("outside")


def _covers_ground(context: Context) -> np.ndarray:
    layers = np.arange(context.filled.shape[1])[None, :, None]
    sky = next_above(context.building) - layers > SKY_M * context.scale
    under = _shifted(context.building, 0, -1, 0)
    under[:, 0] = True
    return context.condition("outside") & sky & under & ~_over_ceiling(context)


_MAKERS: dict[str, Callable[[Context], np.ndarray]] = {
    "under_floor": _under_floor,
    "wall_line": _wall_line,
    "over_ceiling": _over_ceiling,
    "covers_ground": _covers_ground,
    "air_above": _air_above,
    "air_below": _air_below,
    "on_floor": _on_floor,
    "at_wall": _at_wall,
    "under_ceiling": _under_ceiling,
    "in_row": lambda context: _beside_own(context, (0,)),
    "climbs": lambda context: _beside_own(context, (1, -1)),
}

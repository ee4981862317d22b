"""Where a block is: the conditions and measures of ``conditions``, found when asked for."""

import numpy as np

from world2minecraft.minecraftocc.block_map.conditions import NEIGHBOURS
from world2minecraft.minecraftocc.block_map.pieces import pieces_of
from world2minecraft.minecraftocc.block_map.rooms import (
    CEILING,
    FLOOR,
    INSIDE,
    OUTSIDE,
    WALL,
    zones_of,
)
from world2minecraft.minecraftocc.block_map.rules import BlockMap, Rule, Span
from world2minecraft.minecraftocc.block_map.surroundings import MAKERS, shifted
from world2minecraft.minecraftocc.block_map.things import measured, shares_of

COARSE = 2.0  # Blocks per metre under which a chair is one block.
ZONES = {"outside": OUTSIDE, "floor": FLOOR, "ceiling": CEILING, "wall": WALL, "inside": INSIDE}


class Context:
    """The surroundings of every block of a volume.

    Args:
        kinds: int [X, Y, Z], a number for each block's class or kind; 0 is air.
        names: the name of each number.
        rules: the map that says what structure, curtains and pictures are of.
        blocks: int [X, Y, Z], a number for each block's id.
        turned: bool [X, Y, Z], blocks that are upside down.
        scale: blocks per metre.
    """

    def __init__(
        self,
        kinds: np.ndarray,
        names: tuple[str, ...],
        rules: BlockMap,
        blocks: np.ndarray,
        turned: np.ndarray,
        scale: float,
    ):
        self.kinds, self.names, self.scale = kinds, names, scale
        self.filled = ~self._are(("empty",))[kinds]
        self.building = self._are(rules.structure)[kinds]
        self.zones = zones_of(self.building, scale)
        ground = self.zones.ground
        held = self.filled & (self.zones.zone == INSIDE) & ~self._are(rules.apart)[kinds]
        sheets, plates = self._are(rules.sheets)[kinds], self._are(rules.plates)[kinds]
        pieces = pieces_of(held, blocks, sheets, plates, ground, scale)
        self.things = measured(*pieces, ground, scale)
        self.shares = shares_of(self.things.parts, kinds, len(names))
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
                own = name == "at_m"
                result &= (
                    _within(self._at_m(at), span) if own else self._of_things(name, span)[parts]
                )
            for name, span in rule.shares.items():
                share = self.shares[:, self._are((name,))].sum(1)
                result &= _within(share, span)[parts]
        return result

    def _of_things(self, name: str, span: Span) -> np.ndarray:
        return _within(self.things.measures[name], span)

    def _at_m(self, at: np.ndarray) -> np.ndarray:
        """Return how high over their floor blocks stand, in metres."""
        layer = np.unravel_index(at, self.kinds.shape)[1]
        return (layer - self.zones.ground.ravel()[at] - 1) / self.scale

    def condition(self, name: str) -> np.ndarray:
        """Return where a condition holds, bool [X, Y, Z]."""
        if name in ZONES:
            return self.zones.zone == ZONES[name]
        if name not in self._found:
            side, _, other = name.partition(" ")
            if other:
                own = self._are((other,))[self.kinds]
                self._found[name] = shifted(own, *NEIGHBOURS[side])
            else:
                self._found[name] = MAKERS[name](self)
        return self._found[name]

    def _are(self, names: frozenset[str] | tuple[str, ...]) -> np.ndarray:
        """Return which kinds are among names, bool [kinds]."""
        return np.array([name in names for name in self.names])


def _within(values: np.ndarray, span: Span) -> np.ndarray:
    return (values >= span[0] - 1e-9) & (values <= span[1] + 1e-9)

"""The light of one volume: sky light, block light and the lattice that pictures read."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.minecraft.rules.flood import with_margin
from world2minecraft.rendering.light.flood import flood_block, flood_sky, whole_reach
from world2minecraft.rendering.light.lattice import fill_lattice, quarters
from world2minecraft.rendering.light.passage import light_rows

MOST_STATES = 65_535


@dataclass(eq=False)
class LightField:
    """Light of a volume, kept up to date by ``relight.edit_light``.

    Arrays in the grid have one cell of open air around them: cell (x, y, z) is at [x + 1, y + 1,
    z + 1]. Light counts in 1 / ``reach`` levels.
    """

    kinds: np.ndarray  # uint16 [X + 2, Y + 2, Z + 2]: 1 + the state's index, 0 around the volume
    words: np.ndarray  # uint32 [P + 1], see minecraft.rules.flood
    gives: np.ndarray  # uint8 [P + 1], levels
    sky: np.ndarray  # uint8 [X + 2, Y + 2, Z + 2]
    block: np.ndarray  # uint8 [X + 2, Y + 2, Z + 2]
    lattice: np.ndarray  # uint16 [3, X + 2, Y + 2, Z + 2], see render.light.lattice
    reach: float = 1.0
    hidden_lamps: bool = True

    @property
    def sky_light(self) -> np.ndarray:
        """Sky light without the margin, a view of uint8 [X, Y, Z]."""
        return self.sky[1:-1, 1:-1, 1:-1]

    @property
    def block_light(self) -> np.ndarray:
        """Block light without the margin, a view of uint8 [X, Y, Z]."""
        return self.block[1:-1, 1:-1, 1:-1]


def light_field(
    states: np.ndarray,
    palette: tuple[str, ...],
    reach: float = 1.0,
    *,
    hidden_lamps: bool = True,
) -> LightField:
    """Return the light of a volume.

    Args:
        states: uint16 [X, Y, Z], indices of ``palette``.
        palette: block states.
        reach: how many blocks light goes for each level that it loses, 1 to 16, to a fifteenth;
            1 is the game's.
        hidden_lamps: whether the game's invisible light blocks shine. A room that is full of them,
            so that no monsters come, looks natural by its windows and lamps alone.

    Raises:
        ValueError: the reach is out of range, or the palette has over 65,535 states.
    """
    if len(palette) > MOST_STATES:
        raise ValueError(f"a palette may have {MOST_STATES:,} states, not {len(palette):,}")
    reach = whole_reach(reach)
    words, gives = light_rows(palette, hidden_lamps)
    kinds = with_margin(states.astype(np.uint16) + np.uint16(1), 0)
    sky = flood_sky(kinds, words, reach)
    block = flood_block(kinds, words, gives, reach)
    lattice = np.zeros((3, *kinds.shape), np.uint16)
    low, high = np.zeros(3, np.int64), np.array(kinds.shape, np.int64)
    fill_lattice(lattice, sky, block, kinds, words, quarters(reach), low, high)
    return LightField(kinds, words, gives, sky, block, lattice, reach, hidden_lamps)

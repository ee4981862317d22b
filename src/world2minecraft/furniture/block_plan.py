"""A plan on which a family lays the blocks of a design, looking east: +x is the front.

A cell is (front-to-back, side, up): i counts from the back, j from the right (south) side, k from
the bottom. The sides are ``back`` (west), ``front`` (east), ``right`` (south) and ``left`` (north).
Stairs face their high side; the panel of an open trapdoor lies on the side opposite to its facing.
"""

from collections.abc import Iterable, Sequence
from itertools import product
from typing import Literal

from world2minecraft.furniture.template import BlockSize, LocalBlock
from world2minecraft.furniture.template_parameters import Look

Cell = tuple[int, int, int]
Side = Literal["back", "front", "right", "left"]
Numbers = int | Sequence[int]

FACING: dict[Side, str] = {"back": "west", "front": "east", "right": "south", "left": "north"}
OPPOSITE: dict[Side, Side] = {
    "back": "front",
    "front": "back",
    "right": "left",
    "left": "right",
}


class Plan:
    """The blocks of one design; what is laid later takes the place of what was laid before."""

    def __init__(self, size: BlockSize, look: Look):
        self.size, self.look = size, look
        self._blocks: dict[Cell, LocalBlock] = {}

    @property
    def blocks(self) -> list[LocalBlock]:
        """The blocks in the order of their cells."""
        return [self._blocks[cell] for cell in sorted(self._blocks)]

    @property
    def depth(self) -> range:
        """All i, from back to front."""
        return range(self.size.depth)

    @property
    def width(self) -> range:
        """All j, from right to left."""
        return range(self.size.width)

    @property
    def height(self) -> range:
        """All k, from the bottom up."""
        return range(self.size.height)

    @property
    def corners(self) -> list[tuple[int, int]]:
        """The corners (i, j) of the footprint, each once."""
        ends = ((0, self.size.depth - 1), (0, self.size.width - 1))
        return sorted(set(product(*ends)))

    def layers(self, metres: float) -> int:
        """Return how many whole blocks come nearest to a length in metres."""
        return int(metres * self.size.per_metre + 0.5)

    def held(self, cell: Cell) -> bool:
        """Whether a block lies there already."""
        return cell in self._blocks

    def put(
        self, role: str, i: Numbers, j: Numbers, k: Numbers, shape: str = "full", **properties: str
    ) -> None:
        """Lay one shape of a role's material over every cell of i x j x k."""
        self.put_state(role, self.look.state(role, shape, **properties), i, j, k)

    def put_state(self, role: str, state: str, i: Numbers, j: Numbers, k: Numbers) -> None:
        """Lay a state, such as ``minecraft:lantern[hanging=true]``, over every cell."""
        for cell in product(_listed(i), _listed(j), _listed(k)):
            self._blocks[cell] = LocalBlock(cell, state, role)

    def drop(self, i: Numbers, j: Numbers, k: Numbers) -> None:
        """Take away what lies in the cells."""
        for cell in product(_listed(i), _listed(j), _listed(k)):
            self._blocks.pop(cell, None)

    def stairs(
        self,
        role: str,
        i: Numbers,
        j: Numbers,
        k: Numbers,
        high: Side,
        half: Literal["bottom", "top"] = "bottom",
    ) -> None:
        """Lay stairs whose high side is ``high``; upside down with ``half`` top."""
        self.put(role, i, j, k, "stairs", facing=FACING[high], half=half)

    def slab(
        self,
        role: str,
        i: Numbers,
        j: Numbers,
        k: Numbers,
        half: Literal["bottom", "top"] = "bottom",
    ) -> None:
        """Lay slabs in a half of the cells."""
        self.put(role, i, j, k, "slab", type=half)

    def panel(self, role: str, i: Numbers, j: Numbers, k: Numbers, side: Side) -> None:
        """Stand open trapdoors at one side of the cells."""
        self.put(role, i, j, k, "trapdoor", **panel_properties(side))

    def plate(self, role: str, i: Numbers, j: Numbers, k: Numbers, half: str = "top") -> None:
        """Lay closed trapdoors, a plate three sixteenths thick, in a half of the cells."""
        self.put(role, i, j, k, "trapdoor", facing="east", half=half, open="false")


def panel_properties(side: Side) -> dict[str, str]:
    """Return the properties of an open trapdoor whose panel stands at ``side``."""
    return {"facing": FACING[OPPOSITE[side]], "half": "bottom", "open": "true"}


def _listed(numbers: Numbers) -> Iterable[int]:
    return (numbers,) if isinstance(numbers, int) else numbers

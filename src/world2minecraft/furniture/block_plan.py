"""A plan on which a family places the blocks of a design that faces east (+x).

A cell is (front-to-back, side, up): i counts from the back, j from the right (south) side, k from
the bottom. The sides are ``back`` (west), ``front`` (east), ``right`` (south) and ``left`` (north).
Stairs face their high side. The panel of an open trapdoor is on the side opposite to its facing.
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
    """The blocks of a design, in which later blocks replace earlier ones."""

    def __init__(self, size: BlockSize, look: Look):
        self.size, self.look = size, look
        self._blocks: dict[Cell, LocalBlock] = {}

    @property
    def blocks(self) -> list[LocalBlock]:
        """The blocks in the order of their cells."""
        return [self._blocks[cell] for cell in sorted(self._blocks)]

    @property
    def depth(self) -> range:
        """All indices i, from back to front."""
        return range(self.size.depth)

    @property
    def width(self) -> range:
        """All indices j, from right to left."""
        return range(self.size.width)

    @property
    def height(self) -> range:
        """All indices k, from bottom to top."""
        return range(self.size.height)

    @property
    def corners(self) -> list[tuple[int, int]]:
        """The corners (i, j) of the footprint, without duplicates."""
        ends = ((0, self.size.depth - 1), (0, self.size.width - 1))
        return sorted(set(product(*ends)))

    @property
    def middle(self) -> list[tuple[int, int]]:
        """The cells (i, j) around the middle of the footprint: one, two or four."""
        along = {(self.size.depth - 1) // 2, self.size.depth // 2}
        across = {(self.size.width - 1) // 2, self.size.width // 2}
        return sorted(product(along, across))

    def layers(self, metres: float) -> int:
        """Return a length in metres as the nearest whole number of blocks."""
        return int(metres * self.size.per_metre + 0.5)

    def held(self, cell: Cell) -> bool:
        """Return whether a cell already has a block."""
        return cell in self._blocks

    def put(
        self, role: str, i: Numbers, j: Numbers, k: Numbers, shape: str = "full", **properties: str
    ) -> None:
        """Place a shape of a role's material in all cells of i x j x k."""
        self.put_state(role, self.look.state(role, shape, **properties), i, j, k)

    def put_state(self, role: str, state: str, i: Numbers, j: Numbers, k: Numbers) -> None:
        """Place a block state, such as ``minecraft:lantern[hanging=true]``, in all cells."""
        for cell in product(_listed(i), _listed(j), _listed(k)):
            self._blocks[cell] = LocalBlock(cell, state, role)

    def drop(self, i: Numbers, j: Numbers, k: Numbers) -> None:
        """Remove the blocks in the cells."""
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
        """Place stairs with ``high`` as their high side, upside down if ``half`` is top."""
        self.put(role, i, j, k, "stairs", facing=FACING[high], half=half)

    def slab(
        self,
        role: str,
        i: Numbers,
        j: Numbers,
        k: Numbers,
        half: Literal["bottom", "top"] = "bottom",
    ) -> None:
        """Place slabs in one half of the cells."""
        self.put(role, i, j, k, "slab", type=half)

    def panel(self, role: str, i: Numbers, j: Numbers, k: Numbers, side: Side) -> None:
        """Place open trapdoors upright at one side of the cells."""
        self.put(role, i, j, k, "trapdoor", **panel_properties(side))

    def plate(self, role: str, i: Numbers, j: Numbers, k: Numbers, half: str = "top") -> None:
        """Place closed trapdoors, three sixteenths thick, in one half of the cells."""
        self.put(role, i, j, k, "trapdoor", facing="east", half=half, open="false")


def panel_properties(side: Side) -> dict[str, str]:
    """Return the properties of an open trapdoor whose panel is at ``side``."""
    return {"facing": FACING[OPPOSITE[side]], "half": "bottom", "open": "true"}


def _listed(numbers: Numbers) -> Iterable[int]:
    return (numbers,) if isinstance(numbers, int) else numbers

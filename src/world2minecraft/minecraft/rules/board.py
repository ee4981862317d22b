"""A volume of block states while rules change it by looking at neighbours.

Directions are those of ``supports``: north, east, south, west, up, down.
"""

from collections.abc import Callable, Iterable

import numpy as np

from world2minecraft.core.errors import LimitError
from world2minecraft.core.types import AIR
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.rules.supports import STEPS
from world2minecraft.minecraft.rules.traits import traits_of

MOST_STATES = 1 << 16  # A volume's states are uint16.
_NONE = np.empty(0, np.int32)


class Board:
    """A volume with a rim of air around it, whose states are changed by kind.

    Cells are numbers into ``flat``, the volume with its rim in C order.
    """

    def __init__(self, states: np.ndarray, palette: Iterable[str]):
        self.palette = list(palette)
        self._ids = {state: number for number, state in reversed([*enumerate(self.palette)])}
        self._columns: dict[str, np.ndarray] = {}
        self._blocks: dict[str, int] = {}
        self.shape = tuple(side + 2 for side in states.shape)
        padded = np.full(self.shape, self.id_of(AIR), np.uint16)
        padded[1:-1, 1:-1, 1:-1] = states
        self.flat = padded.ravel()
        strides = np.array([self.shape[1] * self.shape[2], self.shape[2], 1])
        self.steps = np.array(STEPS) @ strides
        kinds = self.column("kind").astype(np.uint8)
        # Rules change the properties of blocks and never their kinds, so one look is enough.
        self._cells = np.flatnonzero((kinds > 0)[self.flat]) if kinds.any() else np.empty(0, int)
        self._kinds = kinds[self.flat[self._cells]]

    def result(self) -> tuple[np.ndarray, tuple[str, ...]]:
        """Return the states without the rim, uint16 [X, Y, Z], and the palette."""
        inner = self.flat.reshape(self.shape)[1:-1, 1:-1, 1:-1]
        return np.ascontiguousarray(inner), tuple(self.palette)

    def column(self, name: str) -> np.ndarray:
        """Return one trait of every state of the palette, int32 [P]."""
        known = self._columns.get(name, _NONE)
        if len(known) < len(self.palette):  # States that have joined since it was last asked for.
            more = [self._trait(text, name) for text in self.palette[len(known) :]]
            self._columns[name] = known = np.concatenate([known, np.array(more, np.int32)])
        return known

    def cells_of(self, kind: int) -> np.ndarray:
        """Return the cells, int [N], whose states are of a kind."""
        return self._cells[self._kinds == kind]

    def at(self, cells: np.ndarray, direction: int | None = None) -> np.ndarray:
        """Return the states, uint16 [N], of cells or of their neighbours in a direction."""
        return self.flat[cells if direction is None else cells + self.steps[direction]]

    def towards(self, cells: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Return the states, uint16 [N], of each cell's neighbour in a direction of its own."""
        return self.flat[cells + self.steps[directions]]

    def heights(self, cells: np.ndarray) -> np.ndarray:
        """Return the layer, int [N], of each cell, the rim counted."""
        return cells // self.shape[2] % self.shape[1]

    def change(
        self, cells: np.ndarray, values: np.ndarray, write: Callable[[list[int]], dict[str, str]]
    ) -> None:
        """Give cells new properties.

        Args:
            cells: int [N].
            values: int [N, K], what decides the properties of each cell.
            write: the properties for one row of ``values``.
        """
        if not len(cells):
            return
        own = self.at(cells)
        width = values.max(initial=0) + 1
        keys = own.astype(np.int64)
        for value in values.T:
            keys = keys * width + value
        _, first, index = np.unique(keys, return_index=True, return_inverse=True)
        made = [self._having(int(own[i]), write(values[i].tolist())) for i in first]
        self.flat[cells] = np.array(made, np.uint16)[index.ravel()]

    def _having(self, number: int, changed: dict[str, str]) -> int:
        state = complete(parse_state(self.palette[number]))
        if all(state.get(key) == value for key, value in changed.items()):
            return number
        return self.id_of(str(state.having(**changed)))

    def id_of(self, text: str) -> int:
        """Return the number of a state, which joins the palette where it is new.

        Raises:
            LimitError: the palette is full.
        """
        if text not in self._ids:
            if len(self.palette) >= MOST_STATES:
                raise LimitError("palette", "has more than 65,536 block states")
            self._ids[text] = len(self.palette)
            self.palette.append(text)
        return self._ids[text]

    def _trait(self, text: str, name: str) -> int:
        if name == "block":
            block = parse_state(text).name
            return self._blocks.setdefault(block, len(self._blocks))
        return int(getattr(traits_of(text), name))

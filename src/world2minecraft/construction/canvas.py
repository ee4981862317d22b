"""A mutable volume of blocks with their states, classes and instances in room axes."""

from typing import Any

import numpy as np

from world2minecraft.construction.block_lattice import Lattice
from world2minecraft.core.coordinates import block_to_room, grid_to_block_axes
from world2minecraft.core.errors import LimitError
from world2minecraft.core.types import AIR, BlockVolume, Entity
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.painting_placement import hang_paintings

# Blocks that nobody sees; they are no surface, so they carry class 0.
LIGHT = "minecraft:light[level=15,waterlogged=false]"
BARRIER = "minecraft:barrier"
UNSEEN_BLOCKS = (AIR, LIGHT, BARRIER)


class Canvas:
    """A mutable volume of blocks. All arrays have the shape [X, Y, Z] of the lattice, z up."""

    def __init__(self, lattice: Lattice):
        self.lattice = lattice
        self.states = np.zeros(lattice.shape, np.uint16)
        self.semantic = np.zeros(lattice.shape, np.uint8)
        self.instance = np.zeros(lattice.shape, np.uint16)
        self.entities: list[Entity] = []
        self._ids: dict[str, int] = {AIR: 0}

    def id_of(self, state: str) -> int:
        """Return the palette index of a block state, completed with its default properties."""
        full = str(complete(parse_state(state)))
        if full not in self._ids:
            if len(self._ids) > np.iinfo(np.uint16).max:
                raise LimitError(
                    "palette", "contains over 65,536 block states; use a palette of fewer blocks"
                )
            self._ids[full] = len(self._ids)
        return self._ids[full]

    def ids_of(self, states: list[str]) -> np.ndarray:
        """Return the palette indices, uint16 [N], of N block states."""
        return np.array([self.id_of(state) for state in states], np.uint16)

    def mask_of(self, *states: str) -> np.ndarray:
        """Return the bool [X, Y, Z] mask of the blocks that have one of the given states."""
        numbers = [self._ids[state] for state in states if state in self._ids]
        return np.isin(self.states, numbers)

    @property
    def free(self) -> np.ndarray:
        """Bool [X, Y, Z] mask of air and invisible passable blocks (light)."""
        return self.mask_of(AIR, LIGHT)

    def put(
        self,
        at: tuple[Any, ...] | np.ndarray,
        ids: np.ndarray | int,
        class_id: int,
        instance: int = 0,
    ) -> None:
        """Set the blocks at a mask or at index arrays, with their class and instance."""
        self.states[at] = ids
        self.semantic[at] = class_id
        self.instance[at] = instance

    @property
    def palette(self) -> tuple[str, ...]:
        """The block states in the order of their palette indices."""
        return tuple(self._ids)

    def volume(self) -> BlockVolume:
        """Return the blocks in block axes without unused states, and with paintings hung."""
        used = np.unique(self.states)
        names = sorted(self.palette[number] for number in used if number)
        order = {name: number for number, name in enumerate(names, 1)} | {AIR: 0}
        renumber = np.array([order.get(name, 0) for name in self.palette], np.uint16)
        frame = block_to_room(self.lattice.corner_m, self.lattice.blocks_per_metre)
        volume = BlockVolume(
            states=grid_to_block_axes(renumber[self.states]),
            palette=(AIR, *names),
            semantic=grid_to_block_axes(self.semantic),
            instance=grid_to_block_axes(self.instance),
            corner=self.lattice.corner,
            block_to_room=frame,
            entities=tuple(self.entities),
        )
        return hang_paintings(volume)

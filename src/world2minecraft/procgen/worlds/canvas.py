"""A canvas of house blocks that records the furniture design of each block."""

from typing import Any

import numpy as np

from world2minecraft.construction.block_lattice import Lattice
from world2minecraft.construction.block_updates import apply_block_updates
from world2minecraft.construction.canvas import Canvas
from world2minecraft.core.coordinates import ROOM_CORNER_BLOCK, grid_to_block_axes
from world2minecraft.core.types import BlockVolume
from world2minecraft.procgen.worlds.block_house import BlockHouse

MARGIN = 1  # The wall; what lies before it comes on top.
UNDER = 2  # Layers under the lowest rooms: their floor, and the ground.
OVER = 3  # Layers over the highest rooms: ceiling and air. The roof comes on top.


class WorldCanvas(Canvas):
    """A canvas that records designs. Its indices are house positions plus the margin."""

    def __init__(self, house: BlockHouse, garden: int = 1, roof: int = 0):
        self.margin = margin = MARGIN + garden
        layers = UNDER + house.grounds[-1] + house.height + OVER + roof
        shape = (house.size[0] + 2 * margin, house.size[1] + 2 * margin, layers)
        corner = (-margin, ROOM_CORNER_BLOCK[1] - UNDER, -margin)
        scale = house.blocks_per_metre
        corner_m = np.array([0.0, house.size[1] / scale])
        upper = tuple(UNDER + ground for ground in house.grounds[1:])
        super().__init__(Lattice(corner, shape, corner_m, scale, upper))
        self.design = np.zeros(shape, np.uint16)
        self.designs: dict[str, int] = {"": 0}

    def at(self, x: int, y: int, z: int) -> tuple[int, int, int]:
        """Return the canvas index of a block position in the house."""
        return x + self.margin, y + self.margin, z + UNDER

    def box(
        self, low: tuple[int, int, int], high: tuple[int, int, int]
    ) -> tuple[slice, slice, slice]:
        """Return the canvas slices of a box of house blocks, [low, high)."""
        x, y, z = (slice(a, b) for a, b in zip(self.at(*low), self.at(*high), strict=True))
        return x, y, z

    def set(
        self,
        at: tuple[Any, ...] | np.ndarray,
        state: str,
        class_id: int,
        instance: int = 0,
        design: str = "",
    ) -> None:
        """Set the state, class, instance and design of blocks at an index, slices or a mask."""
        self.put(at, self.id_of(state), class_id, instance)
        self.design[at] = self.designs.setdefault(design, len(self.designs))

    def settle(self) -> int:
        """Connect blocks, remove unstable blocks, and return the number of removed blocks."""
        taken = apply_block_updates(self)
        self.design[self.states == 0] = 0
        return taken

    def finished(self) -> tuple[BlockVolume, np.ndarray, tuple[str, ...]]:
        """Return the volume, the design of each block and the design names.

        The designs are uint16 [X, Y, Z] in block axes, as indices into the names.
        """
        used = np.unique(self.design)
        names = tuple(self.designs)
        used_names = sorted(names[int(number)] for number in used if number)
        order = {name: number for number, name in enumerate(used_names, 1)} | {"": 0}
        renumber = np.array([order.get(name, 0) for name in names], np.uint16)
        volume, designs = self.volume(), grid_to_block_axes(renumber[self.design])
        moved = volume.instance != grid_to_block_axes(self.instance)  # Pictures, to their walls.
        of_instance = np.zeros(int(self.instance.max()) + 1, np.uint16)
        of_instance[self.instance] = renumber[self.design] * (self.instance > 0)
        designs[moved] = of_instance[volume.instance[moved]]
        return volume, designs, ("", *used_names)

"""Volumes of Minecraft blocks with their block entities and entities."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from world2minecraft.core.types import checks

AIR = "minecraft:air"


@dataclass(frozen=True)
class BlockEntity:
    """The data of a block beyond its state, such as the text of a sign."""

    block_pos: tuple[int, int, int]  # world block coordinates
    id: str
    nbt: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Entity:
    """An entity independent of the block grid, with the class and id of its object, if any."""

    position: tuple[float, float, float]  # world block coordinates, not whole
    id: str
    nbt: Mapping[str, Any] = field(default_factory=dict)
    class_id: int = 0
    instance: int = 0

    def __post_init__(self):
        if not all(map(math.isfinite, self.position)):
            raise ValueError(f"position must be three finite numbers, got {self.position}")


@dataclass(frozen=True, eq=False)
class BlockVolume:
    """A box of blocks in block axes: x east, y up, z south.

    ``states[x, y, z]`` indexes ``palette``, which contains full block states, such as
    ``minecraft:oak_stairs[facing=east,half=bottom,...]``. ``palette[0]`` is air. ``corner`` is the
    world position of cell (0, 0, 0). ``block_to_room`` transforms world block coordinates (a block
    spans [n, n+1]) to room metres by a change of axes, a scale and a translation.
    """

    states: np.ndarray  # uint16 [X, Y, Z]
    palette: tuple[str, ...]
    semantic: np.ndarray  # uint8 [X, Y, Z]
    instance: np.ndarray  # uint16 [X, Y, Z]
    corner: tuple[int, int, int]
    block_to_room: np.ndarray  # float64 [4, 4]
    block_entities: tuple[BlockEntity, ...] = ()
    entities: tuple[Entity, ...] = ()

    def __post_init__(self):
        put = object.__setattr__
        states = checks.array("states", self.states, np.uint16, (None, None, None))
        put(self, "states", states)
        put(self, "palette", tuple(self.palette))
        if not self.palette or self.palette[0] != AIR:
            raise ValueError(f"palette must start with {AIR}, got {self.palette[:1]}")
        if states.size and int(states.max()) >= len(self.palette):
            raise ValueError(
                f"states has index {states.max()}, but the palette has {len(self.palette)} entries"
            )
        put(self, "semantic", checks.labels("semantic", self.semantic, states.shape))
        put(self, "instance", checks.array("instance", self.instance, np.uint16, states.shape))
        corner = tuple(int(value) for value in self.corner)
        if len(corner) != 3:
            raise ValueError(f"corner must be three integers, got {self.corner}")
        put(self, "corner", corner)
        put(self, "block_to_room", checks.similarity("block_to_room", self.block_to_room))

    def __repr__(self) -> str:
        size = " x ".join(str(side) for side in self.states.shape)
        return f"BlockVolume({size} blocks of {self.blocks_per_metre:g} per metre at {self.corner})"

    @property
    def blocks_per_metre(self) -> float:
        """The number of blocks per metre of the room."""
        return float(1 / np.linalg.norm(self.block_to_room[:3, 0]))

    @property
    def grid_to_room(self) -> np.ndarray:
        """The transform from cells of the volume to room metres, float64 [4, 4]."""
        moved = np.eye(4)
        moved[:3, 3] = self.corner
        return self.block_to_room @ moved

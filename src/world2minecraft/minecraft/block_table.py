"""The table of blocks of Minecraft 1.20.1: properties, default states and collision boxes.

The data file is a subset of the public package ``minecraft-data``; see the notice in the data
folder. The index of a state counts property values with the last property varying fastest. The
first value of a boolean property is true.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from world2minecraft.minecraft.data_files import read_data


@dataclass(frozen=True)
class BlockType:
    """A kind of block, with its properties in the game's order and the shape of each state."""

    name: str
    properties: tuple[tuple[str, tuple[str, ...]], ...]
    default: int
    shapes: tuple[int, ...]  # One index for all states, or one index per state.

    @property
    def state_count(self) -> int:
        """The number of states of the block."""
        count = 1
        for _, values in self.properties:
            count *= len(values)
        return count

    def values_at(self, index: int) -> dict[str, str]:
        """Return the property values of the state with the given index, in the game's order."""
        found: dict[str, str] = {}
        for name, values in reversed(self.properties):
            index, place = divmod(index, len(values))
            found[name] = values[place]
        return {name: found[name] for name, _ in self.properties}

    def index_of(self, values: dict[str, str]) -> int:
        """Return the index of a state. Missing or invalid values count as the default value."""
        defaults = self.values_at(self.default)
        index = 0
        for name, known in self.properties:
            value = values.get(name, defaults[name])
            index = index * len(known) + known.index(value if value in known else defaults[name])
        return index

    def shape_at(self, index: int) -> int:
        """Return the shape number of the state with the given index."""
        return self.shapes[index if len(self.shapes) > 1 else 0]


@dataclass(frozen=True)
class BlockTable:
    """All blocks by full name, and all collision shapes as float32 [N, 6] boxes in block units."""

    version: str
    blocks: dict[str, BlockType]
    shapes: tuple[np.ndarray, ...]


@cache
def block_table() -> BlockTable:
    """Load the bundled block table. The result is cached."""
    raw = read_data("blocks.json.gz")
    properties = [(name, tuple(values)) for name, values in raw["properties"]]
    blocks = {}
    for name, (numbers, default, shapes) in raw["blocks"].items():
        held = tuple(shapes) if isinstance(shapes, list) else (shapes,)
        full = f"minecraft:{name}"
        blocks[full] = BlockType(full, tuple(properties[n] for n in numbers), default, held)
    return BlockTable(raw["version"], blocks, tuple(map(_boxes, raw["shapes"])))


def _boxes(flat: list[float]) -> np.ndarray:
    boxes = np.array(flat, np.float32).reshape(-1, 6)
    boxes.flags.writeable = False
    return boxes

"""One edit, of a grid or of blocks: what clean-up, SceneForge and ``w2m undo`` share."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.types import checks
from world2minecraft.types.volume import BlockEntity, Entity


@dataclass(frozen=True, eq=False)
class Operation:
    """Cells with their labels before and after. ``kind`` is a verb, such as ``fill``."""

    kind: str
    cells: np.ndarray  # int32 [N, 3]
    before: np.ndarray  # uint8 [N]
    after: np.ndarray  # uint8 [N]
    class_id: int | None = None

    def __post_init__(self):
        put = object.__setattr__
        checks.identifier("kind", self.kind)
        put(self, "cells", checks.array("cells", self.cells, np.int32, (None, 3)))
        for name in ("before", "after"):
            put(self, name, checks.labels(name, getattr(self, name), (len(self.cells),)))

    def inverse(self) -> "Operation":
        """The operation that takes this one back."""
        return Operation(self.kind, self.cells, self.after, self.before, self.class_id)


@dataclass(frozen=True, eq=False)
class Blocks:
    """What N cells of a volume hold, and the data and entities that are there with them.

    ``states`` indexes the palette of the edit that holds this value.
    """

    states: np.ndarray  # uint16 [N]
    semantic: np.ndarray  # uint8 [N]
    instance: np.ndarray  # uint16 [N]
    block_entities: tuple[BlockEntity, ...] = ()
    entities: tuple[Entity, ...] = ()

    def __post_init__(self):
        put = object.__setattr__
        states = checks.array("states", self.states, np.uint16, (None,))
        put(self, "states", states)
        put(self, "semantic", checks.labels("semantic", self.semantic, states.shape))
        put(self, "instance", checks.array("instance", self.instance, np.uint16, states.shape))
        put(self, "block_entities", tuple(self.block_entities))
        put(self, "entities", tuple(self.entities))


@dataclass(frozen=True, eq=False)
class BlockEdit:
    """Blocks before and after: the twin of ``Operation`` for a volume or a world.

    ``cells`` are world block positions, each once. ``kind`` is a verb, such as ``drop``;
    ``reason`` is a plain sentence for whoever reads the list. ``class_id`` and ``instance`` say
    which object it is about, where it is about one.
    """

    kind: str
    cells: np.ndarray  # int32 [N, 3], x y z
    palette: tuple[str, ...]
    before: Blocks
    after: Blocks
    reason: str = ""
    class_id: int | None = None
    instance: int | None = None

    def __post_init__(self):
        put = object.__setattr__
        checks.identifier("kind", self.kind)
        cells = checks.array("cells", self.cells, np.int32, (None, 3))
        ordered = cells[np.lexsort(cells.T)]
        if (ordered[1:] == ordered[:-1]).all(axis=1).any():
            raise ValueError("cells must be named once each")
        put(self, "cells", cells)
        put(self, "palette", tuple(self.palette))
        for name in ("before", "after"):
            self._check(name, getattr(self, name))

    def _check(self, name: str, blocks: Blocks) -> None:
        if len(blocks.states) != len(self.cells):
            counts = f"{len(self.cells)} cells, not {len(blocks.states)}"
            raise ValueError(f"{name} must hold the blocks of {counts}")
        if blocks.states.size and int(blocks.states.max()) >= len(self.palette):
            highest = int(blocks.states.max())
            raise ValueError(f"{name} goes to {highest}, the palette has {len(self.palette)}")
        for entity in blocks.block_entities:
            if not (self.cells == entity.block_pos).all(axis=1).any():
                raise ValueError(f"{name} has data of {entity.block_pos}, which is no cell of it")

    def inverse(self) -> "BlockEdit":
        """The edit that takes this one back."""
        held: dict[str, Any] = vars(self)
        return BlockEdit(**{**held, "before": self.after, "after": self.before})

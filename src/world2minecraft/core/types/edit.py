"""Undoable edits of a scene or of blocks, used by clean-up, SceneForge and ``w2m undo``."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from world2minecraft.core.types import checks
from world2minecraft.core.types.block_volume import BlockEntity, Entity
from world2minecraft.core.types.objects import ObjectInstance, Placement
from world2minecraft.core.types.occupancy_and_evidence import UNSEEN

COUNTED = ("add", "delete", "orient", "move", "relabel", "other")


@dataclass(frozen=True, eq=False)
class GridCells:
    """The contents of N cells of an ``OccupancyGrid``."""

    labels: np.ndarray  # uint8 [N], 0 to 11 or 255
    confidence: np.ndarray  # float16 [N]
    colour: np.ndarray  # uint8 [N, 3]
    source: np.ndarray  # uint8 [N]
    instance: np.ndarray  # uint16 [N]

    def __post_init__(self):
        put = object.__setattr__
        labels = checks.labels("labels", self.labels, (None,))
        put(self, "labels", labels)
        put(
            self,
            "confidence",
            checks.array("confidence", self.confidence, np.float16, labels.shape),
        )
        put(self, "colour", checks.array("colour", self.colour, np.uint8, (*labels.shape, 3)))
        put(self, "source", checks.array("source", self.source, np.uint8, labels.shape))
        put(self, "instance", checks.array("instance", self.instance, np.uint16, labels.shape))
        if not np.array_equal(labels == 255, self.source == UNSEEN):
            raise ValueError("labels must be 255 exactly where source is 0 (unseen)")
        if not ((self.confidence >= 0) & (self.confidence <= 1)).all():
            raise ValueError("confidence must be between 0 and 1")


@dataclass(frozen=True, eq=False)
class SceneObject:
    """An object of a scene with its furniture.

    The fields are those of ``ObjectInstance``. The cells of the object are those of the grid whose
    ``instance`` is its id. All ``placements`` have the id and the class of the object.
    """

    id: int
    class_id: int
    center_m: np.ndarray  # float64 [3]
    size_m: np.ndarray  # float64 [3]
    yaw_deg: float
    confidence: float
    placements: tuple[Placement, ...] = ()
    name: str = ""
    name_confidence: float = 0.0

    def __post_init__(self):
        put = object.__setattr__
        no_cells = np.zeros((0, 3), np.int32)
        fields = (self.center_m, self.size_m, self.yaw_deg, no_cells, self.confidence)
        checked = ObjectInstance(self.id, self.class_id, *fields, self.name, self.name_confidence)
        for name in ("center_m", "size_m", "confidence", "name_confidence"):
            put(self, name, getattr(checked, name))
        put(self, "placements", tuple(self.placements))
        for placed in self.placements:
            if (placed.object_id, placed.class_id) != (self.id, self.class_id):
                other = f"object {placed.object_id} of class {placed.class_id}"
                raise ValueError(
                    f"placements of object {self.id} must have its id and class, got {other}"
                )


@dataclass(frozen=True, eq=False)
class Operation:
    """An edit of a scene: cells and objects, before and after.

    ``kind`` is a verb, such as ``fill``. ``counts_as`` is the category of the edit in the effort
    tables. ``cells`` are grid indices without duplicates. An object only in ``objects_before`` is
    removed, an object only in ``objects_after`` is added, and an object in both is changed.
    ``actor`` is the user and ``time_s`` the time in seconds since 1970, both for display only.
    """

    kind: str
    cells: np.ndarray  # int32 [N, 3]
    before: GridCells
    after: GridCells
    objects_before: tuple[SceneObject, ...] = ()
    objects_after: tuple[SceneObject, ...] = ()
    counts_as: str = "other"
    class_id: int | None = None
    actor: str = ""
    time_s: float = 0.0

    def __post_init__(self):
        put = object.__setattr__
        checks.identifier("kind", self.kind)
        if self.counts_as not in COUNTED:
            raise ValueError(
                f"counts_as must be one of {', '.join(COUNTED)}, got {self.counts_as!r}"
            )
        put(self, "cells", checks.array("cells", self.cells, np.int32, (None, 3)))
        if not rows_are_unique(self.cells):
            raise ValueError("cells must not contain duplicates")
        for name in ("before", "after"):
            count = len(getattr(self, name).labels)
            if count != len(self.cells):
                raise ValueError(f"{name} must have {len(self.cells)} cells, got {count}")
        for name in ("objects_before", "objects_after"):
            put(self, name, tuple(getattr(self, name)))
            ids = [one.id for one in getattr(self, name)]
            if len(set(ids)) != len(ids):
                raise ValueError(f"{name} must not contain duplicate objects, got {ids}")

    def inverse(self) -> "Operation":
        """Return the operation that undoes this one."""
        swapped = {
            "before": self.after,
            "after": self.before,
            "objects_before": self.objects_after,
            "objects_after": self.objects_before,
        }
        return replace(self, **swapped)


def rows_are_unique(cells: np.ndarray) -> bool:
    """Return whether cells [N, 3] contain no duplicates."""
    if not len(cells):
        return True
    low = cells.min(axis=0).astype(np.int64)
    spans = cells.max(axis=0) - low + 1
    if np.prod(spans.astype(np.float64)) >= 2**63:  # No one number can name each cell.
        ordered = cells[np.lexsort(cells.T)]
        return not (ordered[1:] == ordered[:-1]).all(axis=1).any()
    x, y, z = (cells - low).T
    numbers = (x * spans[1] + y) * spans[2] + z
    if (numbers[1:] > numbers[:-1]).all():
        return True
    numbers.sort()
    return not (numbers[1:] == numbers[:-1]).any()


@dataclass(frozen=True, eq=False)
class Blocks:
    """The contents of N cells of a volume, with their block entities and entities.

    ``states`` indexes the palette of the edit that contains this value.
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
    """Blocks before and after an edit of a volume or a world, the equivalent of ``Operation``.

    ``cells`` are world block positions without duplicates. ``kind`` is a verb, such as ``drop``.
    ``reason`` is a readable explanation. ``class_id`` and ``instance`` identify the edited object,
    if any.
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
        if not rows_are_unique(cells):
            raise ValueError("cells must not contain duplicates")
        put(self, "cells", cells)
        put(self, "palette", tuple(self.palette))
        for name in ("before", "after"):
            self._check(name, getattr(self, name))

    def _check(self, name: str, blocks: Blocks) -> None:
        if len(blocks.states) != len(self.cells):
            counts = f"{len(self.cells)} cells, got {len(blocks.states)}"
            raise ValueError(f"{name} must contain the blocks of {counts}")
        if blocks.states.size and int(blocks.states.max()) >= len(self.palette):
            highest = int(blocks.states.max())
            raise ValueError(
                f"{name} has index {highest}, but the palette has {len(self.palette)} entries"
            )
        for entity in blocks.block_entities:
            if not (self.cells == entity.block_pos).all(axis=1).any():
                raise ValueError(
                    f"{name} has data at {entity.block_pos}, which is not one of its cells"
                )

    def inverse(self) -> "BlockEdit":
        """Return the edit that undoes this one."""
        held: dict[str, Any] = vars(self)
        return BlockEdit(**{**held, "before": self.after, "after": self.before})

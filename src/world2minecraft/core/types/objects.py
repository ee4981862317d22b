"""Object instances of a room, and the furniture templates placed for them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from world2minecraft.core.classes import OBJECT_CLASSES
from world2minecraft.core.types import checks


@dataclass(frozen=True, eq=False)
class ObjectInstance:
    """One object of the room. ``size_m`` is along its own axes: front-to-back, side, height.

    ``yaw_deg`` is counter-clockwise from above, 0 = the front looks along room +x. ``center_m``
    is the middle of its box, in the room frame. ``cells`` are indices into the grid.
    """

    id: int
    class_id: int
    center_m: np.ndarray  # float64 [3]
    size_m: np.ndarray  # float64 [3]
    yaw_deg: float
    cells: np.ndarray  # int32 [N, 3]
    confidence: float

    def __post_init__(self):
        put = object.__setattr__
        if not 1 <= self.id <= 65535:
            raise ValueError(f"id must be 1 to 65535, not {self.id}")
        if self.class_id not in OBJECT_CLASSES:
            raise ValueError(f"class_id must be an object class, 5 to 11, not {self.class_id}")
        put(self, "center_m", checks.floats("center_m", self.center_m, (3,)))
        put(self, "size_m", checks.floats("size_m", self.size_m, (3,)))
        checks.floats("yaw_deg", [self.yaw_deg], (1,))
        put(self, "cells", checks.array("cells", self.cells, np.int32, (None, 3)))
        put(self, "confidence", checks.fraction("confidence", self.confidence))


@dataclass(frozen=True)
class Alternative:
    """Another template that was tried for the same object, with its score."""

    template: str
    quarter_turns: int
    iou: float


@dataclass(frozen=True, eq=False)
class Placement:
    """One template in its place, in metres only, so that any block scale can be built from it.

    ``size_m`` is along the template's own axes (front-to-back, side, height) before it is
    turned; ``quarter_turns`` is counter-clockwise from above, 0 = front along room +x.
    The template named ``cells`` stands for "built from the object's own cells within the box".
    An object that was cut into runs has several placements with the same ``object_id``.
    """

    object_id: int
    class_id: int
    template: str
    center_m: np.ndarray  # float64 [3]
    size_m: np.ndarray  # float64 [3]
    quarter_turns: int
    iou: float
    parameters: Mapping[str, float] = field(default_factory=dict)
    alternatives: tuple[Alternative, ...] = ()

    def __post_init__(self):
        put = object.__setattr__
        checks.identifier("template", self.template)
        put(self, "center_m", checks.floats("center_m", self.center_m, (3,)))
        put(self, "size_m", checks.floats("size_m", self.size_m, (3,)))
        if self.quarter_turns not in (0, 1, 2, 3):
            raise ValueError(f"quarter_turns must be 0 to 3, not {self.quarter_turns}")
        put(self, "iou", checks.fraction("iou", self.iou))
        put(self, "parameters", MappingProxyType(dict(sorted(self.parameters.items()))))
        put(self, "alternatives", tuple(self.alternatives))

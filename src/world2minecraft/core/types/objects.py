"""Object instances of a room, and the furniture templates placed for them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from world2minecraft.core.classes import OBJECT_CLASSES
from world2minecraft.core.types import checks

SUPPORTS = ("floor", "wall", "ceiling")


@dataclass(frozen=True, eq=False)
class ObjectInstance:
    """An object of the room. ``size_m`` is along its own axes: front to back, side to side, height.

    ``yaw_deg`` is counter-clockwise from above. At 0, the front faces room +x. ``center_m`` is the
    centre of its bounding box in the room frame. ``cells`` are grid indices. ``name`` is a name of
    the vocabulary, such as ``office chair``, the display name of the class if that is all that is
    known, or empty; ``name_confidence`` is its probability. ``supported_by`` is the id of the
    object that it stands on, ``floor``, ``wall`` or ``ceiling``, or empty if unknown.
    """

    id: int
    class_id: int
    center_m: np.ndarray  # float64 [3]
    size_m: np.ndarray  # float64 [3]
    yaw_deg: float
    cells: np.ndarray  # int32 [N, 3]
    confidence: float
    name: str = ""
    name_confidence: float = 0.0
    supported_by: int | str = ""

    def __post_init__(self):
        put = object.__setattr__
        if not 1 <= self.id <= 65535:
            raise ValueError(f"id must be 1 to 65535, got {self.id}")
        if self.class_id not in OBJECT_CLASSES:
            raise ValueError(f"class_id must be an object class, 5 to 11, got {self.class_id}")
        put(self, "center_m", checks.coordinates("center_m", self.center_m, (3,)))
        put(self, "size_m", checks.lengths("size_m", self.size_m, (3,)))
        checks.floats("yaw_deg", [self.yaw_deg], (1,))
        put(self, "cells", checks.array("cells", self.cells, np.int32, (None, 3)))
        checks.object_name(self.name)
        self._check_support()
        for name in ("confidence", "name_confidence"):
            put(self, name, checks.fraction(name, getattr(self, name)))

    def _check_support(self) -> None:
        by = self.supported_by
        if by in ("", *SUPPORTS) or (type(by) is int and 1 <= by <= 65535 and by != self.id):
            return
        raise ValueError(
            f"supported_by must be another object's id or {', '.join(SUPPORTS)}, got {by!r}"
        )


@dataclass(frozen=True)
class Alternative:
    """Another template that was considered for the same object, with its IoU."""

    template: str
    quarter_turns: int
    iou: float


OWN_CELLS = "cells"  # The template of an object that is built from its own cells.


@dataclass(frozen=True, eq=False)
class Placement:
    """A placed furniture template in metres, from which it can be built at any block scale.

    ``size_m`` is along the template's own axes (front to back, side to side, height) before
    rotation. ``quarter_turns`` is counter-clockwise from above, and at 0 the front faces room +x.
    The template name ``cells`` means that the object is built from its own cells inside the box. An
    object that was cut into pieces has several placements with the same ``object_id``.
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
        put(self, "center_m", checks.coordinates("center_m", self.center_m, (3,)))
        put(self, "size_m", checks.lengths("size_m", self.size_m, (3,)))
        if self.quarter_turns not in (0, 1, 2, 3):
            raise ValueError(f"quarter_turns must be 0 to 3, got {self.quarter_turns}")
        put(self, "iou", checks.fraction("iou", self.iou))
        put(self, "parameters", MappingProxyType(dict(sorted(self.parameters.items()))))
        put(self, "alternatives", tuple(self.alternatives))

"""One edit of a grid: what clean-up, SceneForge and ``w2m undo`` share."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.types import checks


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

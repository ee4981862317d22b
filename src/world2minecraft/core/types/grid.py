"""What stages 3 to 5 give: the semantic occupancy of a room."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.types import checks

UNSEEN, OBSERVED, COMPLETED = 0, 1, 2


@dataclass(frozen=True, eq=False)
class OccupancyGrid:
    """The paper's O_scene: ``labels[x, y, z]`` in the room frame, z up, C order.

    ``labels`` are 0 to 11 or 255 unknown; ``source`` is 0 unseen, 1 observed, 2 completed;
    ``instance`` is 0 or the id of an ObjectInstance. ``origin_m`` is the minimum corner of cell
    (0, 0, 0). An unseen cell is labelled 255, and only an unseen one is.
    """

    labels: np.ndarray  # uint8 [X, Y, Z]
    confidence: np.ndarray  # float16 [X, Y, Z], 0 to 1
    colour: np.ndarray  # uint8 [X, Y, Z, 3]
    source: np.ndarray  # uint8 [X, Y, Z]
    instance: np.ndarray  # uint16 [X, Y, Z]
    voxel_m: float
    origin_m: np.ndarray  # float64 [3]

    def __post_init__(self):
        put = object.__setattr__
        labels = checks.labels("labels", self.labels, (None, None, None))
        shape = labels.shape
        if not labels.size:
            raise ValueError(f"labels must have cells, not shape {shape}")
        put(self, "labels", labels)
        put(self, "confidence", checks.array("confidence", self.confidence, np.float16, shape))
        put(self, "colour", checks.array("colour", self.colour, np.uint8, (*shape, 3)))
        put(self, "source", checks.array("source", self.source, np.uint8, shape))
        put(self, "instance", checks.array("instance", self.instance, np.uint16, shape))
        put(self, "voxel_m", checks.positive("voxel_m", self.voxel_m))
        put(self, "origin_m", checks.origin(self.origin_m, self.voxel_m))
        if self.source.max() > COMPLETED:
            raise ValueError(f"source must be 0, 1 or 2, not {int(self.source.max())}")
        if not np.array_equal(labels == 255, self.source == UNSEEN):
            raise ValueError("labels must be 255 exactly where source is 0 (unseen)")
        if not ((self.confidence >= 0) & (self.confidence <= 1)).all():
            raise ValueError("confidence must lie between 0 and 1")

    @property
    def shape(self) -> tuple[int, int, int]:
        """The number of cells along x, y and z."""
        return self.labels.shape  # type: ignore[return-value]

    @property
    def occupied(self) -> np.ndarray:
        """A bool [X, Y, Z] mask of the cells that hold a surface or an object."""
        return (self.labels > 0) & (self.labels != 255)

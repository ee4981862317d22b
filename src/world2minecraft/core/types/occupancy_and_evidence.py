"""Evidence of occupancy from one view and from all views, and the semantic occupancy grid."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.types import checks

UNSEEN, OBSERVED, COMPLETED = 0, 1, 2


@dataclass(frozen=True, eq=False)
class OccupancyGrid:
    """The paper's O_scene: ``labels[x, y, z]`` in the room frame, z up, C order.

    ``labels`` are 0 to 11, or 255 for unknown. ``source`` is 0 (unseen), 1 (observed) or 2
    (completed). ``instance`` is the id of an ObjectInstance, or 0. ``origin_m`` is the minimum
    corner of cell (0, 0, 0). A cell is labelled 255 if and only if it is unseen.
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
            raise ValueError(f"labels must not be empty, got shape {shape}")
        put(self, "labels", labels)
        put(self, "confidence", checks.array("confidence", self.confidence, np.float16, shape))
        put(self, "colour", checks.array("colour", self.colour, np.uint8, (*shape, 3)))
        put(self, "source", checks.array("source", self.source, np.uint8, shape))
        put(self, "instance", checks.array("instance", self.instance, np.uint16, shape))
        put(self, "voxel_m", checks.voxel_size(self.voxel_m))
        put(self, "origin_m", checks.origin(self.origin_m, self.voxel_m))
        checks.extent(shape, self.voxel_m)
        if self.source.max() > COMPLETED:
            raise ValueError(f"source must be 0, 1 or 2, got {int(self.source.max())}")
        if not np.array_equal(labels == 255, self.source == UNSEEN):
            raise ValueError("labels must be 255 exactly where source is 0 (unseen)")
        if not ((self.confidence >= 0) & (self.confidence <= 1)).all():
            raise ValueError("confidence must be between 0 and 1")

    @property
    def shape(self) -> tuple[int, int, int]:
        """The number of cells along x, y and z."""
        return self.labels.shape  # type: ignore[return-value]

    @property
    def occupied(self) -> np.ndarray:
        """A mask of the cells that contain a surface or an object, bool [X, Y, Z]."""
        return (self.labels > 0) & (self.labels != 255)


@dataclass(frozen=True, eq=False)
class PointEvidence:
    """The surface points of one view from depth or stereo, in the scan frame.

    ``weight`` is the area in square metres that the point's pixel covers perpendicular to its ray:
    ``z^2 / (fx fy)``. Fusion divides the sum of weights in a cell by the area of the cell's face to
    determine how much of the cell the view observed. ``normals`` are unit vectors towards the
    camera, or (0, 0, 0) if unknown. Without normals, surfaces are assumed to face the camera.
    ``labels`` are a compact form of ``votes`` with one full vote for one class. Points that share
    votes, such as those of one pixel of a network, have one row of ``votes`` and its number in
    ``vote_rows``; without ``vote_rows``, each point has a row. ``trust`` is the reliability of each
    point, 0 to 1. Without it, all points have trust 1.
    """

    view: str
    camera_m: np.ndarray  # float64 [3]
    points_m: np.ndarray  # float32 [N, 3]
    weight: np.ndarray  # float32 [N]
    colour: np.ndarray | None = None  # uint8 [N, 3]
    votes: np.ndarray | None = None  # float16 [N or P, 12]
    normals: np.ndarray | None = None  # float32 [N, 3], scan frame
    labels: np.ndarray | None = None  # uint8 [N], class ids; 0 and 255 vote for nothing
    trust: np.ndarray | None = None  # float32 [N], 0 to 1
    vote_rows: np.ndarray | None = None  # int32 [N], rows of votes

    def __post_init__(self):
        put = object.__setattr__
        put(self, "camera_m", checks.floats("camera_m", self.camera_m, (3,)))
        put(self, "points_m", checks.array("points_m", self.points_m, np.float32, (None, 3)))
        count = len(self.points_m)
        put(self, "weight", checks.array("weight", self.weight, np.float32, (count,)))
        if self.colour is not None:
            put(self, "colour", checks.array("colour", self.colour, np.uint8, (count, 3)))
        if self.votes is not None:
            shape = (count if self.vote_rows is None else None, CLASS_COUNT)
            put(self, "votes", checks.array("votes", self.votes, np.float16, shape))
        if self.vote_rows is not None:
            rows = checks.array("vote_rows", self.vote_rows, np.int32, (count,))
            put(self, "vote_rows", rows)
            limit = 0 if self.votes is None else len(self.votes)
            if len(rows) and not 0 <= int(rows.min()) <= int(rows.max()) < limit:
                raise ValueError(f"vote_rows must be below the number of votes, {limit}")
        if self.normals is not None:
            put(self, "normals", checks.array("normals", self.normals, np.float32, (count, 3)))
        if self.labels is not None:
            put(self, "labels", checks.array("labels", self.labels, np.uint8, (count,)))
        if self.trust is not None:
            put(self, "trust", checks.array("trust", self.trust, np.float32, (count,)))

    @property
    def point_votes(self) -> np.ndarray | None:
        """The votes of each point, float16 [N, 12], or None without votes."""
        if self.votes is None or self.vote_rows is None:
            return self.votes
        return self.votes[self.vote_rows]


@dataclass(frozen=True, eq=False)
class GridEvidence:
    """The class probabilities that a network predicts for one view, the paper's O_mono.

    ``colour`` is the colour that the view shows for each cell. It is undefined for free cells.
    """

    view: str
    probabilities: np.ndarray  # float16 [X, Y, Z, 12]
    seen: np.ndarray  # bool [X, Y, Z]
    voxel_m: float
    grid_to_scan: np.ndarray  # 4x4: metres from the grid's minimum corner to the scan frame
    colour: np.ndarray | None = None  # uint8 [X, Y, Z, 3]

    def __post_init__(self):
        put = object.__setattr__
        shape = (None, None, None, CLASS_COUNT)
        probabilities = checks.array("probabilities", self.probabilities, np.float16, shape)
        put(self, "probabilities", probabilities)
        put(self, "seen", checks.array("seen", self.seen, np.bool_, probabilities.shape[:3]))
        put(self, "voxel_m", checks.voxel_size(self.voxel_m))
        put(self, "grid_to_scan", checks.transform("grid_to_scan", self.grid_to_scan))
        if self.colour is not None:
            shape = (*probabilities.shape[:3], 3)
            put(self, "colour", checks.array("colour", self.colour, np.uint8, shape))


@dataclass(frozen=True, eq=False)
class FusedEvidence:
    """The combined evidence of all views in the room frame, as stored in ``evidence.npz``.

    A cell was observed if ``log_odds`` is not 0: it is occupied above 0 and free below 0.
    ``colour_sum`` and ``offset_sum`` are sums over the ``hits`` points of the cell. ``offset_sum /
    hits`` is the mean surface point relative to the cell centre in metres.
    """

    log_odds: np.ndarray  # float16 [X, Y, Z]
    votes: np.ndarray  # float16 [X, Y, Z, 12]
    colour_sum: np.ndarray  # float32 [X, Y, Z, 3]
    offset_sum: np.ndarray  # float32 [X, Y, Z, 3]
    hits: np.ndarray  # uint16 [X, Y, Z]; sums are scaled down together where it would overflow
    voxel_m: float
    origin_m: np.ndarray  # float64 [3]
    scan_to_room: np.ndarray  # float64 [4, 4]

    def __post_init__(self):
        put = object.__setattr__
        log_odds = checks.array("log_odds", self.log_odds, np.float16, (None, None, None))
        shape = log_odds.shape
        put(self, "log_odds", log_odds)
        put(self, "votes", checks.array("votes", self.votes, np.float16, (*shape, CLASS_COUNT)))
        for name in ("colour_sum", "offset_sum"):
            put(self, name, checks.array(name, getattr(self, name), np.float32, (*shape, 3)))
        put(self, "hits", checks.array("hits", self.hits, np.uint16, shape))
        put(self, "voxel_m", checks.voxel_size(self.voxel_m))
        put(self, "origin_m", checks.origin(self.origin_m, self.voxel_m))
        put(self, "scan_to_room", checks.transform("scan_to_room", self.scan_to_room))

"""``Mesh`` and ``PointCloud`` in the units and axes of their file, but near the origin."""

from dataclasses import dataclass, field, replace

import numpy as np

from world2minecraft.core.types import checks

# What is read of one file: a scanned flat at full detail has about five million of each.
MAX_FACES = 20_000_000
MAX_VERTICES = 20_000_000
MAX_POINTS = 200_000_000  # A building scanned from forty places; points are thinned as they come.


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles that may have colours, pictures and classes.

    ``vertices`` float32 [V, 3], ``faces`` int32 [F, 3]. ``colour`` uint8 [V, 3] sRGB, or none.
    Pictures may lie on the faces: ``pixels`` uint8 [T, 3] holds one after the other, row by row,
    ``image_sizes`` int64 [M, 2] their widths and heights, ``face_image`` int16 [F] which one a
    face has (-1: none), ``uv`` float32 [V, 2] where on it (0, 0 is its upper left corner; pictures
    repeat).
    ``labels`` uint8 [F] are class ids, 255 unknown, or none.
    """

    vertices: np.ndarray
    faces: np.ndarray
    colour: np.ndarray | None = None
    uv: np.ndarray | None = None
    face_image: np.ndarray | None = None
    pixels: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), np.uint8))
    image_sizes: np.ndarray = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    labels: np.ndarray | None = None

    def __post_init__(self):
        put = object.__setattr__
        put(self, "vertices", checks.array("vertices", self.vertices, np.float32, (None, 3)))
        put(self, "faces", checks.array("faces", self.faces, np.int32, (None, 3)))
        count, faces = len(self.vertices), len(self.faces)
        if faces and not (self.faces.min() >= 0 and self.faces.max() < count):
            raise ValueError(f"faces must name vertices 0 to {count - 1}")
        if self.colour is not None:
            put(self, "colour", checks.array("colour", self.colour, np.uint8, (count, 3)))
        if self.uv is not None:
            put(self, "uv", checks.array("uv", self.uv, np.float32, (count, 2)))
        if self.face_image is not None:
            if self.uv is None:
                raise ValueError("pictures on faces need uv")
            image = checks.array("face_image", self.face_image, np.int16, (faces,))
            if faces and image.max() >= len(self.image_sizes):
                raise ValueError(f"face_image must be -1 to {len(self.image_sizes) - 1}")
            if int(self.image_sizes.prod(axis=1).sum()) != len(self.pixels):
                raise ValueError("pixels must be those of image_sizes")
            put(self, "face_image", image)
        if self.labels is not None:
            put(self, "labels", checks.array("labels", self.labels, np.uint8, (faces,)))

    @property
    def positions(self) -> np.ndarray:
        """The vertices, float32 [V, 3]."""
        return self.vertices

    @property
    def coloured(self) -> bool:
        """Whether any of it has a colour of its own."""
        return self.colour is not None or self.face_image is not None

    def moved(self, transform: np.ndarray) -> "Mesh":
        """Return it carried by a 4x4 transform, which may scale."""
        return replace(self, vertices=_transform_points(self.vertices, transform))


@dataclass(frozen=True, eq=False)
class PointCloud:
    """Points that may have colours and classes.

    ``points`` float32 [N, 3], ``colour`` uint8 [N, 3] sRGB or none, ``labels`` uint8 [N] class ids
    (255 unknown) or none.
    """

    points: np.ndarray
    colour: np.ndarray | None = None
    labels: np.ndarray | None = None

    def __post_init__(self):
        put = object.__setattr__
        put(self, "points", checks.array("points", self.points, np.float32, (None, 3)))
        count = len(self.points)
        if self.colour is not None:
            put(self, "colour", checks.array("colour", self.colour, np.uint8, (count, 3)))
        if self.labels is not None:
            put(self, "labels", checks.array("labels", self.labels, np.uint8, (count,)))

    @property
    def positions(self) -> np.ndarray:
        """The points, float32 [N, 3]."""
        return self.points

    @property
    def coloured(self) -> bool:
        """Whether it has colours."""
        return self.colour is not None

    def moved(self, transform: np.ndarray) -> "PointCloud":
        """Return it carried by a 4x4 transform, which may scale."""
        return replace(self, points=_transform_points(self.points, transform))


Geometry = Mesh | PointCloud


@dataclass(frozen=True, eq=False)
class LoadedGeometry:
    """A mesh or point cloud as read, and what its file or format states of it.

    A place in the file is one of ``geometry`` plus ``offset`` (float64 [3]), so that surveyed
    coordinates of millions of metres keep their millimetres. ``unit_m`` is metres per unit where
    that is stated; ``usual_up`` is the axis that the format takes for up, ``up_stated`` says that
    it is more than a habit.
    """

    geometry: Geometry
    kind: str
    offset: np.ndarray = field(default_factory=lambda: np.zeros(3))
    unit_m: float | None = None
    usual_up: str = "z"
    up_stated: bool = False
    notes: tuple[str, ...] = ()
    read: int = 0  # Points of the file, before they were thinned.


def _transform_points(positions: np.ndarray, transform: np.ndarray) -> np.ndarray:
    """Return float32 places carried in float64, in blocks that need little memory."""
    result = np.empty_like(positions)
    turn, shift = transform[:3, :3].T, transform[:3, 3]
    for start in range(0, len(positions), 1 << 18):
        block = slice(start, start + (1 << 18))
        result[block] = positions[block].astype(np.float64) @ turn + shift
    return result

"""Meshes and point clouds in the unit and axes of their file, moved close to the origin."""

from dataclasses import dataclass, field, replace

import numpy as np

from world2minecraft.core.types import checks

# What is read of one file: a scanned flat at full detail has about five million of each.
MAX_FACES = 20_000_000
MAX_VERTICES = 20_000_000
MAX_POINTS = 200_000_000  # A building scanned from forty places; points are thinned as they come.
MAX_POSITION = 1e15  # Squares of larger numbers are not finite as float32; none is a place.


def are_places(positions: np.ndarray) -> np.ndarray:
    """Return for each position [N, 3] whether its numbers can be those of a place, bool [N]."""
    return np.all(np.abs(positions) <= MAX_POSITION, axis=1)


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh with optional colours, textures and class labels.

    Texture images are stored one after the other, row by row, in ``pixels``, and repeat outside the
    range 0 to 1 of ``uv``.

    Attributes:
        vertices: Vertex positions, float32 [V, 3].
        faces: Vertex indices of the triangles, int32 [F, 3].
        colour: sRGB colours of the vertices, uint8 [V, 3], or None.
        uv: Texture coordinates of the vertices, float32 [V, 2]; (0, 0) is the upper left corner.
        face_image: Index of each triangle's texture image, int16 [F]; -1 for none.
        pixels: Pixels of all texture images, uint8 [T, 3].
        image_sizes: Widths and heights of the texture images, int64 [M, 2].
        labels: Class ids of the triangles, uint8 [F] (255 if unknown), or None.
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
            raise ValueError(f"faces must contain vertex indices from 0 to {count - 1}")
        if self.colour is not None:
            put(self, "colour", checks.array("colour", self.colour, np.uint8, (count, 3)))
        if self.uv is not None:
            put(self, "uv", checks.array("uv", self.uv, np.float32, (count, 2)))
        if self.face_image is not None:
            if self.uv is None:
                raise ValueError("face_image requires uv")
            image = checks.array("face_image", self.face_image, np.int16, (faces,))
            if faces and image.max() >= len(self.image_sizes):
                raise ValueError(
                    f"face_image must contain indices from -1 to {len(self.image_sizes) - 1}"
                )
            if int(self.image_sizes.prod(axis=1).sum()) != len(self.pixels):
                raise ValueError(
                    "the length of pixels must equal the total number of pixels in image_sizes"
                )
            put(self, "face_image", image)
        if self.labels is not None:
            put(self, "labels", checks.array("labels", self.labels, np.uint8, (faces,)))

    @property
    def positions(self) -> np.ndarray:
        """The vertices as float32 [V, 3]."""
        return self.vertices

    @property
    def coloured(self) -> bool:
        """Whether the mesh has vertex colours or textures."""
        return self.colour is not None or self.face_image is not None

    def moved(self, transform: np.ndarray) -> "Mesh":
        """Return the mesh transformed by a 4x4 matrix, which may include scale."""
        return replace(self, vertices=_transform_points(self.vertices, transform))


@dataclass(frozen=True, eq=False)
class PointCloud:
    """A point cloud with optional colours and class labels.

    Attributes:
        points: Point positions, float32 [N, 3].
        colour: sRGB colours, uint8 [N, 3], or None.
        labels: Class ids, uint8 [N] (255 if unknown), or None.
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
        """The points as float32 [N, 3]."""
        return self.points

    @property
    def coloured(self) -> bool:
        """Whether the points have colours."""
        return self.colour is not None

    def moved(self, transform: np.ndarray) -> "PointCloud":
        """Return the point cloud transformed by a 4x4 matrix, which may include scale."""
        return replace(self, points=_transform_points(self.points, transform))


Geometry = Mesh | PointCloud


@dataclass(frozen=True, eq=False)
class LoadedGeometry:
    """A mesh or point cloud as read from a file, with the metadata that the file states.

    Positions in the file are those of ``geometry`` plus ``offset``, so that large survey
    coordinates keep millimetre precision in float32.

    Attributes:
        geometry: The mesh or point cloud, near the origin.
        kind: Name of the file format, for notes.
        offset: Vector subtracted from all positions, float64 [3].
        unit_m: Metres per unit, or None if the file does not state it.
        usual_up: The up axis by convention of the format: ``x``, ``y`` or ``z``.
        up_stated: Whether the file or its specification states the up axis.
        notes: Remarks about the file for the user.
        read: Number of points in the file before downsampling.
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
    """Transform points in float64 and return them as float32, in blocks to limit memory use."""
    result = np.empty_like(positions)
    turn, shift = transform[:3, :3].T, transform[:3, 3]
    for start in range(0, len(positions), 1 << 18):
        block = slice(start, start + (1 << 18))
        result[block] = positions[block].astype(np.float64) @ turn + shift
    return result

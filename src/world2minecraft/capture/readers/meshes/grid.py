"""A solid on a coarse grid: which cells hold surface."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.readers.meshes.surface_model import Mesh, Solid
from world2minecraft.core.jit import njit

CELL_M = 0.10
MOST_CELLS = 6_000_000  # A flat of 25 x 20 x 12 m; larger places have larger cells.
AIR = 3  # Cells around the box, so that rays end in air.
STEP = 0.45  # Of a cell: so near to each other are the places that mark a triangle's cells.
MOST_SAMPLES = 2_000_000_000


@dataclass(frozen=True, eq=False)
class Grid:
    """Cells ``held`` bool [X, Y, Z] of side ``cell_m`` from ``origin_m``: which hold surface."""

    held: np.ndarray
    origin_m: np.ndarray
    cell_m: float

    def centers_m(self, cells: np.ndarray) -> np.ndarray:
        """Return the middles of cells int [N, 3], float64 [N, 3]."""
        return self.origin_m + (cells + 0.5) * self.cell_m


def grid_of(solid: Solid, low_m: np.ndarray, high_m: np.ndarray) -> Grid:
    """Return which cells of a box hold surface of a solid in metres.

    Raises:
        ValueError: its triangles have far more surface than a building.
    """
    size = high_m - low_m
    cell_m = max(CELL_M, float((np.prod(size + 2 * AIR * CELL_M) / MOST_CELLS) ** (1 / 3)))
    shape = np.ceil(size / cell_m).astype(int) + 2 * AIR + 1
    origin = np.asarray(low_m - AIR * cell_m, np.float64)
    held = np.zeros(tuple(shape), np.bool_)
    if isinstance(solid, Mesh):
        if _sample_count(solid.vertices, solid.faces, cell_m) > MOST_SAMPLES:
            raise ValueError("its triangles have far more surface than a building")
        _mark_triangles(solid.vertices, solid.faces, origin, cell_m, held)
    else:
        _mark_points(solid.points, origin, cell_m, held)
    return Grid(held, origin, cell_m)


@njit
def _parts(vertices, face, cell_m):
    """Return into how many parts a triangle's sides are cut, so that no cell is missed."""
    longest = 0.0
    for k in range(3):
        one, other = vertices[face[k]], vertices[face[(k + 1) % 3]]
        length = 0.0
        for a in range(3):
            length += (one[a] - other[a]) ** 2
        longest = max(longest, length)
    return max(1.0, np.ceil(np.sqrt(longest) / (STEP * cell_m)))


@njit
def _sample_count(vertices, faces, cell_m):
    total = 0.0
    for f in range(len(faces)):
        parts = _parts(vertices, faces[f], cell_m)
        total += (parts + 1) * (parts + 2) / 2
    return total


@njit
def _mark(place, origin, cell_m, held):
    i = int(np.floor((place[0] - origin[0]) / cell_m))
    j = int(np.floor((place[1] - origin[1]) / cell_m))
    k = int(np.floor((place[2] - origin[2]) / cell_m))
    if 0 <= i < held.shape[0] and 0 <= j < held.shape[1] and 0 <= k < held.shape[2]:
        held[i, j, k] = True


@njit
def _mark_triangles(vertices, faces, origin, cell_m, held):
    place = np.empty(3)
    for f in range(len(faces)):
        a, b, c = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
        parts = int(_parts(vertices, faces[f], cell_m))
        for i in range(parts + 1):
            for j in range(parts + 1 - i):
                s, t = i / parts, j / parts
                for axis in range(3):
                    place[axis] = (1 - s - t) * a[axis] + s * b[axis] + t * c[axis]
                _mark(place, origin, cell_m, held)


@njit
def _mark_points(points, origin, cell_m, held):
    for n in range(len(points)):
        _mark(points[n], origin, cell_m, held)

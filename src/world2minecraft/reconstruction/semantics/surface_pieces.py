"""Connected pieces of surface, and the measurements by which they are classified."""

from dataclasses import dataclass
from typing import cast

import numpy as np
from scipy import ndimage

from world2minecraft.geometry.connected_components import label_components
from world2minecraft.geometry.histogram_peaks import highest_peak
from world2minecraft.reconstruction.layout.parameters import PieceParameters
from world2minecraft.reconstruction.layout.surface_cells import Surface

PLANE_GATE_M = 0.03


@dataclass(frozen=True, eq=False)
class Piece:
    """A connected piece, with its cells and the box that contains nearly all of its surface."""

    at: tuple[np.ndarray, np.ndarray, np.ndarray]  # Cell indices, each int [N].
    low_m: np.ndarray  # float64 [3], of the surface points.
    high_m: np.ndarray
    oklab: np.ndarray  # float64 [3], the median colour.
    near_wall: bool
    off_wall_m: float  # How far from the nearest wall's column it reaches.
    flat_share: float  # The share of its cells on its largest upright plane.

    @property
    def size_m(self) -> np.ndarray:
        """The size of the box along x, y and z in metres, float64 [3]."""
        return self.high_m - self.low_m

    @property
    def tall_m(self) -> float:
        """The height of the box in metres."""
        return float(self.size_m[2])

    @property
    def long_m(self) -> float:
        """The longer side of the box in plan, in metres."""
        return float(self.size_m[:2].max())

    @property
    def thin_m(self) -> float:
        """The shorter side of the box in plan, in metres."""
        return float(self.size_m[:2].min())


def find_pieces(
    surface: Surface, rest: np.ndarray, wall: np.ndarray, parameters: PieceParameters
) -> list[Piece]:
    """Return the pieces of ``rest``, bool [X, Y, Z], connected by faces, edges or corners.

    A piece is near a wall if one of its cells is within ``near_wall_m`` of a column of the wall.
    """
    parts, count = label_components(rest)
    columns = wall.sum(axis=2) >= 2
    apart_m = np.full(columns.shape, np.inf)
    if columns.any():
        distance = cast(np.ndarray, ndimage.distance_transform_edt(~columns))
        apart_m = distance * surface.voxel_m
    pieces = []
    for part, box in enumerate(ndimage.find_objects(parts, count), 1):
        start = np.array([side.start for side in box])
        cells = np.argwhere(parts[box] == part) + start
        pieces.append(_piece(surface, cells, apart_m, parameters))
    return pieces


def _piece(
    surface: Surface, cells: np.ndarray, apart_m: np.ndarray, parameters: PieceParameters
) -> Piece:
    """Return the piece that cells, int [N, 3], form."""
    at = tuple(cells.T)
    points = surface.points_m[at].astype(np.float64)
    planes = [highest_peak(points[:, axis], PLANE_GATE_M)[1] for axis in (0, 1)]
    return Piece(
        at=at,  # type: ignore[arg-type]
        low_m=np.quantile(points, 0.02, axis=0),
        high_m=np.quantile(points, 0.98, axis=0),
        oklab=np.median(surface.oklab[at].astype(np.float64), axis=0),
        near_wall=bool(apart_m[at[:2]].min() <= parameters.near_wall_m),
        off_wall_m=float(np.sort(apart_m[at[:2]])[int(0.95 * (len(cells) - 1))]),
        flat_share=max(planes) / len(cells),
    )

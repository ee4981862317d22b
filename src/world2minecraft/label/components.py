"""Connected pieces of surface, and the few numbers by which they are told apart."""

from dataclasses import dataclass
from typing import cast

import numpy as np
from scipy import ndimage

from world2minecraft.label.surface import Surface

FULL = np.ones((3, 3, 3), bool)


@dataclass(frozen=True, eq=False)
class Piece:
    """One connected piece: its cells and its box. ``thin_m`` is its shortest side in plan."""

    at: tuple[np.ndarray, np.ndarray, np.ndarray]  # Cell indices, each int [N].
    low_m: np.ndarray  # float64 [3], of the surface points.
    high_m: np.ndarray
    lightness: float
    near_wall: bool

    @property
    def size_m(self) -> np.ndarray:
        """The box, float64 [3], along x, y and z."""
        return self.high_m - self.low_m

    @property
    def long_m(self) -> float:
        """The longer side in plan."""
        return float(self.size_m[:2].max())

    @property
    def thin_m(self) -> float:
        """The shorter side in plan."""
        return float(self.size_m[:2].min())


def find_pieces(surface: Surface, rest: np.ndarray, wall: np.ndarray) -> list[Piece]:
    """Return the pieces of ``rest``, bool [X, Y, Z], joined by faces, edges and corners."""
    parts, count = cast(tuple[np.ndarray, int], ndimage.label(rest, FULL))
    near_wall = ndimage.binary_dilation(wall, FULL, iterations=2)
    pieces = []
    for part, box in enumerate(ndimage.find_objects(parts, count), 1):
        start = np.array([side.start for side in box])
        cells = np.argwhere(parts[box] == part) + start
        pieces.append(piece_of(surface, cells, near_wall))
    return pieces


def piece_of(surface: Surface, cells: np.ndarray, near_wall: np.ndarray) -> Piece:
    """Return the piece that cells, int [N, 3], form."""
    at = tuple(cells.T)
    points = surface.points_m[at].astype(np.float64)
    return Piece(
        at=at,  # type: ignore[arg-type]
        low_m=np.quantile(points, 0.02, axis=0),
        high_m=np.quantile(points, 0.98, axis=0),
        lightness=float(np.median(surface.oklab[at][:, 0])),
        near_wall=bool(near_wall[at].any()),
    )

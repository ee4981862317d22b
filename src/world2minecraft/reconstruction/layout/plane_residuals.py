"""The relief of a plane: the distance of each position of its face from the plane.

Noise spreads the points of a plane over two layers of cells. The mean of all points at a position
gives its depth to millimetres, and thus the layer of cells that contains the plane's matter.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.geometry.histogram_peaks import highest_peak
from world2minecraft.reconstruction.layout.surface_cells import Surface, turn_surface

SOLID_M = 0.008  # SSCNet's 4 of 64: about this much matter makes a cell of 8 cm solid.
FIT_GATES_M = (0.012, 0.012, 0.01, 0.01)  # Doors, pictures and boards do not show where it lies.
MAX_SLOPE = 0.01  # 0.6 degrees: twice what a frame may be off.
MANY_POINTS = 300  # More points at a position do not improve it: the lens dominates.
FIT_PLACES = 60  # Fewer positions, half a square metre, do not show a slope.
SIGMAS, SIGMA_OF_MEDIAN = 2.5, 1.48


@dataclass(frozen=True, eq=False)
class PlaneResiduals:
    """A part of a plane, rotated so that axis 0 points to its solid side, [N, A, B]."""

    axis: int
    sign: int
    box: tuple[slice, slice, slice]  # Part of the rotated grid.
    cells: np.ndarray  # bool [N, A, B]: the cells of the plane and of what noise made of it.
    weight: np.ndarray  # float [A, B], points seen at each place
    depth_m: np.ndarray  # float [A, B], their mean along axis 0; that of the plane where none
    plane_m: np.ndarray  # float [A, B], the fitted plane

    @property
    def seen(self) -> np.ndarray:
        """Mask of the observed positions, bool [A, B]."""
        return self.weight > 0

    @property
    def gap_m(self) -> np.ndarray:
        """Distance of each position behind the fitted plane in metres, float [A, B]."""
        return self.depth_m - self.plane_m

    def edge_m(self, surface: Surface) -> float:
        """Return the position in metres along axis 0 at which the first layer of the box begins."""
        cells = np.array([0, surface.occupied.shape[self.axis]])
        ends = surface.origin_m[self.axis] + cells * surface.voxel_m
        return float(min(self.sign * ends)) + self.box[0].start * surface.voxel_m

    def of(self, values: np.ndarray) -> np.ndarray:
        """Return the view [N, A, B] of an array [X, Y, Z] that this relief covers."""
        return turn_surface(values, self.axis, self.sign)[self.box]


def noise_of(distances_m: np.ndarray) -> float:
    """Return 2.5 standard deviations of distances, float [N], inferred from their median, or 0."""
    return SIGMAS * SIGMA_OF_MEDIAN * float(np.median(distances_m)) if len(distances_m) else 0.0


def measure_plane_residuals(
    surface: Surface, cells: np.ndarray, axis: int, sign: int, box: tuple[slice, slice, slice]
) -> PlaneResiduals:
    """Measure the relief of a plane.

    Args:
        surface: Surface of the room.
        cells: Mask of the cells of the plane within ``box``, bool [N, A, B].
        axis: Axis perpendicular to the plane.
        sign: 1 if the solid side is towards larger coordinates, otherwise -1.
        box: Part of the rotated grid.
    """
    weight = np.where(cells, turn_surface(surface.hits, axis, sign)[box], 0).astype(np.float64)
    outward = sign * turn_surface(surface.points_m[..., axis], axis, sign)[box]
    total = weight.sum(axis=0)
    mean = (weight * outward).sum(axis=0) / np.maximum(total, 1)
    plane = _fitted(mean, total, surface.voxel_m)
    depth = np.where(total > 0, mean, plane)
    return PlaneResiduals(axis, sign, box, cells, total, depth, plane)


def _fitted(depth_m: np.ndarray, weight: np.ndarray, voxel_m: float) -> np.ndarray:
    """Return the plane fitted robustly to the seen positions, float [A, B]."""
    a, b = np.nonzero(weight)
    if not len(a):
        return np.zeros(depth_m.shape)
    values = depth_m[a, b]
    strength = np.sqrt(np.minimum(weight[a, b], MANY_POINTS))
    columns = np.stack([np.ones(len(a)), a - a.mean(), b - b.mean()], axis=1)
    fit = np.array([highest_peak(values, FIT_GATES_M[0] / 2)[0], 0.0, 0.0])
    for gate_m in FIT_GATES_M:
        near = np.abs(values - columns @ fit) <= gate_m
        if near.sum() < FIT_PLACES:
            break
        rows = columns[near] * strength[near, None]
        found = np.linalg.lstsq(rows, values[near] * strength[near], rcond=None)[0].round(9)
        if np.abs(found[1:]).max() > MAX_SLOPE * voxel_m:
            break
        fit = found
    rows, columns = np.indices(depth_m.shape)
    return fit[0] + fit[1] * (rows - a.mean()) + fit[2] * (columns - b.mean())

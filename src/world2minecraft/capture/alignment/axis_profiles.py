"""Profiles of surface area along an axis, and precise positions of faces.

Other faces lie within centimetres of a wall, such as a door leaf or a window pane behind it, or a
picture or the back of a wardrobe in front of it. The face with the most surface is the wall.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.geometry.oriented_points import OrientedPoints, cell_codes

CELL_M = 0.10  # Area is counted in patches of this side, each of which counts once.
SEARCH_RADIUS_M = 0.08  # A door's leaf lies up to 5 cm behind its wall.
BIN_M = 0.01
LIMITS_M = (0.03, 0.02, 0.012, 0.012)  # The last one separates a wall from a rug 2 cm away.
MIN_SIGMA_M = 0.003  # Error of a face apart from noise, in metres; caps a patch's weight.


@dataclass(frozen=True)
class AxisProfile:
    """The surface area at each position along an axis, counted in distinct patches.

    Attributes:
        start_m: Position of the start of the first bin in metres.
        bin_m: Width of the bins in metres.
        area_m2: Area of each bin with its two neighbours, float64 [bins]; the noise of consumer
            depth sensors at 3 m is about 2 cm.
        bin_area_m2: Area of each bin alone, float64 [bins].
    """

    start_m: float
    bin_m: float
    area_m2: np.ndarray
    bin_area_m2: np.ndarray

    def centers_m(self) -> np.ndarray:
        """Return the centres of the bins in metres."""
        return self.start_m + (np.arange(len(self.area_m2)) + 0.5) * self.bin_m

    def peaks(self, min_area_m2: float) -> np.ndarray:
        """Return the positions of local maxima with at least the given area, in ascending order."""
        bins = np.concatenate([[0.0], self.bin_area_m2, [0.0]])
        height = bins[1:-1] + (bins[:-2] + bins[2:]) / 2
        padded = np.concatenate([[0.0], height, [0.0]])
        top = (height >= padded[:-2]) & (height > padded[2:]) & (self.area_m2 >= min_area_m2)
        return self.centers_m()[top]

    def area_at(self, place_m: float) -> float:
        """Return the area in the bin at a position, or 0 outside the profile."""
        index = int(np.floor((place_m - self.start_m) / self.bin_m))
        return float(self.area_m2[index]) if 0 <= index < len(self.area_m2) else 0.0


def axis_profile(points_m: np.ndarray, axis: int, bin_m: float = 0.03) -> AxisProfile:
    """Compute the surface profile of points along an axis.

    Args:
        points_m: Points on surfaces that face along the axis, in metres, float64 [N, 3].
        axis: Axis 0, 1 or 2.
        bin_m: Width of the bins in metres.
    """
    if not len(points_m):
        return AxisProfile(0.0, bin_m, np.zeros(1), np.zeros(1))
    start = float(np.floor(points_m[:, axis].min() / bin_m) - 1) * bin_m
    bins = ((points_m[:, axis] - start) / bin_m).astype(np.int64)
    count = int(bins.max()) + 2
    occupied = np.unique(cell_codes(other_axes(points_m, axis), CELL_M) * count + bins)
    near = np.unique(np.concatenate([occupied - 1, occupied, occupied + 1]))
    return AxisProfile(start, bin_m, _area_per_bin(near, count), _area_per_bin(occupied, count))


def _area_per_bin(codes: np.ndarray, count: int) -> np.ndarray:
    return np.bincount(codes % count, minlength=count) * (CELL_M * CELL_M)


def face_position_m(facing: OrientedPoints, axis: int, place_m: float) -> float:
    """Return the position of the largest face near a given position along an axis.

    Args:
        facing: Surface points that face in one direction along the axis.
        axis: Axis 0, 1 or 2.
        place_m: Approximate position, which is returned if there are no points within 8 cm.
    """
    near = facing.subset(np.abs(facing.points_m[:, axis] - place_m) < SEARCH_RADIUS_M)
    if not len(near.points_m):
        return place_m
    found = axis_profile(near.points_m, axis, BIN_M)
    place_m = float(found.centers_m()[int(np.argmax(found.area_m2 + found.bin_area_m2))])
    trust = 1 / (near.sigma_m**2 + MIN_SIGMA_M**2) / points_per_cell(near.points_m, axis)
    for limit_m in LIMITS_M:
        off = near.points_m[:, axis] - place_m
        weight = trust * tukey_weights(off, limit_m)
        if weight.sum() > 0:
            place_m += float(np.sum(weight * off) / weight.sum())
    return place_m


def points_per_cell(points_m: np.ndarray, axis: int) -> np.ndarray:
    """Return for each point the number of points in the same 10 cm cell of a face."""
    codes = cell_codes(other_axes(points_m, axis), CELL_M)
    _, index, counts = np.unique(codes, return_inverse=True, return_counts=True)
    return counts[index]


def other_axes(points: np.ndarray, axis: int) -> np.ndarray:
    """Return the coordinates [N, 2] of points along the two axes other than ``axis``."""
    return points[:, [other for other in range(3) if other != axis]]


def tukey_weights(off_m: np.ndarray, limit_m: float) -> np.ndarray:
    """Return Tukey's weights of residuals, which are 0 from ``limit_m`` on."""
    return np.where(np.abs(off_m) < limit_m, (1 - (off_m / limit_m) ** 2) ** 2, 0.0)

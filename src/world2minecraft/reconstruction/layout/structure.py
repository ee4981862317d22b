"""Find the structure of a storey: floor, ceiling, walls, and the openings in the walls.

Floor and ceiling are the two large horizontal planes of a room. The top of the floor is z = 0 in
the room frame, so the floor's cells are the layer below. Noise lifts some floor points into the
layer above. This **spill** is moved down; it is the only case in which a labeller clears an
observed cell.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.geometry.histogram_peaks import highest_peak
from world2minecraft.reconstruction.layout.openings import WallFace, read_wall
from world2minecraft.reconstruction.layout.parameters import StructureParameters
from world2minecraft.reconstruction.layout.plane_residuals import PlaneResiduals, noise_of
from world2minecraft.reconstruction.layout.slanted_walls import SlantedWall, find_slanted_walls
from world2minecraft.reconstruction.layout.sloped_ceilings import find_slopes
from world2minecraft.reconstruction.layout.surface_cells import Surface
from world2minecraft.reconstruction.layout.walls import WallRun, find_walls

MIN_FLOOR_M2 = 0.5
FLOOR_GATES_M = (0.08, 0.06, 0.05)
MAX_FLOOR_SLOPE = 0.035  # 2 degrees.
MAX_FLOOR_NOISE_M = 0.08
MIN_GAIN = 1.1  # A floor that is askew must explain this many times the cells of a level one.


@dataclass(frozen=True, eq=False)
class Floor:
    """The cells of the floor, and the cells directly above it that are noise (spill)."""

    cells: np.ndarray  # bool [X, Y, Z]
    spill: np.ndarray  # bool [X, Y, Z]


def find_floor(surface: Surface, parameters: StructureParameters) -> Floor:
    """Return the cells of the floor, including those that spill is moved to.

    Spill is a cell above the floor's layer whose surface point is on the floor within its noise,
    at least ``spill_m``, with no occupied cell above it, as there would be at the foot of a wall or
    leg.
    """
    cells, spill = np.zeros((2, *surface.occupied.shape), bool)
    layer = surface.floor_layer
    if not 0 <= layer < surface.occupied.shape[2]:
        return Floor(cells, spill)
    cells[:, :, : layer + 1] = surface.occupied[:, :, : layer + 1]
    rise_m, noise_m = _floor_relief(surface, parameters)
    for above in range(layer + 1, min(layer + 3, surface.occupied.shape[2])):
        low = surface.points_m[:, :, above, 2] - rise_m < noise_m
        spill[:, :, above] = surface.occupied[:, :, above] & low
    raised = surface.occupied & ~spill
    spill[:, :, :-1] &= ~raised[:, :, 1:]
    return Floor(cells, spill)


def _floor_relief(surface: Surface, parameters: StructureParameters) -> tuple[np.ndarray, float]:
    """Return how far the floor rises over z = 0 in each column, float [X, Y], and its noise.

    The frame may lean by a degree, and depth that is bent lifts the far end of a floor.
    """
    low = max(surface.floor_layer - 1, 0)
    near = surface.occupied[:, :, low : surface.floor_layer + 3]
    points = surface.points_m[:, :, low : surface.floor_layer + 3][near].astype(np.float64)
    rise_m = np.zeros(surface.occupied.shape[:2])
    straight = np.abs(points[:, 2]) <= parameters.spill_m
    if straight.sum() * surface.voxel_m**2 < MIN_FLOOR_M2:
        return rise_m, parameters.spill_m
    middle = points[straight, :2].mean(axis=0)
    rows = np.column_stack([np.ones(len(points)), points[:, :2] - middle])
    on, fit = straight, np.zeros(3)
    for gate_m in FLOOR_GATES_M:
        found = np.linalg.lstsq(rows[on], points[on, 2], rcond=None)[0].round(9)
        if np.abs(found[1:]).max() > MAX_FLOOR_SLOPE or abs(found[0]) > parameters.plane_gate_m:
            break
        fit = found
        on = np.abs(points[:, 2] - rows @ fit) <= gate_m
    off_m = np.abs(points[:, 2] - rows @ fit)
    if (off_m <= parameters.spill_m).sum() < MIN_GAIN * straight.sum():
        return rise_m, parameters.spill_m
    noise_m = noise_of(off_m[off_m <= FLOOR_GATES_M[0]])
    shape = surface.occupied.shape
    plan_m = [surface.origin_m[a] + (np.arange(shape[a]) + 0.5) * surface.voxel_m for a in (0, 1)]
    slope_m = np.add.outer(fit[1] * (plan_m[0] - middle[0]), fit[2] * (plan_m[1] - middle[1]))
    return fit[0] + slope_m, float(np.clip(noise_m, parameters.spill_m, MAX_FLOOR_NOISE_M))


def find_ceiling(
    surface: Surface, parameters: StructureParameters
) -> tuple[np.ndarray, float | None]:
    """Return the ceiling's cells, bool [X, Y, Z], and its height in metres, or None if unseen.

    The ceiling is the highest horizontal plane, seen from below, with at least ``ceiling_area_m2``.
    All occupied cells above it belong to it.
    """
    cells = np.zeros(surface.occupied.shape, bool)
    below_free = np.zeros_like(cells)
    below_free[:, :, 1:] = surface.free[:, :, :-1]
    below_free[:, :, 2:] |= surface.free[:, :, :-2] & surface.occupied[:, :, 1:-1]
    high = surface.points_m[..., 2] > parameters.ceiling_min_m
    heights = surface.points_m[surface.occupied & below_free & high][:, 2]
    needed = parameters.ceiling_area_m2 / surface.voxel_m**2
    while len(heights):
        peak, count = highest_peak(heights, parameters.plane_gate_m)
        above = int((heights > peak + parameters.plane_gate_m).sum())
        if count < needed:
            return cells, None
        if above < needed:
            height = surface.points_m[..., 2]
            near = (height > peak - parameters.plane_gate_m) & below_free
            # The top cells of walls end just under the ceiling, and are no part of it.
            near |= height > peak - 0.4 * parameters.plane_gate_m
            return surface.occupied & near, peak
        heights = heights[heights > peak + parameters.plane_gate_m]
    return cells, None


@dataclass(frozen=True, eq=False)
class Wall:
    """A straight piece of wall, its relief and its face."""

    run: WallRun
    relief: PlaneResiduals
    face: WallFace


@dataclass(frozen=True, eq=False)
class Structure:
    """The floor, ceiling and walls of a storey in its own frame, with the floor's top at z = 0."""

    surface: Surface
    floor: Floor
    ceiling: np.ndarray  # bool [X, Y, Z]
    ceiling_m: float | None  # None where it was not seen
    slopes: np.ndarray  # bool [X, Y, Z], sloped ceilings
    wall: np.ndarray  # bool [X, Y, Z]
    walls: tuple[Wall, ...]
    slanted: tuple[SlantedWall, ...] = ()

    @property
    def rest(self) -> np.ndarray:
        """Mask of the occupied cells that are not structure, bool [X, Y, Z]."""
        level = self.floor.cells | self.floor.spill | self.ceiling | self.slopes
        return self.surface.occupied & ~(level | self.wall)


def structure_of(surface: Surface, parameters: StructureParameters) -> Structure:
    """Find the structure of a storey."""
    floor = find_floor(surface, parameters)
    ceiling, ceiling_m = find_ceiling(surface, parameters)
    level = floor.cells | floor.spill | ceiling
    slopes = find_slopes(surface, level, parameters)
    level |= slopes
    mask = np.zeros(surface.occupied.shape, bool)
    walls = []
    slanted = find_slanted_walls(surface, surface.occupied & ~level, parameters)
    for piece in slanted:  # First, or a slanted wall would be cut into steps along the axes.
        mask |= piece.cells
    for run, relief in find_walls(surface, level | mask, slopes, ceiling_m, parameters):
        face = read_wall(surface, relief, parameters)
        relief.of(mask)[face.cells] = True
        walls.append(Wall(run, relief, face))
    return Structure(surface, floor, ceiling, ceiling_m, slopes, mask, tuple(walls), slanted)

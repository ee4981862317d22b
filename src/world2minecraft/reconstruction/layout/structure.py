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
from world2minecraft.reconstruction.layout.plane_residuals import PlaneResiduals
from world2minecraft.reconstruction.layout.slanted_walls import SlantedWall, find_slanted_walls
from world2minecraft.reconstruction.layout.sloped_ceilings import find_slopes
from world2minecraft.reconstruction.layout.surface_cells import Surface
from world2minecraft.reconstruction.layout.walls import WallRun, find_walls


@dataclass(frozen=True, eq=False)
class Floor:
    """The cells of the floor, and the cells directly above it that are noise (spill)."""

    cells: np.ndarray  # bool [X, Y, Z]
    spill: np.ndarray  # bool [X, Y, Z]


def find_floor(surface: Surface, parameters: StructureParameters) -> Floor:
    """Return the cells of the floor, including those that spill is moved to.

    Spill is a cell of the first layer above the floor whose surface point is within ``spill_m`` of
    z = 0, with no occupied cell above it, as there would be at the foot of a wall or leg.
    """
    cells, spill = np.zeros((2, *surface.occupied.shape), bool)
    layer = surface.floor_layer
    if not 0 <= layer < surface.occupied.shape[2]:
        return Floor(cells, spill)
    cells[:, :, : layer + 1] = surface.occupied[:, :, : layer + 1]
    if layer + 1 < surface.occupied.shape[2]:
        low = surface.points_m[:, :, layer + 1, 2] < parameters.spill_m
        spill[:, :, layer + 1] = surface.occupied[:, :, layer + 1] & low
    if layer + 2 < surface.occupied.shape[2]:
        spill[:, :, layer + 1] &= ~surface.occupied[:, :, layer + 2]
    return Floor(cells, spill)


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

"""The structure of one storey: floor, ceiling and walls, and what is cut into the walls."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.reconstruction.layout.horizontal import Floor, find_ceiling, find_floor
from world2minecraft.reconstruction.layout.openings import WallFace, read_wall
from world2minecraft.reconstruction.layout.parameters import StructureParameters
from world2minecraft.reconstruction.layout.plane_residuals import Relief
from world2minecraft.reconstruction.layout.sloped_ceilings import find_slopes
from world2minecraft.reconstruction.layout.surface_cells import Surface
from world2minecraft.reconstruction.layout.walls import WallRun, find_walls


@dataclass(frozen=True, eq=False)
class Wall:
    """A straight piece of wall, its relief and what its places are."""

    run: WallRun
    relief: Relief
    face: WallFace


@dataclass(frozen=True, eq=False)
class Structure:
    """Floor, ceiling and walls of a storey, in its own frame: its floor's top is z = 0."""

    surface: Surface
    floor: Floor
    ceiling: np.ndarray  # bool [X, Y, Z]
    ceiling_m: float | None  # None where it was not seen
    slopes: np.ndarray  # bool [X, Y, Z], sloped ceilings
    wall: np.ndarray  # bool [X, Y, Z]
    walls: tuple[Wall, ...]

    @property
    def rest(self) -> np.ndarray:
        """The occupied cells that are no structure, bool [X, Y, Z]."""
        level = self.floor.cells | self.floor.spill | self.ceiling | self.slopes
        return self.surface.occupied & ~(level | self.wall)


def structure_of(surface: Surface, parameters: StructureParameters) -> Structure:
    """Return the structure of a storey."""
    floor = find_floor(surface, parameters)
    ceiling, ceiling_m = find_ceiling(surface, parameters)
    level = floor.cells | floor.spill | ceiling
    slopes = find_slopes(surface, level, parameters)
    level |= slopes
    mask = np.zeros(surface.occupied.shape, bool)
    walls = []
    for run, relief in find_walls(surface, level, slopes, ceiling_m, parameters):
        face = read_wall(surface, relief, parameters)
        relief.of(mask)[face.cells] = True
        walls.append(Wall(run, relief, face))
    return Structure(surface, floor, ceiling, ceiling_m, slopes, mask, tuple(walls))

"""Voxel builds: convert every occupied cell to one full block."""

import numpy as np

from world2minecraft.construction.block_lattice import Lattice
from world2minecraft.construction.canvas import BARRIER, Canvas
from world2minecraft.construction.colour_sources import BuildSource
from world2minecraft.construction.shell_geometry import STANDING_M, WALL, WINDOW
from world2minecraft.construction.surface_painting import BlockChoice, paint_surface
from world2minecraft.core.types import UNSEEN, OccupancyGrid
from world2minecraft.geometry.morphology import dilate, fill_holes


def place_voxels(
    canvas: Canvas,
    source: BuildSource,
) -> tuple[np.ndarray, ...]:
    """Set one block per occupied cell and return the footprint of each storey, bool [X, Y].

    Unseen holes in the floor are closed with invisible barriers of class 0 so that players can walk
    on them, while the visible blocks are exactly the occupied cells.
    """
    grid, colours, coloured, palette, parameters = source
    start = _start(grid, canvas.lattice)
    inside = tuple(slice(low, low + size) for low, size in zip(start, grid.shape, strict=True))
    states = np.zeros(grid.shape, np.uint16)
    occupied = grid.occupied
    surfaces = np.where(occupied, grid.labels.astype(np.int32) << 16, 0)
    surfaces[occupied] += grid.instance[occupied]
    for surface in np.unique(surfaces[occupied]):
        mask = surfaces == surface
        class_id, number = int(surface) >> 16, int(surface) & 0xFFFF
        limit = parameters.object_colours if number else parameters.structure_colours * 2
        if class_id == WINDOW:
            states[mask] = canvas.id_of(palette.glass)
            continue
        choice = BlockChoice(class_id, palette, parameters, limit)
        chosen = paint_surface(mask, colours, coloured, choice)
        names, index = np.unique(chosen.astype(str), return_inverse=True)
        states[mask] = canvas.ids_of(names.tolist())[index]
    canvas.states[inside] = states
    canvas.semantic[inside] = np.where(occupied, grid.labels, 0)
    canvas.instance[inside] = np.where(occupied, grid.instance, 0)
    footprints = []
    for ground in canvas.lattice.grounds:
        footprint = np.zeros(canvas.states.shape[:2], bool)
        footprint[inside[:2]] = _footprint(grid, ground - start[2])
        footprints.append(footprint)
    _close_floor(canvas, footprints[0])
    return tuple(footprints)


def _start(grid: OccupancyGrid, lattice: Lattice) -> tuple[int, int, int]:
    """Return the lattice index of cell (0, 0, 0)."""
    at = lattice.coordinates_of(grid.origin_m)
    x, y, z = np.rint(at).astype(int).tolist()
    return x, y, z


def _footprint(grid: OccupancyGrid, ground: int) -> np.ndarray:
    """Return the columns in which a person can stand: free or furnished near the floor, no wall.

    ``ground`` is the first layer of cells above a storey's floor.
    """
    low = int(np.clip(ground, 0, grid.shape[2] - 1))
    high = low + max(2, int(STANDING_M / grid.voxel_m))
    labels, source = grid.labels[:, :, low:high], grid.source[:, :, low:high]
    stood = (((labels == 0) & (source != UNSEEN)) | ((labels > WINDOW) & (labels != 255))).any(2)
    walls = np.isin(labels, (WALL, WINDOW)).any(2)
    return fill_holes(stood & ~walls)


def _close_floor(canvas: Canvas, footprint: np.ndarray) -> None:
    layer = canvas.lattice.ground - 1
    plan = dilate(footprint, (1, 1))
    holes = plan & (canvas.states[:, :, layer] == 0)
    canvas.states[:, :, layer][holes] = canvas.id_of(BARRIER)

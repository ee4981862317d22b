"""Ceilings: flat, at the heights at which they were seen, and closed over their rooms."""

import numpy as np

from world2minecraft.construction.lattice import Lattice
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.structure_faces import blocks_behind, find_faces, straighten, vote
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.morphology import binary_closing, dilate

CEILING = int(SemanticClass.CEILING)
CEILING_SHARE = 0.4  # Of a storey's plan; of less, most of the ceiling would be made up.


def find_ceiling(
    grid: OccupancyGrid,
    free: np.ndarray,
    lattice: Lattice,
    parameters: BuildParameters,
    coloured: list[tuple[np.ndarray, np.ndarray]],
) -> np.ndarray:
    """Return the ceiling, bool [X, Y, Z]: one flat layer at each height where much was seen.

    Args:
        grid: what each cell is.
        free: bool [x, y, z], the cells that were seen free.
        lattice: where the blocks stand.
        parameters: how to build; a ceiling that is off is empty.
        coloured: gets the cells and the blocks, int [N, 3] each, that colour it.
    """
    ceiling = np.zeros(lattice.shape, bool)
    if parameters.ceiling == "off":
        return ceiling
    solid = grid.labels == CEILING
    for faces in find_faces(grid, solid, free, lattice, 2):
        if faces.side > 0:
            continue  # A ceiling's upper side is not the room's.
        straight = straighten(faces, grid.voxel_m, parameters)
        votes = vote(straight, grid, lattice)
        sheet = votes.area >= parameters.face_share
        gap = max(1, round(parameters.gap_m * lattice.blocks_per_metre / 2))
        ceiling |= binary_closing(sheet, (gap, gap, 0))
        coloured.append((votes.cells, blocks_behind(votes, grid, lattice)))
    ceiling[:, :, : lattice.ground + 1] = False
    return ceiling


def close_ceiling(
    ceiling: np.ndarray, footprint: np.ndarray, shut: np.ndarray, storey: tuple[int, int]
) -> None:
    """Close, in place, a storey's ceiling over its rooms, where much of it was seen.

    Scans seldom look up; what was seen free up there stays open.

    Args:
        ceiling: bool [X, Y, Z], what was seen of it.
        footprint: bool [X, Y], the columns within the storey's rooms.
        shut: bool [X, Y, Z], the blocks in which little space was seen free.
        storey: its first layer above the floor, and the one past its last.
    """
    ground, top = storey
    own = ceiling[:, :, ground + 1 : top + 1]
    layers = (own & footprint[:, :, None]).sum((0, 1))
    if not len(layers) or layers.max() < CEILING_SHARE * max(footprint.sum(), 1):
        return
    level = int(layers.argmax())
    own[:, :, level] |= footprint & shut[:, :, ground + 1 + level] & ~own.any(2)


def cover_with_glass(
    ceiling: np.ndarray, walls: np.ndarray, footprint: np.ndarray, storey: tuple[int, int]
) -> None:
    """Lay, in place, a ceiling upon the walls of a storey in which none was seen.

    Of glass it shuts a room and hides nothing of it.

    Args:
        ceiling: bool [X, Y, Z], what there is of it.
        walls: bool [X, Y, Z], where walls stand.
        footprint: bool [X, Y], the columns within the storey's rooms.
        storey: its first layer above the floor, and the one past its last.
    """
    ground, top = storey
    layers = np.flatnonzero(walls[:, :, ground:top].any((0, 1)))
    level = ground + int(layers.max()) + 1 if len(layers) else top
    plan = dilate(footprint, (1, 1))
    if level < min(top, walls.shape[2]) and not (ceiling[:, :, ground:top] & plan[..., None]).any():
        ceiling[:, :, level] |= plan

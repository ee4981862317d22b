"""The shell of a room as blocks: floor, walls with windows, ceiling, by rules and never by fit.

In: the labelled grid and the lattice. Out: masks of blocks for each part of the shell, each part
a surface of its own with the cells that colour it.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.build.faces import blocks_behind, find_faces, see_through, straighten, vote
from world2minecraft.build.lattice import Lattice, face_shares, overlaps, volume_shares
from world2minecraft.build.morphology import beside, closed, grown, nearest_of, without_holes
from world2minecraft.build.parameters import BuildParameters
from world2minecraft.classes import SemanticClass
from world2minecraft.types import UNSEEN, OccupancyGrid

CEILING, FLOOR, WALL, WINDOW = (
    int(SemanticClass[name]) for name in ("CEILING", "FLOOR", "WALL", "WINDOW")
)
# A block with more seen free space than this is an opening, not a hole in what was seen. A guess:
# a wall's own face takes up to half of its block's free space away.
OPEN_SHARE = 0.35
STANDING_M = 1.0  # Free space up to here shows that one can stand on the floor under it.
FOOTPRINT_SHARE = 0.25


@dataclass(frozen=True, eq=False)
class Shell:
    """Masks bool [X, Y, Z] of the lattice, and the cells [N, 3] and blocks [N, 3] of colours.

    ``patches`` int32 [X, Y, Z] numbers the surfaces that are painted each by itself, from 1.
    """

    floor: np.ndarray
    walls: np.ndarray
    windows: np.ndarray
    ceiling: np.ndarray
    patches: np.ndarray
    footprint: np.ndarray  # bool [X, Y]: where one stands within the room
    cells: np.ndarray
    blocks: np.ndarray


def build_shell(grid: OccupancyGrid, lattice: Lattice, parameters: BuildParameters) -> Shell:
    """Return the shell of a room; see docs/building.md for its rules."""
    free = (grid.labels == 0) & (grid.source != UNSEEN)
    open_share = volume_shares(free, grid, lattice)
    coloured: list[tuple[np.ndarray, np.ndarray]] = []
    patches = np.zeros(lattice.shape, np.int32)
    walls = _walls(grid, free, open_share, lattice, parameters, patches, coloured)
    ceiling = _ceiling(grid, free, lattice, parameters, coloured)
    footprint = _footprint(grid, open_share, walls, lattice)
    floor = _floor(grid, footprint, walls, lattice, coloured)
    walls = _up_and_down(walls, ceiling, open_share, lattice, parameters)
    windows = _windows(grid, walls, free, lattice, parameters)
    patches[ceiling], patches[floor] = patches.max() + 1, patches.max() + 2
    patches = _grow_patches(patches, walls)
    return Shell(
        floor=floor,
        walls=walls & ~windows,
        windows=windows,
        ceiling=ceiling & ~walls,
        patches=patches,
        footprint=footprint,
        cells=np.concatenate([cells for cells, _ in coloured]),
        blocks=np.concatenate([blocks for _, blocks in coloured]),
    )


def _walls(grid, free, open_share, lattice, parameters, patches, coloured) -> np.ndarray:
    """Return where walls and windows stand, straight and one block thick."""
    solid = (grid.labels == WALL) | (grid.labels == WINDOW)
    walls = np.zeros(lattice.shape, bool)
    for axis in (0, 1):
        for faces in find_faces(grid, solid, free, lattice, axis):
            straight = straighten(faces, grid.voxel_m, parameters)
            votes = vote(straight, grid, lattice)
            through = see_through(straight, votes, free, grid, lattice)
            open_share[:] = np.where(through >= 0, through, open_share)
            sheet = _closed(
                votes.area >= parameters.face_share, axis, open_share, lattice, parameters
            )
            coloured.append((votes.cells, blocks_behind(votes, grid, lattice)))
            fresh = sheet & ~walls
            layers = np.indices(lattice.shape, sparse=True)[axis]
            number = 1 + int(patches.max()) + layers
            patches[fresh] = np.broadcast_to(number, lattice.shape)[fresh]
            walls |= sheet
    walls |= _unfaced(grid, solid, free, walls, lattice, parameters)
    return _with_corners(walls, open_share)


def _closed(sheet, axis, open_share, lattice, parameters) -> np.ndarray:
    """Close the small unseen holes of wall sheets square to an axis, leaving openings open."""
    gap = max(1, round(parameters.gap_m * lattice.blocks_per_metre / 2))
    reach = tuple(0 if other == axis else gap for other in range(3))
    return sheet | (closed(sheet, reach) & (open_share < OPEN_SHARE))


def _unfaced(grid, solid, free, walls, lattice, parameters) -> np.ndarray:
    """Return wall blocks whose cells touch no seen free space, away from the walls that do."""
    faced = beside(free)
    edges = [lattice.edges_of(grid, axis) for axis in range(3)]
    rest = face_shares(solid & ~faced, edges, lattice.shape) >= max(0.5, parameters.face_share)
    near = grown(walls, (1, 1, 0))
    return rest & ~near


def _with_corners(walls: np.ndarray, open_share: np.ndarray) -> np.ndarray:
    """Fill the block where two walls meet at an inner corner, which no face speaks for."""
    along_x = np.zeros_like(walls)
    along_x[1:] |= walls[:-1]
    along_x[:-1] |= walls[1:]
    along_y = np.zeros_like(walls)
    along_y[:, 1:] |= walls[:, :-1]
    along_y[:, :-1] |= walls[:, 1:]
    return walls | (along_x & along_y & (open_share < 0.05))


def _up_and_down(walls, ceiling, open_share, lattice, parameters) -> np.ndarray:
    """Continue walls to the floor, over their own unseen gaps, and to the ceiling when near."""
    shut = open_share < OPEN_SHARE
    ground = lattice.ground
    above = np.flip(np.maximum.accumulate(np.flip(walls, 2), axis=2), 2)
    result = walls.copy()
    result[:, :, ground:] |= (above & shut)[:, :, ground:]
    if not ceiling.any():
        return result
    level = int(np.median(np.argwhere(ceiling)[:, 2]))
    reach = max(1, round(parameters.gap_m * lattice.blocks_per_metre))
    for z in range(max(ground, level - reach), level + 1):
        result[:, :, z] |= result[:, :, z - 1] & shut[:, :, z]
    return result


def _ceiling(grid, free, lattice, parameters, coloured) -> np.ndarray:
    """Return the ceiling: one flat layer at each height at which much of it was seen."""
    ceiling = np.zeros(lattice.shape, bool)
    if not parameters.ceiling:
        return ceiling
    solid = grid.labels == CEILING
    for faces in find_faces(grid, solid, free, lattice, 2):
        if faces.side > 0:
            continue  # A ceiling's upper side is not the room's.
        straight = straighten(faces, grid.voxel_m, parameters)
        votes = vote(straight, grid, lattice)
        sheet = votes.area >= parameters.face_share
        gap = max(1, round(parameters.gap_m * lattice.blocks_per_metre / 2))
        ceiling |= closed(sheet, (gap, gap, 0))
        coloured.append((votes.cells, blocks_behind(votes, grid, lattice)))
    ceiling[:, :, : lattice.ground + 1] = False
    return ceiling


def _footprint(grid, open_share, walls, lattice) -> np.ndarray:
    """Return the columns, bool [X, Y], in which one stands inside the room."""
    ground = lattice.ground
    top = ground + max(1, round(STANDING_M * lattice.blocks_per_metre))
    labels = grid.labels
    things = (labels == FLOOR) | ((labels > WINDOW) & (labels != 255))
    cover = [overlaps(lattice.edges_of(grid, axis), lattice.shape[axis]) for axis in (0, 1)]
    below_m = STANDING_M - grid.origin_m[2]
    low = things[:, :, : max(1, round(below_m / grid.voxel_m))].any(2).astype(np.float32)
    stood = cover[0] @ low @ cover[1].T >= FOOTPRINT_SHARE
    stood |= (open_share[:, :, ground:top] >= 0.5).any(2)
    stood &= ~walls[:, :, ground:top].any(2)
    return without_holes(closed(stood, (1, 1)))


def _floor(grid, footprint, walls, lattice, coloured) -> np.ndarray:
    """Return the floor: one flat layer under the footprint, its walls and its open rim."""
    ground = lattice.ground
    plan = grown(footprint, (1, 1))
    floor = np.zeros(lattice.shape, bool)
    floor[:, :, ground - 1] = plan | walls[:, :, ground:].any(2)
    cells = np.argwhere(grid.labels == FLOOR)
    blocks = np.empty_like(cells)
    for axis in (0, 1):
        edges = lattice.edges_of(grid, axis)
        blocks[:, axis] = np.floor((edges[:-1] + edges[1:]) / 2)[cells[:, axis]]
    blocks[:, 2] = ground - 1
    coloured.append((cells, blocks))
    return floor


def _windows(grid, walls, free, lattice, parameters) -> np.ndarray:
    """Return the wall blocks that are glass: where windows outvote walls."""
    shape = lattice.shape
    area = {WALL: np.zeros(shape, np.float32), WINDOW: np.zeros(shape, np.float32)}
    if not (grid.labels == WINDOW).any():
        return np.zeros(shape, bool)
    solid = (grid.labels == WALL) | (grid.labels == WINDOW)
    for axis in (0, 1):
        for faces in find_faces(grid, solid, free, lattice, axis):
            straight = straighten(faces, grid.voxel_m, parameters)
            kinds = grid.labels[tuple(straight.cells.T)]
            for kind in area:
                chosen = straight._replace(
                    cells=straight.cells[kinds == kind], planes=straight.planes[kinds == kind]
                )
                area[kind] += vote(chosen, grid, lattice).area
    return walls & (area[WINDOW] > area[WALL])


def _grow_patches(patches: np.ndarray, walls: np.ndarray) -> np.ndarray:
    """Give wall blocks that were added later the patch of the nearest wall block."""
    missing = walls & (patches == 0)
    if not missing.any() or not (patches > 0).any():
        return patches
    nearest, _ = nearest_of(patches > 0)
    result = patches.copy()
    result[missing] = patches[tuple(axis[missing] for axis in nearest)]
    return result

"""The shell of a room as blocks: floor, walls with windows, and ceiling.

The shell is built by rules, not by fitting, from the labelled grid and the lattice. The result is a
mask of blocks for each part of the shell, with the cells that colour it. Ceilings are flat, at the
heights at which they were seen, and closed above their rooms.
"""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import find_objects

from world2minecraft.construction.block_lattice import (
    Lattice,
    face_shares,
    overlap_weights,
    volume_shares,
)
from world2minecraft.construction.doorways import open_doorways
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.structure_faces import (
    EVEN,
    blocks_behind,
    find_faces,
    majority,
    see_through,
    straighten,
    vote,
)
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import UNSEEN, OccupancyGrid
from world2minecraft.geometry.connected_components import label_face_components
from world2minecraft.geometry.morphology import (
    binary_closing,
    dilate,
    dilate_faces,
    erode_faces,
    fill_holes,
    nearest_set_cells,
)

CEILING, FLOOR, WALL, WINDOW = (
    int(SemanticClass[name]) for name in ("CEILING", "FLOOR", "WALL", "WINDOW")
)
CEILING_SHARE = 0.4  # Of a storey's plan; of less, most of the ceiling would be made up.
# A block with more seen free space than this is an opening, not a hole in what was seen. A guess:
# a wall's own face takes up to half of its block's free space away.
OPEN_SHARE = 0.35
STANDING_M = 1.0  # Free space up to here shows that one can stand on the floor under it.
FOOTPRINT_SHARE = 0.25
OPEN_FLOOR = 0.5  # A block of an upper floor of which more was seen free is no floor.
ROOM_M2 = 0.5  # Smaller pieces of floor lie in a window's niche or behind it.
LEVEL_SHARE = 0.2  # Share of a wall's columns to whose height the others are raised.
FLOORED_SHARE = 0.3  # Minimum share of an upper room's plan; furniture hides much of it.
STAIRWELL_M = 0.7  # A narrower hole in an upper floor was left by noise.


def find_ceiling(
    grid: OccupancyGrid,
    free: np.ndarray,
    lattice: Lattice,
    parameters: BuildParameters,
    coloured: list[tuple[np.ndarray, np.ndarray]],
) -> np.ndarray:
    """Return the ceiling, bool [X, Y, Z]: a flat layer at each height at which much of it was seen.

    Args:
        grid: Grid of the room.
        free: Bool [X, Y, Z] mask of the cells seen as free.
        lattice: Block lattice of the room.
        parameters: Build parameters; with ``ceiling`` off, the result is empty.
        coloured: List to which the cells and blocks, int [N, 3] each, that colour the ceiling are
            appended.
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
    """Close, in place, the ceiling of a storey above its rooms if much of it was seen.

    Scans rarely look up. Blocks with space seen as free stay open.

    Args:
        ceiling: Bool [X, Y, Z] mask of the seen ceiling.
        footprint: Bool [X, Y] mask of the columns within the storey's rooms.
        shut: Bool [X, Y, Z] mask of the blocks with little space seen as free.
        storey: First layer above the floor of the storey, and its exclusive end.
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
    """Add, in place, a ceiling on top of the walls of a storey in which none was seen.

    A glass ceiling closes the room without hiding it.

    Args:
        ceiling: Bool [X, Y, Z] mask of the existing ceiling.
        walls: Bool [X, Y, Z] mask of the walls.
        footprint: Bool [X, Y] mask of the columns within the storey's rooms.
        storey: First layer above the floor of the storey, and its exclusive end.
    """
    ground, top = storey
    layers = np.flatnonzero(walls[:, :, ground:top].any((0, 1)))
    level = ground + int(layers.max()) + 1 if len(layers) else top
    plan = dilate(footprint, (1, 1))
    if level < min(top, walls.shape[2]) and not (ceiling[:, :, ground:top] & plan[..., None]).any():
        ceiling[:, :, level] |= plan


@dataclass(frozen=True, eq=False)
class Shell:
    """The parts of a shell as bool [X, Y, Z] masks, with the cells and blocks that colour them.

    ``patches`` int32 [X, Y, Z] numbers the separately painted surfaces from 1. ``cells`` and
    ``blocks`` are int [N, 3] and correspond to each other.
    """

    floor: np.ndarray
    walls: np.ndarray
    windows: np.ndarray
    ceiling: np.ndarray
    patches: np.ndarray
    footprints: tuple[np.ndarray, ...]  # bool [X, Y] a storey: where one stands in its rooms
    cells: np.ndarray
    blocks: np.ndarray


def build_shell(grid: OccupancyGrid, lattice: Lattice, parameters: BuildParameters) -> Shell:
    """Build the shell of a room or a house by the rules described in docs/explanation/building.md.

    Walls are found over all storeys at once, so that they are above one another. The other parts
    are found storey by storey.
    """
    free = (grid.labels == 0) & (grid.source != UNSEEN)
    open_share = volume_shares(free, grid, lattice)
    coloured: list[tuple[np.ndarray, np.ndarray]] = []
    patches = np.zeros(lattice.shape, np.int32)
    walls = _walls(grid, free, open_share, lattice, parameters, patches, coloured)
    ceiling = find_ceiling(grid, free, lattice, parameters, coloured)
    footprints: list[np.ndarray] = []
    floor = np.zeros(lattice.shape, bool)
    for ground, top in lattice.storeys:
        # First of all, so that what stands before a wall's hidden foot is not taken for a room.
        _up_and_down(walls, ceiling, open_share, lattice, (ground, top), parameters)
        open_floor = _open_floor(grid, free, lattice, ground)
        footprint = _footprint(grid, open_share, walls, lattice, (ground, top), open_floor)
        _floor(grid, footprint, walls, lattice, (ground, top), open_floor, floor, coloured)
        _level_tops(walls, patches, open_share, (ground, top))
        open_doorways(walls, grid, lattice, (ground, top))
        footprints.append(footprint)
        close_ceiling(ceiling, footprint, open_share < OPEN_SHARE, (ground, top))
        if parameters.ceiling == "glass":
            cover_with_glass(ceiling, walls, footprint, (ground, top))
        if ground > lattice.ground:
            _one_slab(ceiling, floor, ground - 1)
    windows = _windows(grid, walls, free, lattice, parameters)
    _number_levels(patches, ceiling, floor, lattice)
    patches = _grow_patches(patches, walls)
    return Shell(
        floor=floor,
        walls=walls & ~windows,
        windows=windows,
        ceiling=ceiling & ~walls & ~floor,
        patches=patches,
        footprints=tuple(footprints),
        cells=np.concatenate([cells for cells, _ in coloured]),
        blocks=np.concatenate([blocks for _, blocks in coloured]),
    )


def _open_floor(grid, free, lattice: Lattice, ground: int) -> np.ndarray:
    """Return the columns, bool [X, Y], in which free space was seen through an upper floor.

    They are inferred from the layers of cells of the rest of the floor, which may be as thin as a
    tenth of a block.
    """
    shape = lattice.shape[:2]
    if ground == lattice.ground:
        return np.zeros(shape, bool)  # The lowest floor has no stairwell.
    edges = lattice.edges_of(grid, 2)
    near = np.flatnonzero(np.abs((edges[:-1] + edges[1:]) / 2 - ground) < 1)
    if not len(near):
        return np.zeros(shape, bool)
    layer = near[(grid.labels[:, :, near] == FLOOR).sum(axis=(0, 1)).argmax()]
    cover = [overlap_weights(lattice.edges_of(grid, axis), lattice.shape[axis]) for axis in (0, 1)]
    share = cover[0] @ free[:, :, layer].astype(np.float32) @ cover[1].T
    return np.asarray(share >= OPEN_FLOOR)


def _one_slab(ceiling: np.ndarray, floor: np.ndarray, layer: int) -> None:
    """Remove, in place, the parts of a ceiling in or above the floor that it carries."""
    under = floor[:, :, layer]
    for z in (layer, layer + 1):
        ceiling[:, :, z] &= ~under


def _number_levels(patches, ceiling, floor, lattice) -> None:
    """Number, in place, each storey's ceiling and floor as separate surfaces."""
    for ground, top in lattice.storeys:
        for mask, start in ((ceiling, ground), (floor, ground - 1)):
            part = mask[:, :, start:top]
            patches[:, :, start:top][part] = patches.max() + 1


def _walls(grid, free, open_share, lattice, parameters, patches, coloured) -> np.ndarray:
    """Return the mask of walls and windows, straight and one block thick."""
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
            # A window's cells show the sky, and would paint the wall around it.
            own = grid.labels[tuple(votes.cells.T)] == WALL
            coloured.append((votes.cells[own], blocks_behind(votes, grid, lattice)[own]))
            fresh = sheet & ~walls
            layers = np.indices(lattice.shape, sparse=True)[axis]
            number = 1 + int(patches.max()) + layers
            patches[fresh] = np.broadcast_to(number, lattice.shape)[fresh]
            walls |= sheet
    walls |= _unfaced(grid, solid, free, walls, lattice, parameters)
    return _with_corners(walls, open_share)


def _closed(sheet, axis, open_share, lattice, parameters) -> np.ndarray:
    """Close small unseen holes of wall sheets perpendicular to an axis; openings stay open."""
    gap = max(1, round(parameters.gap_m * lattice.blocks_per_metre / 2))
    reach = tuple(0 if other == axis else gap for other in range(3))
    return sheet | (binary_closing(sheet, reach) & (open_share < OPEN_SHARE))


def _unfaced(grid, solid, free, walls, lattice, parameters) -> np.ndarray:
    """Return wall blocks whose cells touch no free space, away from walls that do."""
    faced = dilate_faces(free)
    edges = [lattice.edges_of(grid, axis) for axis in range(3)]
    rest = face_shares(solid & ~faced, edges, lattice.shape) >= max(0.5, parameters.face_share)
    near = dilate(walls, (1, 1, 0))
    return rest & ~near


def _with_corners(walls: np.ndarray, open_share: np.ndarray) -> np.ndarray:
    """Fill the block at an inner corner of two walls, which has no face."""
    along_x = np.zeros_like(walls)
    along_x[1:] |= walls[:-1]
    along_x[:-1] |= walls[1:]
    along_y = np.zeros_like(walls)
    along_y[:, 1:] |= walls[:, :-1]
    along_y[:, :-1] |= walls[:, 1:]
    return walls | (along_x & along_y & (open_share < 0.05))


def _up_and_down(walls, ceiling, open_share, lattice, storey, parameters) -> None:
    """Extend walls, in place, to their floor, across unseen gaps and to a close ceiling.

    ``storey`` is its first layer above the floor and its exclusive end.
    """
    ground, top = storey
    own = walls[:, :, ground:top]
    shut = open_share[:, :, ground:top] < OPEN_SHARE
    above = np.flip(np.maximum.accumulate(np.flip(own, 2), axis=2), 2)
    own |= above & shut
    held = np.argwhere(ceiling[:, :, ground : top + 2])
    if not len(held):
        return
    level = min(int(np.median(held[:, 2])), own.shape[2] - 1)
    reach = max(1, round(parameters.gap_m * lattice.blocks_per_metre))
    for z in range(max(1, level - reach), level + 1):
        own[:, :, z] |= own[:, :, z - 1] & shut[:, :, z]


def _level_tops(walls, patches, open_share, storey) -> None:
    """Raise, in place, the columns of each wall to the height that much of it reaches.

    If a scan looks down, walls end at a ragged line. Space seen as free stays open.
    """
    ground, top = storey
    own, shut = walls[:, :, ground:top], open_share[:, :, ground:top] < OPEN_SHARE
    numbers = np.where(own, patches[:, :, ground:top], 0)
    heights = np.arange(1, own.shape[2] + 1)
    for number in np.unique(numbers[numbers > 0]).tolist():
        tops = ((numbers == number) * heights).max(axis=2)
        columns = tops > 0
        level = int(np.quantile(tops[columns], 1 - LEVEL_SHARE, method="higher"))
        for z in range(int(tops[columns].min()), level):
            own[:, :, z] |= own[:, :, z - 1] & shut[:, :, z] & columns


def _footprint(grid, open_share, walls, lattice, storey, open_floor) -> np.ndarray:
    """Return the columns inside a storey's rooms, bool [X, Y].

    ``open_floor`` bool [X, Y] are the columns of a stairwell, in which the floor was seen through.
    """
    ground, end = storey
    top = min(ground + max(1, round(STANDING_M * lattice.blocks_per_metre)), end)
    labels = grid.labels
    things = (labels == FLOOR) | ((labels > WINDOW) & (labels != 255))
    cover = [overlap_weights(lattice.edges_of(grid, axis), lattice.shape[axis]) for axis in (0, 1)]
    edges = lattice.edges_of(grid, 2)
    first, last = np.searchsorted((edges[:-1] + edges[1:]) / 2, [ground - 1.0, float(top)])
    first = 0 if ground == lattice.ground else first
    low = things[:, :, first : max(last, first + 1)].any(2).astype(np.float32)
    stood = cover[0] @ low @ cover[1].T >= FOOTPRINT_SHARE
    stood |= (open_share[:, :, ground:top] >= 0.5).any(2)
    walled = walls[:, :, ground:top].any(2)
    whole = fill_holes(binary_closing(stood & ~walled & ~open_floor, (1, 1)))
    whole = _rooms(whole & ~walled & ~_wide(open_floor, lattice), lattice)
    return whole if ground == lattice.ground else _carried_by_floor(whole, grid, lattice, ground)


def _rooms(plan: np.ndarray, lattice: Lattice) -> np.ndarray:
    """Return a plan, bool [X, Y], without separate parts that are too small for a room."""
    parts, sizes = label_face_components(plan)
    least = min(ROOM_M2 * lattice.blocks_per_metre**2, sizes.max(initial=0))
    return plan & (sizes[parts] >= least)


def _carried_by_floor(plan: np.ndarray, grid, lattice, ground: int) -> np.ndarray:
    """Return the parts of an upper storey's plan, bool [X, Y], with floor below.

    Free space seen outside, above the roof of a lower part of the house, is not a room.
    """
    edges = lattice.edges_of(grid, 2)
    middles = (edges[:-1] + edges[1:]) / 2
    near = (middles > ground - 1.5) & (middles < ground + 0.5)
    floor = (grid.labels[:, :, near] == FLOOR).any(2).astype(np.float32)
    cover = [overlap_weights(lattice.edges_of(grid, axis), lattice.shape[axis]) for axis in (0, 1)]
    seen = (cover[0] @ floor @ cover[1].T >= FOOTPRINT_SHARE) & plan
    parts, sizes = label_face_components(plan)
    share = np.bincount(parts[seen], minlength=len(sizes)) / np.maximum(sizes, 1)
    return plan & (share[parts] >= FLOORED_SHARE)


def _wide(mask: np.ndarray, lattice: Lattice) -> np.ndarray:
    """Return the parts of a plan, bool [X, Y], that are as wide as a stairwell."""
    reach = max(0, round(STAIRWELL_M * lattice.blocks_per_metre / 2) - 1)
    core = mask.copy()
    for _ in range(reach):
        core = erode_faces(core)
    return dilate(core, (reach, reach)) & mask


def _floor(grid, footprint, walls, lattice, storey, open_floor, floor, coloured) -> None:
    """Set, in place, a storey's floor as a flat layer under its rooms, walls and open rim."""
    ground, top = storey
    plan = dilate(footprint, (1, 1)) | walls[:, :, ground:top].any(2)
    floor[:, :, ground - 1] |= plan & ~_wide(open_floor, lattice)
    cells = np.argwhere(grid.labels == FLOOR)
    height = lattice.edges_of(grid, 2)[cells[:, 2]]
    nearest = np.abs(height[:, None] - np.array(lattice.grounds)).argmin(axis=1)
    cells = cells[np.array(lattice.grounds)[nearest] == ground]
    blocks = np.empty_like(cells)
    for axis in (0, 1):
        edges = lattice.edges_of(grid, axis)
        blocks[:, axis] = np.floor((edges[:-1] + edges[1:]) / 2)[cells[:, axis]]
    blocks[:, 2] = ground - 1
    coloured.append((cells, blocks))


def _windows(grid, walls, free, lattice, parameters) -> np.ndarray:
    """Return the wall blocks in which the votes for window exceed those for wall."""
    lead = np.zeros(lattice.shape, np.float32)
    if not (grid.labels == WINDOW).any():
        return np.zeros(lattice.shape, bool)
    solid = (grid.labels == WALL) | (grid.labels == WINDOW)
    for axis in (0, 1):
        for faces in find_faces(grid, solid, free, lattice, axis):
            straight = straighten(faces, grid.voxel_m, parameters)
            glazed = grid.labels[tuple(straight.cells.T)] == WINDOW
            lead += majority(straight, glazed, grid, lattice)
    return without_ragged_edges(walls & (lead > EVEN))


def without_ragged_edges(windows: np.ndarray) -> np.ndarray:
    """Return windows, bool [X, Y, Z], without outermost rows of at most half of the next row.

    The labels at the edges of a window are uncertain. Windows of fewer than three rows stay.
    """
    result = windows.copy()
    parts, _ = label_face_components(windows)
    for number, box in enumerate(find_objects(parts), start=1):
        part = parts[box] == number
        for axis in range(3):
            rows = np.moveaxis(part, axis, 0)
            sizes = rows.sum(axis=(1, 2))
            for edge, inner in ((0, 1), (-1, -2)):
                if len(sizes) >= 3 and 2 * sizes[edge] <= sizes[inner]:
                    np.moveaxis(result[box], axis, 0)[edge][rows[edge]] = False
    return result


def _grow_patches(patches: np.ndarray, walls: np.ndarray) -> np.ndarray:
    """Assign wall blocks that were added later to the patch of the nearest wall block."""
    missing = walls & (patches == 0)
    if not missing.any() or not (patches > 0).any():
        return patches
    nearest, _ = nearest_set_cells(patches > 0)
    result = patches.copy()
    result[missing] = patches[tuple(axis[missing] for axis in nearest)]
    return result

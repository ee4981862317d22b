"""Faces of walls, windows and ceilings, where structure cells meet space seen as free.

A fused wall is a sheet of cells that varies by one or two cells. The room ends at its face, not at
its centre, so each face votes for the block behind it. Faces close to a common plane are first
moved to that plane, so that walls become straight and one block thick.
"""

from typing import NamedTuple

import numpy as np
from scipy import ndimage

from world2minecraft.construction.block_lattice import Lattice, overlap_weights, weighted_sum
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.core.types import OccupancyGrid

MIN_WIDTH_M = 0.24  # Narrower than this, structure is noise or the end of a wall. A guess.
EVEN = 1e-6  # Of a block; a smaller lead is a rounding error.


class Faces(NamedTuple):
    """Faces perpendicular to an axis that point in one direction, or those of thin sheets."""

    axis: int
    cells: np.ndarray  # intp [N, 3]
    planes: np.ndarray  # float64 [N], lattice coordinate of the face along the axis
    side: int  # 1: free space lies towards higher coordinates; -1: lower; 0: on both sides


class Votes(NamedTuple):
    """The area and the target block of each face."""

    area: np.ndarray  # float32 [X, Y, Z], in block faces
    target: np.ndarray  # intp [N], the block layer along the axis of each face
    cells: np.ndarray  # intp [N, 3]
    axis: int


def find_faces(
    grid: OccupancyGrid, solid: np.ndarray, free: np.ndarray, lattice: Lattice, axis: int
) -> list[Faces]:
    """Return the faces of solid cells along an axis: facing -, facing +, and those of sheets."""
    edges = lattice.edges_of(grid, axis)
    thin = max(1, int(0.75 / (edges[1] - edges[0])))
    body, empty = np.moveaxis(solid, axis, 0), np.moveaxis(free, axis, 0)
    above = np.zeros_like(body)
    above[:-1] = body[:-1] & empty[1:]
    below = np.zeros_like(body)
    below[1:] = body[1:] & empty[:-1]
    wide = _spread_wide(above | below, grid.voxel_m) if axis < 2 else np.ones_like(body)
    above, below = above & wide, below & wide
    ends = _sheet_ends(body, below, above, thin)
    sheet_low = np.argwhere(ends > 0)
    sheet_high = ends[ends > 0] - 1 + sheet_low[:, 0]
    single_above, single_below = above.copy(), below & (ends == 0)
    single_above[sheet_high, sheet_low[:, 1], sheet_low[:, 2]] = False
    found = [
        (np.argwhere(single_below), edges[:-1], -1),
        (np.argwhere(single_above), edges[1:], 1),
    ]
    faces = [_faces(axis, cells, edge[cells[:, 0]], side) for cells, edge, side in found]
    middles = (edges[sheet_low[:, 0]] + edges[sheet_high + 1]) / 2
    return [*faces, _faces(axis, sheet_low, middles, 0)]


def _spread_wide(faces: np.ndarray, voxel_m: float) -> np.ndarray:
    """Return which faces [axis, side, up] belong to a wide surface instead of a bump.

    Within 0.25 m to each side, most positions of at least one side must have a face at about the
    same depth and height.
    """
    reach = max(1, round(MIN_WIDTH_M / voxel_m))
    near = ndimage.maximum_filter(faces.astype(np.uint8), size=(3, 1, 3))
    counts = ndimage.convolve1d(
        near.astype(np.int32), np.ones(2 * reach + 1, np.int32), axis=1, mode="constant"
    )
    return np.asarray(counts) > reach * 0.8


def _sheet_ends(body: np.ndarray, below: np.ndarray, above: np.ndarray, thin: int) -> np.ndarray:
    """Return the thickness in cells of each thin sheet at its low face; 0 elsewhere."""
    ends = np.zeros(body.shape, np.intp)
    running = below.copy()
    for thickness in range(1, thin + 1):
        if thickness > 1:
            running = running & (ends == 0)
            running[: 1 - thickness] &= body[thickness - 1 :]
            running[1 - thickness :] = False
        top = np.zeros_like(above)
        top[: len(above) - thickness + 1] = above[thickness - 1 :]
        ends[running & top] = thickness
    return ends


def _faces(axis: int, cells: np.ndarray, planes: np.ndarray, side: int) -> Faces:
    order = {0: [0, 1, 2], 1: [1, 0, 2], 2: [1, 2, 0]}[axis]
    return Faces(axis, cells[:, order], planes, side)


def straighten(faces: Faces, voxel_m: float, parameters: BuildParameters) -> Faces:
    """Move the faces of each plane to the strongest plane within reach.

    The strongest plane attracts all faces near it, then the next strongest the remaining faces.
    Planes with an area below ``plane_area_m2`` attract no faces.
    """
    if not len(faces.planes):
        return faces
    steps = np.round(faces.planes * 1e6).astype(np.int64)
    levels, inverse, counts = np.unique(steps, return_inverse=True, return_counts=True)
    least = parameters.plane_area_m2 / voxel_m**2
    reach = parameters.plane_reach_blocks * 1e6
    taken = np.zeros(len(levels), bool)
    drawn = levels.copy()
    for level in np.lexsort((levels, -counts)):
        if counts[level] < least:
            break
        if taken[level]:
            continue
        near = ~taken & (np.abs(levels - levels[level]) <= reach)
        mean = np.average(levels[near], weights=counts[near])
        drawn[near] = levels[level] if abs(mean - levels[level]) > reach / 2 else int(mean)
        taken |= near
    return faces._replace(planes=drawn[inverse] / 1e6)


def vote(faces: Faces, grid: OccupancyGrid, lattice: Lattice) -> Votes:
    """Sum the area of the faces in front of each block; a face belongs to the block behind it."""
    target, flat = _flatten(faces, 1, grid, lattice)
    for position, weights in enumerate(_cover_across(faces, grid, lattice), 1):
        flat = weighted_sum(weights, flat, position)
    return Votes(np.moveaxis(flat, 0, faces.axis), target, faces.cells, faces.axis)


def majority(faces: Faces, chosen: np.ndarray, grid: OccupancyGrid, lattice: Lattice) -> np.ndarray:
    """Return the lead of the chosen faces in front of each block, float32 [X, Y, Z].

    The faces decide row by row, and then the rows decide. A rectangle thus remains a rectangle. By
    area, it would lose a corner block of which it covers 0.6 along both sides, and thus 0.36.

    Args:
        faces: Faces of the structure.
        chosen: Bool [N] mask of the faces.
        grid: Grid of the room.
        lattice: Block lattice of the room.
    """
    _, flat = _flatten(faces, np.where(chosen, 1, -1), grid, lattice)
    along, up = _cover_across(faces, grid, lattice)
    lead, area = weighted_sum(along, flat, 1), weighted_sum(along, np.abs(flat), 1)
    rows = np.where(lead > EVEN, area, -area)
    return np.moveaxis(weighted_sum(up, rows, 2), 0, faces.axis)


def _flatten(
    faces: Faces, values: np.ndarray | int, grid: OccupancyGrid, lattice: Lattice
) -> tuple[np.ndarray, np.ndarray]:
    """Return the target layer of each face, and the faces' values in those layers of cells."""
    count = lattice.shape[faces.axis]
    if faces.side == 0:
        target = np.floor(faces.planes).astype(np.intp)
    else:
        boundary = np.floor(faces.planes + 0.5).astype(np.intp)
        target = boundary - (1 if faces.side > 0 else 0)
    target = np.clip(target, 0, count - 1)
    across = [axis for axis in range(3) if axis != faces.axis]
    flat = np.zeros([count, *(grid.shape[axis] for axis in across)], np.float32)
    flat[(target, *(faces.cells[:, axis] for axis in across))] = values
    return target, flat


def _cover_across(faces: Faces, grid: OccupancyGrid, lattice: Lattice) -> list[np.ndarray]:
    """Return the overlap weights along the two axes across the faces."""
    return [
        overlap_weights(lattice.edges_of(grid, axis), lattice.shape[axis])
        for axis in range(3)
        if axis != faces.axis
    ]


def see_through(
    faces: Faces, votes: Votes, free: np.ndarray, grid: OccupancyGrid, lattice: Lattice
) -> np.ndarray:
    """Return the share of each block's face, float32 [X, Y, Z], through which space was seen.

    The share is measured in the layer of cells directly behind each plane and is -1 for blocks
    without a plane. A doorway is open in this layer, while the space in front of a recessed wall is
    not.
    """
    edges = lattice.edges_of(grid, faces.axis)
    result = np.full(lattice.shape, -1, np.float32)
    planes, first = np.unique(faces.planes, return_index=True)
    for plane, target in zip(planes, votes.target[first], strict=True):
        layer = int(np.searchsorted(edges, plane - 1e-6 * faces.side, "right")) - 1
        share = np.take(free, np.clip(layer, 0, len(edges) - 2), faces.axis).astype(np.float32)
        for position, weights in enumerate(_cover_across(faces, grid, lattice)):
            share = weighted_sum(weights, share, position)
        sheet = np.moveaxis(result, faces.axis, 0)[target]
        np.maximum(sheet, share, out=sheet)
    return result


def blocks_behind(votes: Votes, grid: OccupancyGrid, lattice: Lattice) -> np.ndarray:
    """Return the block, intp [N, 3], that each voting cell colours."""
    blocks = np.empty_like(votes.cells)
    for axis in range(3):
        edges = lattice.edges_of(grid, axis)
        centres = (edges[:-1] + edges[1:]) / 2
        blocks[:, axis] = np.floor(centres[votes.cells[:, axis]])
    blocks[:, votes.axis] = votes.target
    return blocks

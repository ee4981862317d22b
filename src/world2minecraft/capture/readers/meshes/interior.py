"""Detection of the free space inside a building: grid cells in which a person could stand.

From each free cell, the 26 directions to its neighbours are followed to the end of the voxel grid.
A cell is inside if there is a floor below it and surface in most other directions; the ceiling or
one wall may be missing. Where no such space exists, because only the lower part of a room or two
of its walls were captured, the space between walls that form a corner is used, up to the height of
a person. Spaces too small for a person, such as the inside of a cupboard or of a wall, are
discarded. ``backface_share`` measures how often the back of a face is seen from inside.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from world2minecraft.capture.readers.meshes.mesh_and_cloud import Geometry, Mesh
from world2minecraft.capture.readers.meshes.mesh_rasterizer import NO_FACE, render_face_ids
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera
from world2minecraft.geometry.connected_components import label_components

CELL_M = 0.10
MAX_CELLS = 6_000_000  # A flat of 25 x 20 x 12 m; larger places have larger cells.
PADDING_CELLS = 3  # Cells around the box, so that rays end in air.
SAMPLE_STEP = 0.45  # Spacing of the samples that mark the cells of a triangle, in cells.
MAX_SAMPLES = 2_000_000_000
CHECKED_VIEWS = 12
DOWNSCALE = 8  # Views that test a place for being inside are smaller by this factor.
CLEAR_CELLS = 2  # About 0.25 m: cameras keep this distance from surfaces.
MIN_SPACE_M3 = 1.5  # Clear space of a bathroom of 1.5 x 1.2 m; the inside of a wardrobe has 0.6.
MIN_SINGLE_SPACE_M3 = 0.6  # Of the largest space if none reaches MIN_SPACE_M3: a shower room.
MIN_HEIGHT_M = 0.8  # Height of the clear part of a space in which a person can stand.
DOWN_VOTES, SIDE_VOTES, BOTH_VOTES = 5, 6, 12  # Of 9 down, 8 level, and 17 level or up.
# Of 8 level directions, one long wall or one block meets at most 3; two walls at a corner meet 5.
CORNER_SIDE_VOTES = 4
STANDING_M = 1.6  # Eye height of a person, from which places behind low walls are visible.
HINTED_SIDE_VOTES, HINTED_BOTH_VOTES = 3, 6  # Used if the user names a place inside.
MAX_HINT_DISTANCE_M = 1.0  # Maximum distance of the named place from the space.


@dataclass(frozen=True, eq=False)
class SurfaceGrid:
    """A voxel grid of the surface of a mesh or point cloud.

    Attributes:
        occupied: Cells that contain surface, bool [X, Y, Z].
        origin_m: Corner of the grid with the smallest coordinates, in metres, float64 [3].
        cell_m: Edge length of a cell in metres.
    """

    occupied: np.ndarray
    origin_m: np.ndarray
    cell_m: float

    def centers_m(self, cells: np.ndarray) -> np.ndarray:
        """Return the centres of cells, given as int [N, 3], in metres as float64 [N, 3]."""
        return self.origin_m + (cells + 0.5) * self.cell_m


def voxelise_surface(geometry: Geometry, low_m: np.ndarray, high_m: np.ndarray) -> SurfaceGrid:
    """Mark the grid cells of a bounding box that contain surface of a mesh or point cloud.

    Args:
        geometry: The mesh or point cloud in metres.
        low_m: Minimum corner of the bounding box in metres.
        high_m: Maximum corner of the bounding box in metres.

    Raises:
        ValueError: If the triangles have far more surface than a building.
    """
    size = high_m - low_m
    cell_m = max(CELL_M, float((np.prod(size + 2 * PADDING_CELLS * CELL_M) / MAX_CELLS) ** (1 / 3)))
    shape = np.ceil(size / cell_m).astype(int) + 2 * PADDING_CELLS + 1
    origin = np.asarray(low_m - PADDING_CELLS * cell_m, np.float64)
    occupied = np.zeros(tuple(shape), np.bool_)
    if isinstance(geometry, Mesh):
        if _sample_count(geometry.vertices, geometry.faces, cell_m) > MAX_SAMPLES:
            raise ValueError(
                "the total triangle area is far larger than that of a building; check "
                "the unit of the file"
            )
        _mark_triangles(geometry.vertices, geometry.faces, origin, cell_m, occupied)
    else:
        _mark_points(geometry.points, origin, cell_m, occupied)
    return SurfaceGrid(occupied, origin, cell_m)


@njit
def _subdivisions(vertices, face, cell_m):
    """Return the number of parts to divide a triangle's edges into, so that no cell is missed."""
    longest = 0.0
    for k in range(3):
        one, other = vertices[face[k]], vertices[face[(k + 1) % 3]]
        length = 0.0
        for a in range(3):
            length += (one[a] - other[a]) ** 2
        longest = max(longest, length)
    return max(1.0, np.ceil(np.sqrt(longest) / (SAMPLE_STEP * cell_m)))


@njit
def _sample_count(vertices, faces, cell_m):
    total = 0.0
    for f in range(len(faces)):
        parts = _subdivisions(vertices, faces[f], cell_m)
        total += (parts + 1) * (parts + 2) / 2
    return total


@njit
def _mark_cell(place, origin, cell_m, occupied):
    i = int(np.floor((place[0] - origin[0]) / cell_m))
    j = int(np.floor((place[1] - origin[1]) / cell_m))
    k = int(np.floor((place[2] - origin[2]) / cell_m))
    if 0 <= i < occupied.shape[0] and 0 <= j < occupied.shape[1] and 0 <= k < occupied.shape[2]:
        occupied[i, j, k] = True


@njit
def _mark_triangles(vertices, faces, origin, cell_m, occupied):
    place = np.empty(3)
    for f in range(len(faces)):
        a, b, c = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
        parts = int(_subdivisions(vertices, faces[f], cell_m))
        for i in range(parts + 1):
            for j in range(parts + 1 - i):
                s, t = i / parts, j / parts
                for axis in range(3):
                    place[axis] = (1 - s - t) * a[axis] + s * b[axis] + t * c[axis]
                _mark_cell(place, origin, cell_m, occupied)


@njit
def _mark_points(points, origin, cell_m, occupied):
    for n in range(len(points)):
        _mark_cell(points[n], origin, cell_m, occupied)


def backface_share(mesh: Mesh, camera: Camera, camera_to_world: np.ndarray) -> float:
    """Return the share of pixels in the first camera views that see the back of a triangle."""
    small = camera.resized(camera.width_px // DOWNSCALE, camera.height_px // DOWNSCALE)
    backs, total = 0, 0
    for pose in camera_to_world[:CHECKED_VIEWS]:
        seen = render_face_ids(mesh, small, invert_rigid(pose))
        faces = mesh.faces[seen[seen != NO_FACE]]
        corners = apply(invert_rigid(pose), mesh.vertices[faces].astype(np.float64))
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        backs += int((np.einsum("fa,fa->f", across, corners[:, 0]) > 0).sum())
        total += len(faces)
    return backs / max(total, 1)


@dataclass(frozen=True, eq=False)
class Interior:
    """The free space inside a building.

    Attributes:
        clear: Cells suitable as camera positions, bool [X, Y, Z].
        drop: Number of cells down to the floor, int16 [X, Y, Z].
        spaces: Number of separate spaces.
        is_open: Whether walls are low or missing on several sides.
    """

    clear: np.ndarray
    drop: np.ndarray
    spaces: int
    is_open: bool = False


def find_interior(grid: SurfaceGrid, inside_m: np.ndarray | None = None) -> Interior | None:
    """Return the free space inside a building, or None if there is none.

    Args:
        grid: Surface grid with z up.
        inside_m: Optional point inside the room, in metres; only the space around it is returned.
    """
    down, side, up, drop = enclosure_votes(grid.occupied)
    min_side_votes, min_both_votes = SIDE_VOTES, BOTH_VOTES
    if inside_m is not None:
        min_side_votes, min_both_votes = HINTED_SIDE_VOTES, HINTED_BOTH_VOTES
    enclosed = (side >= min_side_votes) | (side + up >= min_both_votes)
    inside = ~grid.occupied & (drop > 0) & (down >= DOWN_VOTES) & enclosed
    near = ndimage.binary_dilation(
        grid.occupied, ndimage.generate_binary_structure(3, 2), iterations=CLEAR_CELLS
    )
    parts, count = label_components(inside & np.logical_not(near), corners=False)
    if inside_m is not None:
        chosen = _space_around(parts, grid, inside_m)
        return Interior(np.isin(parts, chosen), drop, len(chosen)) if chosen else None
    if chosen := _standing_spaces(parts, count, grid.cell_m):
        return Interior(np.isin(parts, chosen), drop, len(chosen))
    free = ~grid.occupied & np.logical_not(near) & (drop > 0)
    between = free & (down >= DOWN_VOTES) & (side >= CORNER_SIDE_VOTES)
    if not between.any():
        return None
    lowest = int(np.flatnonzero(between.any(axis=(0, 1)))[0]) - CLEAR_CELLS  # Just over the floor.
    eyes = lowest + round(STANDING_M / grid.cell_m)
    parts, count = label_components(_extend_upwards(between, free, eyes), corners=False)
    chosen = _standing_spaces(parts, count, grid.cell_m, min_single_m3=MIN_SPACE_M3)
    return Interior(np.isin(parts, chosen), drop, len(chosen), is_open=True) if chosen else None


def _extend_upwards(cells: np.ndarray, allowed: np.ndarray, top: int) -> np.ndarray:
    """Return cells, bool [X, Y, Z], and the runs of allowed cells over them up to layer ``top``."""
    extended = cells.copy()
    for z in range(1, min(top, cells.shape[2])):
        extended[:, :, z] |= extended[:, :, z - 1] & allowed[:, :, z]
    return extended


def _standing_spaces(
    parts: np.ndarray, count: int, cell_m: float, min_single_m3: float = MIN_SINGLE_SPACE_M3
) -> list[int]:
    """Return the numbers of the spaces in which a person can stand."""
    volumes = np.bincount(parts.ravel(), minlength=count + 1) * cell_m**3
    boxes = ndimage.find_objects(parts)
    high = [
        number
        for number, box in enumerate(boxes, 1)
        if (box[2].stop - box[2].start) * cell_m >= MIN_HEIGHT_M
    ]
    large = [number for number in high if volumes[number] >= MIN_SPACE_M3]
    if large or not high:
        return large
    largest = max(high, key=lambda number: volumes[number])
    return [largest] if volumes[largest] >= min_single_m3 else []


def _space_around(parts: np.ndarray, grid: SurfaceGrid, inside_m: np.ndarray) -> list[int]:
    """Return the number of the space nearest to the given point, if that space is close enough."""
    cells = np.argwhere(parts > 0)
    if not len(cells):
        return []
    away = np.linalg.norm(grid.centers_m(cells) - inside_m, axis=1)
    nearest = int(np.argmin(away))
    return [int(parts[tuple(cells[nearest])])] if away[nearest] <= MAX_HINT_DISTANCE_M else []


@njit
def _sweep_direction(occupied, dx, dy, dz, hit):
    """Fill ``hit`` with whether a walk by (dx, dy, dz) from each cell meets an occupied cell.

    A diagonal step does not pass between two occupied cells that touch at their edges.
    """
    nx, ny, nz = occupied.shape
    for step_x in range(nx):
        x = nx - 1 - step_x if dx > 0 else step_x
        for step_y in range(ny):
            y = ny - 1 - step_y if dy > 0 else step_y
            for step_z in range(nz):
                z = nz - 1 - step_z if dz > 0 else step_z
                a, b, c = x + dx, y + dy, z + dz
                if a < 0 or b < 0 or c < 0 or a >= nx or b >= ny or c >= nz:
                    hit[x, y, z] = False
                    continue
                found = occupied[a, b, c] or hit[a, b, c]
                if not found and abs(dx) + abs(dy) + abs(dz) == 2:
                    if dz == 0:
                        found = occupied[a, y, z] and occupied[x, b, z]
                    elif dy == 0:
                        found = occupied[a, y, z] and occupied[x, y, c]
                    else:
                        found = occupied[x, b, z] and occupied[x, y, c]
                hit[x, y, z] = found


@njit
def enclosure_votes(occupied):
    """Count for each cell the directions that meet surface, and measure the distance to the floor.

    Returns:
        The counts of downward (of 9), level (of 8) and upward (of 9) directions as uint8 [X, Y, Z]
        each, and the number of cells down to the next surface as int16 [X, Y, Z] (0 if there is
        none).
    """
    down, side = np.zeros(occupied.shape, np.uint8), np.zeros(occupied.shape, np.uint8)
    up, hit = np.zeros(occupied.shape, np.uint8), np.zeros(occupied.shape, np.bool_)
    for dx in range(-1, 2):
        for dy in range(-1, 2):
            for dz in range(-1, 2):
                if dx == 0 and dy == 0 and dz == 0:
                    continue
                _sweep_direction(occupied, dx, dy, dz, hit)
                if dz < 0:
                    down += hit
                elif dz == 0:
                    side += hit
                else:
                    up += hit
    return down, side, up, _drops_to_floor(occupied)


@njit
def _drops_to_floor(occupied):
    drop = np.zeros(occupied.shape, np.int16)
    for x in range(occupied.shape[0]):
        for y in range(occupied.shape[1]):
            for z in range(1, occupied.shape[2]):
                if occupied[x, y, z - 1]:
                    drop[x, y, z] = 1
                elif drop[x, y, z - 1] > 0:
                    drop[x, y, z] = drop[x, y, z - 1] + 1
    return drop

"""Display entities in pictures: boxes that stand anywhere, turned and stretched, drawn exactly.

Each box is carried to the unit cube by an affine map, and so is each ray; what a ray meets there,
it meets at the same ``t`` in the grid. A box is tried only at the pixels around its corners'
places in the picture, so that the cost is the pixels that boxes cover.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.jit import njit
from world2minecraft.minecraft.displays import display_cubes
from world2minecraft.render.appearance import palette_colours, visible_boxes
from world2minecraft.render.shade import (
    EDGE_BLOCKS,
    EDGE_FADE_PX,
    EDGE_SHADE,
    EXPOSURE,
    FACE_SHADE,
    GLOW,
    HASH_SHARE,
    HEADLIGHT,
    ray_of_pixel,
)
from world2minecraft.render.trace import NO_FACE
from world2minecraft.types import Entity

MOST_CUBES = 200_000  # A house in display style has some thousands.
_FLAT = 1e-9  # Blocks: a box thinner than this has no inside that a ray could enter.
_BEHIND = 1e-6


@dataclass(frozen=True, eq=False)
class CubeTable:
    """N boxes of display entities. ``grid_to_cube`` carries grid coordinates to the unit cube."""

    grid_to_cube: np.ndarray  # float64 [N, 3, 4]
    corners: np.ndarray  # float64 [N, 8, 3], in grid coordinates
    sides: np.ndarray  # float64 [N, 3], lengths in blocks
    colours: np.ndarray  # float32 [N, 4]: sRGB 0 to 255, glow
    semantic: np.ndarray  # uint8 [N]
    instance: np.ndarray  # uint16 [N]

    def __len__(self) -> int:
        return len(self.semantic)

    @property
    def normals(self) -> np.ndarray:
        """The unit normals, float64 [N, 3, 3], of each box's three upper faces, in the grid."""
        rows = self.grid_to_cube[:, :, :3]
        return rows / np.linalg.norm(rows, axis=2, keepdims=True)

    def from_camera(self, pose: np.ndarray) -> np.ndarray:
        """Return float64 [N, 3, 4], camera to unit cube, of a pose [3, 4], camera to grid."""
        return self.grid_to_cube @ np.vstack([pose, [0.0, 0.0, 0.0, 1.0]])


def cube_table(entities: Sequence[Entity], corner: Sequence[int]) -> CubeTable:
    """Return the boxes of all display entities in the grid whose cell (0, 0, 0) is at a corner.

    Args:
        entities: any; those that draw no block are left out.
        corner: the world position of the grid's cell (0, 0, 0).
    """
    matrices, colours, semantic, instance = [], [], [], []
    to_grid = np.eye(4)
    to_grid[:3, 3] = -np.asarray(corner, np.float64)
    for cube in display_cubes(entities)[:MOST_CUBES]:
        colour = palette_colours((cube.state,))[0]
        for low_high in visible_boxes(cube.state).astype(np.float64):
            part = np.diag([*(low_high[3:] - low_high[:3]), 1.0])
            part[:3, 3] = low_high[:3]
            matrices.append(to_grid @ cube.cube_to_world @ part)
            colours.append(colour)
            semantic.append(cube.class_id)
            instance.append(cube.instance)
    every = np.array(matrices).reshape(-1, 4, 4)
    solid = np.abs(np.linalg.det(every[:, :3, :3])) > _FLAT**2 if len(every) else np.zeros(0, bool)
    every = every[solid]
    unit = np.stack(np.meshgrid(*[[0.0, 1.0]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    return CubeTable(
        grid_to_cube=np.ascontiguousarray(np.linalg.inv(every)[:, :3]),
        corners=unit @ every[:, :3, :3].transpose(0, 2, 1) + every[:, None, :3, 3],
        sides=np.linalg.norm(every[:, :3, :3], axis=1),
        colours=np.array(colours, np.float32).reshape(-1, 4)[solid],
        semantic=np.array(semantic, np.uint8)[solid],
        instance=np.array(instance, np.uint16)[solid],
    )


def pixel_bounds(
    table: CubeTable, pose: np.ndarray, rays: np.ndarray, spread: float, size: tuple[int, int]
) -> np.ndarray:
    """Return the rows and columns, int64 [N, 4], that each box may cover: first and past the last.

    Args:
        table: N boxes.
        pose: float64 [3, 4], camera to grid.
        rays: float64 [4], fx, fy, cx, cy, or pixels a metre for parallel rays.
        spread: 1 for a pinhole camera, 0 for parallel rays.
        size: height and width in pixels.
    """
    grid_to_camera = np.linalg.inv(np.vstack([pose, [0, 0, 0, 1]]))
    seen = table.corners @ grid_to_camera[:3, :3].T + grid_to_camera[:3, 3]
    depth = seen[..., 2]
    along = np.where(depth > _BEHIND, depth, np.inf) if spread else np.ones_like(depth)
    result = np.empty((len(table), 4), np.int64)
    for place, (axis, limit) in enumerate(((1, size[0]), (0, size[1]))):
        at = rays[axis] * seen[..., axis] / along + rays[axis + 2]
        first, last = np.floor(at.min(axis=1)) - 1, np.ceil(at.max(axis=1)) + 1
        if spread:  # Of a box that reaches behind the camera any pixel may show a part.
            behind = (depth <= _BEHIND).any(axis=1)
            first, last = np.where(behind, 0, first), np.where(behind, limit, last)
        result[:, 2 * place] = np.clip(first, 0, limit)
        result[:, 2 * place + 1] = np.clip(last, 0, limit)
    result[(depth <= _BEHIND).all(axis=1)] = 0
    return result


@njit
def draw_cubes(
    camera_to_cube, normals, sides, colours, bounds, pose, rays, spread, first, last, with_colour,
    depth, distance, index, face, colour, cube,
):  # fmt: skip
    """Draw boxes over what ``draw_rows`` left in the rows ``first`` to ``last`` (past the end).

    In: as ``CubeTable`` (its ``from_camera`` and ``normals``), ``pixel_bounds`` and ``draw_rows``
    say. Out: as ``draw_rows``, where a box is nearer; ``index`` is -1 there and ``cube`` int32
    [H, W] is the box's number.
    """
    cell_m = 1.0 / np.sqrt(pose[0, 2] ** 2 + pose[1, 2] ** 2 + pose[2, 2] ** 2)
    for n in range(len(camera_to_cube)):
        row0, row1, column0, column1 = bounds[n]
        if row0 >= row1 or column0 >= column1:
            continue
        local = camera_to_cube[n]
        tone = 1 + HASH_SHARE * (2 * _hash(n) - 1)
        for v in range(max(row0, first), min(row1, last)):
            for u in range(column0, column1):
                x, y = (u + 0.5 - rays[2]) / rays[0], (v + 0.5 - rays[3]) / rays[1]
                ox, oy, oz, dx, dy, dz = ray_of_pixel(local, x, y, spread)
                t, side = _meet_unit(ox, oy, oz, dx, dy, dz)
                if side == NO_FACE or (depth[v, u] > 0 and t >= depth[v, u]):
                    continue
                axis = side // 2
                normal = normals[n, axis] * (1.0 if side % 2 else -1.0)
                length = np.sqrt((x * x + y * y) * spread + 1.0)
                depth[v, u], distance[v, u] = t, t * length
                index[v, u], cube[v, u] = -1, n
                face[v, u] = _nearest_face(normal)
                if not with_colour:
                    continue
                light = GLOW
                if colours[n, 3] == 0:
                    _, _, _, ax, ay, az = ray_of_pixel(pose, x, y, spread)
                    cosine = abs(normal[0] * ax + normal[1] * ay + normal[2] * az)
                    cosine *= cell_m / length
                    light = EXPOSURE * tone * _shade(normal) * (1 - HEADLIGHT * (1 - cosine))
                    block_px = cell_m * rays[0] / (t * spread + 1 - spread) * max(cosine, 0.2)
                    light *= _edges(sides[n], axis, ox + t * dx, oy + t * dy, oz + t * dz, block_px)
                for c in range(3):
                    colour[v, u, c] = np.uint8(min(255.0, colours[n, c] * light + 0.5))


@njit
def _meet_unit(ox, oy, oz, dx, dy, dz):
    """Return ``(t, face)`` where a ray enters the unit cube from outside, ahead of its origin."""
    enter, leave, face = -np.inf, np.inf, NO_FACE
    for axis in range(3):
        o = ox if axis == 0 else (oy if axis == 1 else oz)
        d = dx if axis == 0 else (dy if axis == 1 else dz)
        if abs(d) < 1e-15:
            if o < 0 or o > 1:
                return 0.0, NO_FACE
            continue
        near, far = -o / d, (1 - o) / d
        side = 2 * axis
        if near > far:
            near, far, side = far, near, side + 1
        if near > enter:
            enter, face = near, side
        leave = min(leave, far)
    if enter <= 0 or enter > leave:
        return 0.0, NO_FACE
    return enter, face


@njit
def _nearest_face(normal):
    best, face = 0.0, 0
    for axis in range(3):
        if abs(normal[axis]) > best:
            best, face = abs(normal[axis]), 2 * axis + (1 if normal[axis] > 0 else 0)
    return face


@njit
def _shade(normal):
    """Return the light of a face's direction, between those of the six of a block."""
    light = 0.0
    for axis in range(3):
        light += normal[axis] ** 2 * FACE_SHADE[2 * axis + (1 if normal[axis] > 0 else 0)]
    return light


@njit
def _edges(sides, axis, x, y, z, block_px):
    """Return how dark a face is near its edges, as blocks are."""
    strength = min(1.0, max(0.0, (block_px - EDGE_FADE_PX) / (3 * EDGE_FADE_PX)))
    inside = np.inf
    for other in range(3):
        if other != axis:
            at = x if other == 0 else (y if other == 1 else z)
            inside = min(inside, min(at, 1 - at) * sides[other])
    width = max(EDGE_BLOCKS, 0.7 / max(block_px, 1e-6))
    if inside >= width:
        return 1.0
    return 1 - EDGE_SHADE * strength * (1 - max(inside, 0.0) / width)


@njit
def _hash(n):
    """Return a number from 0 to 1 that belongs to a box."""
    mixed = ((n + 1) * 73856093) & 0x7FFFFFFF
    mixed = ((mixed ^ (mixed >> 13)) * 1274126177) & 0x7FFFFFFF
    return ((mixed ^ (mixed >> 16)) & 0xFFFF) / 65535.0

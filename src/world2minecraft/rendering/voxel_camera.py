"""Virtual depth cameras that cast rays into a fine grid of full cubes, such as a 2 cm room."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import lean
from world2minecraft.core.types import Camera
from world2minecraft.rendering.grid_traversal import (
    CUBE,
    NEAR_AIR,
    TILE,
    bundle_start,
    fill_distances,
    trace_ray,
)
from world2minecraft.rendering.picture_arrays import run_bands
from world2minecraft.rendering.ray_caster.ray import ray_of_pixel
from world2minecraft.rendering.scene_tables import NO_FACE


class VoxelHits(NamedTuple):
    """The first hits of a camera's pixels."""

    depth_m: np.ndarray  # float32 [H, W], z-depth, 0 where there is nothing
    voxel_index: np.ndarray  # int32 [H, W], C-order index into the labels, -1 where nothing
    face: np.ndarray  # uint8 [H, W], of grid axes: -x +x -y +y -z +z; 255 where nothing


@dataclass(frozen=True, eq=False)
class VoxelScene:
    """A grid of cubes prepared for ray casting."""

    cells: np.ndarray  # uint8 [X, Y, Z], see rendering.grid_traversal
    semantic: np.ndarray  # uint8 [X, Y, Z]
    room_to_grid: np.ndarray  # float64 [4, 4]: room metres to cells
    cells_per_metre: float


def prepare_voxels(labels: np.ndarray, voxel_m: float, origin_m: np.ndarray) -> VoxelScene:
    """Return the scene of a grid, in which every cell other than 0 and 255 is a full cube.

    Args:
        labels: Labels in room axes, uint8 [X, Y, Z].
        voxel_m: Cell size in metres.
        origin_m: Minimum corner of cell (0, 0, 0) in the room, float64 [3].
    """
    filled = (labels != 0) & (labels != 255)
    cells = np.where(filled, np.uint8(CUBE), np.uint8(NEAR_AIR))
    fill_distances(cells)
    room_to_grid = np.eye(4) / voxel_m
    room_to_grid[:3, 3] = -np.asarray(origin_m, np.float64) / voxel_m
    room_to_grid[3, 3] = 1
    return VoxelScene(cells, labels, room_to_grid, 1 / voxel_m)


def cast_voxels(
    labels: np.ndarray | VoxelScene,
    camera: Camera,
    camera_to_room: np.ndarray,
    *,
    voxel_m: float = 0.02,
    origin_m: tuple[float, float, float] | np.ndarray = (0.0, 0.0, 0.0),
    threads: int = 1,
) -> VoxelHits:
    """Cast the rays of a camera into a grid of full cubes.

    Args:
        labels: Labels, uint8 [X, Y, Z], with 0 and 255 for empty cells, or the result of
            ``prepare_voxels``, for which ``voxel_m`` and ``origin_m`` are ignored.
        camera: Camera intrinsics. Distortion is ignored.
        camera_to_room: Camera pose, 4x4, OpenCV axes, metres.
        voxel_m: Cell size in metres.
        origin_m: Minimum corner of cell (0, 0, 0) in the room.
        threads: Number of bands of rows computed in parallel. It does not affect the result.
    """
    scene = (
        labels
        if isinstance(labels, VoxelScene)
        else prepare_voxels(labels, voxel_m, np.array(origin_m))
    )
    pose = np.ascontiguousarray((scene.room_to_grid @ camera_to_room)[:3], np.float64)
    rays = np.array([camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px])
    size = (camera.height_px, camera.width_px)
    hits = VoxelHits(np.empty(size, np.float32), np.empty(size, np.int32), np.empty(size, np.uint8))
    run_bands(lambda rows: _cast_rows(scene.cells, pose, rays, *rows, *hits), size[0], threads)
    return hits


@lean
def _cast_rows(cells, pose, rays, first, last, depth, index, face):
    ny, nz = cells.shape[1], cells.shape[2]
    for v_tile in range(first, last, TILE):
        for u_tile in range(0, depth.shape[1], TILE):
            start = bundle_start(cells, pose, rays, 1.0, u_tile, v_tile)
            for v in range(v_tile, min(v_tile + TILE, last)):
                for u in range(u_tile, min(u_tile + TILE, depth.shape[1])):
                    x, y = (u + 0.5 - rays[2]) / rays[0], (v + 0.5 - rays[3]) / rays[1]
                    ox, oy, oz, dx, dy, dz = ray_of_pixel(pose, x, y, 1.0)
                    t, i, j, k, side = trace_ray(cells, ox, oy, oz, dx, dy, dz, start)
                    depth[v, u], face[v, u] = t, side
                    index[v, u] = (i * ny + j) * nz + k if side != NO_FACE else -1

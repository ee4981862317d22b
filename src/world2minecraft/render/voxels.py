"""Virtual scans: what a camera meets in a fine grid of full cubes, such as a 2 cm room."""

from typing import NamedTuple

import numpy as np

from world2minecraft.render.picture import render_volume
from world2minecraft.render.scene import RayScene
from world2minecraft.render.trace import FULL, NEAR_AIR, fill_distances
from world2minecraft.types import Camera


class VoxelHits(NamedTuple):
    """What the pixels of a camera meet first."""

    depth_m: np.ndarray  # float32 [H, W], z-depth, 0 where there is nothing
    voxel_index: np.ndarray  # int32 [H, W], C-order index into the labels, -1 where nothing
    face: np.ndarray  # uint8 [H, W], of grid axes: -x +x -y +y -z +z; 255 where nothing


def prepare_voxels(labels: np.ndarray, voxel_m: float, origin_m: np.ndarray) -> RayScene:
    """Return the scene of a grid: every cell that is neither 0 nor 255 is a full cube.

    Args:
        labels: uint8 [X, Y, Z] in room axes.
        voxel_m: the side of a cell in metres.
        origin_m: float64 [3], the minimum corner of cell (0, 0, 0) in the room.
    """
    filled = (labels != 0) & (labels != 255)
    cells = np.where(filled, np.uint8(FULL), np.uint8(NEAR_AIR))
    fill_distances(cells)
    room_to_grid = np.eye(4) / voxel_m
    room_to_grid[:3, 3] = -np.asarray(origin_m, np.float64) / voxel_m
    room_to_grid[3, 3] = 1
    return RayScene(
        cells=cells,
        states=np.zeros((1, 1, 1), np.uint16),
        box_start=np.zeros(2, np.int32),
        boxes=np.empty((0, 6), np.float32),
        colours=np.zeros((1, 4), np.float32),
        semantic=labels,
        instance=np.zeros((1, 1, 1), np.uint16),
        room_to_grid=room_to_grid,
        cells_per_metre=1 / voxel_m,
    )


def cast_voxels(
    labels: np.ndarray | RayScene,
    camera: Camera,
    camera_to_room: np.ndarray,
    *,
    voxel_m: float = 0.02,
    origin_m: tuple[float, float, float] | np.ndarray = (0.0, 0.0, 0.0),
    threads: int = 1,
) -> VoxelHits:
    """Cast the rays of a camera into a grid of full cubes.

    Args:
        labels: uint8 [X, Y, Z], 0 and 255 empty; or what ``prepare_voxels`` gave, for which
            ``voxel_m`` and ``origin_m`` are not read.
        camera: intrinsics; its distortion is ignored.
        camera_to_room: 4x4, OpenCV axes, metres.
        voxel_m: the side of a cell in metres.
        origin_m: the minimum corner of cell (0, 0, 0) in the room.
        threads: bands of rows cast at a time; the result is the same for any number.
    """
    scene = (
        labels
        if isinstance(labels, RayScene)
        else prepare_voxels(labels, voxel_m, np.array(origin_m))
    )
    picture = render_volume(scene, camera, camera_to_room, outputs=(), threads=threads)
    return VoxelHits(picture.depth_m, picture.block_index, picture.face)

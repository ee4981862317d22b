"""Open3D's VoxelBlockGrid as the rival of fusion: the same frames at the same voxel size.

It integrates a truncated distance, a weight and a colour into a hash of voxel blocks. Our map also
takes a normal for each point, so the rival creates the normals of each frame in the same time.
"""

from collections.abc import Sequence

import numpy as np
import open3d as o3d

from world2minecraft.core.types import View

core, vision = o3d.core, o3d.t.geometry
BLOCK_SIDE, BLOCKS = 8, 4000
TRUNCATION_VOXELS = 4.0
MAX_DEPTH_M = 6.0


def integrate(views: Sequence[View], voxel_m: float) -> "vision.VoxelBlockGrid":
    """Fuse views with depth and colour on one CPU thread setting of Open3D; return the grid."""
    device = core.Device("CPU:0")
    grid = vision.VoxelBlockGrid(
        ("tsdf", "weight", "color"),
        (core.float32, core.float32, core.float32),
        ((1), (1), (3)),
        voxel_m,
        BLOCK_SIDE,
        BLOCKS,
        device,
    )
    for view in views:
        camera, colour_camera = view.depth_camera, view.colour_camera
        assert camera is not None and colour_camera is not None
        depth = vision.Image(core.Tensor(np.ascontiguousarray(view.depth_m)))
        colour = vision.Image(core.Tensor(view.colour.astype(np.float32) / 255))
        inner, outer = _matrix(camera), _matrix(colour_camera)
        extrinsic = core.Tensor(np.linalg.inv(view.depth_camera_to_scan))
        vertices = depth.create_vertex_map(inner, 0.0)
        vertices.create_normal_map(0.0)
        blocks = grid.compute_unique_block_coordinates(
            depth, inner, extrinsic, 1.0, MAX_DEPTH_M, TRUNCATION_VOXELS
        )
        grid.integrate(
            blocks, depth, colour, inner, outer, extrinsic, 1.0, MAX_DEPTH_M, TRUNCATION_VOXELS
        )
    return grid


def _matrix(camera) -> "core.Tensor":
    return core.Tensor(
        [
            [float(camera.fx_px), 0.0, float(camera.cx_px)],
            [0.0, float(camera.fy_px), float(camera.cy_px)],
            [0.0, 0.0, 1.0],
        ]
    )

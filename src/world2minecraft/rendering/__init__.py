"""Rendering of block volumes by ray casting: colour, depth and ids without a display or a mesh.

``render_volume`` renders an image from a camera in the room, ``preview`` and ``plan_view`` show a
whole room, and ``cast_voxels`` scans a fine grid. To render many images of one volume, create its
scene once with ``prepare_scene`` or ``prepare_voxels``.
"""

from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.picture import Picture, render_parallel, render_volume
from world2minecraft.rendering.preview import plan_view, preview
from world2minecraft.rendering.scene import BlockScene, prepare_scene
from world2minecraft.rendering.shading_parameters import DAY, NEUTRAL
from world2minecraft.rendering.voxel_camera import (
    VoxelHits,
    VoxelScene,
    cast_voxels,
    prepare_voxels,
)

__all__ = [
    "DAY",
    "NEUTRAL",
    "BlockScene",
    "LightSettings",
    "Picture",
    "VoxelHits",
    "VoxelScene",
    "cast_voxels",
    "plan_view",
    "prepare_scene",
    "prepare_voxels",
    "preview",
    "render_parallel",
    "render_volume",
]

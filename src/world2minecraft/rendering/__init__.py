"""Render block volumes: colour, depth and ids by casting rays, without display or mesh.

``render_volume`` takes a picture through a camera of the room, ``preview`` and ``plan_view`` show
a whole room, ``cast_voxels`` scans a fine grid. Whoever takes many pictures of one volume makes
its scene once, with ``prepare_scene`` or ``prepare_voxels``.
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

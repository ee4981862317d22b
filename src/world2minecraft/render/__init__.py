"""Block volumes to images: colour, depth and ids by casting rays; no display, no mesh.

``render_volume`` takes a picture through a camera of the room, ``preview`` and ``plan_view`` show
a whole room, ``cast_voxels`` scans a fine grid. Whoever takes many pictures of one volume makes
its scene once, with ``prepare_scene`` or ``prepare_voxels``.
"""

from world2minecraft.render.picture import Picture, render_parallel, render_volume
from world2minecraft.render.preview import plan_view, preview
from world2minecraft.render.scene import RayScene, prepare_scene
from world2minecraft.render.voxels import VoxelHits, cast_voxels, prepare_voxels

__all__ = [
    "Picture",
    "RayScene",
    "VoxelHits",
    "cast_voxels",
    "plan_view",
    "prepare_scene",
    "prepare_voxels",
    "preview",
    "render_parallel",
    "render_volume",
]

"""Conversion of block volumes to quad meshes for web pages and game engines."""

from world2minecraft.rendering.mesh.baking import BlockMesh, mesh_of

__all__ = ["BlockMesh", "mesh_of"]

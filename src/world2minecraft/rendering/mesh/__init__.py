"""A block volume as a mesh: the quads that pages and game engines draw, as rays see them."""

from world2minecraft.rendering.mesh.baking import BlockMesh, mesh_of

__all__ = ["BlockMesh", "mesh_of"]

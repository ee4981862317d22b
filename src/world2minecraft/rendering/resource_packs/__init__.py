"""Resource packs and client jars of the user as a source of looks: ``ResourcePackModels``.

``archive`` opens a pack, ``resources`` stacks several, ``blockstates`` and ``model_files`` read
the files of a block, ``shapes`` and ``turning`` make elements of them, ``textures`` makes pictures.
"""

from world2minecraft.rendering.resource_packs.pack_models import ResourcePackModels

__all__ = ["ResourcePackModels"]
